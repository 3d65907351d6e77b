//! The extent of a warped picture.

use super::image_warp::in_pixels;
use kurbo::{Affine, Point, Rect};
use pathwarp::map::{Creases, Map};

/// Number of cells along a side of the sampling grid.
const CELLS: usize = 192;

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

/// Measures the image of the box `area` under `placed`, then `map`, then `after`, from samples inside it and many along its edge.
/// `None` if the map is defined nowhere on it.
#[must_use]
pub fn extent(area: Rect, placed: Affine, map: &dyn Map, after: Affine) -> Option<Extent> {
    const ALONG: usize = 2048;
    let mut creases = Creases::default();
    map.creases(&mut creases);
    let at = |u: f64, v: f64| Point::new(area.x0 + u * area.width(), area.y0 + v * area.height());
    let n = CELLS as f64;
    let inside = (0..=CELLS).flat_map(|j| (0..=CELLS).map(move |i| (i as f64 / n, j as f64 / n)));
    let edge = (0..=ALONG).map(|k| k as f64 / ALONG as f64).flat_map(|t| [(t, 0.0), (t, 1.0), (0.0, t), (1.0, t)]);
    let mut out: Option<Extent> = None;
    let mut undefined = None;
    for (u, v) in inside.chain(edge) {
        let p = placed * at(u, v);
        let jet = in_pixels(&map.jet(p), after, placed);
        if !jet.p.is_finite() || !creases.defined_at(p) {
            undefined = undefined.or(Some(p));
            continue;
        }
        let frobenius = jet.dx.hypot2() + jet.dy.hypot2();
        let discriminant = (frobenius * frobenius - 4.0 * jet.det() * jet.det()).max(0.0).sqrt();
        let stretch = (0.5 * (frobenius + discriminant)).sqrt();
        let squeeze = jet.det().abs() / stretch;
        let e = out.get_or_insert(Extent {
            bounds: Rect::from_origin_size(jet.p, (0.0, 0.0)),
            stretch: 0.0,
            squeeze: f64::INFINITY,
            undefined,
        });
        e.bounds = e.bounds.union_pt(jet.p);
        if stretch.is_finite() {
            e.stretch = e.stretch.max(stretch);
            e.squeeze = e.squeeze.min(squeeze);
        }
    }
    out.map(|e| Extent { undefined, ..e })
}
