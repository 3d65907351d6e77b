//! Draws paths: fill and stroke with colours, gradients, tiling patterns, and their opacity.

use crate::file::{File, State, deflated};
use crate::gradient::Gradient;
use crate::group;
use crate::stream::{Stream, affine, from_usvg, has_area, matrix, pdf_rect, rect, roomy};
use kurbo::{Affine, BezPath, PathEl, Rect};
use pdf_writer::types::{LineCapStyle, LineJoinStyle, MaskType, PaintType, TilingType};
use pdf_writer::{Filter, Ref};
use usvg::{Fill, LineCap, LineJoin, Paint, PaintOrder, Path, Stroke};

/// A use of a paint.
struct PaintUse<'a> {
    paint: &'a Paint,
    opacity: f32,
    /// `true` for a stroke, `false` for a fill.
    strokes: bool,
    /// The path to paint.
    path: &'a Path,
}

/// Calls `draw` with the paint set.
fn with_paint(file: &mut File<'_>, stream: &mut Stream, paint_use: &PaintUse<'_>, draw: impl FnOnce(&mut Stream)) {
    let PaintUse { paint, opacity, strokes, path } = *paint_use;
    let area = roomy(rect(path.stroke_bounding_box()));
    let mesh = (file.options.mesh)(paint, rect(path.bounding_box()));
    let gradient = mesh.map(Gradient::mesh).or_else(|| Gradient::from_paint(paint, area));
    let mut state = State::default().opacity(opacity);
    if let Some(gradient) = gradient.as_ref().filter(|g| g.is_translucent()) {
        // The opacities as shades of grey serve as a mask.
        let group = file.group(area, stream.shift, |file, stream| {
            stream.pattern(gradient.opacities(file, stream.to_start), false);
            let corner = area.origin() - stream.shift;
            let [x, y, width, height] = [corner.x, corner.y, area.width(), area.height()].map(|v| v as f32);
            stream.content.rect(x, y, width, height).fill_nonzero();
        });
        state = state.mask(MaskType::Luminosity, group);
    }
    // Every path sets its paint, so a gradient or pattern can stay set, but a state would affect later paths.
    let has_state = !state.is_plain();
    if has_state {
        stream.save();
        stream.state(file.state(state));
    }
    match (paint, &gradient) {
        (Paint::Color(c), _) => {
            let [r, g, b] = [c.red, c.green, c.blue].map(|v| f32::from(v) / 255.0);
            if strokes {
                stream.content.set_stroke_rgb(r, g, b);
            } else {
                stream.content.set_fill_rgb(r, g, b);
            }
        }
        (Paint::Pattern(p), _) => stream.pattern(add_pattern(file, p, stream.to_start), strokes),
        (_, Some(gradient)) => stream.pattern(gradient.colors(file, stream.to_start), strokes),
        // The transform of the gradient has no inverse.
        (_, None) => {}
    }
    draw(stream);
    if has_state {
        stream.restore();
    }
}

/// Returns the exact outline of a path, or else the outline in usvg.
pub(crate) fn outline(file: &File<'_>, p: &Path) -> BezPath {
    (file.options.exact)(p).unwrap_or_else(|| from_usvg(p.data()))
}

/// Draws a path.
pub(crate) fn draw(file: &mut File<'_>, stream: &mut Stream, path: &Path) {
    if !path.is_visible() {
        return;
    }
    let outline = outline(file, path);
    match path.paint_order() {
        PaintOrder::FillAndStroke => {
            fill(file, stream, path, &outline);
            stroke(file, stream, path, &outline);
        }
        PaintOrder::StrokeAndFill => {
            stroke(file, stream, path, &outline);
            fill(file, stream, path, &outline);
        }
    }
}

fn fill(file: &mut File<'_>, stream: &mut Stream, path: &Path, outline: &BezPath) {
    let Some(fill) = path.fill().filter(|_| has_area(outline)) else { return };
    let paint_use = PaintUse { paint: Fill::paint(fill), opacity: fill.opacity().get(), strokes: false, path };
    with_paint(file, stream, &paint_use, |stream| stream.fill(outline, fill.rule()));
}

