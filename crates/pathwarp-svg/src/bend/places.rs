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
mod tests {
    use super::*;
    use pathwarp::kurbo::Shape as _;

    /// Agrees with kurbo's winding numbers, computed point by point.
    #[test]
    fn places_inside_are_inside_and_evenly_spread() {
        for data in [
            "M0,0 H100 V80 H0 Z M20,20 V60 H80 V20 Z",
            "M50,0 C110,10 90,100 40,90 S-20,10 50,0 Z M30,30 h20 v20 h-20 Z",
            "M0,50 A50,50 0 1 1 100,50 A50,50 0 1 1 0,50 Z",
            "M0,0 L100,0 L0,70 L100,70",
        ] {
            let outline = Outline::from_svg(data).unwrap();
            let path = Outline::from_svg(&format!("{data} Z")).unwrap().to_bez_path(1e-6);
            for rule in [FillRule::NonZero, FillRule::EvenOdd] {
                let filled = |p: Point| {
                    let w = path.winding(p);
                    if rule == FillRule::EvenOdd { w % 2 != 0 } else { w != 0 }
                };
                let bounds = outline.bounding_box().unwrap();
                let every = lattice(&[], bounds, rule, TRIED);
                assert!(every.is_empty());
                let found = inside(&outline, rule, false);
                let wrong = found.iter().filter(|p| !filled(**p)).count();
                assert!(wrong <= found.len() / 100, "{data}: {wrong} of {}", found.len());
                // Their share is that of the area.
                let fine = 200 * 200;
                let at = |k: u32| {
                    bounds.origin()
                        + Vec2::new(
                            bounds.width() * (f64::from(k % 200) + 0.5) / 200.0,
                            bounds.height() * (f64::from(k / 200) + 0.5) / 200.0,
                        )
                };
                let area = f64::from((0..fine).filter(|k| filled(at(*k))).count() as u32) / f64::from(fine);
                let share = found.len() as f64 / TRIED as f64;
                assert!((share - area).abs() < 0.02, "{data}: {share} for {area}");
            }
        }
    }

    #[test]
    fn thin_shapes_are_sampled_more_densely() {
        let sliver = Outline::from_svg("M0,0 L100,100 L100,101 L0,1 Z").unwrap();
        let found = inside(&sliver, FillRule::NonZero, false);
        assert!(found.len() > 40, "{}", found.len());
        assert!(found.iter().all(|p| p.y - p.x > -0.01 && p.y - p.x < 1.01));
    }

    #[test]
    fn strokes_are_sampled_along_their_path() {
        let path = Outline::from_svg("M0,0 H100 V50").unwrap();
        let found = along(&path, 4.0);
        assert_eq!(found.len(), ALONG);
        assert!(found.iter().all(|p| (p.y.abs() <= 2.0 && p.x <= 100.0) || (p.x - 100.0).abs() <= 2.0));
        let down = found.iter().filter(|p| p.y > 2.0).count();
        assert!((down as f64 / ALONG as f64 - 48.0 / 150.0).abs() < 0.03, "{down}");
        assert!(along(&Outline::from_svg("M5,5").unwrap(), 1.0).is_empty());
    }
}
