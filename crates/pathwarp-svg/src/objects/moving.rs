//! Moves an object by a transform of root user space.

use super::nodes::{by_id, parse};
use super::patches::apply;
use crate::source::number::matrix;
use pathwarp::Error;
use pathwarp::budget::Limits;
use pathwarp::kurbo::Affine;
use std::str::FromStr;
use usvg::roxmltree::Node;

/// Moves the object with an id by `by`, a transform of root user space, with its `transform` attribute.
///
/// # Errors
/// Returns [`Error::Input`] if `svg` is not XML, or takes more work than the limits allow.
pub fn moved(svg: &str, id: &str, by: Affine, limits: &Limits) -> Result<String, Error> {
    let doc = parse(svg, limits)?;
    let Some(&n) = by_id(&doc).get(id) else { return Ok(svg.to_owned()) };
    let around: Vec<Affine> = n.ancestors().skip(1).map(own_transform).collect();
    let around = around.into_iter().rev().fold(Affine::IDENTITY, |all, t| all * t);
    let new = matrix(around.inverse() * by * around * own_transform(n));
    let patch = match n.attributes().find(|a| a.name() == "transform" && a.namespace().is_none()) {
        Some(a) => (a.range_value(), new),
        None => {
            let start = n.range().start + 1;
            let rest = &svg[start..];
            let end =
                start + rest.find(|c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>')).unwrap_or(rest.len());
            (end..end, format!(" transform=\"{new}\""))
        }
    };
    Ok(apply(svg, vec![patch]))
}

/// The element's own transform.
fn own_transform(n: Node<'_, '_>) -> Affine {
    let read = |t| svgtypes::Transform::from_str(t).ok();
    let t = n.attribute("transform").and_then(read).unwrap_or_default();
    Affine::new([t.a, t.b, t.c, t.d, t.e, t.f])
}
