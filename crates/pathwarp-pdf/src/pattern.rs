//! Patterns as PDF's tiling patterns.

use crate::file::{File, deflated};
use crate::space::{affine, matrix, pdf_rect};
use crate::stream::Stream;
use kurbo::{Affine, Rect};
use pdf_writer::types::{PaintType, TilingType};
use pdf_writer::{Filter, Ref};

/// Adds a pattern. `to_start` leads from the user space of the painted path to the start of the content stream.
pub(crate) fn add(file: &mut File<'_>, pattern: &usvg::Pattern, to_start: Affine) -> Ref {
    let mut stream = Stream::new();
    (file.draw)(file, &mut stream, pattern.root());
    let (bytes, used) = stream.finish();
    let bytes = deflated(&bytes);
    let tile = pattern.rect();
    let (width, height) = (tile.width(), tile.height());
    // The content's origin is the tile's corner.
    let corner = Affine::translate((f64::from(tile.x()), f64::from(tile.y())));
    let at = file.new_ref();
    let mut out = file.pdf.tiling_pattern(at, &bytes);
    out.filter(Filter::FlateDecode);
    out.paint_type(PaintType::Colored).tiling_type(TilingType::ConstantSpacing);
    out.bbox(pdf_rect(Rect::new(0.0, 0.0, f64::from(width), f64::from(height)))).x_step(width).y_step(height);
    out.matrix(matrix(to_start * affine(pattern.transform()) * corner));
    used.write(&mut out.resources());
    at
}
