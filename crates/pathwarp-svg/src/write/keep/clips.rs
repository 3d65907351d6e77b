//! Clip paths, masks and viewports of the source.

use super::keeper::Keeper;
use super::walk;
use crate::scene::affine::stretch;
use crate::scene::model::{Clip, Group, Mask, Node, Referrer};
use crate::source::tags::ElementId;
use crate::source::unpatchable::Unpatchable;
use crate::source::xml::escape;
use crate::write::masks;
use std::collections::BTreeSet;
use std::ops::Range;

/// Patches the clip paths. For a clip path used in several frames, the first stays in its place and the others get
/// definitions of their own.
pub(super) fn clips(k: &mut Keeper<'_, '_>) -> Result<(), Unpatchable> {
    let clips = || k.input.scene.clips.iter().filter(|c| !c.foreign);
    // What is not bent keeps its definition.
    let kept = clips().filter(|c| !k.input.changes(c.parts.clone()));
    let mut patched: BTreeSet<ElementId> = kept.filter_map(|c| k.definition(&c.id, "clipPath")).collect();
    for (i, c) in k.input.scene.clips.iter().enumerate().filter(|c| !c.1.foreign) {
        let def = k.definition(&c.id, "clipPath");
        if !k.input.changes(c.parts.clone()) {
            // The edge of a viewport has no definition.
            k.writer.defs.clip_ids[i] = def.map(|_| c.id.clone());
            continue;
        }
        let is_viewport = c.referrers.iter().any(|r| r.owner.is_none() && r.element.is_some_and(|e| k.tag(e) == "svg"));
        match def {
            None if is_viewport => viewport(k, i)?,
            Some(def) if patched.insert(def) => clip(k, i, c, def),
            _ => {
                let id = k.writer.clip_id(i);
                redirect(k, &c.referrers, "clip-path", &id)?;
            }
        }
    }
    Ok(())
}

/// Patches the definition of a clip path.
fn clip(k: &mut Keeper<'_, '_>, i: usize, c: &Clip, def: ElementId) {
    k.writer.defs.clip_ids[i] = Some(c.id.clone());
    let units = k.source.attr(def, "clipPathUnits");
    if units.is_none_or(|u| u != "objectBoundingBox") && has_plain_shapes(k, &c.root) {
        walk::group(k, &c.root);
    } else {
        let head = k.attributes_without(def, &["clipPathUnits", "transform", "clip-path"]);
        let text = k.replacement(def, |w| w.clip(i, &head));
        k.edits.replace(def, text);
    }
}

/// Patches the masks, in the same way.
pub(super) fn masks(k: &mut Keeper<'_, '_>) -> Result<(), Unpatchable> {
    let kept = k.input.scene.masks.iter().filter(|m| !m.foreign && !k.input.changes(m.parts.clone()));
    let mut patched: BTreeSet<ElementId> = kept.filter_map(|m| k.definition(&m.id, "mask")).collect();
    for (i, m) in k.input.scene.masks.iter().enumerate().filter(|m| !m.1.foreign) {
        let def = k.definition(&m.id, "mask");
        // A mask in box units hides a box without area completely. The result's box may have an area, so write a new mask.
        let in_box_units = def.is_none_or(|d| k.source.attr(d, "maskUnits").is_none_or(|u| u != "userSpaceOnUse"));
        if in_box_units && m.root.children.is_empty() {
            let id = k.writer.mask_id(i);
            redirect(k, &m.referrers, "mask", &id)?;
            continue;
        }
        if !k.input.changes(m.parts.clone()) {
            k.writer.defs.mask_ids[i] = def.map(|_| m.id.clone());
            continue;
        }
        match def {
            Some(def) if patched.insert(def) => mask(k, i, m, def),
            _ => {
                let id = k.writer.mask_id(i);
                redirect(k, &m.referrers, "mask", &id)?;
            }
        }
    }
    Ok(())
}

