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
pub(crate) struct Counted<R> {
    map: Arc<dyn Map>,
    work: f64,
    budget: Arc<Budget>,
    rule: R,
}

/// Counts evaluations of one kind of map.
pub(crate) trait Rule: Send + Sync {
    /// The part of the work of an evaluation that others should count.
    const LEFT: f64;

    /// Counts evaluations of a map, of which each takes `work`.
    fn count(&self, map: &dyn Map, budget: &Budget, evaluations: usize, work: f64) -> Result<(), Exceeded>;
}

/// For the inverse of a map, which a bitmap asks about once in a while, or for every pixel: the number is known only afterwards.
pub(crate) struct Inverse;

impl Rule for Inverse {
    const LEFT: f64 = 1.0;

    fn count(&self, map: &dyn Map, budget: &Budget, evaluations: usize, work: f64) -> Result<(), Exceeded> {
        budget.spend(Limit::Evaluations, (evaluations as f64 * work) as u64 + searched(map))
    }
}

/// What the last evaluations searched in vain.
fn searched(map: &dyn Map) -> u64 {
    map.take_overrun().unwrap_or(0)
}

/// For a map that Newton's method inverts, which a pixel asks a few times, or hundreds where it has no place in the source.
#[derive(Default)]
pub(super) struct Tried {
    evaluations: AtomicU64,
}

impl Rule for Tried {
    const LEFT: f64 = 0.0;

    fn count(&self, _: &dyn Map, budget: &Budget, evaluations: usize, work: f64) -> Result<(), Exceeded> {
        /// Evaluations that are counted together.
        const TOGETHER: u64 = 64;
        /// What an evaluation without a fit around it counts as.
        const ALONE: f64 = 0.8;
        let (before, more) = (self.evaluations.fetch_add(evaluations as u64, Ordering::Relaxed), evaluations as u64);
        let rounds = (before + more) / TOGETHER - before / TOGETHER;
        budget.spend_cut(Limit::Evaluations, (ALONE * (rounds * TOGETHER) as f64 * work) as u64)
    }
}

impl<R: Rule> Counted<R> {
    pub(super) fn new(map: Arc<dyn Map>, budget: Arc<Budget>, rule: R) -> Self {
        Self { work: map.work(), map, budget, rule }
    }

    fn count(&self, evaluations: usize) -> bool {
        self.rule.count(&*self.map, &self.budget, evaluations, self.work).is_ok()
    }
}

impl Counted<Inverse> {
    /// Fails if there were too many evaluations.
    pub(crate) fn check(&self) -> Result<(), Exceeded> {
        self.budget.spend_cut(Limit::Evaluations, searched(&*self.map))
    }
}

impl<R: Rule> Map for Counted<R> {
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
        R::LEFT * self.work
    }

    fn prefers_batches(&self) -> bool {
        self.map.prefers_batches()
    }

    fn differentiates(&self) -> bool {
        self.map.differentiates()
    }
}
