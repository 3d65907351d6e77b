//! Computes the areas that visible parts, strokes and filters of a drawing cover.

use super::geometry::{rect, stretch};
use super::model::{Bitmap, Group, Node, Part, PartRole, Scene};
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::kurbo::{self, Affine, Cap, Join, Point, Rect, Vec2};
use pathwarp::{Outline, Seg, Subpath};
use std::collections::HashMap;
use usvg::filter::{
    ColorMatrixKind, CompositeOperator, Filter, Input, Kind, MorphologyOperator, Primitive, TransferFunction,
};
use usvg::{LineCap, LineJoin, Stroke};

/// Flags for the parts and bitmaps to include in a box.
pub(crate) struct Counted {
    pub(crate) parts: Vec<bool>,
    pub(crate) bitmaps: Vec<bool>,
    /// `true` if strokes extend the box by half their width.
    pub(crate) strokes: bool,
}

/// Bounding box of the visible area of the counted artwork. `page` is the visible area of the drawing, if it has one.
pub(crate) fn seen_box(scene: &Scene, page: Option<Rect>, counted: &Counted) -> Option<Rect> {
    group_box(scene, &scene.root, page, counted, &|_| true)
}

/// Bounding box of the visible area of the counted artwork that touches the page. Shapes count with their area beyond the page.
pub(crate) fn uncut_box(scene: &Scene, page: Rect, counted: &Counted) -> Option<Rect> {
    group_box(scene, &scene.root, None, counted, &|b| overlap(b, page).is_some())
}

/// Bounding box of a bitmap in root user space. `None` if it is hidden or was not read.
pub(crate) fn picture_box(b: &Bitmap) -> Option<Rect> {
    let [p, q, r, s] = picture_corners(b)?;
    Some(Rect::from_points(p, q).union(Rect::from_points(r, s)))
}

/// The corners of a bitmap in root user space. `None` if it is hidden or was not read.
pub(crate) fn picture_corners(b: &Bitmap) -> Option<[Point; 4]> {
    let size = b.image.size();
    let all = Rect::new(0.0, 0.0, f64::from(size.width()), f64::from(size.height()));
    let r = b.crop.map_or(all, |c| c.intersect(all));
    let corners = [(r.x0, r.y0), (r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)].map(|p| b.frame * Point::from(p));
    (b.image.is_visible() && !b.is_unread()).then_some(corners).filter(|c| c.iter().all(|p| p.is_finite()))
}

/// Bounding box of the counted artwork in a group, clipped to `room`. Includes only parts and bitmaps whose box `is_kept` accepts.
fn group_box(
    scene: &Scene,
    g: &Group,
    room: Option<Rect>,
    counted: &Counted,
    is_kept: &dyn Fn(Rect) -> bool,
) -> Option<Rect> {
    let room = room_in(scene, g, room)?;
    let clipped = |all: Rect| room.map_or(Some(all), |room| overlap(all, room)).filter(|b| is_kept(*b));
    let child_box = |n: &Node| match n {
        Node::Group(g) => group_box(scene, g, room, counted, is_kept),
        Node::Text { content, .. } => group_box(scene, content, room, counted, is_kept),
        Node::Part(i) => {
            let p = &scene.parts[*i];
            let is_counted = is_seen(p) && p.role == PartRole::Paint && counted.parts[*i];
            let by = if counted.strokes { stroke_extent(p, scene.to_px) } else { 0.0 };
            clipped(p.outline().bounding_box().filter(|b| is_counted && b.is_finite())?.inflate(by, by))
        }
        Node::Image(i) => clipped(picture_box(&scene.bitmaps[*i]).filter(|_| counted.bitmaps[*i])?),
    };
    g.children.iter().filter_map(child_box).reduce(|a, b| a.union(b))
}

/// Distance by which a part's stroke extends from its path, in root user units: half its width. In tiles, the path is
/// the stroke's outline already.
pub(crate) fn stroke_extent(p: &Part, to_px: Affine) -> f64 {
    let frame = if p.fixed_width { to_px.inverse() } else { p.frame };
    p.stroke.as_ref().filter(|_| !p.in_tile).map_or(0.0, |s| 0.5 * f64::from(s.width().get()) * stretch(frame))
}

/// Returns `true` if a part is visible and has a paint that is not transparent.
pub(crate) fn is_seen(p: &Part) -> bool {
    let fill = p.fill.as_ref().is_some_and(|f| f.opacity().get() > 0.0);
    let stroke = p.stroke.as_ref().is_some_and(|s| s.opacity().get() > 0.0);
    p.visible && (fill || stroke)
}

