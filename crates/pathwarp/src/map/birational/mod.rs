//! Free-form deformation of degree 1×n with a closed-form inverse.
//!
//! > P(s,t) = (1−s)·P₀(t) + s·P₁(t)
//!
//! with P₀, P₁ rational Bézier curves of degree n, the rows. Their control points are free. The weights make both rows monoids
//! that are followed by the same line L(t), which turns about the point A in which the lines through the first and through the
//! last pair of control points meet (T. W. Sederberg, J. Zheng, *Birational 2D free-form deformation of degree 1×n*, CAGD 2016).
//! Then t and s of a point X have closed forms:
//!
//! > t = ℓ₀·X / (ℓ₀·X − ℓ₁·X),  s = f₀(X) / (f₀(X) − f₁(X))
//!
//! with f₀, f₁ the implicit equations of the rows (`Monoid::implicit`). The code computes s from the rows at t: the same number
//! with less rounding. Lines of constant t stay straight lines.
//!
//! **Normalisation of the weights.** Scaling ℓ₁ multiplies wᵢ by gⁱ in both rows, which changes only the speed of t; a common
//! factor of a row changes nothing. Here w₀₀ = w₁₀ = 1 and w₀ₙ·w₁ₙ = 1, so that the map depends on the points alone and a
//! rectangle gives the identity.
//!
//! **B-spline rows** are cut into Bézier pieces by knot insertion, each with its own A. Neighbours share the line between them and
//! its points: the rows of a piece start with the weights with which the rows of the previous piece end. Speeds are chosen so that
//! both sides of every joint agree in the geometric mean over both rows, with all w₀ₙ·w₁ₙ as near 1 as that allows. Rows
//! keep their tangents across a joint; the map has a crease there.

mod map;
mod monoid;
#[cfg(test)]
mod tests;
mod weights;

pub use map::{Birational, BirationalInverse, Rows};
