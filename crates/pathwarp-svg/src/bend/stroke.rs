//! What a map does to a stroke: the width it should have, how wrong one width is, and the stroke's outline.

use crate::bend::part::stretch;
use pathwarp::Outline;
use pathwarp::kurbo::{self, Affine, Cap, Circle, Join, Point, Rect, Shape as _, StrokeOpts, Vec2};
use pathwarp::map::Map;
use usvg::{LineCap, LineJoin, Stroke};

/// How a map scales a stroke's width along a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Width {
    /// The factor for the width, and for dashes.
    pub(crate) scale: f64,
    /// The largest relative error of that one factor anywhere on the path.
    pub(crate) error: f64,
}

/// A direction under a linear map.
fn linear(m: Affine, v: Vec2) -> Vec2 {
    let [a, b, c, d, ..] = m.as_coeffs();
    Vec2::new(a * v.x + c * v.y, b * v.x + d * v.y)
}

/// Looks at the map along `outline` (root user space) of a part whose user space was `read` and will be `write`. `None` where
/// the map has no finite derivative.
pub(crate) fn width(outline: &Outline, read: Affine, write: Affine, map: &dyn Map, stroke: &Stroke) -> Option<Width> {
    let (before, after) = (read.inverse(), write.inverse());
    let frames = (after.determinant() / before.determinant()).abs();
    let (mut across, mut along) = (Vec::new(), Vec::new());
    let (mut area, mut length) = (0.0, 0.0);
    let mut dots: Vec<f64> = Vec::new();
    let segments = outline.segs().count().max(1);
    // Long paths tell enough with fewer samples on each segment.
    let samples: &[f64] = match segments {
        0..=64 => &[0.0, 0.25, 0.5, 0.75, 1.0],
        65..=4096 => &[0.1, 0.5, 0.9],
        _ => &[0.5],
    };
    for s in outline.segs() {
        for &t in samples {
            let (p, v) = (s.eval(t), s.deriv(t));
            let jet = map.jet(p);
            let here = linear(before, v).hypot();
            let there = linear(after, jet.push(v)).hypot();
            if here <= 0.0 {
                // A dot shows its caps, which reach every way.
                let column = |e| linear(after, jet.push(linear(read, e)));
                let (x, y) = (column(Vec2::new(1.0, 0.0)), column(Vec2::new(0.0, 1.0)));
                let long = stretch(Affine::new([x.x, x.y, y.x, y.y, 0.0, 0.0]));
                if is_point(s, s.start()) && stroke.linecap() != LineCap::Butt && long > 0.0 {
                    dots.extend([long, x.cross(y).abs() / long]);
                }
                continue;
            }
            let det = jet.det().abs() * frames;
            if !(det.is_finite() && there > 0.0) {
                return None;
            }
            across.push(det * here / there);
            along.push(there / here);
            area += det.sqrt() * here;
            length += here;
        }
    }
    let scale = match dots.as_slice() {
        _ if length > 0.0 => area / length,
        [long, short, ..] => (long * short).sqrt(),
        _ => return Some(Width { scale: 1.0, error: 0.0 }),
    };
    along.extend(&dots);
    let worst = |all: &[f64]| all.iter().fold(0.0_f64, |m, r| m.max((r / scale - 1.0).abs()));
    let mut error = worst(&across);
    // Caps, joins and dashes reach along the path as well.
    if segments > 1 || !dots.is_empty() || stroke.linecap() != LineCap::Butt || stroke.dasharray().is_some() {
        error = error.max(worst(&along));
    }
    Some(Width { scale, error })
}

impl Width {
    /// One width for what has several: the mean one, as wrong as it is anywhere.
    pub(crate) fn common(all: &[Self]) -> Option<Self> {
        let scale = all.iter().map(|w| w.scale).sum::<f64>() / all.len() as f64;
        let wrong = |w: &Self| (1.0 + w.error) * (w.scale / scale).max(scale / w.scale) - 1.0;
        let error = all.iter().map(wrong).fold(0.0, f64::max);
        (scale > 0.0).then_some(Self { scale, error })
    }
}

/// The stroke of `local` as a filled outline in the same user space, within `tolerance` there.
pub(crate) fn outline(local: &Outline, stroke: &Stroke, tolerance: f64) -> Outline {
    let cap = match stroke.linecap() {
        LineCap::Butt => Cap::Butt,
        LineCap::Round => Cap::Round,
        LineCap::Square => Cap::Square,
    };
    let join = match stroke.linejoin() {
        LineJoin::Miter | LineJoin::MiterClip => Join::Miter,
        LineJoin::Round => Join::Round,
        LineJoin::Bevel => Join::Bevel,
    };
    let mut style = kurbo::Stroke::new(f64::from(stroke.width().get()))
        .with_caps(cap)
        .with_join(join)
        .with_miter_limit(f64::from(stroke.miterlimit().get()));
    let dot = if cap == Cap::Butt { 0.0 } else { DOT * f64::from(stroke.width().get()) };
    if let Some(dashes) = stroke.dasharray() {
        // A dash of no length still shows its caps; an expander sees it only if it has some.
        let dashes: Vec<f64> = dashes.iter().map(|d| f64::from(*d).max(dot)).collect();
        /// Dashes finer than this many on one path would be a grey line and no end of work.
        const MOST_DASHES: f64 = 20_000.0;
        let period: f64 = dashes.iter().sum();
        if period > 0.0 && rough_length(local) / period * (dashes.len() as f64) < 2.0 * MOST_DASHES {
            style = style.with_dashes(f64::from(stroke.dashoffset()), dashes);
        }
    }
    // Subpaths of no length show their caps alone.
    let (points, lines): (Vec<_>, Vec<_>) =
        local.subpaths.iter().cloned().partition(|s| s.segs.iter().all(|g| is_point(g, s.start)));
    let path = Outline { subpaths: lines }.to_bez_path(tolerance);
    let mut out: Outline = (&kurbo::stroke(path, &style, &StrokeOpts::default(), tolerance)).into();
    let reach = f64::from(stroke.width().get()) / 2.0;
    for s in points.iter().filter(|s| s.closed || !s.segs.is_empty()) {
        let dot = match cap {
            Cap::Butt => continue,
            Cap::Round => Circle::new(s.start, reach).to_path(tolerance),
            Cap::Square => Rect::from_center_size(s.start, (2.0 * reach, 2.0 * reach)).to_path(tolerance),
        };
        out.subpaths.extend(Outline::from(&dot).subpaths);
    }
    out
}

/// The part of the width that a dot is long.
const DOT: f64 = 1e-5;

fn is_point(s: &pathwarp::Seg, at: Point) -> bool {
    let c = s.to_cubic();
    [c.p0, c.p1, c.p2, c.p3].iter().all(|p| *p == at)
}

/// The control polygons' length: an upper bound.
fn rough_length(o: &Outline) -> f64 {
    let leg = |s: &pathwarp::Seg| {
        let c = s.to_cubic();
        c.p0.distance(c.p1) + c.p1.distance(c.p2) + c.p2.distance(c.p3)
    };
    o.segs().map(leg).sum()
}
