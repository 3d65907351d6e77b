//! Conversions from kurbo's types to tiny-skia's.

use kurbo::{Affine, BezPath, PathEl, Point};
use tiny_skia::{Path, PathBuilder, Transform};

/// Rounds to the precision of the renderer.
#[expect(clippy::cast_possible_truncation, reason = "pixels need no more")]
pub(super) fn to_f32(x: f64) -> f32 {
    x as f32
}

pub(super) fn transform(affine: Affine) -> Transform {
    let [sx, ky, kx, sy, tx, ty] = affine.as_coeffs().map(to_f32);
    Transform::from_row(sx, ky, kx, sy, tx, ty)
}

/// Converts a path; `None` if there is nothing to draw.
pub(super) fn path(path: &BezPath) -> Option<Path> {
    let mut builder = PathBuilder::new();
    let xy = |p: Point| (to_f32(p.x), to_f32(p.y));
    for element in path.elements() {
        match *element {
            PathEl::MoveTo(p) => {
                let (x, y) = xy(p);
                builder.move_to(x, y);
            }
            PathEl::LineTo(p) => {
                let (x, y) = xy(p);
                builder.line_to(x, y);
            }
            PathEl::QuadTo(p, q) => {
                let ((px, py), (qx, qy)) = (xy(p), xy(q));
                builder.quad_to(px, py, qx, qy);
            }
            PathEl::CurveTo(p, q, r) => {
                let ((px, py), (qx, qy), (rx, ry)) = (xy(p), xy(q), xy(r));
                builder.cubic_to(px, py, qx, qy, rx, ry);
            }
            PathEl::ClosePath => builder.close(),
        }
    }
    builder.finish()
}
