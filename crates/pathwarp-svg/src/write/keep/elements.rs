//! Walks over the scene and patches each element. In every function, `k` is the keeper of the edits, and `e` the patched element.

use super::keeper::{self, GEOMETRY, Keeper};
use super::text;
use crate::bend::fits::{EmbeddedImage, FilterOutcome};
use crate::bend::options::Clones;
use crate::bend::outcome::{Skipped, WarpedPart};
use crate::scene::geometry::stretch;
use crate::scene::model::{Clip, Group, Mask, Node, Part, Referrer};
use crate::source::elements::{ElementId, Namespace, Unpatchable, is_live, is_shape};
use crate::source::number::single;
use crate::write::boxes;
use crate::write::fragment::bent_image;
use crate::write::input::WriteInput;
use crate::write::markup::{bent_attributes, bent_url, dashes, part_data};
use crate::write::surroundings::Surroundings;
use pathwarp::kurbo::Affine;
use pathwarp_reader::xml::escape;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use usvg::{Fill, Stroke};

pub(super) fn patch_group(k: &mut Keeper<'_, '_>, g: &Group) {
    patch_filters(k, g);
    if matches!(k.input.filter_outcome(g), Some(FilterOutcome::Whole(_))) {
        return;
    }
    // Shapes with markers: the nodes of the shape and its markers, in painting order.
    let mut marked: BTreeMap<ElementId, Vec<&Node>> = BTreeMap::new();
    for n in &g.children {
        match n {
            Node::Group(c) => match c.owner {
                Some(e) if k.tag(e) == "use" && k.input.is_absorbed(n) => k.edits.replace(e, String::new()),
                Some(e) if k.tag(e) == "use" => patch_copy(k, e, c),
                Some(e) if k.tag(e) == "image" => patch_drawing(k, e, n, c),
                Some(e) if is_shape(k.tag(e)) => marked.entry(e).or_default().push(n),
                _ => patch_group(k, c),
            },
            Node::Text { element: Some(e), .. } if k.input.is_absorbed(n) => k.edits.replace(*e, String::new()),
            Node::Text { element: Some(e), content, sources } => text::patch_text(k, *e, content, sources),
            Node::Text { element: None, .. } => {}
            Node::Image(i) => patch_bitmap(k, g, *i),
            Node::Part(i) => {
                let p = k.input.part(*i);
                match (p.owner, p.source) {
                    (Some(e), _) if is_shape(k.tag(e)) => marked.entry(e).or_default().push(n),
                    (None, Some(e)) if k.input.is_absorbed(n) => k.edits.replace(e, String::new()),
                    (None, Some(e)) if k.input.warped(*i).is_some() => patch_shape(k, e, *i),
                    _ => {}
                }
            }
        }
    }
    for (e, nodes) in marked {
        patch_marked_shape(k, e, &nodes);
    }
}

fn patch_filters(k: &mut Keeper<'_, '_>, g: &Group) {
    if g.filters.is_empty() {
        return;
    }
    if !k.input.keeps_filters(g) {
        return replace_filters(k, g);
    }
    let growth = boxes::growth(&k.input, g);
    let slot = g.slot.map(|s| &k.input.scene.slots[s]);
    if let [n @ Node::Text { element: Some(e), .. }] = g.children.as_slice()
        && k.changed(n)
    {
        // Box units refer to the text's layout box, which outlines do not have. Write the filter in user space.
        let new = |f| format!("url(#{})", k.writer.filter_id(f, boxes::grown(f, growth)));
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
                k.writer.defs.grow(f, boxes::grown(f, growth));
            }
        }
    }
    k.writer.note_filters(g);
}

/// Replaces the filters of a group by pictures.
fn replace_filters(k: &mut Keeper<'_, '_>, g: &Group) {
    let Some(outcome) = k.input.filter_outcome(g) else { return };
    let Some(e) = g.slot.and_then(|s| k.input.scene.slots[s].element) else { return };
    k.edits.set_property(e, "filter", "none".into());
    if matches!(outcome, FilterOutcome::Whole(_)) {
        let picture = k.writer.with_pictures(g, String::new());
        if !matches!(k.tag(e), "g" | "a") {
            k.make_group(e, String::new());
        }
        let title = k.source.elements[e].title.as_ref().map_or(String::new(), |t| k.writer.markup.title(t));
        k.edits.set_content(e, title + &picture);
        return;
    }
    let [beneath, above] =
        outcome.pictures().map(|p| p.map_or(String::new(), |p| bent_image(&k.writer.markup, p, Affine::IDENTITY)));
    if matches!(k.tag(e), "g" | "a") {
        k.edits.wrap_content(e, beneath, above);
    } else {
        k.pictures.insert(e, [beneath, above]);
    }
}

