//! Tests deformations of solids from outside, against independent formulas and in exact arithmetic.

#![allow(clippy::unwrap_used)]

mod creases;
mod oracle;
mod patches;
