//! Shapes, and the surface that they are mapped to.

use pathwarp::Outline;
use pathwarp::kurbo::Point;

/// A point in space: x, y, z.
pub type Point3 = [f64; 3];

/// Maps points of the drawing to a surface in space; `None` for points without an image.
pub type SurfaceFn<'a> = dyn Fn(Point) -> Option<Point3> + 'a;

/// A named shape of the artwork.
#[derive(Debug, Clone, Copy)]
pub struct NamedShape<'a> {
    /// Name of the object in the file.
    pub name: &'a str,
    /// Outline in the plane of the drawing.
    pub outline: &'a Outline,
    /// Fill rule: even-odd if `true`, else nonzero.
    pub even_odd: bool,
}
