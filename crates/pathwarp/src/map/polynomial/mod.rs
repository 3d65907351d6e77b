//! Polynomials in Bernstein and in power form, and the maps that are quotients of them.

pub(crate) mod bernstein;
mod plane;
mod quotient;

pub(crate) use plane::Plane;
pub(crate) use quotient::{Quotient, source_coordinates};
