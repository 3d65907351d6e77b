//! The work on bitmaps: pixels, and evaluations of the inverse map.

use pathwarp::budget::{Budget, Exceeded, Limit};
use pathwarp::kurbo::Point;
use pathwarp::map::{Jet, Map};
use pathwarp_raster::Pixmap;
use std::sync::Arc;

/// Work for a pixel that was decoded, and for one that is sampled and compressed, in pixels painted.
const DECODED: f64 = 4.0;
const WARPED: f64 = 29.0;

/// Counts the pixels of a source and of its image of `width` × `height`.
pub(crate) fn count_pixels(budget: &Budget, source: &Pixmap, (width, height): (u32, u32)) -> Result<(), Exceeded> {
    let area = |width: u32, height: u32| f64::from(width) * f64::from(height);
    let work = DECODED * area(source.width(), source.height()) + WARPED * area(width, height);
    budget.spend(Limit::Painting, work as u64)
}

/// A map that counts its evaluations and, once there are too many, is undefined everywhere.
///
/// For the inverse of a map, which a bitmap asks about once in a while, or for every pixel: the number is known only afterwards.
pub(crate) struct Counted {
    map: Arc<dyn Map>,
    work: f64,
    budget: Arc<Budget>,
}

impl Counted {
    pub(crate) fn new(map: Arc<dyn Map>, budget: Arc<Budget>) -> Self {
        Self { work: map.work(), map, budget }
    }

    /// Fails if there were too many evaluations.
    pub(crate) fn check(&self) -> Result<(), Exceeded> {
        self.budget.spend_cut(Limit::Evaluations, self.searched())
    }

    fn count(&self, evaluations: usize) -> bool {
        let work = (evaluations as f64 * self.work) as u64 + self.searched();
        self.budget.spend(Limit::Evaluations, work).is_ok()
    }

    /// What the last evaluations searched in vain.
    fn searched(&self) -> u64 {
        self.map.take_overrun().unwrap_or(0)
    }
}

impl Map for Counted {
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
        self.work
    }
}
