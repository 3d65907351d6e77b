//! Wavefront OBJ: polygons with groups, materials, texture coordinates and normals.
//!
//! Read and written here rather than by a crate: the crates that read OBJ give triangles by material, without groups, polylines
//! or the order of objects, and a deformed file should differ from its source in the coordinates alone. Long files are read and
//! written by all threads; the result does not depend on their number.

mod read;
mod tokens;
mod write;

pub use read::read;
pub use write::write;
