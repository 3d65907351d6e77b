//! The area that a stroke covers.

use super::affine::stretch;
use super::expand::{spend_stroke, stroke_outline};
use super::model::Part;
use pathwarp::Outline;
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::kurbo::Affine;

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
