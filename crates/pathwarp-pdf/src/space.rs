//! Conversions between the number types of usvg, kurbo and PDF.

use kurbo::{Affine, Rect};

/// A transform in f64.
pub(crate) fn affine(t: usvg::Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}

/// A transform as PDF writes it.
pub(crate) fn matrix(m: Affine) -> [f32; 6] {
    m.as_coeffs().map(|v| v as f32)
}

/// A rectangle in f64.
pub(crate) fn rect(r: usvg::Rect) -> Rect {
    let [x0, y0, x1, y1] = [r.left(), r.top(), r.right(), r.bottom()].map(f64::from);
    Rect::new(x0, y0, x1, y1)
}

/// A rectangle as PDF writes it.
pub(crate) fn pdf_rect(r: Rect) -> pdf_writer::Rect {
    let [x0, y0, x1, y1] = [r.x0, r.y0, r.x1, r.y1].map(|v| v as f32);
    pdf_writer::Rect::new(x0, y0, x1, y1)
}

/// A rectangle that surely holds what is drawn in `r`, whose numbers are rounded and ignore anti-aliasing.
pub(crate) fn roomy(r: Rect) -> Rect {
    /// A share of the size, and a pixel.
    const MARGIN: (f64, f64) = (0.01, 1.0);
    r.inflate(MARGIN.0 * r.width() + MARGIN.1, MARGIN.0 * r.height() + MARGIN.1)
}
