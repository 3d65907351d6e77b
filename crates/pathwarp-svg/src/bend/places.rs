//! Places at which the paint of a shape is seen: inside a fill, or along a stroke.

use pathwarp::Outline;
use pathwarp::kurbo::{self, BezPath, ParamCurve as _, ParamCurveArclen as _, Point, Rect, Vec2};
use pathwarp::outline::boundary;
use usvg::FillRule;

/// Number of places tried over the box of a fill; a Fibonacci number, for which the lattice is most even.
const TRIED: usize = 610;
/// The same where every place counts, and for thin shapes, which few of the first meet.
const TRIED_DENSELY: usize = 6765;
/// Fewer places than these are too few to judge by.
const FEW: usize = 128;
/// Number of places along a stroke.
const ALONG: usize = 377;
/// Flattening tolerance, relative to the box.
const FLATNESS: f64 = 1e-3;

/// Places inside an outline, spread evenly over its area: no two have a coordinate in common, so that bands of any direction are
/// met.
pub(super) fn inside(outline: &Outline, rule: FillRule, densely: bool) -> Vec<Point> {
    let Some(bounds) = outline.bounding_box() else { return Vec::new() };
    let lines = lines(outline, bounds);
    let found = if densely { Vec::new() } else { lattice(&lines, bounds, rule, TRIED) };
    if found.len() >= FEW { found } else { lattice(&lines, bounds, rule, TRIED_DENSELY) }
}

/// Places on a stroke of the given width around an outline, without caps and dashes.
pub(super) fn along(outline: &Outline, width: f64) -> Vec<Point> {
    let Some(bounds) = outline.bounding_box() else { return Vec::new() };
    let path = flat(outline, bounds);
    let lengths: Vec<(kurbo::PathSeg, f64)> = path.segments().map(|s| (s, s.arclen(bounds.width()))).collect();
    let total: f64 = lengths.iter().map(|l| l.1).sum();
    let mut out = Vec::with_capacity(ALONG);
    let mut before = 0.0;
    for (segment, length) in lengths.iter().filter(|l| l.1 > 0.0) {
        let normal = (segment.end() - segment.start()).turn_90() / *length;
        while (out.len() as f64 + 0.5) / ALONG as f64 * total < before + length && out.len() < ALONG {
            let n = out.len() as f64;
            let t = ((n + 0.5) / ALONG as f64 * total - before) / length;
            out.push(segment.eval(t) + normal * width * (golden(n) - 0.5));
        }
        before += length;
    }
    out
}

/// The fractional part of n times the golden ratio.
fn golden(n: f64) -> f64 {
    const RATIO: f64 = 0.618_033_988_749_894_9;
    (n * RATIO).fract()
}

fn flatness(bounds: Rect) -> f64 {
    FLATNESS * bounds.width().hypot(bounds.height())
}

fn flat(outline: &Outline, bounds: Rect) -> BezPath {
    let tolerance = flatness(bounds);
    let mut out = BezPath::new();
    kurbo::flatten(outline.to_bez_path(tolerance), tolerance, |e| out.push(e));
    out
}

/// The lines of the flattened outline, with subpaths closed.
fn lines(outline: &Outline, bounds: Rect) -> Vec<(Point, Point)> {
    let tolerance = flatness(bounds);
    let mut out = Vec::new();
    boundary(outline.to_bez_path(tolerance), tolerance, |a, b| out.push((a, b)));
    out
}

/// The points of the Fibonacci lattice of `n` points over a box that lie inside. Every line adds to the winding numbers of the
/// points to its right, which have ordered ordinates.
fn lattice(lines: &[(Point, Point)], bounds: Rect, rule: FillRule, n: usize) -> Vec<Point> {
    let size = Vec2::new(bounds.width(), bounds.height());
    let row = |k: usize| bounds.y0 + size.y * (k as f64 + 0.5) / n as f64;
    let point = |k: usize| Point::new(bounds.x0 + size.x * golden(k as f64 + 0.5), row(k));
    let first_from = |y: f64| (((y - bounds.y0) / size.y * n as f64 - 0.5).ceil().max(0.0) as usize).min(n);
    let mut windings = vec![0_i32; n];
    for (a, b) in lines.iter().filter(|(a, b)| a.y != b.y) {
        let (top, bottom, direction) = if a.y < b.y { (a, b, 1) } else { (b, a, -1) };
        let slope = (bottom.x - top.x) / (bottom.y - top.y);
        let from = first_from(top.y);
        for (k, winding) in windings[..first_from(bottom.y)].iter_mut().enumerate().skip(from) {
            let p = point(k);
            if top.x + slope * (p.y - top.y) <= p.x {
                *winding += direction;
            }
        }
    }
    let filled = |w: i32| if rule == FillRule::EvenOdd { w % 2 != 0 } else { w != 0 };
    windings.into_iter().enumerate().filter(|(_, w)| filled(*w)).map(|(k, _)| point(k)).collect()
}

#[cfg(test)]
mod tests;
