//! Rectangles of pixels of the result.

use super::trace::{ChebyshevBasis, SAMPLES, Trace};
use kurbo::{Affine, Point, Rect};
use pathwarp::map::Map;

/// Side of a tile in pixels; its part of the source fits into the cache.
pub(super) const TILE: usize = 32;
/// Side down to which tiles are divided if the inverse is not close to a cubic. Below that every pixel asks the inverse.
pub(super) const SMALLEST: usize = 8;

/// A rectangle of pixels of the result.
#[derive(Clone, Copy)]
pub(super) struct PixelArea {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl PixelArea {
    /// The four quarters without empty ones.
    pub(super) fn quarters(self) -> impl Iterator<Item = Self> {
        let (w, h) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let quarter = move |k: usize| {
            let (right, low) = (k % 2, k / 2);
            Self {
                left: self.left + right * w,
                top: self.top + low * h,
                width: if right == 0 { w } else { self.width - w },
                height: if low == 0 { h } else { self.height - h },
            }
        };
        (0..4).map(quarter).filter(|a| a.width > 0 && a.height > 0)
    }

    /// Parts of the area that are no larger than a tile.
    pub(super) fn tiles(self) -> impl Iterator<Item = Self> {
        let (right, bottom) = (self.left + self.width, self.top + self.height);
        let corners = (self.top..bottom)
            .step_by(TILE)
            .flat_map(move |top| (self.left..right).step_by(TILE).map(move |left| (left, top)));
        corners.map(move |(left, top)| {
            let (width, height) = (TILE.min(right - left), TILE.min(bottom - top));
            Self { left, top, width, height }
        })
    }

    /// The box in the plane that the pixels cover.
    pub(super) fn covered(self, shown: Affine) -> Rect {
        let (left, top) = (self.left as f64, self.top as f64);
        shown.transform_rect_bbox(Rect::new(left, top, left + self.width as f64, top + self.height as f64))
    }

    /// Approximates the source places of the pixels by a polynomial; `None` if that is not accurate. `shown` maps pixels to the
    /// plane, `inverse` maps the plane back, and `last` maps to the coordinates of the result.
    pub(super) fn trace(self, basis: &ChebyshevBasis, shown: Affine, inverse: &dyn Map, last: Affine) -> Option<Trace> {
        let mut values = [Point::ORIGIN; SAMPLES];
        inverse.points(&self.samples(basis, shown), &mut values);
        for value in &mut values {
            *value = last * *value;
        }
        basis.interpolate(&values, self.span())
    }

    /// The distance between the centres of the first and the last column and row, or 1.
    fn span(self) -> (f64, f64) {
        // Give a single column a width too, so that there is a derivative.
        ((self.width - 1).max(1) as f64, (self.height - 1).max(1) as f64)
    }

    /// The places where a trace samples the inverse.
    fn samples(self, basis: &ChebyshevBasis, shown: Affine) -> [Point; SAMPLES] {
        let (size, left, top) = (self.span(), self.left as f64 + 0.5, self.top as f64 + 0.5);
        let mut places = [Point::ORIGIN; SAMPLES];
        for (place, (u, v)) in places.iter_mut().zip(basis.places()) {
            *place = shown * Point::new(left + u * size.0, top + v * size.1);
        }
        places
    }

    /// The centres of its pixels in the plane, row by row.
    pub(super) fn pixels(self, shown: Affine) -> impl Iterator<Item = Point> {
        let centre = move |k: usize| {
            let (i, j) = (self.left + k % self.width, self.top + k / self.width);
            shown * Point::new(i as f64 + 0.5, j as f64 + 0.5)
        };
        (0..self.width * self.height).map(centre)
    }
}

/// Announces to `inverse`, a memory, what the traces of `areas` and of their parts are going to ask, one size after the other; and,
/// with `announce_pixels`, the pixels of the smallest ones that cannot be traced.
pub(super) fn announce(
    mut areas: Vec<PixelArea>,
    basis: &ChebyshevBasis,
    (shown, last): (Affine, Affine),
    inverse: &dyn Map,
    announce_pixels: impl Fn(&[Point]),
) {
    while !areas.is_empty() {
        let samples: Vec<Point> = areas.iter().flat_map(|a| a.samples(basis, shown)).collect();
        inverse.prepare(&samples, &[]);
        areas.retain(|a| a.trace(basis, shown, inverse, last).is_none());
        let (divided, smallest): (Vec<_>, Vec<_>) = areas.into_iter().partition(|a| a.width.max(a.height) > SMALLEST);
        announce_pixels(&smallest.iter().flat_map(|a| a.pixels(shown)).collect::<Vec<_>>());
        areas = divided.into_iter().flat_map(PixelArea::quarters).collect();
    }
}
