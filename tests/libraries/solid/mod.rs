//! Tests deformations of solids from outside, against independent formulas and in exact arithmetic.

mod creases;
mod hulls;
mod oracle;
mod patches;