/// The area to which a group clips its content: `Some(None)` if it is unbounded, `None` if the group hides everything.
fn room_in(scene: &Scene, g: &Group, room: Option<Rect>) -> Option<Option<Rect>> {
    if g.opacity <= 0.0 {
        return None;
    }
    let room = room_in_clip(scene, g, room)?;
    let Some(mask) = g.mask.map(|i| mask_box(scene, i)) else { return Some(room) };
    room.map_or(Some(mask), |room| overlap(room, mask)).map(Some)
}

/// The area to which the clip path of a group clips its content: `Some(None)` if it is unbounded, `None` if nothing is left of `room`.
pub(crate) fn room_in_clip(scene: &Scene, g: &Group, room: Option<Rect>) -> Option<Option<Rect>> {
    let Some(i) = g.clip else { return Some(room) };
    let clip = clip_box(scene, i, &|i| scene.parts[i].outline().bounding_box())?;
    room.map_or(Some(clip), |room| overlap(room, clip)).map(Some)
}

/// Bounding box of a clip path, given the boxes of parts; `None` if it hides everything.
pub(crate) fn clip_box(scene: &Scene, i: usize, part_box: &dyn Fn(usize) -> Option<Rect>) -> Option<Rect> {
    fn content(g: &Group, part_box: &dyn Fn(usize) -> Option<Rect>) -> Option<Rect> {
        let boxes = g.children.iter().filter_map(|n| match n {
            Node::Group(g) => content(g, part_box),
            Node::Text { content: text, .. } => content(text, part_box),
            Node::Part(i) => part_box(*i),
            Node::Image(_) => None,
        });
        boxes.reduce(|a, b| a.union(b))
    }
    let clip = &scene.clips[i];
    let bounds = content(&clip.root, part_box)?;
    match clip.clip {
        Some(next) => overlap(bounds, clip_box(scene, next, part_box)?),
        None => Some(bounds),
    }
}

/// Bounding box of a mask in root user space, regardless of its brightness.
fn mask_box(scene: &Scene, i: usize) -> Rect {
    let m = &scene.masks[i];
    m.frame.transform_rect_bbox(overlap(m.rect, m.content).unwrap_or_default())
}

/// The intersection of two areas, which may be lines or points.
pub(crate) fn overlap(a: Rect, b: Rect) -> Option<Rect> {
    let (x0, x1) = (a.x0.max(b.x0), a.x1.min(b.x1));
    let (y0, y1) = (a.y0.max(b.y0), a.y1.min(b.y1));
    (x0 <= x1 && y0 <= y1).then(|| Rect::new(x0, y0, x1, y1))
}

/// Work of each segment of an expanded stroke. It is less than for other segments, since their number is an upper bound, and fitting them
/// is charged separately.
const EXPANDED: f64 = 18.0;

/// Segments of the outline of a dash or a subpath with its caps. Each segment is held three times: expanded, bent, and as written.
const PER_DASH: f64 = 3.0 * 8.0;
/// Segments of the outline of a segment with its join, held three times.
const PER_SEGMENT: f64 = 3.0 * 2.0;
/// Segments of the outline of a segment with its round join, held three times.
const PER_ROUND_SEGMENT: f64 = 3.0 * 4.0;

/// Work of measuring a dash, in expanded segments.
const PER_MEASURED_DASH: f64 = 2.0;

/// Sides closer than this fraction of the tolerance get no join, which adds up to half of the gap to the error.
const GAP: f64 = 0.3;

/// Expands the stroke of `local` to a filled outline in the same user space, within `tolerance` there.
pub(crate) fn stroke_outline(local: &Outline, stroke: &Stroke, tolerance: f64) -> Outline {
    let each = stroke_outlines(local, stroke, |_| [(1.0 - 0.5 * GAP) * tolerance, GAP * tolerance]);
    Outline { subpaths: each.into_iter().flat_map(|(_, o)| o.subpaths).collect() }
}

/// Expands the stroke of each subpath. `tolerances` gives the tolerance and the largest gap for a subpath by its index.
pub(crate) fn stroke_outlines(
    local: &Outline,
    stroke: &Stroke,
    tolerances: impl Fn(usize) -> [f64; 2],
) -> Vec<(usize, Outline)> {
    let style = style(stroke, drawn_dashes(local, stroke) > 0.0);
    let clips_miters = stroke.linejoin() == LineJoin::MiterClip;
    let outline = |(i, s): (usize, &Subpath)| {
        let one = Outline { subpaths: vec![s.clone()] };
        // Bending the path itself reports coordinates that are not finite.
        (i, one.stroked(&style, clips_miters, tolerances(i)).unwrap_or_default())
    };
    local.subpaths.iter().enumerate().map(outline).collect()
}

