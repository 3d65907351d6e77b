//! Expands strokes to filled outlines.

use super::regular::{is_point, polygon, regular};
use super::tidy::tidy;
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::kurbo::{self, Cap, Circle, Join, Rect, Shape as _, StrokeOpts};
use pathwarp::{Outline, Seg};
use usvg::{LineCap, LineJoin, Stroke};

/// Length of a dash that stands for a dot, as a fraction of the stroke width.
const DOT: f64 = 1e-5;

/// Share of the tolerance for regular segments and true arcs as cubics. Their error falls with the sixth power of their number.
const PATH: f64 = 0.2;
/// The same of a dashed path: cubics beside an arc by this much all around are longer by as much for each radian, and dashes move on.
const DASHED_PATH: f64 = 0.01;

/// Expands the stroke of `local` to a filled outline in the same user space, within `tolerance` there.
pub(crate) fn stroke_outline(local: &Outline, stroke: &Stroke, tolerance: f64) -> Outline {
    let each = stroke_outlines(local, stroke, |_| tolerance);
    Outline { subpaths: each.into_iter().flat_map(|(_, o)| o.subpaths).collect() }
}

/// Expands the stroke of each subpath, given by its index, within a tolerance of its own.
pub(crate) fn stroke_outlines(
    local: &Outline,
    stroke: &Stroke,
    tolerance: impl Fn(usize) -> f64,
) -> Vec<(usize, Outline)> {
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
    let width = f64::from(stroke.width().get());
    let dot = if cap == Cap::Butt { 0.0 } else { DOT * width };
    if let Some(dashes) = stroke.dasharray() {
        // kurbo drops dashes of zero length, which should show their caps.
        let dashes: Vec<f64> = dashes.iter().map(|d| f64::from(*d).max(dot)).collect();
        if dash_count(local, &dashes) < MOST_DASHES {
            style = style.with_dashes(f64::from(stroke.dashoffset()), dashes);
        }
    }
    // Subpaths of zero length show only their caps.
    let (points, lines): (Vec<_>, Vec<_>) =
        local.subpaths.iter().enumerate().partition(|(_, s)| s.segs.iter().all(|g| is_point(g, s.start)));
    let expanded = |o: &Outline, tolerance: f64| -> Outline {
        let share = if style.dash_pattern.is_empty() { PATH } else { DASHED_PATH };
        let path = o.to_bez_path(share * tolerance);
        (&kurbo::stroke(path, &style, &StrokeOpts::default(), (1.0 - PATH) * tolerance)).into()
    };
    let mut out = Vec::with_capacity(local.subpaths.len());
    for (i, s) in lines {
        let tolerance = tolerance(i);
        let s = regular(s, PATH * tolerance);
        let mut edge = expanded(&Outline { subpaths: vec![s.clone()] }, tolerance);
        if !is_finite(&edge) {
            edge = expanded(&polygon(&s, PATH * tolerance), tolerance);
        }
        out.push((i, tidy(edge, &s, 0.5 * width)));
    }
    let reach = width / 2.0;
    for (i, s) in points.into_iter().filter(|(_, s)| s.closed || !s.segs.is_empty()) {
        let dot = match cap {
            Cap::Butt => continue,
            Cap::Round => Circle::new(s.start, reach).to_path(tolerance(i)),
            Cap::Square => Rect::from_center_size(s.start, (2.0 * reach, 2.0 * reach)).to_path(tolerance(i)),
        };
        out.push((i, Outline::from(&dot)));
    }
    out
}

/// Limit on the dashes of a path. More would take long and look like a grey line.
const MOST_DASHES: f64 = 20_000.0;

/// The work of one of the segments below: there are fewer, and fitting them is counted, too.
const EXPANDED: f64 = 15.0;

/// Segments of the outline of a dash or a subpath with its caps, and of a segment with its join. All are held three times: expanded,
/// bent, and as they are written.
const PER_DASH: f64 = 3.0 * 8.0;
const PER_SEGMENT: f64 = 3.0 * 2.0;
const PER_ROUND_SEGMENT: f64 = 3.0 * 4.0;

/// Segments whose work that of expanding a dash is.
const MEASURED: f64 = 2.0;

/// The work of expanding the dashes of a stroke, in segments. They are held only until the stroke is measured.
pub(crate) fn spend_dashes(local: &Outline, stroke: &Stroke, budget: &Budget) -> Result<(), Exceeded> {
    budget.spend(EXPANDED * MEASURED * drawn_dashes(local, stroke))
}

/// Counts a bound for the segments into which a stroke is expanded.
///
/// # Errors
/// It is more work than the limit allows.
pub(crate) fn spend_stroke(local: &Outline, stroke: &Stroke, budget: &Budget) -> Result<(), Exceeded> {
    let dashes = drawn_dashes(local, stroke);
    let each = if stroke.linejoin() == LineJoin::Round { PER_ROUND_SEGMENT } else { PER_SEGMENT };
    let segments = PER_DASH * (dashes + local.subpaths.len() as f64) + each * local.segs().count() as f64;
    budget.spend(EXPANDED * segments)
}

/// A bound for the number of dashes that are drawn of a stroke.
fn drawn_dashes(local: &Outline, stroke: &Stroke) -> f64 {
    let Some(dashes) = stroke.dasharray() else { return 0.0 };
    let dashes: Vec<f64> = dashes.iter().map(|d| f64::from(*d)).collect();
    let count = dash_count(local, &dashes);
    if count < MOST_DASHES { count } else { 0.0 }
}

/// A bound for the number of dashes along an outline; infinite if they have no length.
fn dash_count(local: &Outline, dashes: &[f64]) -> f64 {
    /// A dash and a gap.
    const PAIR: f64 = 2.0;
    let period: f64 = dashes.iter().sum();
    if period > 0.0 { rough_length(local) / period * dashes.len() as f64 / PAIR } else { f64::INFINITY }
}

/// Returns `true` if all control points of an outline are finite.
fn is_finite(o: &Outline) -> bool {
    o.segs().map(Seg::to_cubic).all(|c| [c.p0, c.p1, c.p2, c.p3].iter().all(|p| p.is_finite()))
}

/// Length of the control polygons, an upper bound of the path's length.
fn rough_length(o: &Outline) -> f64 {
    let leg = |s: &Seg| {
        let c = s.to_cubic();
        c.p0.distance(c.p1) + c.p1.distance(c.p2) + c.p2.distance(c.p3)
    };
    o.segs().map(leg).sum()
}