const MARKERS: [&str; 3] = ["marker-start", "marker-mid", "marker-end"];

/// Patches a shape element with the image of part `i`.
fn patch_shape(k: &mut Keeper<'_, '_>, e: ElementId, i: usize) {
    let p = k.input.part(i);
    let Some(warped) = k.input.warped(i) else { return };
    let is_outlined = p.stroke.is_some() && warped.stroke.outline().is_some();
    let has_separate_fill = warped.fill.as_ref().is_some_and(|f| !f.elements().is_empty());
    if k.input.in_pieces(i) || is_outlined || has_separate_fill || k.pictures.contains_key(&e) {
        let content = k.written_inside(e, |w| w.part(i));
        let content = k.between_pictures(e, content);
        k.make_group(e, content);
        return;
    }
    let tag = k.tag(e);
    if tag != "path" {
        k.edits.rename(e, "path");
        k.remove_attributes(e, &GEOMETRY);
        // Unlike a path, these shapes have no markers.
        if matches!(tag, "rect" | "circle" | "ellipse")
            && k.source.attr(e, "style").is_some_and(|s| s.contains("marker-"))
        {
            for name in MARKERS {
                k.edits.set_property(e, name, "none".into());
            }
        }
    }
    k.edits.set_attr(e, "d", part_data(p, Some(warped), k.source));
    k.remove_lettering(e);
    patch_paint(k, e, i, p, warped);
    patch_stroke(k, e, p, warped);
}

fn patch_paint(k: &mut Keeper<'_, '_>, e: ElementId, i: usize, p: &Part, warped: &WarpedPart) {
    let paints = [("fill", p.fill.as_ref().map(Fill::paint)), ("stroke", p.stroke.as_ref().map(Stroke::paint))];
    for (name, paint) in paints {
        let changes = |paint: &&usvg::Paint| {
            let is_fitted = k.input.paint_fit(paint, p, Some(warped)).is_some();
            is_fitted || k.input.bent_gradient(paint, p, warped).is_some()
        };
        if let Some(paint) = paint.filter(changes) {
            let paint = k.writer.paint(paint, p, Some(warped));
            k.edits.set_property(e, name, paint);
        }
    }
    // A shape without width or height shows the fallback colour of a paint server in box units. The warped shape may have
    // both, and must not show the paint server.
    let is_flat = p.local.bounding_box().is_some_and(|b| b.width() == 0.0 || b.height() == 0.0);
    if is_flat && (k.source.text.contains("objectBoundingBox") || k.source.text.contains("Gradient")) {
        for (name, value) in k.writer.properties(i) {
            if matches!(name, "fill" | "stroke") {
                k.edits.set_property(e, name, value);
            }
        }
    }
    if warped.fill.is_some() {
        k.edits.set_property(e, "fill", "none".into());
    }
}

fn patch_stroke(k: &mut Keeper<'_, '_>, e: ElementId, p: &Part, warped: &WarpedPart) {
    let scale = warped.stroke.scale();
    let Some(s) = p.stroke.as_ref().filter(|_| (scale - 1.0).abs() > 1e-9) else { return };
    k.edits.set_property(e, "stroke-width", single(f64::from(s.width().get()) * scale));
    // In units of `pathLength`, dashes need no change on the new path.
    if s.dasharray().is_some() && k.source.attr(e, "pathLength").is_none() {
        k.edits.set_property(e, "stroke-dasharray", dashes(s, scale));
        if s.dashoffset() != 0.0 {
            k.edits.set_property(e, "stroke-dashoffset", single(f64::from(s.dashoffset()) * scale));
        }
    }
}

