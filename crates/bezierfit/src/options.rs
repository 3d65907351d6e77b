//! Options and errors of a fit.

use crate::limits::SMOOTH_JOINT;
use crate::source::NotFinite;
use kurbo::Point;

/// Requirements for a fit.
///
/// ```
/// use bezierfit::{Degree, Options};
///
/// let options = Options::new(0.01).with_degree(Degree::Quadratic).with_corner(15.0_f64.to_radians());
/// assert_eq!(options.tolerance, 0.01);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Largest allowed Hausdorff distance between the source and the output, both ways.
    pub tolerance: f64,
    /// Prove the error where the source is a quotient of polynomials, instead of measuring it by dense sampling. Cubics only.
    pub certify: bool,
    /// Joints of a path that turn by more than this, in radians, are corners. `None`, the default: a joint is a corner if no smooth curve
    /// passes within the tolerance, as at those of a square with sides of ten tolerances, but not of pixel stairs, noise or facets.
    /// Joints of other curves are smooth up to half a degree by default.
    pub corner: Option<f64>,
    /// Choice of the nodes. By default, as few as the tolerance allows.
    pub nodes: Nodes,
    /// Degree of the pieces. Cubics by default.
    pub degree: Degree,
    /// Number of pieces. By default, as few as the tolerance allows.
    pub pieces: Pieces,
    /// Return the best path found if the tolerance was not met, and list the points in the report. Off by default, when this is
    /// [`Error::NotMet`]. A given number of pieces implies it.
    pub best: bool,
    /// Most evaluations of the source in each smooth part between its [breaks](crate::Source::breaks): [`MAX_EVALUATIONS`] by default.
    /// Work ends earlier where it finds too little: after 2,000,000 evaluations, plus 10,000 for each piece found. Most pieces take some
    /// hundreds. A given number of pieces takes several fits.
    pub evaluations: usize,
}

/// Most evaluations of each smooth part of a source, unless [`Options::evaluations`] is set.
pub const MAX_EVALUATIONS: usize = 100_000_000;

/// Degree of pieces that are not lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Degree {
    /// Cubics.
    Cubic,
    /// Quadratics, as stored in the `glyf` table of fonts. Where they join smoothly, the joint is midway between the control points, so
    /// that it need not be stored.
    Quadratic,
}

/// Choice of the nodes between pieces, besides corners.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Nodes {
    /// Nodes of the source's structure: smooth horizontal and vertical extremes with handles along the axis, and ends of straight lines
    /// and arcs. Such a node moves to an extreme of the result, with handles exactly along the axis, if the curve turns by less than 20° up
    /// to there. Between them are as few pieces as the tolerance allows, the same ones if the path runs the other way.
    Auto,
    /// Nodes wherever they allow the fewest pieces.
    #[default]
    Fewest,
    /// Nodes at every smooth horizontal or vertical extreme of the result, with handles along the axis. Pieces between them as for `Auto`.
    Extremes,
    /// Nodes of the source: no piece crosses a joint.
    Source,
}

impl Nodes {
    /// Returns `true` if pieces may cross smooth joints.
    #[must_use]
    pub fn merges(self) -> bool {
        self != Self::Source
    }

    /// Returns `true` if some nodes are chosen for their position.
    #[must_use]
    pub fn are_placed(self) -> bool {
        matches!(self, Self::Auto | Self::Extremes)
    }
}

/// Number of pieces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pieces {
    /// As few as the tolerance allows.
    Fewest,
    /// At most this many. If the tolerance needs more, they have nearly the least possible error, which is in the report.
    AtMost(usize),
    /// Exactly this many, whatever the tolerance. The error is usually at most 1.3 times the least one found with any tolerance, but a
    /// multiple where only a narrow range of tolerances finds the pieces that suit the symmetry of a curve.
    Exactly(usize),
}

macro_rules! setters {
    ($($name:ident($field:ident: $type:ty) => $value:expr;)*) => {$(
        #[doc = concat!("Sets [`Options::", stringify!($field), "`].")]
        #[must_use]
        pub fn $name(self, $field: $type) -> Self {
            Self { $field: $value, ..self }
        }
    )*};
}

impl Options {
    /// Options for a fit within `tolerance`, which is measured.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        let (degree, pieces) = (Degree::Cubic, Pieces::Fewest);
        let (best, evaluations) = (false, MAX_EVALUATIONS);
        Self { tolerance, certify: false, corner: None, nodes: Nodes::default(), degree, pieces, best, evaluations }
    }

    setters! {
        with_certify(certify: bool) => certify;
        with_corner(corner: f64) => Some(corner);
        with_nodes(nodes: Nodes) => nodes;
        with_degree(degree: Degree) => degree;
        with_pieces(pieces: Pieces) => pieces;
        with_best(best: bool) => best;
        with_evaluations(evaluations: usize) => evaluations;
    }

    /// Returns an error if a value is out of range.
    pub(crate) fn check(&self) -> Result<(), Error> {
        if !(self.tolerance > 0.0 && self.tolerance.is_finite()) {
            return Err(Error::Tolerance(self.tolerance));
        }
        self.corner.filter(|c| c.is_nan() || *c < 0.0).map_or(Ok(()), |c| Err(Error::Corner(c)))
    }

    /// Largest turn of a smooth joint of curves other than paths, in radians.
    pub(crate) fn max_smooth_turn(&self) -> f64 {
        self.corner.unwrap_or(SMOOTH_JOINT)
    }

    /// Largest turn of a joint of a path that may lie inside a piece, in radians: at most the corner angle. At larger turns the piece would
    /// differ from the path in direction, although not in distance.
    pub(crate) fn max_inner_turn(&self) -> f64 {
        const MOST: f64 = 15.0 / 180.0 * std::f64::consts::PI;
        self.corner.map_or(MOST, |corner| corner.min(MOST))
    }
}

/// Reason why a curve was not fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The curve or path is not finite.
    NotFinite(NotFinite),
    /// The tolerance is zero, negative, infinite or not a number.
    Tolerance(f64),
    /// The corner angle is negative or not a number.
    Corner(f64),
    /// The crossings of the edges of an area were not found.
    Crossings,
    /// The tolerance was not met, and [`Options::best`] is not set: the curve jumps at a parameter that is not among its breaks, or swings
    /// faster than its evaluations allow.
    NotMet {
        /// The first [point](crate::Source::place) where it was not.
        at: Point,
        /// The largest distance.
        error: f64,
    },
    /// Corners and gaps need more pieces than were allowed.
    TooFewPieces {
        /// The number of pieces that were allowed.
        allowed: usize,
        /// The least number that was found.
        least: usize,
    },
}

impl From<NotFinite> for Error {
    fn from(e: NotFinite) -> Self {
        Self::NotFinite(e)
    }
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotFinite(e) => e.fmt(f),
            Self::Tolerance(v) => write!(f, "the tolerance must be a number above zero, not {v}"),
            Self::Corner(v) => write!(f, "the corner angle must be a number of at least zero, not {v}"),
            Self::Crossings => {
                f.write_str("the crossings of the area's edges could not be determined; try another tolerance")
            }
            Self::NotMet { at, error } => write!(
                f,
                "the tolerance was not met, first near {},{}, where the curve may jump or swing too fast; what was found is {error} off",
                at.x, at.y
            ),
            Self::TooFewPieces { allowed, least } => {
                write!(f, "{allowed} pieces are too few: corners and gaps need {least}")
            }
        }
    }
}

impl std::error::Error for Error {}
