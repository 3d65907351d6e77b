//! Draws paths: fill and stroke.

use crate::file::File;
use crate::outline::{from_usvg, has_area};
use crate::paint::{Use, with_paint};
use crate::stream::Stream;
use kurbo::{BezPath, PathEl};
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use usvg::{Fill, FillRule, LineCap, LineJoin, Paint, PaintOrder, Path, Stroke};

/// Draws a path.
pub(crate) fn draw(file: &mut File<'_>, stream: &mut Stream, path: &Path) {
    if !path.is_visible() {
        return;
    }
    let outline = (file.options.exact)(path).unwrap_or_else(|| from_usvg(path.data()));
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
    let painted = Use { paint: Fill::paint(fill), opacity: fill.opacity().get(), strokes: false, path };
    with_paint(file, stream, &painted, |stream| {
        stream.outline(outline);
        match fill.rule() {
            FillRule::NonZero => stream.content.fill_nonzero(),
            FillRule::EvenOdd => stream.content.fill_even_odd(),
        };
    });
}

fn stroke(file: &mut File<'_>, stream: &mut Stream, path: &Path, outline: &BezPath) {
    let Some(stroke) = path.stroke() else { return };
    let paint: &Paint = Stroke::paint(stroke);
    let painted = Use { paint, opacity: stroke.opacity().get(), strokes: true, path };
    with_paint(file, stream, &painted, |stream| {
        pen(stream, stroke);
        match stroke.linecap() {
            LineCap::Square => stream.outline(&with_dots(outline, stroke.width().get())),
            _ => stream.outline(outline),
        }
        stream.content.stroke();
    });
}

/// Sets width, joins, caps and dashes.
fn pen(stream: &mut Stream, stroke: &Stroke) {
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
    content.set_dash_pattern(dashes.iter().copied(), offset(dashes, stroke.dashoffset()));
}

/// The outline with lines of no length made minute ones: SVG draws their square caps, PDF does not.
fn with_dots(outline: &BezPath, width: f32) -> BezPath {
    /// Length as a share of the width.
    const MINUTE: f64 = 1e-4;
    let elements = outline.elements();
    let starts = |i: usize| elements.get(i).is_none_or(|e| matches!(e, PathEl::MoveTo(_)));
    let mut out = BezPath::new();
    for (i, element) in elements.iter().enumerate() {
        match (*element, elements.get(i.wrapping_sub(1))) {
            (PathEl::LineTo(p), Some(PathEl::MoveTo(q))) if p == *q && starts(i + 1) => {
                out.line_to((p.x + MINUTE * f64::from(width), p.y));
            }
            (other, _) => out.push(other),
        }
    }
    out
}

/// The offset into the dashes, which PDF wants positive.
fn offset(dashes: &[f32], offset: f32) -> f32 {
    let period: f32 = dashes.iter().sum();
    if period > 0.0 { offset.rem_euclid(period) } else { 0.0 }
}
