//! The walk over the scene that patches each element.

use super::keeper::Keeper;
use super::{copies, shape, text};
use crate::scene::model::{Group, Node};
use crate::source::tags::{ElementId, is_shape};
use crate::write::filter_region;
use crate::write::fragment::FILTERS;
use std::collections::BTreeMap;

/// Patches everything in a group.
pub(super) fn group(k: &mut Keeper<'_, '_>, g: &Group) {
    filters(k, g);
    // Shapes with their markers, in painting order.
    let mut marked: BTreeMap<ElementId, Vec<&Node>> = BTreeMap::new();
    for n in &g.children {
        match n {
            Node::Group(c) => match c.owner {
                Some(e) if k.tag(e) == "use" => copies::copy(k, e, c),
                Some(e) if k.tag(e) == "image" => copies::drawing(k, e, n, c),
                Some(e) if is_shape(k.tag(e)) => marked.entry(e).or_default().push(n),
                _ => group(k, c),
            },
            Node::Text { element: Some(e), content, owners } => text::text(k, *e, content, owners),
            Node::Text { element: None, .. } => {}
            Node::Image(i) => copies::bitmap(k, g, *i),
            Node::Part(i) => {
                let p = k.input.part(*i);
                match (p.owner, p.source) {
                    (Some(e), _) if is_shape(k.tag(e)) => marked.entry(e).or_default().push(n),
                    (None, Some(e)) if k.input.warped(*i).is_some() => shape::shape(k, e, *i),
                    _ => {}
                }
            }
        }
    }
    for (e, nodes) in marked {
        shape::marked_shape(k, e, &nodes);
    }
}

/// Patches the filters of a group.
fn filters(k: &mut Keeper<'_, '_>, g: &Group) {
    if g.filters.is_empty() {
        return;
    }
    let growth = filter_region::growth(&k.input, g);
    let slot = g.slot.map(|s| &k.input.scene.slots[s]);
    if let [n @ Node::Text { element: Some(e), .. }] = g.children.as_slice()
        && k.changed(n)
    {
        // Box units refer to the text's layout box, which outlines do not have. Write the filter in user space.
        let new = |f| format!("url(#{})", k.writer.filter_id(f, filter_region::grown(f, growth)));
        let list: Vec<String> = g.filters.iter().map(new).collect();
        k.edits.set_property(*e, "filter", list.join(" "));
    } else if g.filters.iter().any(|f| k.input.shows_warped(f))
        && let Some((None, Some(e))) = slot.map(|s| (s.owner, s.element))
    {
        let list = k.writer.filters(g);
        k.edits.set_property(e, "filter", list);
    } else {
        for f in &g.filters {
            if k.writer.keeps_filter(f) {
                k.writer.defs.grow(f, filter_region::grown(f, growth));
            }
        }
    }
    for f in &g.filters {
        k.writer.notes.add(FILTERS, f.id());
    }
}
