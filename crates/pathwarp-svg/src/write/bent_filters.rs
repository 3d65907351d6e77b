//! Replaces filters by pictures where the affine fit of their slot, with which they move, looks different from the map: pictures of the
//! filter's drawing beneath and above the graphic, or of both together.

use super::boxes;
use super::fragment::Writer;
use super::input::WriteInput;
use super::layers::{Layer, is_local, layers_around};
use crate::bend::drawing::BentDrawing;
use crate::bend::fits::{self, FilterOutcome};
use crate::bend::options::Filters;
use crate::bend::outcome::Notes;
use crate::bend::pictures::FilterRequest;
use crate::scene::areas;
use crate::scene::geometry::{rect, stretch};
use crate::scene::model::{Group, Node};
use crate::source::elements::is_shape;
use pathwarp::kurbo::{Affine, Rect};
use std::collections::BTreeMap;
use std::sync::Arc;
use usvg::filter::{Filter, Kind, Primitive};
use usvg::{BlendMode, Paint, Stop};

/// The results for the filters of a drawing, by the index of their slot. Filters without one follow the slot's fit and look different.
pub(crate) fn outcomes(input: &WriteInput<'_>) -> BTreeMap<usize, FilterOutcome> {
    let mut groups = Vec::new();
    if input.bends.each.iter().any(|b| b.options.filters != Filters::Affine) {
        add_filtered(&input.scene.root, &mut groups);
    }
    if groups.is_empty() {
        return BTreeMap::new();
    }
    let unbent = BentDrawing::unbent(input.scene);
    let original = WriteInput::new(input.drawing, &unbent, input.bends);
    let with_slot = |&(slot, g): &(usize, &Group)| Some((slot, outcome(input, &original, (slot, g), groups.len())?));
    groups.iter().filter_map(with_slot).collect()
}

/// Lists the groups with filters that have a slot, with its index.
fn add_filtered<'a>(g: &'a Group, out: &mut Vec<(usize, &'a Group)>) {
    out.extend(g.slot.filter(|_| !g.filters.is_empty()).map(|s| (s, g)));
    for n in &g.children {
        if let Node::Group(g) | Node::Text { content: g, .. } = n {
            add_filtered(g, out);
        }
    }
}

/// An SVG drawing of a group with its filters, or of a layer of its only filter.
fn drawing(input: &WriteInput<'_>, g: &Group, layer: Option<&Layer>, view: Rect) -> String {
    let (mut skipped, mut notes) = (Vec::new(), Notes::default());
    Writer::new(*input, false, &mut skipped, &mut notes).layer_drawing(g, layer, view)
}

/// The result for the filters of one of `among` groups, which share the painter's pixels. `None` if they follow the fit and look different.
fn outcome(
    input: &WriteInput<'_>,
    original: &WriteInput<'_>,
    (slot, group): (usize, &Group),
    among: usize,
) -> Option<FilterOutcome> {
    let s = &input.scene.slots[slot];
    let bend = &input.bends.each[fits::slot_bend(s, input.scene, input.bends, input.part_bends)?];
    let painter = bend.options.painter.as_ref().filter(|_| bend.options.filters != Filters::Affine)?;
    let always = bend.options.filters == Filters::Picture;
    let is_repeated = bend.options.copies.len() > 1 || !bend.options.letters.places.is_empty();
    let refuses_pictures = has_inner_filters(group) || displaces(group) || !takes_pictures(input, slot);
    if bend.is_identity() || s.fits_outside || is_repeated || refuses_pictures {
        return None;
    }
    let content = content(original, group, s.frame.inverse())?;
    let painted = |area: Option<Rect>, f: &Arc<Filter>| areas::filter_box(f, rect(f.rect().to_rect()), area?);
    let area = group.filters.iter().fold(Some(content), painted)?;
    let to_root = input.written(Some(slot), s.frame);
    let to_px = stretch(input.scene.to_px * to_root);
    let bending = || fits::distance_from_translation(area, s.frame, to_root, bend.map) * to_px;
    if !always && moves_little(group, (content, area), bending()) {
        return Some(FilterOutcome::Fits);
    }
    let layers = match group.filters.as_slice() {
        [f] => layers_around(f, content, is_opaque(original, group)),
        _ => None,
    };
    let whole = |view| drawing(original, group, None, view);
    let draw = || match &layers {
        Some(layers) => layers.iter().map(|l| l.as_ref().map(|l| drawing(original, group, Some(l), area))).collect(),
        None => vec![Some(whole(area))],
    };
    let fitted = |view| drawing(input, group, None, view);
    let request = FilterRequest {
        layers: &draw,
        compared: (!always).then_some([&whole, &fitted]),
        area,
        graphic: content,
        placed: s.frame,
        map: bend.map,
        after: to_root.inverse(),
        to_px: input.scene.to_px,
        page: input.drawing.view_box().area() / to_root.determinant().abs(),
        among,
    };
    // Without pictures, the fit looks right.
    let Some(mut pictures) = painter.filter(&request).ok()?.map(Vec::into_iter) else {
        return Some(FilterOutcome::Fits);
    };
    let mut next = || pictures.next().flatten();
    if layers.is_some() {
        return Some(FilterOutcome::Around { beneath: next(), above: next() });
    }
    next().map(FilterOutcome::Whole)
}

