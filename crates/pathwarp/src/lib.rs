//! Plane deformations of vector paths, given back as clean Bézier curves.
mod error;
pub mod outline;
pub use error::{Error, GeometryError};
pub use kurbo;
pub use outline::{Outline, Seg, Subpath};
