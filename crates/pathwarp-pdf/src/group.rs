//! Draws groups with their clip paths, masks, opacity, blend modes and content. A group with a filter becomes a picture.

use crate::file::{File, State};
use crate::options::PRINT;
use crate::stream::{Stream, affine, rect, roomy};
use crate::{image, paint};
use kurbo::{Affine, BezPath, Rect, Shape as _, Vec2};
use pathwarp_raster::{Error, Pixmap, render_group};
use pdf_writer::Ref;
use pdf_writer::types::MaskType;
use resvg::tiny_skia::Transform;
use usvg::{BlendMode, ClipPath, Fill, FillRule, Group, Mask, Node};

/// Draws a group.
pub(crate) fn draw(file: &mut File<'_>, stream: &mut Stream, group: &Group) {
    let transform = affine(group.transform());
    let is_plain = !group.should_isolate();
    if is_plain && transform == Affine::IDENTITY {
        draw_children(file, stream, group);
        return;
    }
    stream.save();
    stream.transform(transform);
    if is_plain {
        draw_children(file, stream, group);
    } else if group.filters().is_empty() {
        draw_isolated(file, stream, group);
    } else {
        draw_as_picture(file, stream, group);
    }
    stream.restore();
}

fn draw_children(file: &mut File<'_>, stream: &mut Stream, group: &Group) {
    for child in group.children() {
        match child {
            Node::Group(group) => draw(file, stream, group),
            Node::Path(p) => paint::draw(file, stream, p),
            Node::Image(i) => image::draw(file, stream, i),
            Node::Text(t) => draw(file, stream, t.flattened()),
        }
    }
}

/// Draws an isolated group, in the coordinates of its content.
fn draw_isolated(file: &mut File<'_>, stream: &mut Stream, group: &Group) {
    let bounds = roomy(rect(group.layer_bounding_box().to_rect()));
    let mut masks = Vec::new();
    if let Some(clip) = group.clip_path() {
        masks.extend(apply_clip(file, stream, clip, bounds).map(|m| (MaskType::Luminosity, m)));
    }
    masks.extend(group.mask().map(|m| add_mask(file, m, stream.shift)));
    let state = State::default().opacity(group.opacity().get()).blend(group.blend_mode());
    // A clip path alone does not need a group.
    if masks.is_empty() && state.is_plain() && !group.isolate() {
        draw_children(file, stream, group);
        return;
    }
    let mut content = file.group(bounds, stream.shift, |file, stream| draw_children(file, stream, group));
    // A state has one mask, so a second one goes into another group.
    if masks.len() > 1
        && let Some((kind, mask)) = masks.pop()
    {
        content = file.group(bounds, stream.shift, |file, stream| {
            compose(file, stream, State::default().mask(kind, mask), content);
        });
    }
    let state = masks.pop().map_or(state, |(kind, mask)| state.mask(kind, mask));
    compose(file, stream, state, content);
}

/// Draws an object under a graphics state.
fn compose(file: &mut File<'_>, stream: &mut Stream, state: State, object: Ref) {
    if !state.is_plain() {
        stream.state(file.state(state));
    }
    stream.object(object);
}

fn add_mask(file: &mut File<'_>, m: &Mask, shift: Vec2) -> (MaskType, Ref) {
    let kind = match m.kind() {
        usvg::MaskType::Luminance => MaskType::Luminosity,
        usvg::MaskType::Alpha => MaskType::Alpha,
    };
    let area: Rect = rect(m.rect().to_rect());
    let group = file.group(area, shift, |file, stream| {
        let outer = m.mask().map(|m| add_mask(file, m, shift));
        let content = file.group(area, shift, |file, stream| draw(file, stream, m.root()));
        let state = outer.map_or(State::default(), |(kind, group)| State::default().mask(kind, group));
        compose(file, stream, state, content);
    });
    (kind, group)
}

/// Draws a group with a filter as a picture.
fn draw_as_picture(file: &mut File<'_>, stream: &mut Stream, group: &Group) {
    if file.failed.is_some() {
        return;
    }
    let added = render(file, group).and_then(|picture| {
        let Some(picture) = picture else { return Ok(None) };
        Ok(Some((image::add_bitmap(file, &picture.pixmap, true)?, picture.area)))
    });
    match added {
        Ok(Some((object, area))) => {
            file.pictures += 1;
            if group.blend_mode() != BlendMode::Normal {
                stream.state(file.state(State::default().blend(group.blend_mode())));
            }
            image::draw_over(stream, object, area);
        }
        Ok(None) => {}
        Err(e) => file.failed = Some(e),
    }
}

/// Restricts drawing to a clip path. If outlines cannot express it, returns the group of a mask that does.
fn apply_clip(file: &mut File<'_>, stream: &mut Stream, clip: &ClipPath, bounds: Rect) -> Option<Ref> {
    if let Some(outlines) = clip_outlines(file, clip) {
        for (path, rule) in &outlines {
            stream.clip(path, *rule);
        }
        return None;
    }
    Some(file.group(bounds, stream.shift, |file, stream| {
        if let Some(next) = clip.clip_path()
            && let Some(mask) = apply_clip(file, stream, next, bounds)
        {
            stream.state(file.state(State::default().mask(MaskType::Luminosity, mask)));
        }
        stream.content.set_fill_gray(1.0);
        stream.transform(affine(clip.transform()));
        fill_silhouette(file, stream, clip.root(), bounds);
    }))
}

