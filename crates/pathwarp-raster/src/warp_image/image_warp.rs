//! The description of a warp.

use kurbo::{Affine, Rect, Vec2};
use pathwarp::map::{Jet, Map};
use tiny_skia::Pixmap;

/// A bitmap, a map, and the part of the plane that the result shows.
#[derive(Debug, Clone, Copy)]
pub struct ImageWarp<'a> {
    /// The bitmap.
    pub source: &'a Pixmap,
    /// Placement of the bitmap: maps its pixels (the box 0, 0, width, height) to the plane.
    pub placed: Affine,
    /// The map of the plane.
    pub map: &'a dyn Map,
    /// The inverse of the map; values that are not finite mark points outside its image.
    pub inverse: &'a dyn Map,
    /// The view of the result: maps its pixels (the box 0, 0, width, height) to the plane.
    pub shown: Affine,
    /// Width and height of the result in pixels.
    pub size: (u32, u32),
}

/// Returns the map from the pixels of a result of `size` pixels to the box `target` that it shows.
#[must_use]
pub fn shown(target: Rect, size: (u32, u32)) -> Affine {
    Affine::translate(target.origin().to_vec2())
        * Affine::scale_non_uniform(target.width() / f64::from(size.0), target.height() / f64::from(size.1))
}

/// Converts a jet of a map between planes to one between the pixels of two pictures.
#[inline]
pub(super) fn in_pixels(jet: &Jet, to_source: Affine, shown: Affine) -> Jet {
    let [a, b, c, d, ..] = to_source.as_coeffs();
    let along = |v: Vec2| Vec2::new(a * v.x + c * v.y, b * v.x + d * v.y);
    let [p, q, r, s, ..] = shown.as_coeffs();
    Jet { p: to_source * jet.p, dx: along(jet.push(Vec2::new(p, q))), dy: along(jet.push(Vec2::new(r, s))) }
}
