//! Plane deformations of vector paths, given back as clean Bézier curves.
//!
//! The way of the data: an [`Outline`] (lines, quadratics, cubics and true arcs) and a [`map::Map`] of the plane go into
//! [`refit::warp_path`]; a [`kurbo::BezPath`] within a stated distance of the true image comes out.
//!
//! This crate is pure: no I/O, no globals, no printing.

pub(crate) mod anchors;
pub mod check;
pub mod decimal;
pub mod deform;
pub mod distance;
mod error;
pub mod fold;
pub(crate) mod formula;
pub mod map;
pub mod outline;
pub mod param;
pub mod recipe;
pub mod refit;

pub use error::{Error, GeometryError};
pub use kurbo;
pub use outline::{Outline, Seg, Subpath};

/// The README's examples, tested.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
