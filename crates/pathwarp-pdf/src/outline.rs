//! Outlines as path operators.

use kurbo::{BezPath, PathEl, Point, Shape as _};
use pdf_writer::Content;
use usvg::tiny_skia_path::{Path, PathSegment};

/// An outline of usvg in f64.
pub(crate) fn from_usvg(path: &Path) -> BezPath {
    let point = |p: usvg::tiny_skia_path::Point| Point::new(f64::from(p.x), f64::from(p.y));
    let mut out = BezPath::new();
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(p) => out.move_to(point(p)),
            PathSegment::LineTo(p) => out.line_to(point(p)),
            PathSegment::QuadTo(p, q) => out.quad_to(point(p), point(q)),
            PathSegment::CubicTo(p, q, r) => out.curve_to(point(p), point(q), point(r)),
            PathSegment::Close => out.close_path(),
        }
    }
    out
}

/// Writes the operators that construct an outline.
pub(crate) fn write(out: &mut Content, path: &BezPath) {
    let mut at = Point::ORIGIN;
    for element in path.elements() {
        let f = |p: Point| (p.x as f32, p.y as f32);
        let cubic = |out: &mut Content, p: Point, q: Point, r: Point| {
            let ((x1, y1), (x2, y2), (x3, y3)) = (f(p), f(q), f(r));
            out.cubic_to(x1, y1, x2, y2, x3, y3);
        };
        match *element {
            PathEl::MoveTo(p) => drop(out.move_to(f(p).0, f(p).1)),
            PathEl::LineTo(p) => drop(out.line_to(f(p).0, f(p).1)),
            // PDF has no quadratics; this cubic is the same curve.
            PathEl::QuadTo(p, q) => cubic(out, at + (p - at) * (2.0 / 3.0), q + (p - q) * (2.0 / 3.0), q),
            PathEl::CurveTo(p, q, r) => cubic(out, p, q, r),
            PathEl::ClosePath => drop(out.close_path()),
        }
        at = element.end_point().unwrap_or(at);
    }
}

/// Returns `true` if the outline has an area to fill.
pub(crate) fn has_area(path: &BezPath) -> bool {
    let r = path.bounding_box();
    r.width() > 0.0 && r.height() > 0.0
}
