//! Options of a fit, and what can go wrong.

use crate::limits::SMOOTH_JOINT;
use crate::source::NotFinite;
use kurbo::Point;

/// What is wanted of a fit.
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
    /// Joints of a path that turn by more than this, in radians, are corners. `None`, the default: those for which no smooth curve can stand
    /// within the tolerance, such as squares with sides of some ten tolerances, but neither stairs of pixels nor noise nor facets. Joints
    /// of other curves are smooth up to half a degree by default.
    pub corner: Option<f64>,
    /// Where nodes are. As few as the tolerance allows by default.
    pub nodes: Nodes,
    /// What the pieces are. Cubics by default.
    pub degree: Degree,
    /// How many pieces there may be. As many as the tolerance needs by default.
    pub pieces: Pieces,
    /// Return the best path found where the tolerance was not met, and list the places in the report. Off by default: that is
    /// [`Error::NotMet`]. A given number of pieces asks for the best itself.
    pub best: bool,
    /// Evaluations of the source in each smooth part between its [breaks](crate::Source::breaks), at most: [`MAX_EVALUATIONS`] by default.
    /// Work ends earlier where it finds too little: after 2,000,000 evaluations and 10,000 for each piece found, of which usual ones take
    /// some hundreds. A given number of pieces takes several fits.
    pub evaluations: usize,
}

/// Evaluations of each smooth part of a source, at most, unless [`Options::evaluations`] allows another number.
pub const MAX_EVALUATIONS: usize = 100_000_000;

/// What pieces are, besides lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Degree {
    /// Cubics.
    Cubic,
    /// Quadratics, as the `glyf` table of fonts holds them. Where they join smoothly, the joint is midway between the control points, so
    /// that it need not be stored.
    Quadratic,
}

/// Where the nodes between pieces are, besides corners.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Nodes {
    /// Where the source has its structure: at smooth horizontal and vertical extremes with handles along the axis, at ends of straight lines
    /// and arcs. Such a node goes to the result's own extreme, with handles exactly along the axis, if the curve turns by less than 20° up
    /// to there. Pieces between them are as few as the tolerance allows, and divided alike from either end.
    Auto,
    /// Where the fewest pieces need them.
    #[default]
    Fewest,
    /// At every smooth horizontal or vertical extreme of the result, with handles exactly along the axis; between them as for `Auto`.
    Extremes,
    /// Where the source has them: no piece crosses a joint.
    Source,
}

impl Nodes {
    /// Returns `true` if pieces may cross smooth joints.
    #[must_use]
    pub fn merges(self) -> bool {
        self != Self::Source
    }

    /// Returns `true` if some nodes are chosen for their place.
    #[must_use]
    pub fn are_placed(self) -> bool {
        matches!(self, Self::Auto | Self::Extremes)
    }
}

/// A number of pieces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pieces {
    /// As few as the tolerance allows.
    Fewest,
    /// At most this many: if the tolerance needs more, these with nearly the least error that they reach, which the report tells.
    AtMost(usize),
    /// This many, whatever the tolerance, with hardly more than the least error that a tolerance leads to: usually within 1.3 of it, but a
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
    /// Within `tolerance`, measured.
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

    /// Refuses what makes no sense.
    pub(crate) fn checked(&self) -> Result<(), Error> {
        if !(self.tolerance > 0.0 && self.tolerance.is_finite()) {
            return Err(Error::Tolerance(self.tolerance));
        }
        self.corner.filter(|c| c.is_nan() || *c < 0.0).map_or(Ok(()), |c| Err(Error::Corner(c)))
    }

    /// Joints of curves that are no path and turn by less, in radians, are smooth.
    pub(crate) fn joint(&self) -> f64 {
        self.corner.unwrap_or(SMOOTH_JOINT)
    }

    /// Joints of paths that turn by less, in radians, may lie inside of a piece, unless corners begin below that. At larger turns it would
    /// differ from the path in direction, although not in distance.
    pub(crate) fn path_joint(&self) -> f64 {
        const MOST: f64 = 15.0 / 180.0 * std::f64::consts::PI;
        self.corner.map_or(MOST, |corner| corner.min(MOST))
    }
}

/// Why a curve was not fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The curve or path is not finite.
    NotFinite(NotFinite),
    /// The tolerance is zero, negative, infinite or not a number.
    Tolerance(f64),
    /// The corner angle is negative or not a number.
    Corner(f64),
    /// How the edges of an area cross was not found.
    Crossings,
    /// The tolerance was not met, and [`Options::best`] does not ask for what was found: the curve jumps where it does not say so, or
    /// swings faster than its evaluations allow.
    NotMet {
        /// The first [place](crate::Source::place) where it was not.
        at: Point,
        /// The largest distance.
        error: f64,
    },
    /// Corners and gaps ask for more pieces than were allowed.
    TooFewPieces {
        /// The pieces that were allowed.
        allowed: usize,
        /// The fewest that were found.
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
            Self::Corner(v) => write!(f, "the corner angle must be a number from zero on, not {v}"),
            Self::Crossings => f.write_str("how the edges of the area cross was not found; another tolerance may help"),
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
