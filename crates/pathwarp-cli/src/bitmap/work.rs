//! The work on bitmaps: pixels, and evaluations of the inverse map.

use crate::watch;
use pathwarp::budget::{Budget, Exceeded, Limit, cost};
use pathwarp::kurbo::Point;
use pathwarp::map::{Jet, Map};
use std::sync::Arc;

/// What is done with a pixel, in pixels painted.
#[derive(Clone, Copy)]
pub(crate) enum Pixel {
    /// Of a model, for every face in front of or behind it.
    Sampled = 2,
    Decoded = 4,
    /// Sampled and compressed.
    Warped = 60,
    /// Of a gradient.
    Shaded = 40,
}

/// Counts work on pixels.
pub(crate) fn spend(budget: &Budget, pixel: Pixel, pixels: f64) -> Result<(), Exceeded> {
    budget.spend(cost::PIXEL * f64::from(pixel as u8) * pixels)
}

/// Counts a picture that is read or made, which the limits on time and memory allow for.
pub(crate) fn picture(budget: &Budget, pixel: Pixel, (width, height): (f64, f64)) -> Result<(), Exceeded> {
    budget.take(Limit::Pixels, width * height)?;
    watch::count_pixels(width * height);
    spend(budget, pixel, width * height)
}

/// Counts evaluations of a map.
pub(crate) fn evaluations(budget: &Budget, map: &dyn Map, n: f64) -> Result<(), Exceeded> {
    budget.spend(n * map.work())
}

/// An inverse whose evaluations are counted, and which is undefined everywhere once nothing is left: a bitmap asks about once in a while, or
/// for every pixel.
pub(crate) struct Inverse {
    map: Arc<dyn Map>,
    budget: Arc<Budget>,
}

impl Inverse {
    pub(super) fn new(map: Arc<dyn Map>, budget: Arc<Budget>) -> Self {
        Self { map: map.within(&budget).unwrap_or(map), budget }
    }

    fn count(&self, n: usize) -> bool {
        evaluations(&self.budget, &*self.map, n as f64).is_ok()
    }
}

impl Map for Inverse {
    fn jet(&self, p: Point) -> Jet {
        if self.count(1) { self.map.jet(p) } else { Jet::UNDEFINED }
    }

    fn point(&self, p: Point) -> Point {
        if self.count(1) { self.map.point(p) } else { Jet::UNDEFINED.p }
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        if self.count(ps.len()) { self.map.jets(ps, out) } else { out.fill(Jet::UNDEFINED) }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        if self.count(ps.len()) { self.map.points(ps, out) } else { out.fill(Jet::UNDEFINED.p) }
    }

    fn work(&self) -> f64 {
        self.map.work()
    }

    fn prefers_batches(&self) -> bool {
        self.map.prefers_batches()
    }

    fn differentiates(&self) -> bool {
        self.map.differentiates()
    }
}