/// Converts a stroke's style to kurbo's.
fn style(stroke: &Stroke, is_dashed: bool) -> kurbo::Stroke {
    let cap = match stroke.linecap() {
        LineCap::Butt => Cap::Butt,
        LineCap::Round => Cap::Round,
        LineCap::Square => Cap::Square,
    };
    let join = match stroke.linejoin() {
        LineJoin::Miter | LineJoin::MiterClip => Join::Miter,
        LineJoin::Round => Join::Round,
        LineJoin::Bevel => Join::Bevel,
    };
    let style = kurbo::Stroke::new(f64::from(stroke.width().get()))
        .with_caps(cap)
        .with_join(join)
        .with_miter_limit(f64::from(stroke.miterlimit().get()));
    match stroke.dasharray().filter(|_| is_dashed) {
        Some(dashes) => style.with_dashes(f64::from(stroke.dashoffset()), dashes.iter().copied().map(f64::from)),
        None => style,
    }
}

/// The area that a part's stroke covers in root user space, within `tolerance` there, for the nonzero rule. `to_px` maps root user
/// space to px.
///
/// # Errors
/// [`Exceeded`] if the stroke has more segments than the budget allows.
pub(crate) fn stroked(
    part: &Part,
    to_px: Affine,
    tolerance: f64,
    budget: &Budget,
) -> Result<Option<Outline>, Exceeded> {
    let Some(stroke) = &part.stroke else { return Ok(None) };
    if part.in_tile {
        return Ok(Some(Outline::clone(&part.outline())));
    }
    spend_stroke(&part.local, stroke, budget)?;
    // Maps the space in which the width is measured to root user space.
    let frame = if part.fixed_width { to_px.inverse() } else { part.frame };
    let scale = stretch(frame);
    if !(scale > 0.0 && scale.is_finite()) {
        return Ok(None);
    }
    let path = if part.fixed_width { part.outline().transformed(to_px) } else { Outline::clone(&part.local) };
    Ok(Some(stroke_outline(&path, stroke, tolerance / scale).transformed(frame)))
}

/// Returns `true` if a segment has no extent beyond the point `at`.
pub(crate) fn is_point(s: &Seg, at: Point) -> bool {
    let c = s.to_cubic();
    [c.p0, c.p1, c.p2, c.p3].iter().all(|p| *p == at)
}

/// Charges for expanding the dashes of a stroke that is only measured.
pub(crate) fn spend_dashes(local: &Outline, stroke: &Stroke, budget: &Budget) -> Result<(), Exceeded> {
    budget.spend(EXPANDED * PER_MEASURED_DASH * drawn_dashes(local, stroke))
}

/// Charges for an upper bound on the segments into which a stroke is expanded.
///
/// # Errors
/// [`Exceeded`] if the work exceeds the budget.
pub(crate) fn spend_stroke(local: &Outline, stroke: &Stroke, budget: &Budget) -> Result<(), Exceeded> {
    let dashes = drawn_dashes(local, stroke);
    let each = if stroke.linejoin() == LineJoin::Round { PER_ROUND_SEGMENT } else { PER_SEGMENT };
    let segments = PER_DASH * (dashes + local.subpaths.len() as f64) + each * local.segs().count() as f64;
    budget.spend(EXPANDED * segments)
}

/// An upper bound on the number of dashes drawn for a stroke.
fn drawn_dashes(local: &Outline, stroke: &Stroke) -> f64 {
    let pattern: Vec<f64> = stroke.dasharray().into_iter().flatten().map(|d| f64::from(*d)).collect();
    local.drawn_dashes(&pattern)
}

/// Extent of a Gaussian in standard deviations, about that of the three box blurs by which renderers approximate it (Filter Effects Module
/// Level 1, §9.14).
const BLUR_REACH: f64 = 3.0;

/// A bound on the area that `filter` paints from `content`, with `region` for the filter region, all in the filter's user space.
/// Returns `None` if it paints nothing.
pub(crate) fn filter_box(filter: &Filter, region: Rect, content: Rect) -> Option<Rect> {
    let mut results: HashMap<&str, Option<Rect>> = HashMap::new();
    let mut last = overlap(content, region);
    for p in filter.primitives() {
        let region = primitive_region(filter, p, region);
        let input_box = |input: &Input| match input {
            Input::SourceGraphic | Input::SourceAlpha => Some(content),
            Input::Reference(name) => results.get(name.as_str()).copied().unwrap_or(Some(region)),
        };
        last = primitive_box(p.kind(), &input_box, region).and_then(|b| overlap(b, region));
        results.insert(p.result(), last);
    }
    last
}

