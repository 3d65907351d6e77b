//! Resolves a drawing: walks usvg's tree and finds the source element, the exact outline and the exact transform of everything in it.
//! [`Context`] explains owners and slots, and [`SceneBuilder`] markers and fixed stroke widths.

mod builder;
mod markers;
mod tiles;

use super::geometry::{GeometryReader, affine, bits, f32_bits, is_near, linear_part, rect};
use super::lettering::Owners;
use super::model::{Bitmap, Clip, Group, Mask, Node, Part, PartRole, PatternTile, PlacedText, Referrer, Scene};
use super::resolve::builder::{Context, GroupAt, SceneBuilder, add_slot, holds_drawing, trace};
use super::resolve::markers::{marked_children, place_markers};
use super::resolve::tiles::{PaintKind, blends, lay_out_tiles};
use crate::source::elements::{ElementId, Unpatchable};
use crate::source::text::SourceText;
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Point, Rect, Size, Vec2};
use std::sync::Arc;
use usvg::{Fill, Stroke};

pub(crate) use builder::{Painted, Tiling};

/// Resolves the drawing. `letters` are the elements of letters in texts. Patterns become geometry where `tiling` requests it.
/// `division` has the index of every element's bend, or is empty. Clip paths and masks are resolved once for each bend of their referrers.
pub(crate) fn build(
    tree: &usvg::Tree,
    source: &SourceText,
    letters: &Owners,
    dpi: f64,
    tiling: Option<Tiling<'_>>,
    division: &[Option<usize>],
) -> Scene {
    let page = Size::new(f64::from(tree.size().width()), f64::from(tree.size().height()));
    let reader = GeometryReader { source, dpi, page };
    let mut b = SceneBuilder::new(reader, letters, tiling, division);
    let (top, to_px) = root_group(&b, tree, page);
    b.top = Some(std::ptr::from_ref(top));
    let root = resolve_group(&mut b, top, Affine::IDENTITY, Context::top(PartRole::Paint));
    let SceneBuilder { mut scene, tiling, .. } = b;
    scene.root = root;
    scene.to_px = to_px;
    scene.notes = tiling.map(|t| t.notes).unwrap_or_default();
    for (i, p) in scene.parts.iter().enumerate() {
        if let Some(e) = p.source {
            scene.by_source.entry(e).or_default().push(i);
        }
    }
    scene
}

/// Finds the group that holds root user space, and the transform from there to px.
fn root_group<'t>(b: &SceneBuilder<'_>, tree: &'t usvg::Tree, page: Size) -> (&'t usvg::Group, Affine) {
    let by_source = b.reader.view_box_transform(0, page);
    let [usvg::Node::Group(g)] = tree.root().children() else { return (tree.root(), by_source) };
    // usvg wraps everything in a group exactly if the root has a transform or a background.
    let has_transform = b.reader.source.attr(0, "transform").is_some();
    let is_transformed = f32_bits(by_source) != f32_bits(Affine::IDENTITY) || has_transform;
    let has_background = b.may_have_background
        && g.id().is_empty()
        && g.transform().is_identity()
        && matches!(g.children().first(), Some(usvg::Node::Path(p)) if p.id().is_empty());
    if !is_transformed && !has_background {
        return (tree.root(), by_source);
    }
    let by_usvg = affine(g.transform());
    let shift = by_source.translation();
    // usvg centres the drawing in f32, where differences of numbers as large as the page are rounded, and shifts it by any distance.
    let slack = 1e-6 * (page.width + page.height + 1.0) + 3e-7 * shift.x.abs().max(shift.y.abs());
    let is_rounding = |v: Vec2| v.x.abs() <= slack && v.y.abs() <= slack;
    let agree = is_near(linear_part(by_source), linear_part(by_usvg)) && is_rounding(shift - by_usvg.translation());
    // If the page equals its viewBox up to rounding, there is no such group.
    let is_identity = is_near(linear_part(by_source), Affine::IDENTITY) && is_rounding(shift) && !has_transform;
    if is_identity && !agree && !has_background {
        return (tree.root(), by_source);
    }
    (g, if agree { by_source } else { by_usvg })
}

