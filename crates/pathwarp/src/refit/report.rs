//! The result of a refit: the path, its error, and how far that error can be trusted.

use crate::outline::Outline;
use kurbo::{BezPath, Point};

/// Basis of the reported error, from the weakest to the strongest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Assurance {
    /// Measured by dense sampling; the error between samples is estimated.
    Checked,
    /// A proven bound.
    Certified,
    /// Nothing was approximated; the error is rounding.
    Exact,
}

/// Statistics of a refit path.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PathReport {
    /// Segments in the source, closing lines included.
    pub segments_in: usize,
    /// Segments in the output, closing lines included.
    pub segments_out: usize,
    /// Largest distance between the true image and the output, in root user units.
    pub max_error: f64,
    /// Basis of `max_error`: the weakest of all segments.
    pub assurance: Assurance,
    /// Places in the source at which the tolerance was not met: the work budget ran out, or rounding is larger.
    pub over_budget: Vec<Point>,
}

impl Default for PathReport {
    fn default() -> Self {
        Self { segments_in: 0, segments_out: 0, max_error: 0.0, assurance: Assurance::Exact, over_budget: Vec::new() }
    }
}

impl PathReport {
    /// Names a place if the tolerance was missed and none is named yet: coordinates so large that their rounding exceeds it.
    pub(super) fn name_a_miss(&mut self, outline: &Outline, tolerance: f64) {
        /// Sums of errors round up.
        const ROUNDING: f64 = 1e-9;
        let missed = self.max_error > tolerance * (1.0 + ROUNDING);
        if missed && self.over_budget.is_empty() {
            self.over_budget.extend(outline.subpaths.first().map(|s| s.start));
        }
    }

    /// Adds the pieces of another part of the path.
    pub(super) fn add(&mut self, part: Self) {
        self.add_error(part.max_error, part.assurance);
        self.over_budget.extend(part.over_budget);
    }

    /// Accounts for a piece with this error.
    pub(super) fn add_error(&mut self, error: f64, assurance: Assurance) {
        self.max_error = self.max_error.max(error);
        self.assurance = self.assurance.min(assurance);
    }
}

/// The image of a path.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RefittedPath {
    /// Lines and cubics.
    pub path: BezPath,
    /// Statistics.
    pub report: PathReport,
}
