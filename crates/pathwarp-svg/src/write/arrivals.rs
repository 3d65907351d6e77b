//! Artwork that lay off the page before the warp and shows on it afterwards, such as notes beside a drawing.

use super::boxes::{bound, painted_box};
use super::input::WriteInput;
use super::page::{image_boxes, warped_clip};
use crate::scene::model::{Group, Node, PartRole};
use crate::scene::seen::{is_seen, overlap};
use crate::source::tags::ElementId;
use pathwarp::kurbo::Rect;
use std::collections::BTreeSet;

/// Extent of an arrival on the page to be seen, as a fraction of the page.
const VISIBLE: f64 = 1e-3;

/// The names of the elements that have come onto the page `shown` of the result.
pub(super) fn arrivals(input: &WriteInput<'_>, shown: Rect) -> Vec<String> {
    let Some(page) = input.drawing.specified_area() else { return Vec::new() };
    let mut found = BTreeSet::new();
    in_group(input, &input.scene.root, (page, shown), &mut found);
    found.into_iter().map(|e| input.source.display_name(e)).collect()
}

/// Finds the elements of a group that lay off the page and now show in an area.
fn in_group(input: &WriteInput<'_>, g: &Group, (page, shown): (Rect, Rect), found: &mut BTreeSet<ElementId>) {
    if g.opacity <= 0.0 || g.mask.is_some() {
        return;
    }
    let Some(room) = g.clip.map_or(Some(shown), |i| overlap(shown, warped_clip(input, i)?)) else { return };
    let deep = VISIBLE * page.width().max(page.height());
    let shows = |after| overlap(after, room).is_some_and(|o| o.width().max(o.height()) > deep);
    for n in &g.children {
        match n {
            Node::Group(g) => in_group(input, g, (page, room), found),
            Node::Text { content, .. } => in_group(input, content, (page, room), found),
            Node::Image(i) => {
                let came = image_boxes(input, *i).is_some_and(|(b, after)| overlap(b, page).is_none() && shows(after));
                found.extend(input.scene.bitmaps[*i].owner.filter(|_| came));
            }
            Node::Part(i) => {
                let p = input.part(*i);
                let cheap = bound(p, None, p.frame);
                let off = || overlap(cheap, page).is_none() || overlap(painted_box(p, None, p.frame), page).is_none();
                let after = || painted_box(p, input.warped(*i), input.written(p.slot, p.frame));
                let paints = is_seen(p) && p.role == PartRole::Paint && page.union(cheap) != page;
                found.extend(p.owner.or(p.source).filter(|_| paints && off() && shows(after())));
            }
        }
    }
}