/// Resolves a group. `parent` maps the space around it to root user space.
fn resolve_group(b: &mut SceneBuilder<'_>, g: &usvg::Group, parent: Affine, mut context: Context) -> Group {
    let source = b.element(g.id());
    let element = source.or_else(|| only_child(b, g));
    let transform = match b.markers.get(&address(g)) {
        Some(Some(placed_marker)) => *placed_marker,
        _ if b.is_top(g) => Affine::IDENTITY,
        _ => b.exact_transform(g.transform(), element),
    };
    let frame = parent * transform;
    let is_owner = |&e: &ElementId| b.tag(e) == "use" || (b.tag(e) == "image" && holds_drawing(g));
    let owner = context.owner.or(source.filter(is_owner));
    let at = GroupAt { group: g, source, element, parent, frame };
    let slot = add_slot(b, &at, Context { owner, ..context });
    context.slot = slot.or(context.slot);
    let referrer = Referrer { element, owner: context.owner };
    let definition_context = Context { bend: b.bend_of(referrer, context), ..context };
    let clip = g.clip_path().map(|c| add_clip(b, c, frame, referrer, definition_context));
    let mask = g.mask().map(|m| add_mask(b, m, frame, referrer, definition_context));
    context.owner = owner;
    context.image = source.filter(|&e| b.tag(e) == "image").or(context.image);
    context.viewport = sliced_viewport(g).or(context.viewport);
    for p in g.filters().iter().flat_map(|f| f.primitives()) {
        if let usvg::filter::Kind::Image(image) = p.kind() {
            resolve_filter_image(b, image.root());
        }
    }
    // Markers are placed where there is no owner, and in copies (`use`).
    let copy = context.owner.filter(|&e| b.tag(e) == "use");
    let marked = if copy == context.owner { marked_children(b, g, copy) } else { Vec::new() };
    place_markers(b, g, copy, &marked);
    let mut children = Vec::with_capacity(g.children().len());
    for (i, c) in g.children().iter().enumerate() {
        // Skip hidden markers.
        if matches!(c, usvg::Node::Group(m) if matches!(b.markers.get(&address(m)), Some(None))) {
            continue;
        }
        let shape = marked.iter().find(|m| m.0 == i).map(|m| m.1);
        let context = Context { owner: context.owner.or(shape), ..context };
        children.push(match c {
            usvg::Node::Group(c) => Node::Group(Box::new(resolve_group(b, c, frame, context))),
            usvg::Node::Path(p) => Node::Part(add_part(b, p, frame, context)),
            usvg::Node::Image(i) => resolve_image(b, i, element, transform, frame, context),
            usvg::Node::Text(t) => resolve_text(b, t, frame, context),
        });
    }
    if let Some(s) = slot {
        b.scene.slots[s].parts.end = b.scene.parts.len();
    }
    // Chain the element's clip path to the clip path of its viewport's edge, since the element can refer to only one.
    if let ([usvg::Node::Group(c)], [Node::Group(edge)]) = (g.children(), children.as_slice())
        && let (Some(_), Some(edge)) = (sliced_viewport(c), edge.clip)
        && b.scene.clips[edge].clip.is_none()
    {
        b.scene.clips[edge].clip = clip;
    }
    Group {
        source,
        owner,
        transform,
        opacity: g.opacity().get(),
        blend: g.blend_mode(),
        isolate: g.isolate(),
        clip,
        mask,
        filters: g.filters().to_vec(),
        slot,
        children,
    }
}

/// The viewport of an image that extends past it (`slice`). usvg puts such an image into a group within a group with a clip path.
fn sliced_viewport(g: &usvg::Group) -> Option<Rect> {
    let [usvg::Node::Group(inner)] = g.children() else { return None };
    let [usvg::Node::Image(_)] = inner.children() else { return None };
    g.clip_path()?;
    Some(rect(g.bounding_box()))
}

/// The address of a group, which identifies it.
fn address(g: &usvg::Group) -> usize {
    std::ptr::from_ref(g) as usize
}

/// The element of a group without id: the only shape, text or image in it.
fn only_child(b: &SceneBuilder<'_>, g: &usvg::Group) -> Option<ElementId> {
    let mut found = None;
    for c in g.children() {
        let leaf = match c {
            usvg::Node::Path(_) | usvg::Node::Text(_) => b.element(c.id()),
            usvg::Node::Group(_) => b.element(c.id()).filter(|&e| b.tag(e) == "image"),
            usvg::Node::Image(_) => None,
        };
        if let Some(e) = leaf
            && found.replace(e).is_some()
        {
            return None;
        }
    }
    found
}

/// Resolves a text as its outlines.
fn resolve_text(b: &mut SceneBuilder<'_>, t: &usvg::Text, frame: Affine, context: Context) -> Node {
    let element = b.element(t.id());
    if element.is_none() && context.owner.is_none() {
        b.unpatchable(Unpatchable::AmbiguousText);
    }
    let context = Context { owner: context.owner.or(element), ..context };
    let first = b.scene.parts.len();
    let content = resolve_group(b, t.flattened(), frame, context);
    if context.role == PartRole::Paint {
        let text = std::ptr::from_ref(t) as usize;
        b.scene.texts.push(PlacedText { text, owner: context.owner, frame, first });
    }
    let sources = element.and_then(|e| b.letters.get(&e)).cloned().unwrap_or_default();
    Node::Text { element, content: Box::new(content), sources }
}