fn stroke(file: &mut File<'_>, stream: &mut Stream, path: &Path, outline: &BezPath) {
    let Some(stroke) = path.stroke() else { return };
    if let Some(spot) = (file.options.spot)(path) {
        stream.save();
        if !spot.knockout {
            stream.state(file.state(State::default().overprint()));
        }
        stream.ink(file.ink(&spot.name));
        set_pen(stream, stroke);
        stream.outline(outline);
        stream.content.stroke();
        stream.restore();
        return;
    }
    let paint_use = PaintUse { paint: Stroke::paint(stroke), opacity: stroke.opacity().get(), strokes: true, path };
    with_paint(file, stream, &paint_use, |stream| {
        set_pen(stream, stroke);
        match stroke.linecap() {
            LineCap::Square => stream.outline(&with_dots(outline, stroke.width().get())),
            _ => stream.outline(outline),
        }
        stream.content.stroke();
    });
}

/// Sets width, joins, caps and dashes.
fn set_pen(stream: &mut Stream, stroke: &Stroke) {
    let content = &mut stream.content;
    content.set_line_width(stroke.width().get());
    content.set_line_cap(match stroke.linecap() {
        LineCap::Butt => LineCapStyle::ButtCap,
        LineCap::Round => LineCapStyle::RoundCap,
        LineCap::Square => LineCapStyle::ProjectingSquareCap,
    });
    content.set_line_join(match stroke.linejoin() {
        LineJoin::Miter | LineJoin::MiterClip => LineJoinStyle::MiterJoin,
        LineJoin::Round => LineJoinStyle::RoundJoin,
        LineJoin::Bevel => LineJoinStyle::BevelJoin,
    });
    content.set_miter_limit(stroke.miterlimit().get());
    let dashes = stroke.dasharray().unwrap_or_default();
    // PDF requires a positive offset into the dashes.
    let period: f32 = dashes.iter().sum();
    let offset = if period > 0.0 { stroke.dashoffset().rem_euclid(period) } else { 0.0 };
    content.set_dash_pattern(dashes.iter().copied(), offset);
}

/// Gives lines of no length a minute length, since SVG draws their square caps and PDF does not.
fn with_dots(outline: &BezPath, width: f32) -> BezPath {
    /// The length as a fraction of the width.
    const MINUTE: f64 = 1e-4;
    let elements = outline.elements();
    let ends_before = |i: usize| elements.get(i).is_none_or(|e| matches!(e, PathEl::MoveTo(_)));
    let mut out = BezPath::new();
    for (i, element) in elements.iter().enumerate() {
        match (*element, elements.get(i.wrapping_sub(1))) {
            (PathEl::LineTo(p), Some(PathEl::MoveTo(q))) if p == *q && ends_before(i + 1) => {
                out.line_to((p.x + MINUTE * f64::from(width), p.y));
            }
            (other, _) => out.push(other),
        }
    }
    out
}

/// Adds a pattern. `to_start` maps the user space of the painted path to the coordinates at the start of the content stream.
fn add_pattern(file: &mut File<'_>, pattern: &usvg::Pattern, to_start: Affine) -> Ref {
    let mut stream = Stream::new();
    group::draw(file, &mut stream, pattern.root());
    let (bytes, used) = stream.finish();
    let bytes = deflated(&bytes);
    let tile = pattern.rect();
    let (width, height) = (tile.width(), tile.height());
    // The origin of the content is the corner of the tile.
    let corner = Affine::translate((f64::from(tile.x()), f64::from(tile.y())));
    let object = file.new_ref();
    let mut out = file.pdf.tiling_pattern(object, &bytes);
    out.filter(Filter::FlateDecode);
    out.paint_type(PaintType::Colored).tiling_type(TilingType::ConstantSpacing);
    out.bbox(pdf_rect(Rect::new(0.0, 0.0, f64::from(width), f64::from(height)))).x_step(width).y_step(height);
    out.matrix(matrix(to_start * affine(pattern.transform()) * corner));
    used.write(&mut out.resources());
    object
}
