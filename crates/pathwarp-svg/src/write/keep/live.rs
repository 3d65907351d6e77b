//! Inkscape's live shapes and path effects: a warped shape is a plain path, and says so.

use super::keeper::{GEOMETRY, Keeper};
use super::warped::Warped;
use crate::source::element::Attr;
use crate::source::live::is_live;
use crate::source::tags::{ElementId, Namespace, is_shape};

/// Removes live attributes from everything that is warped or contains anything warped. The rest of a live group that is
/// warped in part loses those that mean nothing without the group.
pub(super) fn let_go(k: &mut Keeper<'_, '_>, warped: &Warped) {
    let source = k.source;
    // No element is live without a declared namespace, and most drawings have none.
    if !source.elements.iter().any(|e| e.attrs.iter().any(|a| is_live(a, &source.text))) {
        return;
    }
    for e in (0..source.elements.len()).filter(|&e| warped.within[e]) {
        if is_shape(k.tag(e)) && source.attr_in(e, Namespace::Sodipodi, "type").is_some() {
            // A rectangle with a path effect is a `path` with the attributes of a `rect`; a linked offset has a link.
            for name in GEOMETRY.into_iter().filter(|n| *n != "d").chain(["href"]) {
                k.edits.remove_attr(e, name);
            }
        }
        k.edits.remove_attrs(e, |a| is_live(a, &source.text));
        orphans(k, e, warped);
    }
}

/// Releases the shapes of a 3D box, and those under a group's path effect, that are not warped themselves.
fn orphans(k: &mut Keeper<'_, '_>, group: ElementId, warped: &Warped) {
    let source = k.source;
    let is_box = source.attr_in(group, Namespace::Sodipodi, "type").is_some_and(|t| t == "inkscape:box3d");
    let has_effect = |e: ElementId| source.attr_in(e, Namespace::Inkscape, "path-effect").is_some();
    if is_shape(k.tag(group)) || !(is_box || has_effect(group)) {
        return;
    }
    for e in source.descendants(group).filter(|&e| !warped.within[e]) {
        let is_orphan = |a: &Attr| match (a.namespace, a.name(&source.text)) {
            (Namespace::Sodipodi, "type") | (Namespace::Inkscape, "box3dsidetype") => is_box,
            (Namespace::Inkscape, "original-d") => !has_effect(e),
            _ => false,
        };
        k.edits.remove_attrs(e, is_orphan);
    }
}
