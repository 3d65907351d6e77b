//! Options of a refit, and the tolerance that suits a contour.

use super::borders::Borders;
use super::shared::{SharedEdges, Span};
use crate::budget::Budget;
use crate::error::GeometryError;
use crate::outline::Subpath;
use bezierfit::Nodes;
use std::sync::Arc;

/// Options of [`warp_path`](super::warp_path).
///
/// ```
/// use pathwarp::refit::{Nodes, Options};
///
/// let options = Options::new(0.01).with_certify(true).with_nodes(Nodes::Auto);
/// assert_eq!(options.tolerance, 0.01);
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// The largest allowed Hausdorff distance between the true image and the output, in root user units.
    pub tolerance: f64,
    /// `true` to prove the error bound where the map allows it, instead of estimating it by dense sampling.
    pub certify: bool,
    /// The placement of nodes. Joints that turn by up to half a degree count as smooth, since drawings round their coordinates.
    pub nodes: Nodes,
    /// Edges that get the same curves in all outlines that share them, so that neighbouring shapes stay watertight.
    pub shared: Arc<SharedEdges>,
    /// Borders that [`simplified`](super::simplified) gives the same curves in all outlines that share them.
    pub borders: Arc<Borders>,
    /// `true` to hold small contours to the tolerance that [`suited`] finds for them. A contour is a subpath here.
    pub suited: bool,
    /// Tolerances of consecutive segments, over all subpaths. If empty, `tolerance`, or the suited one of each subpath, holds for all.
    pub spans: Arc<[Span]>,
    /// The budget for evaluations of the map and for segments.
    pub budget: Arc<Budget>,
}

impl Options {
    /// Options with this tolerance, checked by dense sampling, and the fewest nodes, which are also the fitter's defaults.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        let (nodes, shared, borders, spans, budget) = Default::default();
        Self { tolerance, certify: false, nodes, shared, borders, suited: false, spans, budget }
    }

    /// Checks the tolerances.
    ///
    /// # Errors
    /// [`GeometryError::Tolerance`] if a tolerance is not positive, or not finite.
    pub fn check(&self) -> Result<(), GeometryError> {
        let mut all = [self.tolerance].into_iter().chain(self.spans.iter().map(|s| s.tolerance));
        let is_invalid = |t: &f64| !(t.is_finite() && *t > 0.0);
        all.find(is_invalid).map_or(Ok(()), |t| Err(GeometryError::Tolerance(t)))
    }

    /// The tolerance of a contour: [`Options::tolerance`], or, with [`Options::suited`], the one that suits its diagonal.
    #[must_use]
    pub fn of_contour(&self, contour: &Subpath) -> f64 {
        if self.suited { suited(self.tolerance, contour.diagonal()) } else { self.tolerance }
    }

    setters! {
        /// Sets [`Options::tolerance`].
        with_tolerance(tolerance: f64) => tolerance: tolerance;
        /// Sets [`Options::certify`].
        with_certify(certify: bool) => certify: certify;
        /// Sets [`Options::nodes`].
        with_nodes(nodes: Nodes) => nodes: nodes;
        /// Sets [`Options::shared`].
        with_shared(shared: Arc<SharedEdges>) => shared: shared;
        /// Sets [`Options::borders`].
        with_borders(borders: Arc<Borders>) => borders: borders;
        /// Sets [`Options::suited`].
        with_suited(suited: bool) => suited: suited;
        /// Sets [`Options::spans`].
        with_spans(spans: impl Into<Arc<[Span]>>) => spans: spans.into();
        /// Sets [`Options::budget`].
        with_budget(budget: Arc<Budget>) => budget: budget;
    }
}

/// Returns the tolerance that suits a contour of this diagonal, in a drawing that is held to `tolerance` as a whole: 2e-3 of the
/// diagonal, so that a dot stays round and a letter legible however large the drawing is, but not more than `tolerance`, and not less
/// than a thousandth of it. With the usual 1e-4 of the drawing's diagonal, contours larger than a twentieth of the drawing are held to
/// `tolerance`, and none to less than 1e-7 of its diagonal.
///
/// Diagonals are measured on the painted area, with strokes. A contour is a subpath, or a letter with its holes.
///
/// ```
/// use pathwarp::refit::suited;
///
/// let of_a_poster = 0.14;
/// assert_eq!(suited(of_a_poster, 1000.0), 0.14);
/// assert_eq!(suited(of_a_poster, 1.5), 0.003);
/// assert!((suited(of_a_poster, 0.0) - 0.14e-3).abs() < 1e-15);
/// ```
#[must_use]
pub fn suited(tolerance: f64, diagonal: f64) -> f64 {
    const OF_DIAGONAL: f64 = 2e-3;
    const LEAST_SHARE: f64 = 1e-3;
    (OF_DIAGONAL * diagonal).max(LEAST_SHARE * tolerance).min(tolerance)
}
