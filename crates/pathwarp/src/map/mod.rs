//! Maps of the plane, numbers only: what a deformation is once its parameters are settled.
//!
//! [`Map`] is the trait; [`Formula`] the short way to write one (a formula over any [`Real`], derivatives come from dual
//! numbers); [`Chain`] composes maps; [`Homography`] and [`AffineMap`] are the two classes that fold into one another.

mod affine;
pub(crate) mod arclength;
#[doc(hidden)]
pub mod batch;
pub(crate) mod bernstein;
mod birational;
pub(crate) mod bspline;
mod chain;
mod coons;
mod crease;
mod dual;
mod formula;
mod homography;
mod inverse;
mod jet;
mod lattice;
mod local;
mod monoid;
pub mod net;
pub(crate) mod patch;
pub(crate) mod quotient;
mod rational;
pub mod ruled;
mod side;
mod tiled;
mod traits;

pub use affine::AffineMap;
pub use birational::{Birational, BirationalInverse, Rows};
pub use chain::Chain;
pub use coons::{Coons, Sides};
pub use crease::{Crease, CreaseKind, Creases, Level};
pub use dual::{Dual, Real};
pub use formula::Formula;
pub use homography::Homography;
pub use inverse::NewtonInverse;
pub use jet::Jet;
pub use lattice::{Lattice, LatticeMap};
pub use local::Local;
pub use monoid::{Monoid, Ray};
pub use net::BicubicNet;
pub use patch::Patch;
pub use quotient::Quotient;
pub use rational::RationalBezier;
pub use ruled::{Along, Guide};
pub use side::{Pace, Side};
pub use tiled::{Row, Tiled};
pub use traits::Map;

use kurbo::Affine;

/// What kind of map it is: the kinds that keep lines need no refitting, and fold in a [`Chain`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Class {
    /// Control points map exactly.
    Affine(Affine),
    /// Lines stay lines.
    Projective(Homography),
    /// Anything else.
    Smooth,
}

/// (x, y) ↦ (X/W, Y/W) with polynomials X, Y, W.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RationalDegree {
    /// The largest total degree (exponents of x and y together) of X, Y and W.
    pub degree: usize,
    /// `true` if W is not the constant 1. [`Map::denominator`] gives its values.
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