/// Replaces a shape with markers by a group of the shape and its markers (`nodes`, in painting order).
fn patch_marked_shape(k: &mut Keeper<'_, '_>, e: ElementId, nodes: &[&Node]) {
    if !nodes.iter().any(|n| k.changed(n)) {
        return;
    }
    if nodes.iter().all(|n| k.input.is_absorbed(n)) {
        return k.edits.replace(e, String::new());
    }
    let content = k.written_inside(e, |w| nodes.iter().map(|n| w.node(n)).collect());
    let content = k.between_pictures(e, content);
    k.make_group(e, content);
    for name in MARKERS {
        k.edits.set_style(e, name, "none".into());
    }
}

/// Patches the element of bitmap `i`, in group `g`.
fn patch_bitmap(k: &mut Keeper<'_, '_>, g: &Group, i: usize) {
    let bitmap = &k.input.scene.bitmaps[i];
    let e = g.source.or(bitmap.owner).filter(|&e| k.tag(e) == "image");
    let why = match (&k.input.images[i], e) {
        (EmbeddedImage::Placed, _) => return,
        (EmbeddedImage::Bent { image, clip }, Some(e)) => {
            // The element's clip path and filters apply to the clipped image, which therefore goes into a group.
            let has = |name: &str| k.source.property(e, name).is_some_and(|v| v.trim() != "none");
            if clip.is_some() && (has("clip-path") || has("filter")) {
                let content = k.writer.clipped_image(image, clip.as_deref(), Affine::IDENTITY);
                k.remove_attributes(e, &["href", "preserveAspectRatio"]);
                k.make_group(e, content);
            } else {
                for (name, value) in bent_attributes(image, Affine::IDENTITY) {
                    k.edits.set_attr(e, name, value);
                }
                k.edits.set_attr(e, "href", bent_url(image));
                if let Some(data) = clip {
                    let id = k.writer.outline_id(data, Affine::IDENTITY);
                    k.edits.set_property(e, "clip-path", format!("url(#{id})"));
                }
            }
            let text = &k.source.text;
            // Inkscape's path to the file that the image was linked to.
            k.edits.remove_attrs(e, |a| a.namespace == Namespace::Sodipodi && a.name(text) == "absref");
            return;
        }
        (EmbeddedImage::Bent { .. }, None) => {
            "its element was not found; it is placed by the best affine fit".to_owned()
        }
        (EmbeddedImage::Approximate(why), _) => why.clone(),
    };
    let id = k.source.image_name(e);
    k.writer.skipped.push(Skipped { id, why });
}

/// Replaces an image that is a drawing by a group with the drawing's content.
fn patch_drawing(k: &mut Keeper<'_, '_>, e: ElementId, n: &Node, g: &Group) {
    if k.changed(n) {
        let content = k.writer.group(g, "");
        k.remove_attributes(e, &["href", "preserveAspectRatio"]);
        k.make_group(e, content);
    }
}

/// Returns `false` if the original of a `use` may have been warped.
fn is_original_unchanged(k: &Keeper<'_, '_>, e: ElementId) -> bool {
    let WriteInput { source, scene, outcomes, options, .. } = k.input;
    if options.selection.is_everything() {
        return true;
    }
    let originals: Vec<ElementId> =
        source.href(e).and_then(|id| source.by_id().get(&id)).into_iter().flatten().copied().collect();
    // An original that shows others counts as changed if anything is.
    let shows_others = |o: &ElementId| k.tag(*o) == "use" || source.descendants(*o).any(|d| k.tag(d) == "use");
    let ranges: Vec<_> = originals.iter().map(|&o| &source.elements[o].range).collect();
    let is_in_original = |e: ElementId| ranges.iter().any(|r| r.contains(&source.elements[e].range.start));
    let may_show_any = originals.is_empty() || originals.iter().any(shows_others);
    let warped = scene.parts.iter().zip(outcomes).filter(|(_, o)| o.warped().is_some());
    !warped.map(|(p, _)| p.element()).any(|e| may_show_any || e.is_none_or(is_in_original))
}