/// Expresses a clip path as an intersection of outlines. Returns `None` if that is impossible.
fn clip_outlines(file: &File<'_>, clip: &ClipPath) -> Option<Vec<(BezPath, FillRule)>> {
    let mut content = Vec::new();
    collect_outlines(file, clip.root(), affine(clip.transform()), &mut content)?;
    let rule = content.first().map_or(FillRule::NonZero, |(_, rule)| *rule);
    let boxes: Vec<Rect> = content.iter().map(|(path, _)| path.bounding_box()).collect();
    // The winding numbers of outlines that overlap would add up.
    if content.iter().any(|(_, r)| *r != rule) || !are_apart(&boxes) {
        return None;
    }
    let mut path = BezPath::new();
    content.iter().for_each(|(p, _)| path.extend(p.iter()));
    if path.elements().is_empty() {
        // An empty clip path hides everything, but an empty outline would not clip at all.
        path = Rect::ZERO.to_path(1.0);
    }
    let mut out = clip.clip_path().map_or(Some(Vec::new()), |next| clip_outlines(file, next))?;
    out.push((path, rule));
    Some(out)
}

/// Returns `true` if no two boxes overlap; `false` for many boxes, since comparing all pairs would take long.
fn are_apart(boxes: &[Rect]) -> bool {
    const MAX_BOXES: usize = 256;
    let overlap = |a: &Rect, b: &Rect| a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
    boxes.len() <= MAX_BOXES && boxes.iter().enumerate().all(|(i, a)| !boxes[i + 1..].iter().any(|b| overlap(a, b)))
}

/// Collects the outlines of a clip path's content. Returns `None` if a part of it is clipped in turn.
fn collect_outlines(file: &File<'_>, group: &Group, to_user: Affine, out: &mut Vec<(BezPath, FillRule)>) -> Option<()> {
    for child in group.children() {
        match child {
            Node::Group(group) if group.clip_path().is_some() => return None,
            Node::Group(group) => collect_outlines(file, group, to_user * affine(group.transform()), out)?,
            Node::Text(t) => collect_outlines(file, t.flattened(), to_user * affine(t.flattened().transform()), out)?,
            Node::Path(p) => {
                if let Some(fill) = p.fill().filter(|_| p.is_visible()) {
                    out.push((to_user * paint::outline(file, p), Fill::rule(fill)));
                }
            }
            Node::Image(_) => {}
        }
    }
    Some(())
}

/// Fills the content of a clip path with the current colour. `bounds` is in its coordinates.
fn fill_silhouette(file: &mut File<'_>, stream: &mut Stream, group: &Group, bounds: Rect) {
    for child in group.children() {
        let group = match child {
            Node::Group(group) => &**group,
            Node::Text(t) => t.flattened(),
            Node::Path(p) => {
                if let Some(fill) = p.fill().filter(|_| p.is_visible()) {
                    stream.fill(&paint::outline(file, p), fill.rule());
                }
                continue;
            }
            Node::Image(_) => continue,
        };
        stream.save();
        stream.transform(affine(group.transform()));
        let inner = affine(group.transform()).inverse();
        let inner = if inner.is_finite() { inner.transform_rect_bbox(bounds) } else { bounds };
        if let Some(clip) = group.clip_path()
            && let Some(mask) = apply_clip(file, stream, clip, inner)
        {
            stream.state(file.state(State::default().mask(MaskType::Luminosity, mask)));
        }
        fill_silhouette(file, stream, group, inner);
        stream.restore();
    }
}

const PX_PER_INCH: f64 = 96.0;

/// Largest number of halvings of a picture's sides to stay within the limits.
const MAX_HALVINGS: i32 = 4;

/// A picture in the coordinates of a group.
struct Picture {
    pixmap: Pixmap,
    area: Rect,
}

/// Renders a group with its filters, clip path, mask and opacity, with fewer pixels if the limits do not allow the resolution.
/// Returns `None` if it shows nothing.
fn render(file: &mut File<'_>, group: &Group) -> Result<Option<Picture>, Error> {
    let area = rect(group.layer_bounding_box().to_rect());
    let dpi = file.options.picture_dpi.unwrap_or(PRINT);
    let pixels_per_unit = affine(group.abs_transform()).determinant().abs().sqrt() * dpi / PX_PER_INCH;
    // The renderer moves the picture's corner to the origin and applies the group's transform; undo both.
    let back = affine(group.transform()).inverse();
    if !back.is_finite() || !pixels_per_unit.is_finite() {
        return Ok(None);
    }
    let layer = group.abs_layer_bounding_box();
    let to_area = Affine::translate(-area.origin().to_vec2())
        * back
        * Affine::translate((f64::from(layer.x()), f64::from(layer.y())));
    let mut halvings = 0;
    loop {
        let scale = pixels_per_unit * 0.5_f64.powi(halvings);
        let size = [area.width(), area.height()].map(|v| (v * scale).ceil().max(1.0));
        let to_pixels = Affine::scale_non_uniform(size[0] / area.width(), size[1] / area.height()) * to_area;
        let [a, b, c, d, e, f] = to_pixels.as_coeffs().map(|v| v as f32);
        match render_group(group, Transform::from_row(a, b, c, d, e, f), size, &file.budget) {
            Err(Error::TooLarge { .. } | Error::TooMuch(_)) if halvings < MAX_HALVINGS => halvings += 1,
            Err(e) => return Err(e),
            Ok(drawn) => {
                file.coarser += usize::from(halvings > 0);
                return Ok(drawn.map(|pixmap| Picture { pixmap, area }));
            }
        }
    }
}
