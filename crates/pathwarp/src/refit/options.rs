//! Options of a refit.

use super::shared::SharedEdges;
use crate::budget::Budget;
use std::sync::Arc;

/// Options of [`warp_path`](super::warp_path).
///
/// ```
/// use pathwarp::refit::Options;
///
/// let options = Options::new(0.01).with_certify(true).with_merge(true);
/// assert_eq!(options.tolerance, 0.01);
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Largest allowed Hausdorff distance between the true image and the output, in root user units.
    pub tolerance: f64,
    /// Prove the error bound where the map allows it, instead of estimating it by dense sampling.
    pub certify: bool,
    /// Merge consecutive pieces across smooth joints where that saves nodes.
    pub merge: bool,
    /// Edges that merging leaves alone, so that neighbouring shapes stay watertight.
    pub shared: Arc<SharedEdges>,
    /// Counts evaluations of the map and segments.
    pub budget: Arc<Budget>,
}

impl Options {
    /// Checked by dense sampling against `tolerance`; no merging.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        Self { tolerance, certify: false, merge: false, shared: Arc::default(), budget: Arc::default() }
    }

    /// Sets [`Options::tolerance`].
    #[must_use]
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Sets [`Options::certify`].
    #[must_use]
    pub fn with_certify(self, certify: bool) -> Self {
        Self { certify, ..self }
    }

    /// Sets [`Options::merge`].
    #[must_use]
    pub fn with_merge(self, merge: bool) -> Self {
        Self { merge, ..self }
    }

    /// Sets [`Options::shared`].
    #[must_use]
    pub fn with_shared(self, shared: Arc<SharedEdges>) -> Self {
        Self { shared, ..self }
    }

    /// Sets [`Options::budget`].
    #[must_use]
    pub fn with_budget(self, budget: Arc<Budget>) -> Self {
        Self { budget, ..self }
    }
}
