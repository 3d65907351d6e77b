//! Slots: groups that can only be moved as a whole.

use super::builder::{Context, SceneBuilder};
use crate::scene::affine::{affine, is_near};
use crate::scene::model::{PartRole, Slot};
use crate::source::tags::ElementId;
use pathwarp::kurbo::{Affine, Rect};

/// A group about to be resolved.
pub(super) struct GroupAt<'g> {
    pub(super) group: &'g usvg::Group,
    /// The element with the group's id.
    pub(super) source: Option<ElementId>,
    /// That element, or else the only shape or text that the group was made for.
    pub(super) element: Option<ElementId>,
    /// From outside of the group to root user space.
    pub(super) parent: Affine,
    /// From inside the group to root user space.
    pub(super) frame: Affine,
}

/// Adds a slot if the group holds content that cannot be bent, and there is a transform to take the fit.
pub(super) fn slot(b: &mut SceneBuilder<'_>, at: &GroupAt<'_>, context: Context) -> Option<usize> {
    let g = at.group;
    let image = at.element.filter(|&e| b.tag(e) == "image");
    let vector = holds_drawing(g);
    let raster = !vector && g.children().iter().any(|c| matches!(c, usvg::Node::Image(_)));
    // The root has no transform to take the fit; a single image in it has.
    if g.filters().is_empty() && (b.is_top(g) || vector || image.is_none() && !raster)
        || matches!(context.role, PartRole::Clip | PartRole::Pattern)
        || context.slot.is_some_and(|s| image.is_some() && b.scene.slots[s].element == at.element)
    {
        return None;
    }
    // In a fragment, the group's own transform is written; elsewhere, an element's.
    if context.owner.is_none() && b.scene.unpatchable.is_none() && !takes_fit(b, at, image.is_some()) {
        return None;
    }
    // The group of an image holds its placing, which is not the element's transform.
    let before = image.is_some() && at.source == image || image.is_none() && raster;
    let r = g.bounding_box();
    let corners = Rect::new(f64::from(r.left()), f64::from(r.top()), f64::from(r.right()), f64::from(r.bottom()));
    let (frame, area) =
        if before { (at.parent, affine(g.transform()).transform_rect_bbox(corners)) } else { (at.frame, corners) };
    let parts = b.scene.parts.len()..b.scene.parts.len();
    b.scene.slots.push(Slot {
        outer: context.slot,
        frame,
        area,
        before,
        element: at.element,
        owner: context.owner,
        parts,
    });
    Some(b.scene.slots.len() - 1)
}

/// Returns `true` if the fit can be written to the `transform` of the group's element.
fn takes_fit(b: &SceneBuilder<'_>, at: &GroupAt<'_>, is_image: bool) -> bool {
    let source = b.reader.source;
    let only_transform_attribute = |e: ElementId| {
        b.tag(e) != "svg"
            && source.attr(e, "transform-origin").is_none()
            && !source.attr(e, "style").is_some_and(|s| s.contains("transform"))
            && !source.css_declares("transform")
    };
    at.element.is_some_and(|e| {
        only_transform_attribute(e)
            && (at.source == Some(e) && is_image
                || b.reader.own_transform(e).is_some_and(|t| is_near(t, affine(at.group.transform()))))
    })
}

/// Returns `true` if the group's only content is a drawing shown as an image.
pub(super) fn holds_drawing(g: &usvg::Group) -> bool {
    match g.children() {
        [usvg::Node::Image(i)] => matches!(i.kind(), usvg::ImageKind::SVG(_)),
        [usvg::Node::Group(g)] => g.id().is_empty() && holds_drawing(g),
        _ => false,
    }
}
