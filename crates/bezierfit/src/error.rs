//! What can go wrong.

use crate::source::NotFinite;

/// Why a curve was not fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The curve or path is not finite.
    NotFinite(NotFinite),
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
        }
    }
}

impl std::error::Error for Error {}
