//! Fits any curve with few Bézier curves, within a Hausdorff distance that is checked or proven.
//!
//! Let g(t) be the curve, a [`Source`], whose points the modules call images. A fit goes through these stages, each with its modules:
//!
//! 1. **Samples** (`sample`). g is evaluated at eight parameters in one batch, at eight more in between when needed, and with its
//!    derivative at the break points.
//! 2. **Quick outcomes** (`stretch`). A line, if the curve is one to rounding, or the Hermite cubic, with the curve's end derivatives.
//! 3. **Fit** (`fit`). A piece keeps end points and end tangents (G¹). Its two handle lengths minimise the normal residuals: Gauss–Newton
//!    by variable projection, each step bent along the valley of equal area. The error is of sixth order in the piece's length. Where
//!    that does not suffice, the fit iterates to convergence, restarts elsewhere in the valley, and minimises the largest residual.
//! 4. **Acceptance** (`judge`). A fit is judged by the cheapest test that can decide: eight samples; sixteen, with the peaks
//!    predicted between them; samples halfway beside doubtful ones; a dense check; or, if wanted, a proof by polynomial
//!    bounds (`proof`, `sampled`).
//! 5. **Break points** (`breaks`). The sixth root of error ÷ tolerance measures difficulty. Break points go to its quantiles,
//!    with fewer pieces tried first and single break points bisected, until every piece fits.
//! 6. **Merging** (`run`, `distances`, `merge`, `joined`), if wanted: the fewest cubics across smooth joints of several curves, and
//!    across the pieces of a long one.
//! 7. **Quadratics** (`spline`) instead of cubics, and a given number of pieces (`path`), by a search for the tolerance.
//!
//! `limits` holds every threshold of these stages, with the reason for its value.

// Loops over eight lanes run by index through several arrays at once, a form that LLVM vectorises.
#![allow(clippy::needless_range_loop)]
#![cfg_attr(test, allow(clippy::unwrap_used))]
// Only types in `parts` lack it.
#![allow(missing_debug_implementations)]

mod adaptor;
mod banded;
mod breaks;
mod distances;
mod fit;
mod guide;
mod joined;
mod judge;
mod limits;
mod merge;
mod nodes;
mod offset;
mod options;
mod part;
mod path;
mod proof;
#[cfg(feature = "area")]
mod region;
mod report;
mod run;
mod sample;
mod sampled;
mod scale;
mod source;
mod spline;
mod stretch;
#[cfg(feature = "area")]
mod strips;
mod stroke;

pub use adaptor::Kurbo;
pub use offset::Offset;
pub use options::{Degree, Error, MAX_EVALUATIONS, Nodes, Options, Pieces};
pub use path::{PathSource, Segment, fit, fit_points, simplify};
#[cfg(feature = "area")]
pub use region::{difference, intersection, offset, union, union_even_odd};
pub use report::{Assurance, Fitted, Piece, PieceReport, Report};
pub use sample::{Lane, Lanes};
pub use source::{BreakPoint, NotFinite, Quotient, SlowSpots, Source};
pub use stroke::stroke;

/// Parts of the fitter, for callers that assemble one. They may change in any release.
#[doc(hidden)]
pub mod parts {
    pub use crate::distances::{MarkBatch, MarkedCubic};
    pub use crate::fit::{ChordFrame, FOOT_ROUNDING};
    pub use crate::joined::cover_far;
    pub use crate::limits::{ACCEPTED, MERGE_GRID, SMOOTH_JOINT, STRAIGHT};
    pub use crate::merge::{FitOwn, Leg, MergeSettings, OwnPieces, PassedLeg, ReachMemory, Reaches, refined};
    pub use crate::nodes::{NodeSettings, PlacedWork, Side, is_structure, placed};
    pub use crate::path::append;
    pub use crate::run::{RunSegment, SegmentRun, per_segment, sample_lanes};
    pub use crate::sample::{CHECKED, FITTED, UNEVEN, fma, spaced};
    pub use crate::source::{VANISHING_DERIVATIVE, tangent_beside};
    pub use crate::stretch::STRAIGHT_TURN;
    pub use crate::stretch::StretchFitter;
    pub use crate::stroke::{Edge, EdgeCurve, contours, drawn_dashes};
}

/// The README's example, tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