/// Replaces a `use` by a group with its resolved content, if that is no longer a copy of the original.
fn patch_copy(k: &mut Keeper<'_, '_>, e: ElementId, g: &Group) {
    if !g.children.iter().any(|n| k.changed(n))
        && (k.input.options.clones == Clones::Follow || is_original_unchanged(k, e))
    {
        return;
    }
    let source = k.source;
    let text = &source.text;
    let is_kept =
        |name: &str| name == "id" || name == "class" || name.starts_with("data-") || name.starts_with("aria-");
    let el = &source.elements[e];
    let kept = el
        .attrs
        .iter()
        .filter(|a| !is_live(a, text))
        .filter(|a| is_kept(a.name(text)) || matches!(a.namespace, Namespace::Inkscape | Namespace::Sodipodi));
    let head: String = kept.map(|a| format!(" {}", &text[a.range.clone()])).collect();
    let united = united_attributes(k.input, e).into_iter();
    let head = united.fold(head, |head, (name, value)| format!("{head} {name}=\"{}\"", escape(&value)));
    let title = el.title.as_ref().map_or(String::new(), |t| k.writer.markup.title(t));
    k.new_groups.insert(e);
    let lead = title + &keeper::kept_animations(source, e);
    k.writer.surroundings = Surroundings::of_copy(source, e);
    let text = k.writer.group_with(g, &head, &lead);
    k.writer.surroundings = None;
    k.edits.replace(e, text);
}

/// Names the united elements on the shapes that they have become: by ids in `data-united`, by classes and, on shapes without a title, by
/// titles.
pub(super) fn name_united(k: &mut Keeper<'_, '_>) {
    let (source, input) = (k.source, k.input);
    for (&e, all) in input.united.merged.iter().filter(|(e, _)| source.elements[**e].tag != "use") {
        for (name, value) in united_attributes(input, e) {
            k.edits.set_attr(e, name, value);
        }
        let mut titles: Vec<&str> = all.iter().filter_map(|e| source.elements[*e].title.as_deref()).collect();
        titles.dedup();
        if source.elements[e].title.is_none() && !titles.is_empty() && k.tag(e) != "text" {
            let title = k.writer.markup.title(&titles.join(", "));
            k.edits.wrap_content(e, title, String::new());
        }
    }
}

/// The attributes of a shape that name the elements united to it. Classes are left out if the drawing has style sheets, whose rules could
/// then apply to the shape.
fn united_attributes(input: WriteInput<'_>, e: ElementId) -> Vec<(&'static str, String)> {
    let Some(all) = input.united.merged.get(&e) else { return Vec::new() };
    let values = |name: &'static str| all.iter().filter_map(move |e| input.source.attr(*e, name));
    let distinct_words = |name: &'static str| {
        let mut seen = BTreeSet::new();
        let values: Vec<_> = values(name).collect();
        let words = values.iter().flat_map(|v| v.split_ascii_whitespace());
        words.filter(|w| seen.insert(*w)).collect::<Vec<_>>().join(" ")
    };
    let class = (!input.source.has_css()).then(|| ("class", distinct_words("class")));
    // Letters make words.
    let is_letter = |e: &ElementId| input.source.attr(*e, "data-glyph").is_some();
    let word = all.iter().all(is_letter).then(|| ("aria-label", values("aria-label").collect::<String>()));
    let all = [("data-united", distinct_words("id"))].into_iter().chain(class).chain(word);
    all.filter(|(_, words)| !words.is_empty()).collect()
}

/// Patches the clip paths. Of a clip path used in several frames, the first one keeps the definition and the others get new ones.
pub(super) fn patch_clips(k: &mut Keeper<'_, '_>) -> Result<(), Unpatchable> {
    let clips = || k.input.scene.clips.iter().filter(|c| !c.foreign);
    // A clip path that is not bent keeps its definition.
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
            None if is_viewport => patch_viewport(k, i)?,
            Some(def) if patched.insert(def) => patch_clip(k, i, c, def),
            _ => {
                let id = k.writer.clip_id(i);
                redirect(k, &c.referrers, "clip-path", &id)?;
            }
        }
    }
    Ok(())
}

/// Patches the definition of clip path `i`: the shapes in it, or else it is written anew.
fn patch_clip(k: &mut Keeper<'_, '_>, i: usize, c: &Clip, def: ElementId) {
    k.writer.defs.clip_ids[i] = Some(c.id.clone());
    let units = k.source.attr(def, "clipPathUnits");
    if units.is_none_or(|u| u != "objectBoundingBox") && has_plain_shapes(k, &c.root) {
        patch_group(k, &c.root);
    } else {
        let head = k.attributes_without(def, &["clipPathUnits", "transform", "clip-path"]);
        let text = k.replacement(def, |w| w.clip(i, &head));
        k.edits.replace(def, text);
    }
}