/// Returns `true` if the fit takes the drawing of filters so close to where the map takes it that no one sees the difference: if they only
/// move and blur, and the map hardly bends over that distance. `content` is the box of the graphic, `area` that of the drawing, and
/// `bending` the change of a unit in px.
fn moves_little(g: &Group, (content, area): (Rect, Rect), bending: f64) -> bool {
    /// Largest invisible distance, in px.
    const INVISIBLE: f64 = 0.5;
    /// Ratio of a blur's deviation to its reach.
    const BLUR: f64 = 1.0 / 3.0;
    let [x, y] = [(content.x0 - area.x0).max(area.x1 - content.x1), (content.y0 - area.y0).max(area.y1 - content.y1)];
    let moves_or_blurs =
        |k: &Kind| matches!(k, Kind::DropShadow(_) | Kind::Flood(_) | Kind::GaussianBlur(_) | Kind::Offset(_));
    let primitives = || g.filters.iter().flat_map(|f| f.primitives()).map(Primitive::kind);
    let offset = |k: &Kind| match k {
        Kind::Offset(o) => o.dx().hypot(o.dy()),
        Kind::DropShadow(s) => s.dx().hypot(s.dy()),
        _ => 0.0,
    };
    let reach = x.max(y).max(0.0);
    let offset = primitives().map(offset).map(f64::from).sum::<f64>().min(reach);
    let is_simple = primitives().all(|k| is_local(k) || moves_or_blurs(k));
    is_simple && bending * (offset + BLUR * (reach - offset)) < INVISIBLE
}

/// Returns `true` if pictures can replace the filters of a slot.
fn takes_pictures(input: &WriteInput<'_>, slot: usize) -> bool {
    let s = &input.scene.slots[slot];
    let has =
        |e: usize, name: &str| input.source.attr(e, name).is_some_and(|v| name == "filter" || v.contains("filter"));
    let tag = |e: usize| input.source.elements[e].tag.as_ref();
    // A `switch` puts its filters around the element that takes the fit.
    let takes = |e: usize| matches!(tag(e), "g" | "a" | "text") || is_shape(tag(e));
    s.owner.is_some() || s.element.is_some_and(|e| takes(e) && (has(e, "filter") || has(e, "style")))
}

/// The box that a group paints, in the user space of its filters.
fn content(original: &WriteInput<'_>, g: &Group, from_root: Affine) -> Option<Rect> {
    let one = |n: &Node| match n {
        Node::Group(c) | Node::Text { content: c, .. } => content(original, c, from_root),
        Node::Part(i) => {
            let p = original.part(*i);
            areas::is_seen(p).then(|| boxes::painted_box(p, None, from_root * p.frame))
        }
        Node::Image(i) => {
            let b = &original.scene.bitmaps[*i];
            Some(from_root.transform_rect_bbox(areas::picture_box(b)?))
        }
    };
    g.children.iter().filter_map(one).reduce(|a, b| a.union(b)).filter(Rect::is_finite)
}

/// Returns `true` if a filter displaces pixels: the renderer moves them by the square of the scale.
fn displaces(g: &Group) -> bool {
    g.filters.iter().flat_map(|f| f.primitives()).any(|p| matches!(p.kind(), Kind::DisplacementMap(_)))
}

/// Returns `true` if anything inside a group has filters.
fn has_inner_filters(g: &Group) -> bool {
    g.children.iter().any(|n| match n {
        Node::Group(c) | Node::Text { content: c, .. } => !c.filters.is_empty() || has_inner_filters(c),
        Node::Part(_) | Node::Image(_) => false,
    })
}

/// Returns `true` if nothing shines through a group where it paints.
fn is_opaque(input: &WriteInput<'_>, g: &Group) -> bool {
    let stops = |s: &[Stop]| s.iter().all(|s| s.opacity().get() >= 1.0);
    let covers = |p: &Paint| match p {
        Paint::Color(_) => true,
        Paint::LinearGradient(g) => stops(g.stops()),
        Paint::RadialGradient(g) => stops(g.stops()),
        Paint::Pattern(_) => false,
    };
    g.children.iter().all(|n| match n {
        Node::Group(g) | Node::Text { content: g, .. } => {
            let is_plain = g.opacity >= 1.0 && g.blend == BlendMode::Normal;
            is_plain && g.mask.is_none() && g.filters.is_empty() && is_opaque(input, g)
        }
        Node::Part(i) => {
            let p = input.part(*i);
            p.fill.as_ref().is_none_or(|f| f.opacity().get() >= 1.0 && covers(f.paint()))
                && p.stroke.as_ref().is_none_or(|s| s.opacity().get() >= 1.0 && covers(s.paint()))
        }
        Node::Image(_) => false,
    })
}
