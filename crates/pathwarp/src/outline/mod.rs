//! Paths as drawn: the source geometry of every deformation.
//!
//! An [`Outline`] is a list of [`Subpath`]s, each a run of [`Seg`]s: lines, quadratic and cubic Bézier curves, and *true* elliptical
//! arcs. Read one from SVG path data with [`Outline::from_svg`], convert a [`kurbo::BezPath`] with `From`, or draw one with a
//! [`Builder`].
//!
//! [`BezPath`](kurbo::BezPath) has no arcs. Converting a circle to cubics before warping it would spend part of the tolerance, or many
//! nodes, before the warp begins. Here an [`EllipticArc`] stays an arc until its image is fitted, so that the promised error
//! counts from the shape that was drawn.

mod arc;
mod boundary;
mod builder;
mod path;
mod seg;
mod stroke;
mod svg;

pub use arc::EllipticArc;
pub use boundary::boundary;
pub use builder::Builder;
pub use path::{Outline, Subpath};
pub use seg::Seg;
pub use svg::PathDataError;
