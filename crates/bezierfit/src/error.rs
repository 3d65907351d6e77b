//! What can go wrong.

use crate::source::NotFinite;

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
            Self::TooFewPieces { allowed, least } => {
                write!(f, "{allowed} pieces are too few: corners and gaps need {least}")
            }
        }
    }
}

impl std::error::Error for Error {}
