//! Attributes of patterns, transformed by the affine fit of the map.

use crate::scene::affine::affine;
use crate::source::number::{matrix, short};
use pathwarp::kurbo::Affine;
use pathwarp_reader::xml::escape;
use std::fmt::Write as _;
use usvg::Pattern;

/// Writes the attributes of a pattern.
pub(super) fn head(pattern: &Pattern, id: &str, fit: Affine) -> String {
    let r = pattern.rect();
    let mut out = format!(
        " id=\"{}\" patternUnits=\"userSpaceOnUse\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"",
        escape(id),
        short(r.x().into()),
        short(r.y().into()),
        short(r.width().into()),
        short(r.height().into())
    );
    let t = fit * affine(pattern.transform());
    if t != Affine::IDENTITY {
        let _ = write!(out, " patternTransform=\"{}\"", matrix(t));
    }
    out
}