/// Adds the part of a path. Returns its index.
fn add_part(b: &mut SceneBuilder<'_>, p: &usvg::Path, frame: Affine, context: Context) -> usize {
    let traced = trace(b, p);
    // The first path may be the page's background, which is not artwork.
    let is_background = b.scene.parts.is_empty() && b.may_have_background;
    if traced.source.is_none() && context.owner.is_none() && p.is_visible() && !is_background {
        b.unpatchable(Unpatchable::UntracedPath);
    }
    for paint in [p.fill().map(Fill::paint), p.stroke().map(Stroke::paint)] {
        if let Some(usvg::Paint::Pattern(pattern)) = paint {
            resolve_tile(b, pattern);
        }
    }
    let fixed_width = traced.source.or(traced.copied).is_some_and(|e| b.fixed_widths.contains(&e));
    let tile_context = Context { owner: context.owner.or(traced.source), ..context };
    let fill_tiles = lay_out_tiles(b, p, PaintKind::Fill, frame, tile_context);
    let stroke_tiles = if fixed_width { None } else { lay_out_tiles(b, p, PaintKind::Stroke, frame, tile_context) };
    b.scene.parts.push(Part {
        source: traced.source,
        drawn: traced.drawn,
        fill: p.fill().cloned(),
        stroke: p.stroke().cloned(),
        paint_order: p.paint_order(),
        rendering: p.rendering_mode(),
        visible: p.is_visible(),
        fixed_width,
        differs_from_usvg: (fixed_width && p.stroke().is_some())
            || context.owner.is_some_and(|e| b.marked.contains(&e)),
        slot: context.slot,
        path: std::ptr::from_ref(p) as usize,
        fill_tiles,
        stroke_tiles,
        ..Part::plain(context.role, context.owner, traced.outline, frame)
    });
    b.scene.parts.len() - 1
}

/// Resolves an image in a group that belongs to `element`. From pixels, `placing` leads to outside the group, and `frame` to root user
/// space.
fn resolve_image(
    b: &mut SceneBuilder<'_>,
    image: &usvg::Image,
    element: Option<ElementId>,
    placing: Affine,
    frame: Affine,
    context: Context,
) -> Node {
    let source = element.filter(|&e| b.tag(e) == "image");
    if let usvg::ImageKind::SVG(tree) = image.kind() {
        let context = Context { owner: context.owner.or(source), viewport: None, ..context };
        return Node::Group(Box::new(resolve_drawing(b, image, tree, frame, context)));
    }
    b.scene.bitmaps.push(Bitmap {
        image: Box::new(image.clone()),
        frame,
        placing,
        slot: context.slot,
        owner: context.owner.or(source).or(context.image),
        bends: context.role != PartRole::Pattern,
        crop: context.viewport.map(|v| placing.inverse().transform_rect_bbox(v)),
    });
    Node::Image(b.scene.bitmaps.len() - 1)
}

/// Resolves a drawing shown as an image: its content can be warped, and is clipped to the image. `frame` leads from the drawing's px to
/// root user space.
fn resolve_drawing(
    b: &mut SceneBuilder<'_>,
    image: &usvg::Image,
    tree: &usvg::Tree,
    frame: Affine,
    context: Context,
) -> Group {
    if context.owner.is_none() {
        b.unpatchable(Unpatchable::AmbiguousImage);
    }
    // An image does not blend with its backdrop.
    let isolate = blends(tree.root());
    let mut out = Group { isolate, ..Group::plain(context.owner, Affine::IDENTITY, Vec::new()) };
    if !image.is_visible() {
        return out;
    }
    b.scene.foreign.extend(tree.linear_gradients().iter().map(|g| Arc::as_ptr(g) as usize));
    b.scene.foreign.extend(tree.radial_gradients().iter().map(|g| Arc::as_ptr(g) as usize));
    b.scene.foreign.extend(tree.filters().iter().map(|f| Arc::as_ptr(f) as usize));
    b.foreign_depth += 1;
    let (width, height) = (tree.size().width(), tree.size().height());
    let content = tree.root().abs_layer_bounding_box();
    // Content within this distance of the edge overflows by rounding only.
    let slack = 1e-4 * (f64::from(width) + f64::from(height)) as f32;
    let overflows = content.left() < -slack
        || content.top() < -slack
        || content.right() > width + slack
        || content.bottom() > height + slack;
    if overflows && context.role != PartRole::Pattern {
        out.clip = Some(add_image_edge(b, Size::new(width.into(), height.into()), frame, context));
    }
    let inner = resolve_group(b, tree.root(), frame, context);
    b.foreign_depth -= 1;
    out.children.push(Node::Group(Box::new(inner)));
    out
}

