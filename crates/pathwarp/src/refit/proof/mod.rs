//! Proofs that a fitted cubic lies within a distance of the true image, where map and segment are quotients of polynomials.
//!
//! Let g be the image over one piece, τ in [0, 1], and C the cubic. For any continuous φ from [0, 1] onto [0, 1], the Hausdorff
//! distance of the two curves is at most sup |g(τ) − C(φ(τ))|: every point of g has a partner on C, and, φ being onto, every
//! point of C has one on g. With a polynomial φ that follows the foot points of the fit, D = g − C∘φ is a polynomial of known
//! degree, and a bound for it follows from finitely many values.
//!
//! **Denominators.** If g = G/W, D is no polynomial. But with a polynomial V close to 1/W, the product F = V·W·D is one, and
//! |D| ≤ |F| / (1−ε) where |VW − 1| ≤ ε. VW is a polynomial too, bounded in the same way.
//!
//! [`piece()`] tries the proofs in the order of their cost:
//!
//! - `sampled`: from the samples that the fit has taken anyway, or sixteen more.
//! - `nodes`: from 24 to 48 Chebyshev nodes. Also for merged pieces, whose ends do not coincide with the image's.
//! - `straight`: for lines.

mod chebyshev;
mod form;
mod nodes;
mod piece;
mod sampled;
mod straight;

pub(super) use form::RationalForm;
pub(super) use nodes::stretch;
pub(super) use piece::piece;
pub(super) use straight::line;
