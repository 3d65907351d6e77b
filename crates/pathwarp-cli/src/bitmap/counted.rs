//! The work on bitmaps: pixels, and evaluations of the inverse map.

use pathwarp::budget::{Budget, Exceeded, Limit};
use pathwarp::kurbo::Point;
use pathwarp::map::{Jet, Map};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Work for a pixel that was decoded, and for one that is sampled and compressed, in pixels painted.
const DECODED: f64 = 4.0;
const WARPED: f64 = 29.0;

/// Counts the pixels of a source of this size.
pub(crate) fn count_decoded(budget: &Budget, size: (u32, u32)) -> Result<(), Exceeded> {
    count_pixels(budget, DECODED, size)
}

/// Counts the pixels of an image of this size.
pub(crate) fn count_warped(budget: &Budget, size: (u32, u32)) -> Result<(), Exceeded> {
    count_pixels(budget, WARPED, size)
}

fn count_pixels(budget: &Budget, work: f64, (width, height): (u32, u32)) -> Result<(), Exceeded> {
    budget.spend(Limit::Painting, (work * f64::from(width) * f64::from(height)) as u64)
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

/// A map that Newton's method inverts. It counts its evaluations, of which a pixel takes a few, or hundreds where it has no place in
/// the source; once there are too many, it is undefined everywhere.
pub(super) struct Tried {
    map: Arc<dyn Map>,
    budget: Arc<Budget>,
    evaluations: AtomicU64,
}

impl Tried {
    pub(super) fn new(map: Arc<dyn Map>, budget: Arc<Budget>) -> Self {
        Self { map, budget, evaluations: AtomicU64::new(0) }
    }

    fn count(&self, evaluations: usize) -> bool {
        /// Evaluations that are counted together.
        const TOGETHER: u64 = 64;
        /// What an evaluation without a fit around it counts as.
        const ALONE: f64 = 0.8;
        let (before, more) = (self.evaluations.fetch_add(evaluations as u64, Ordering::Relaxed), evaluations as u64);
        let rounds = (before + more) / TOGETHER - before / TOGETHER;
        let work = ALONE * (rounds * TOGETHER) as f64 * self.map.work();
        self.budget.spend_cut(Limit::Evaluations, work as u64).is_ok()
    }
}

impl Map for Tried {
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

    /// Nothing besides what is counted here.
    fn work(&self) -> f64 {
        0.0
    }

    fn prefers_batches(&self) -> bool {
        self.map.prefers_batches()
    }

    fn differentiates(&self) -> bool {
        self.map.differentiates()
    }
}
