//! Animations under a warp. They stay unless they move a warped shape, or apply to an element that has become a group.

use super::keeper::{GEOMETRY, Keeper};
use super::warped::Warped;
use crate::source::tags::{ElementId, is_animation};
use crate::source::text::SourceText;

const OF_GEOMETRY: &str = "animations of a shape's geometry are dropped, as the shape is warped";
const OF_POSITION: &str = "animations that move warped shapes along straight lines are dropped";
const OF_PAINT: &str =
    "animations of fill and stroke are dropped where a shape, text or copy has become a group of several";

/// Property changed by an animation.
enum Animated {
    Geometry,
    Position,
    Paint,
    Other,
}

/// Removes animations that no longer fit.
pub(super) fn remove_unfit(k: &mut Keeper<'_, '_>, warped: &Warped) {
    let source = k.source;
    if !source.animated {
        return;
    }
    for a in (0..source.elements.len()).filter(|&a| is_animation(&source.elements[a].tag)) {
        let target = match source.href(a) {
            Some(id) => source.by_id().get(&id).and_then(|all| all.first().copied()),
            None => source.elements[a].parent,
        };
        let Some(target) = target else { continue };
        let why = match animated(source, a) {
            Animated::Geometry if warped.own[target] => OF_GEOMETRY,
            Animated::Position if warped.within[target] => OF_POSITION,
            Animated::Paint if k.fragments.contains(&target) => OF_PAINT,
            _ => continue,
        };
        k.edits.replace(a, String::new());
        k.writer.notes.add(why, &source.display_name(target));
    }
}

/// The animations among the children of an element whose content is replaced, except those that no longer fit.
pub(super) fn kept(source: &SourceText, e: ElementId) -> String {
    let children = source
        .descendants(e)
        .filter(|&c| source.elements[c].parent == Some(e) && is_animation(&source.elements[c].tag));
    let kept = children.filter(|&c| matches!(animated(source, c), Animated::Other));
    kept.map(|c| &source.text[source.elements[c].range.clone()]).collect()
}

fn animated(source: &SourceText, a: ElementId) -> Animated {
    if matches!(source.elements[a].tag.as_ref(), "animateTransform" | "animateMotion") {
        return Animated::Position;
    }
    match source.attr(a, "attributeName").as_deref().map(str::trim) {
        Some("transform") => Animated::Position,
        Some("dx" | "dy" | "rotate" | "textLength" | "font-size" | "href" | "xlink:href") => Animated::Geometry,
        Some(n) if GEOMETRY.contains(&n) => Animated::Geometry,
        Some(n) if n.starts_with("fill") || n.starts_with("stroke") => Animated::Paint,
        _ => Animated::Other,
    }
}
