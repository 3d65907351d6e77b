//! Searches are counted after they are done: how long one goes on is known only then. Shared by the inverses of the plane and of space.

use crate::budget::{Budget, Exceeded, Limit};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Work of a jet of a map of work 1, with the step of Newton's method around it, in evaluations of the budget: 30 ns, of the 80 that an
/// evaluation stands for.
const JET: f64 = 0.4;
/// Work of looking at a starting point, in evaluations of the budget.
const START: f64 = 0.01;
/// Jets that find a source where there is one, which the work of an inverse stands for.
const FORESEEN: usize = 12;

/// The work of a search.
#[derive(Debug, Clone, Copy, Default)]
pub struct Effort {
    /// Jets of the map that is inverted.
    pub jets: usize,
    /// Starting points that were looked at once.
    pub starts: usize,
}

impl Effort {
    /// Adds another search for the same point.
    pub fn add(&mut self, other: Self) {
        self.jets += other.jets;
        self.starts += other.starts;
    }

    /// Returns the effort beyond that of `points` points with a source, in evaluations of the budget. `work` is that of a jet.
    fn beyond(self, points: usize, work: f64) -> u64 {
        (JET * work * self.jets.saturating_sub(FORESEEN * points) as f64 + START * self.starts as f64) as u64
    }
}

/// The sum of what exceeded the work foreseen, in whole evaluations, so that it does not depend on the order of searches. Clones share it.
#[derive(Debug, Clone, Default)]
pub struct Overrun(Arc<AtomicU64>);

impl Overrun {
    /// Adds what a search took beyond what is foreseen for `points` points. `work` is that of a jet.
    pub fn add(&self, effort: Effort, points: usize, work: f64) {
        let more = effort.beyond(points, work);
        if more > 0 {
            self.0.fetch_add(more, Ordering::Relaxed);
        }
    }

    /// Takes the sum and begins anew.
    #[must_use]
    pub fn take(&self) -> u64 {
        // Most searches leave nothing.
        if self.0.load(Ordering::Relaxed) == 0 { 0 } else { self.0.swap(0, Ordering::Relaxed) }
    }
}

/// Counts the searches of maps in a budget.
#[derive(Debug)]
pub struct Meter {
    budget: Arc<Budget>,
    /// The limit was exceeded.
    over: AtomicBool,
    /// Nothing is counted any more.
    released: AtomicBool,
}

impl Meter {
    /// Creates a meter for all inverses of a recipe.
    #[must_use]
    pub fn new(budget: Arc<Budget>) -> Arc<Self> {
        Arc::new(Self { budget, over: AtomicBool::new(false), released: AtomicBool::new(false) })
    }

    /// The budget.
    #[must_use]
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Returns `false` if there is no limit, so that nothing need be counted.
    #[must_use]
    pub fn counts(&self) -> bool {
        self.budget.limits().of(Limit::Evaluations).is_finite()
    }

    /// Ends counting: from now on the maps search as long as it takes.
    pub fn release(&self) {
        self.released.store(true, Ordering::Relaxed);
    }

    /// Counts what a map has searched.
    pub fn count(&self, searched: Option<u64>) {
        let searched = searched.unwrap_or(0);
        if searched > 0
            && !self.released.load(Ordering::Relaxed)
            && self.budget.spend(Limit::Evaluations, searched).is_err()
        {
            self.over.store(true, Ordering::Relaxed);
        }
    }

    /// Returns `true` if searches have exceeded the limit. Their maps are then undefined everywhere.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.over.load(Ordering::Relaxed)
    }

    /// Returns the limit that searches have exceeded. How far beyond it they went depends on threads, and is not told.
    #[must_use]
    pub fn exceeded(&self) -> Option<Exceeded> {
        let most = self.budget.limits().of(Limit::Evaluations);
        self.is_over().then_some(Exceeded { limit: Limit::Evaluations, most, needed: most, cut: true })
    }
}
