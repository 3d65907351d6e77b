//! Shapes with markers in usvg's tree.

use super::builder::SceneBuilder;
use crate::source::tags::{ElementId, is_shape};

/// Finds the children of a group that belong to shapes with markers: the shape and the group of marker instances next to it.
/// Returns their indices with the shape's element.
pub(super) fn marked_children(b: &SceneBuilder<'_>, g: &usvg::Group) -> Vec<(usize, ElementId)> {
    let mut out = Vec::new();
    let shape = |i: usize| match g.children().get(i) {
        Some(usvg::Node::Path(p)) => b.element(p.id()).filter(|&e| is_shape(b.tag(e))),
        _ => None,
    };
    for (i, c) in g.children().iter().enumerate() {
        let usvg::Node::Group(c) = c else { continue };
        let anonymous = c.id().is_empty() && c.transform().is_identity() && c.opacity().get() == 1.0;
        if !anonymous || c.clip_path().is_some() || c.children().is_empty() {
            continue;
        }
        // Each marker instance is a group without an id.
        let instances = c.children().iter().all(|m| matches!(m, usvg::Node::Group(m) if m.id().is_empty()));
        if !instances || b.has_ids(c) {
            continue;
        }
        for j in [i.wrapping_sub(1), i + 1] {
            if let Some(e) = shape(j) {
                out.push((i, e));
                out.push((j, e));
                break;
            }
        }
    }
    out
}
