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
    /// The coordinates are quotients of polynomials: enough to prove error bounds without writing out an image. If they have a
    /// denominator, the map implements [`Map::denominator`](super::Map::denominator) too.
    Rational(RationalDegree),
    /// Anything else.
    Smooth,
}

impl Class {
    /// The degree of the map if its coordinates are quotients of polynomials.
    #[must_use]
    pub const fn degree(&self) -> Option<RationalDegree> {
        match self {
            Self::Affine(_) => Some(RationalDegree::polynomial(1)),
            Self::Projective(_) => Some(RationalDegree::rational(1)),
            Self::Rational(degree) => Some(*degree),
            Self::Smooth => None,
        }
    }
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
