//! Maps given by a net of Bézier or B-spline control points.

mod bicubic;
pub mod bspline;
mod patch;
mod power_basis;

pub use bicubic::{BicubicNet, Net, complete_net};
pub(crate) use patch::Patch;
pub(crate) use power_basis::powers;