/// Patches the definition of a mask.
fn mask(k: &mut Keeper<'_, '_>, i: usize, m: &Mask, def: ElementId) {
    k.writer.defs.mask_ids[i] = Some(m.id.clone());
    let units = k.source.attr(def, "maskContentUnits");
    let plain = units.is_none_or(|u| u != "objectBoundingBox") && masks::edge(&k.input, i).is_none();
    if plain {
        for (name, value) in masks::region(&k.input, i) {
            k.edits.set_attr(def, name, value);
        }
        walk::group(k, &m.root);
    } else {
        let omitted = ["maskUnits", "maskContentUnits", "x", "y", "width", "height", "mask", "mask-type"];
        let head = k.attributes_without(def, &omitted);
        let text = k.replacement(def, |w| w.mask(i, &head));
        k.edits.replace(def, text);
    }
}

/// Points all referrers to a new definition.
fn redirect(
    k: &mut Keeper<'_, '_>,
    referrers: &[Referrer],
    property: &'static str,
    id: &str,
) -> Result<(), Unpatchable> {
    for r in referrers {
        match (r.owner, r.element) {
            // Replaced as a whole, with the right reference.
            (Some(_), _) => {}
            (None, Some(e)) if k.tag(e) == "use" => {}
            (None, Some(e)) => k.edits.set_property(e, property, format!("url(#{id})")),
            (None, None) => return Err(Unpatchable::AmbiguousReferrer(property)),
        }
    }
    Ok(())
}

/// Returns `true` if a clip path holds only shape elements that become one path each.
fn has_plain_shapes(k: &Keeper<'_, '_>, g: &Group) -> bool {
    g.children.iter().all(|n| match n {
        Node::Group(g) => g.owner.is_none() && has_plain_shapes(k, g),
        Node::Part(i) => {
            let p = k.input.part(*i);
            p.source.is_some() && p.owner.is_none()
        }
        Node::Image(_) | Node::Text { .. } => false,
    })
}

/// Patches a nested viewport, which clips its content to a rectangle. Warped content must not be clipped like that, so the
/// viewport becomes `overflow: visible`. If it did clip anything, its warped edge becomes a clip path around it.
fn viewport(k: &mut Keeper<'_, '_>, i: usize) -> Result<(), Unpatchable> {
    let c = &k.input.scene.clips[i];
    let svgs: BTreeSet<ElementId> =
        c.referrers.iter().filter_map(|r| r.element).filter(|&e| k.tag(e) == "svg").collect();
    for e in svgs {
        k.edits.set_property(e, "overflow", "visible".into());
        if !fits(k, e, c.parts.clone()) {
            if k.source.attr(e, "transform").is_some() {
                return Err(Unpatchable::ClippingViewport);
            }
            let id = k.writer.clip_id(i);
            let g = k.writer.markup.tag("g");
            k.edits.insert_before(e, &format!("<{g} clip-path=\"url(#{})\">", escape(&id)));
            k.edits.insert_after(e, &format!("</{g}>"));
        }
    }
    Ok(())
}

/// Returns `true` if the content of `e` is inside the box of the part `edge`.
fn fits(k: &Keeper<'_, '_>, e: ElementId, edge: Range<usize>) -> bool {
    let scene = k.input.scene;
    let Some(edge) = scene.parts.get(edge.start).and_then(|p| p.outline().bounding_box()) else { return false };
    let inside = k.source.elements[e].range.clone();
    scene.parts.iter().filter(|p| !p.in_tile).all(|p| {
        let is_inside = p.element().is_some_and(|s| inside.contains(&k.source.elements[s].range.start));
        let reach = p.stroke.as_ref().map_or(0.0, |s| f64::from(s.width().get() * s.miterlimit().get()));
        let reach = reach * stretch(p.frame);
        !is_inside || p.outline().bounding_box().is_none_or(|b| edge.union(b.inflate(reach, reach)) == edge)
    })
}
