//! Deforming solids, tested from outside against formulas written again and exact fractions.

#![allow(clippy::unwrap_used)]

mod creases;
mod oracle;
mod patches;