/// Adds the edge of an image as a clip path. Returns its index.
fn add_image_edge(b: &mut SceneBuilder<'_>, size: Size, frame: Affine, context: Context) -> usize {
    let Size { width: w, height: h } = size;
    let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(Point::from);
    let outline = Outline::from_points(&corners, true).into();
    let first = b.scene.parts.len();
    let edge = Part { slot: context.slot, ..Part::plain(PartRole::Clip, context.owner, outline, frame) };
    b.scene.parts.push(edge);
    let root = Group::plain(None, Affine::IDENTITY, vec![Node::Part(first)]);
    b.push_clip(Clip::foreign("image-edge", root, context.owner, first..first + 1))
}

/// Resolves a clip path in the frame of its referrer, once for each frame, slot and bend. Returns its index.
fn add_clip(
    b: &mut SceneBuilder<'_>,
    c: &usvg::ClipPath,
    frame: Affine,
    referrer: Referrer,
    outside: Context,
) -> usize {
    let Context { slot, bend, .. } = outside;
    let key = (std::ptr::from_ref(c) as usize, bits(frame), slot, bend);
    if let Some(&i) = b.clip_index.get(&key) {
        b.scene.clips[i].referrers.push(referrer);
        return i;
    }
    let first = b.scene.parts.len();
    let definition = b.definition(c.id(), "clipPath");
    let transform = b.exact_transform(c.transform(), definition);
    let chained = Referrer { element: definition, owner: None };
    let clip = c.clip_path().map(|c| add_clip(b, c, frame, chained, outside));
    let context = Context { slot, bend, ..Context::top(PartRole::Clip) };
    let root = resolve_definition(b, c.root(), frame * transform, context);
    let i = b.push_clip(Clip {
        id: c.id().to_owned(),
        transform,
        clip,
        root,
        referrers: vec![referrer],
        bend,
        parts: first..b.scene.parts.len(),
        foreign: b.foreign_depth > 0,
    });
    b.clip_index.insert(key, i);
    i
}

/// Resolves a mask in the frame of its referrer, once for each frame, slot and bend. Returns its index.
fn add_mask(b: &mut SceneBuilder<'_>, m: &usvg::Mask, frame: Affine, referrer: Referrer, outside: Context) -> usize {
    let Context { slot, bend, .. } = outside;
    let key = (std::ptr::from_ref(m) as usize, bits(frame), slot, bend);
    if let Some(&i) = b.mask_index.get(&key) {
        b.scene.masks[i].referrers.push(referrer);
        return i;
    }
    let first = b.scene.parts.len();
    let chained = Referrer { element: b.definition(m.id(), "mask"), owner: None };
    let mask = m.mask().map(|m| add_mask(b, m, frame, chained, outside));
    let root = resolve_definition(b, m.root(), frame, Context { slot, bend, ..Context::top(PartRole::Mask) });
    b.scene.masks.push(Mask {
        id: m.id().to_owned(),
        rect: rect(m.rect().to_rect()),
        kind: m.kind(),
        mask,
        root,
        frame,
        slot,
        referrers: vec![referrer],
        bend,
        parts: first..b.scene.parts.len(),
        foreign: b.foreign_depth > 0,
        content: rect(m.root().stroke_bounding_box()),
    });
    let i = b.scene.masks.len() - 1;
    b.mask_index.insert(key, i);
    i
}

/// Resolves a pattern's tile, once.
fn resolve_tile(b: &mut SceneBuilder<'_>, pattern: &Arc<usvg::Pattern>) {
    if b.scene.tiles.iter().any(|t| Arc::ptr_eq(&t.pattern, pattern)) {
        return;
    }
    let root = resolve_definition(b, pattern.root(), Affine::IDENTITY, Context::top(PartRole::Pattern));
    b.scene.tiles.push(PatternTile { pattern: pattern.clone(), root });
}

/// Resolves the content of an `feImage`, once.
fn resolve_filter_image(b: &mut SceneBuilder<'_>, root: &usvg::Group) {
    let key = std::ptr::from_ref(root) as usize;
    if !b.scene.pictures.contains_key(&key) {
        let group = resolve_definition(b, root, Affine::IDENTITY, Context::top(PartRole::Pattern));
        b.scene.pictures.insert(key, group);
    }
}

/// Resolves the content of a definition. Parts in it that cannot be traced do not prevent patching, since they replace no element of the
/// drawing.
fn resolve_definition(b: &mut SceneBuilder<'_>, g: &usvg::Group, frame: Affine, context: Context) -> Group {
    let before = b.scene.unpatchable.take();
    let root = resolve_group(b, g, frame, context);
    b.scene.unpatchable = before;
    root
}
