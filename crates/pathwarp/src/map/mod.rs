//! Maps of the plane: the result of a deformation once its parameters are known.
//!
//! A [`Map`] takes every point of the drawing to a new place and knows its derivatives there. [`warp_path`] samples a map along a
//! path and fits Bézier curves to the image. Bitmaps ask the inverse map for the source of each pixel.
//!
//! # Writing a map
//!
//! [`from_fn`] makes one of a closure.
//!
//! Implement [`Formula`]: one function from (x, y) to (x, y), generic over the number type ([`Real`]). Run on `f64` it gives
//! values, run on [`Dual`] numbers it gives derivatives. Implement [`Map`] itself if derivatives have a cheaper closed form; only
//! [`Map::jet`], the value and both partial derivatives at a point, is required.
//!
//! Everything else is optional knowledge that makes results better:
//!
//! - [`Map::class`] reports affine and projective maps, which are applied to control points or keep lines straight.
//! - [`Map::creases`] lists the lines along which the derivative jumps and the boundary of the domain. Paths are split there, and
//!   [`Map::branch`] gives the smooth map on one side.
//! - [`Map::class`] and [`Map::image`] describe the image exactly, so that the error of a fit can be proved instead of measured.
//! - [`Map::inverse`] gives the inverse in closed form. [`NewtonInverse`] inverts any smooth map over a box.
//!
//! # Composing maps
//!
//! [`Chain`] applies maps one after another. Compose first and refit once: every refit adds to the error and to the number of
//! nodes.
//!
//! # Maps that are here
//!
//! [`AffineMap`] and [`Homography`]; [`BicubicNet`], given by 16 control points; [`LatticeMap`], free-form deformation by a
//! [`Lattice`] of any size; [`Birational`], a lattice of two rows with a closed-form inverse; and [`Coons`], given by four curved
//! sides. The maps of single deformations are in [`deform`](crate::deform).
//!
//! Coordinates are user units of the drawing's root, y down.
//!
//! [`warp_path`]: crate::refit::warp_path

mod batches;
mod birational;
mod chain;
mod class;
#[cfg(test)]
pub(crate) mod counted;
mod crease;
mod creased;
pub(crate) mod curves;
mod dual;
mod formula;
mod from_fn;
mod homography;
mod jet;
mod lattice;
pub(crate) mod nets;
mod newton;
pub(crate) mod piecewise;
pub(crate) mod polynomial;
mod projective;
mod rational_bezier;
mod traits;

pub use batches::Gathered;
pub use birational::{Birational, BirationalInverse, Rows};
pub use chain::Chain;
pub use class::{Class, RationalDegree};
pub use crease::{Crease, CreaseKind, Creases, Level};
pub use creased::inverse_over;
pub use curves::{Pace, Side};
pub use dual::{Dual, Real};
pub use formula::Formula;
pub use from_fn::{FromFn, FromFnWith, from_fn, from_fn_with};
pub use homography::Homography;
pub use jet::Jet;
pub use lattice::{Lattice, LatticeMap};
pub use nets::{BicubicNet, Net, bspline, complete_net};
pub(crate) use newton::INVERSE_WORK;
pub use newton::NewtonInverse;
pub use piecewise::{Coons, Sides};
pub use projective::{AffineMap, Undeclared};
pub use rational_bezier::RationalBezier;
pub use traits::{Batches, Cost, Images, Map, Searches};

pub(crate) use curves::{Along, Guide, increasing_root};
pub(crate) use piecewise::{Local, TileRow, Tiled, ruled};
