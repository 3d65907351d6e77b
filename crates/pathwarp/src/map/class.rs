//! Facts about a map as a whole: its class, and its degree as a quotient of polynomials.

use super::Homography;
use kurbo::Affine;

/// The class of a map. Affine and projective maps need no refitting, and neighbours fold into one in a
/// [`Chain`](super::Chain).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Class {
    /// Control points map exactly.
    Affine(Affine),
    /// Lines stay lines.
    Projective(Homography),
    /// Anything else.
    Smooth,
}

/// The degree of a map (x, y) ↦ (X/W, Y/W) with polynomials X, Y, W.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RationalDegree {
    /// The largest total degree (exponents of x and y together) of X, Y and W.
    pub degree: usize,
    /// `true` if W is not the constant 1. [`Map::denominator`](super::Map::denominator) gives its values.
    pub rational: bool,
}

impl RationalDegree {
    /// A polynomial map: W = 1.
    #[must_use]
    pub const fn polynomial(degree: usize) -> Self {
        Self { degree, rational: false }
    }

    /// A map with a denominator.
    #[must_use]
    pub const fn rational(degree: usize) -> Self {
        Self { degree, rational: true }
    }
}
