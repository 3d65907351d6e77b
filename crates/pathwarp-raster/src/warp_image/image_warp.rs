//! Describes a warp of a bitmap, and measures its extent.

use super::continued::lattice;
use kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::map::{Creases, Jet, Map};
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
    /// The inverse of the map. Values that are not finite mark points outside the map's image.
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

/// The jet of the composition of `before`, a map and `after`, in this order, given the map's jet. So a jet between planes becomes one
/// between the pixels of two pictures.
#[inline]
pub(crate) fn composed(jet: &Jet, after: Affine, before: Affine) -> Jet {
    let [a, b, c, d, ..] = after.as_coeffs();
    let push = |v: Vec2| Vec2::new(a * v.x + c * v.y, b * v.x + d * v.y);
    let [p, q, r, s, ..] = before.as_coeffs();
    Jet { p: after * jet.p, dx: push(jet.push(Vec2::new(p, q))), dy: push(jet.push(Vec2::new(r, s))) }
}

/// The singular values of a jet, smaller one first: the lengths of the images of unit vectors in the directions of extreme stretch.
pub(crate) fn lengths(jet: &Jet) -> [f64; 2] {
    let frobenius = jet.dx.hypot2() + jet.dy.hypot2();
    let discriminant = (frobenius * frobenius - 4.0 * jet.det() * jet.det()).max(0.0).sqrt();
    let stretch = (0.5 * (frobenius + discriminant)).sqrt();
    [jet.det().abs() / stretch, stretch]
}

/// The extent of a warped picture.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Extent {
    /// Bounding box of the image.
    pub bounds: Rect,
    /// Largest stretch: length of the image of one pixel of the picture.
    pub stretch: f64,
    /// Smallest stretch.
    pub squeeze: f64,
    /// A point of the picture where the map is not defined.
    pub undefined: Option<Point>,
}

/// Measures the image of the box `area` under `placed`, then `map`, then `after`, from samples inside and many along the edge.
/// Returns `None` if the map is defined at none of them.
#[must_use]
pub fn extent(area: Rect, placed: Affine, map: &dyn Map, after: Affine) -> Option<Extent> {
    /// Cells along a side of the grid of samples inside, and intervals between those along a side of the edge.
    const CELLS: usize = 192;
    const INTERVALS: usize = 2048;
    let mut creases = Creases::default();
    map.creases(&mut creases);
    let shares = (0..=INTERVALS).map(|k| k as f64 / INTERVALS as f64);
    let edge = shares.flat_map(|t| [(t, 0.0), (t, 1.0), (0.0, t), (1.0, t)]);
    let edge = edge.map(|(u, v)| Point::new(area.x0 + u * area.width(), area.y0 + v * area.height()));
    let mut out: Option<Extent> = None;
    let mut undefined = None;
    for p in lattice(area, CELLS).chain(edge) {
        let p = placed * p;
        let jet = composed(&map.jet(p), after, placed);
        if !jet.p.is_finite() || !creases.defined_at(p) {
            undefined = undefined.or(Some(p));
            continue;
        }
        let [squeeze, stretch] = lengths(&jet);
        let bounds = Rect::from_points(jet.p, jet.p);
        let e = out.get_or_insert(Extent { bounds, stretch: 0.0, squeeze: f64::INFINITY, undefined });
        e.bounds = e.bounds.union_pt(jet.p);
        if stretch.is_finite() {
            e.stretch = e.stretch.max(stretch);
            e.squeeze = e.squeeze.min(squeeze);
        }
    }
    out.map(|e| Extent { undefined, ..e })
}
