//! The area that a stroke covers.

use super::affine::stretch;
use super::model::Part;
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::kurbo::{self, Affine, Cap, Join, Point};
use pathwarp::{Outline, Seg, Subpath};
use usvg::{LineCap, LineJoin, Stroke};

/// The work of one of the segments below: there are fewer, and fitting them is counted, too.
const EXPANDED: f64 = 15.0;

/// Segments of the outline of a dash or a subpath with its caps, and of a segment with its join. All are held three times: expanded,
/// bent, and as they are written.
const PER_DASH: f64 = 3.0 * 8.0;
const PER_SEGMENT: f64 = 3.0 * 2.0;
const PER_ROUND_SEGMENT: f64 = 3.0 * 4.0;

/// Segments whose work that of expanding a dash is.
const MEASURED: f64 = 2.0;

/// Share of the tolerance for gaps between sides that are closed without a join.
const GAP: f64 = 0.3;

/// Expands the stroke of `local` to a filled outline in the same user space, within `tolerance` there.
pub(crate) fn stroke_outline(local: &Outline, stroke: &Stroke, tolerance: f64) -> Outline {
    let each = stroke_outlines(local, stroke, |_| [(1.0 - 0.5 * GAP) * tolerance, GAP * tolerance]);
    Outline { subpaths: each.into_iter().flat_map(|(_, o)| o.subpaths).collect() }
}

/// Expands the stroke of each subpath, given by its index, within a tolerance and with gaps of its own.
pub(crate) fn stroke_outlines(
    local: &Outline,
    stroke: &Stroke,
    fine: impl Fn(usize) -> [f64; 2],
) -> Vec<(usize, Outline)> {
    let style = style(stroke);
    let clipped = stroke.linejoin() == LineJoin::MiterClip;
    let outline = |(i, s): (usize, &Subpath)| {
        let one = Outline { subpaths: vec![s.clone()] };
        // What is not finite is refused when the path itself is bent.
        (i, one.stroked(&style, clipped, fine(i)).unwrap_or_default())
    };
    local.subpaths.iter().enumerate().map(outline).collect()
}

/// A stroke's style as kurbo's.
fn style(stroke: &Stroke) -> kurbo::Stroke {
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
    let style = kurbo::Stroke::new(f64::from(stroke.width().get()))
        .with_caps(cap)
        .with_join(join)
        .with_miter_limit(f64::from(stroke.miterlimit().get()));
    match stroke.dasharray() {
        Some(dashes) => style.with_dashes(f64::from(stroke.dashoffset()), dashes.iter().copied().map(f64::from)),
        None => style,
    }
}

/// The area that a part's stroke covers in root user space, to be filled by the nonzero rule, within `tolerance` there. `to_px` leads from
/// root user space to px.
///
/// # Errors
/// More segments than the limit allows.
pub(crate) fn stroked(
    part: &Part,
    to_px: Affine,
    tolerance: f64,
    budget: &Budget,
) -> Result<Option<Outline>, Exceeded> {
    let Some(stroke) = &part.stroke else { return Ok(None) };
    if part.in_tile {
        return Ok(Some(Outline::clone(&part.outline())));
    }
    spend_stroke(&part.local, stroke, budget)?;
    // The space in which the width counts, as seen from root user space.
    let frame = if part.fixed_width { to_px.inverse() } else { part.frame };
    let scale = stretch(frame);
    if !(scale > 0.0 && scale.is_finite()) {
        return Ok(None);
    }
    let path = if part.fixed_width { part.outline().transformed(to_px) } else { Outline::clone(&part.local) };
    Ok(Some(stroke_outline(&path, stroke, tolerance / scale).transformed(frame)))
}

/// Returns `true` if the whole segment is the point `at`.
pub(crate) fn is_point(s: &Seg, at: Point) -> bool {
    let c = s.to_cubic();
    [c.p0, c.p1, c.p2, c.p3].iter().all(|p| *p == at)
}

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
    let pattern: Vec<f64> = stroke.dasharray().into_iter().flatten().map(|d| f64::from(*d)).collect();
    local.drawn_dashes(&pattern)
}
