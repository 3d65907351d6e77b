//! The work of searching: inverses spend it directly, since how long a search goes on is known only afterwards.

use crate::budget::Budget;
use std::sync::Arc;

/// Work of a jet of a map of work 1, with the step of Newton's method around it.
const JET: f64 = 0.4;
/// Work of looking at a starting point.
const START: f64 = 0.01;
/// Jets that find a source where there is one, which the work of an inverse stands for.
const FORESEEN: usize = 12;

/// What a search has taken so far.
#[derive(Debug, Clone, Copy, Default)]
pub struct Search {
    /// Jets of the map that is inverted.
    pub jets: usize,
    /// Starting points that were looked at once.
    pub starts: usize,
}

impl Search {
    /// Adds another search for the same point.
    pub fn add(&mut self, other: Self) {
        self.jets += other.jets;
        self.starts += other.starts;
    }

    /// Spends what exceeds the work of `points` points with a source, which callers count. `work` is that of a jet.
    pub fn spend(self, budget: Option<&Arc<Budget>>, points: usize, work: f64) {
        let beyond = JET * work * self.jets.saturating_sub(FORESEEN * points) as f64 + START * self.starts as f64;
        if let Some(budget) = budget.filter(|_| beyond >= 1.0) {
            // The next search finds nothing left.
            let _ = budget.spend(beyond);
        }
    }
}

/// Returns `true` once nothing is left of a budget: inverses within it are then undefined everywhere.
#[must_use]
pub fn is_over(budget: Option<&Arc<Budget>>) -> bool {
    budget.is_some_and(|b| b.left() <= 0.0)
}
