//! Regions of filters. Programs draw them tightly around what is filtered, which would be cut where it bends out of them.

use super::boxes::painted_box;
use super::input::WriteInput;
use crate::scene::filter_area;
use crate::scene::model::{Group, PartRole};
use crate::scene::seen::is_seen;
use pathwarp::kurbo::{Insets, Rect};
use usvg::filter::Filter;

/// Growth of a side that is kept, as a fraction of the content's size. Less comes from rounding and is not seen.
const SEEN: f64 = 1e-4;

/// The growth of the regions of a group's filters: on each side, as much as its bent content reaches further than the source's. Both
/// are measured in the filters' user space, which has taken the affine part of the map.
pub(super) fn growth(input: &WriteInput<'_>, g: &Group) -> Insets {
    let slot = g.slot.filter(|_| !g.filters.is_empty()).map(|i| &input.scene.slots[i]);
    let Some(slot) = slot.filter(|s| !s.before && input.changes(s.parts.clone())) else { return Insets::ZERO };
    let from = slot.frame.inverse();
    let to = input.written(g.slot, slot.frame).inverse();
    let painted = slot.parts.clone().filter(|&i| {
        let p = input.part(i);
        p.role == PartRole::Paint && is_seen(p)
    });
    let boxes = painted.map(|i| {
        let p = input.part(i);
        let before = painted_box(p, None, from * p.frame);
        (before, painted_box(p, input.warped(i), to * input.written(p.slot, p.frame)))
    });
    let all = boxes.reduce(|(a, b), (c, d)| (a.union(c), b.union(d)));
    let Some((before, after)) = all.filter(|(a, b)| a.is_finite() && b.is_finite()) else { return Insets::ZERO };
    let least = SEEN * before.width().max(before.height());
    let side = |outwards: f64| if outwards > least { outwards } else { 0.0 };
    let (left, top) = (side(before.x0 - after.x0), side(before.y0 - after.y0));
    Insets::new(left, top, side(after.x1 - before.x1), side(after.y1 - before.y1))
}

/// The region of a filter in user space, grown.
pub(super) fn grown(f: &Filter, growth: Insets) -> Rect {
    filter_area::rect(f.rect()) + growth
}