/// A bound on the area that a primitive paints, given the boxes of its inputs.
fn primitive_box(kind: &Kind, input: &dyn Fn(&Input) -> Option<Rect>, region: Rect) -> Option<Rect> {
    let union = |a: Option<Rect>, b: Option<Rect>| a.into_iter().chain(b).reduce(|a, b| a.union(b));
    let grown = |b: Rect, x: f32, y: f32| b.inflate(f64::from(x), f64::from(y));
    let blurred = |b: Rect, x: f32, y: f32| b.inflate(BLUR_REACH * f64::from(x), BLUR_REACH * f64::from(y));
    match kind {
        Kind::GaussianBlur(b) => input(b.input()).map(|i| blurred(i, b.std_dev_x().get(), b.std_dev_y().get())),
        Kind::DropShadow(s) => input(s.input()).map(|i| {
            let shadow = blurred(i, s.std_dev_x().get(), s.std_dev_y().get());
            i.union(shadow + Vec2::new(s.dx().into(), s.dy().into()))
        }),
        Kind::Offset(o) => input(o.input()).map(|i| i + Vec2::new(o.dx().into(), o.dy().into())),
        Kind::Blend(b) => union(input(b.input1()), input(b.input2())),
        Kind::Composite(c) => match c.operator() {
            CompositeOperator::In => input(c.input1()).and_then(|a| overlap(a, input(c.input2())?)),
            CompositeOperator::Out => input(c.input1()),
            CompositeOperator::Atop => input(c.input2()),
            CompositeOperator::Arithmetic { k4, .. } if k4 > 0.0 => Some(region),
            CompositeOperator::Over
            | CompositeOperator::Xor
            | CompositeOperator::Lighter
            | CompositeOperator::Arithmetic { .. } => union(input(c.input1()), input(c.input2())),
        },
        Kind::Merge(m) => m.inputs().iter().filter_map(input).reduce(|a, b| a.union(b)),
        Kind::Morphology(m) => input(m.input()).map(|i| match m.operator() {
            MorphologyOperator::Erode => i,
            MorphologyOperator::Dilate => grown(i, m.radius_x().get(), m.radius_y().get()),
        }),
        Kind::DisplacementMap(m) => input(m.input1()).map(|i| grown(i, m.scale().abs() / 2.0, m.scale().abs() / 2.0)),
        // The last value of a matrix's fourth row is the alpha of transparent pixels.
        Kind::ColorMatrix(m) => match m.kind() {
            ColorMatrixKind::Matrix(v) if v.get(19).is_some_and(|alpha| *alpha > 0.0) => Some(region),
            ColorMatrixKind::LuminanceToAlpha
            | ColorMatrixKind::Matrix(_)
            | ColorMatrixKind::Saturate(_)
            | ColorMatrixKind::HueRotate(_) => input(m.input()),
        },
        Kind::Flood(f) if f.opacity().get() == 0.0 => None,
        Kind::ComponentTransfer(t) if keeps_transparent(t.func_a()) => input(t.input()),
        Kind::ComponentTransfer(_)
        | Kind::ConvolveMatrix(_)
        | Kind::DiffuseLighting(_)
        | Kind::SpecularLighting(_)
        | Kind::Flood(_)
        | Kind::Image(_)
        | Kind::Tile(_)
        | Kind::Turbulence(_) => Some(region),
    }
}

/// Returns `true` if a transfer function of alpha leaves transparent pixels transparent.
fn keeps_transparent(alpha: &TransferFunction) -> bool {
    match alpha {
        TransferFunction::Identity => true,
        TransferFunction::Table(v) | TransferFunction::Discrete(v) => v.first().is_none_or(|a| *a <= 0.0),
        TransferFunction::Linear { intercept, .. } => *intercept <= 0.0,
        TransferFunction::Gamma { offset, .. } => *offset <= 0.0,
    }
}

/// The region of a primitive; without one, `region`, the filter region.
pub(crate) fn primitive_region(filter: &Filter, p: &Primitive, region: Rect) -> Rect {
    if p.rect() == filter.rect() { region } else { rect(p.rect().to_rect()) }
}
