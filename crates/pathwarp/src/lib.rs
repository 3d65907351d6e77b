//! Plane deformations of vector paths, with the result refitted by clean Bézier curves.
//!
//! Three types do the work:
//!
//! - [`Outline`]: the source geometry, made of lines, quadratics, cubics and true elliptical arcs.
//! - [`Map`](map::Map): a differentiable map of the plane. The constructors in [`deform`] build one from a cage, a skeleton, a
//!   lattice, a preset and so on; [`map::Formula`] turns any formula into one; [`map::Chain`] composes them.
//! - [`refit::warp_path`]: maps an outline and fits a [`kurbo::BezPath`] to the image, within a Hausdorff distance that you choose.
//!
//! ```
//! use pathwarp::{Outline, deform::Swirl, kurbo::Point, refit};
//!
//! let swirl = Swirl::new(Point::new(50.0, 50.0), 60.0).build()?;
//! let square = Outline::from_svg("M20,20 H80 V80 H20 Z")?;
//! let warped = refit::warp_path(&square, &swirl.map, &refit::Options::new(0.01))?;
//! assert!(warped.report.max_error <= 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`deform::Registry`] builds deformations by name from text, as the command line and [`recipe`]s do; [`check`] tests the laws that
//! every deformation must obey; [`fold`] finds where a map turns the plane over; [`distance`] measures how far two paths are apart.
//!
//! An application needs these, with [`edit`], [`map`] and [`budget`]. To write a deformation, implement [`map::Map`] or
//! [`map::Formula`], and [`deform::Deformation`] with [`param`]. A third part, `engine`, is for pathwarp's crates, and hidden here.
//!
//! # Features
//!
//! - `serde` (default): reads JSON. Without it there are no warp styles and text shapes ([`deform::Warp`], [`deform::WordArt`]),
//!   which are JSON themselves, and the registry's entries refuse files of lattices, meshes and handles.
//! - `parallel`: refits long paths on all processors. The result does not depend on their number.
//!
//! The crate is pure: no I/O, no globals, no printing. All numbers are `f64`; coordinates are user units, y down.

// Without the presets, the code that only they use has no caller.
#![cfg_attr(not(feature = "serde"), allow(dead_code, unused_imports))]

/// Setters that take a value and return the changed deformation: `height(height: f64);` sets the field of that name,
/// `center(c: Point) => center: Some(c);` sets fields to expressions. After `const:`, they also serve in constants.
#[doc(hidden)]
#[macro_export]
macro_rules! setters {
    (@one [$($const:tt)?] $(#[$about:meta])* $name:ident($value:ident: $type:ty)) => {
        $crate::setters! { @one [$($const)?] $(#[$about])* $name($value: $type) => $name: $value }
    };
    (@one [$($const:tt)?] $(#[$about:meta])* $name:ident($($value:ident: $type:ty),+) => $($field:ident: $set:expr),+) => {
        $(#[$about])*
        #[must_use]
        pub $($const)? fn $name(self, $($value: $type),+) -> Self {
            Self { $($field: $set,)+ ..self }
        }
    };
    (const: $($(#[$about:meta])* $name:ident $values:tt $(=> $($field:ident: $set:expr),+)?;)*) => {
        $($crate::setters! { @one [const] $(#[$about])* $name $values $(=> $($field: $set),+)? })*
    };
    ($($(#[$about:meta])* $name:ident $values:tt $(=> $($field:ident: $set:expr),+)?;)*) => {
        $($crate::setters! { @one [] $(#[$about])* $name $values $(=> $($field: $set),+)? })*
    };
}

mod anchors;
pub mod budget;
pub mod check;
#[doc(hidden)]
pub mod decimal;
pub mod deform;
pub mod distance;
pub mod edit;
mod error;
pub mod fold;
mod formula;
pub mod map;
pub mod outline;
pub mod param;
pub mod recipe;
pub mod refit;
#[doc(hidden)]
pub mod solve;

/// Interfaces for the crates that build on this one, such as pathwarp-svg and pathwarp-engine: costs, caches and batches of maps,
/// edges that shapes share, maps written in other languages. It may change in any release.
#[doc(hidden)]
pub mod engine {
    pub use crate::map::batches::{Batches, Cost, Gathered, Images, Searches};
    pub use crate::map::bspline;
    pub use crate::map::called::{Abilities, Ask, Called, Callee};
    pub use crate::map::joint::Joint;
    pub use crate::outline::marching_squares::{GridEdge, marching_squares};
    pub use crate::recipe::{BuiltParts, Portion};
    pub use crate::refit::KnownShapes;
    pub use crate::refit::borders::Borders;
    pub use crate::refit::report::{RESOLUTION, SpanReport};
    pub use crate::refit::shared::{SharedEdges, Span};
    pub use crate::{decimal, solve};
}

pub use bezierfit as fit;
pub use error::{Error, GeometryError};
pub use kurbo;
pub use outline::{Outline, Seg, Subpath};