/// Patches the masks. Of a mask used in several frames, the first one keeps the definition and the others get new ones.
pub(super) fn patch_masks(k: &mut Keeper<'_, '_>) -> Result<(), Unpatchable> {
    let kept = k.input.scene.masks.iter().filter(|m| !m.foreign && !k.input.changes(m.parts.clone()));
    let mut patched: BTreeSet<ElementId> = kept.filter_map(|m| k.definition(&m.id, "mask")).collect();
    for (i, m) in k.input.scene.masks.iter().enumerate().filter(|m| !m.1.foreign) {
        let def = k.definition(&m.id, "mask");
        // A mask in box units hides a box without area completely. The result's box may have an area, so write a new mask.
        let in_box_units = def.is_none_or(|d| k.source.attr(d, "maskUnits").is_none_or(|u| u != "userSpaceOnUse"));
        let hides_all = in_box_units && m.root.children.is_empty();
        if !hides_all && !k.input.changes(m.parts.clone()) {
            k.writer.defs.mask_ids[i] = def.map(|_| m.id.clone());
            continue;
        }
        match def.filter(|_| !hides_all) {
            Some(def) if patched.insert(def) => patch_mask(k, i, m, def),
            _ => {
                let id = k.writer.mask_id(i);
                redirect(k, &m.referrers, "mask", &id)?;
            }
        }
    }
    Ok(())
}

/// Patches the definition of mask `i`: its region and content, or else it is written anew.
fn patch_mask(k: &mut Keeper<'_, '_>, i: usize, m: &Mask, def: ElementId) {
    k.writer.defs.mask_ids[i] = Some(m.id.clone());
    let units = k.source.attr(def, "maskContentUnits");
    if units.is_none_or(|u| u != "objectBoundingBox") && boxes::edge(&k.input, i).is_none() {
        for (name, value) in boxes::region(&k.input, i) {
            k.edits.set_attr(def, name, value);
        }
        patch_group(k, &m.root);
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
            // An owner is replaced as a whole, with the right reference.
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

/// Patches a nested viewport, which clips its content to a rectangle. Warped content must not be clipped to it, so the viewport becomes
/// `overflow: visible`. If it did clip anything, its warped edge becomes a clip path around it.
fn patch_viewport(k: &mut Keeper<'_, '_>, i: usize) -> Result<(), Unpatchable> {
    let c = &k.input.scene.clips[i];
    let svgs: BTreeSet<ElementId> =
        c.referrers.iter().filter_map(|r| r.element).filter(|&e| k.tag(e) == "svg").collect();
    for e in svgs {
        k.edits.set_property(e, "overflow", "visible".into());
        if !fits_edge(k, e, c.parts.clone()) {
            if k.source.attr(e, "transform").is_some() {
                return Err(Unpatchable::ClippingViewport);
            }
            let id = k.writer.clip_id(i);
            let prefix = &k.writer.markup.prefix;
            k.edits.insert_before(e, &format!("<{prefix}g clip-path=\"url(#{})\">", escape(&id)));
            k.edits.insert_after(e, &format!("</{prefix}g>"));
        }
    }
    Ok(())
}

/// Returns `true` if the content of `e` is inside the box of the part `edge`.
fn fits_edge(k: &Keeper<'_, '_>, e: ElementId, edge: Range<usize>) -> bool {
    let scene = k.input.scene;
    let Some(edge) = scene.parts.get(edge.start).and_then(|p| p.outline().bounding_box()) else { return false };
    let range = k.source.elements[e].range.clone();
    scene.parts.iter().filter(|p| !p.in_tile).all(|p| {
        let is_content = p.element().is_some_and(|s| range.contains(&k.source.elements[s].range.start));
        let extent = p.stroke.as_ref().map_or(0.0, |s| f64::from(s.width().get() * s.miterlimit().get()));
        let extent = extent * stretch(p.frame);
        !is_content || p.outline().bounding_box().is_none_or(|b| edge.contains_rect(b.inflate(extent, extent)))
    })
}
