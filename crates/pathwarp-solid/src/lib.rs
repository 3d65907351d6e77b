//! Deformations of space for meshes and points.
//!
//! - [`Map3`](map::Map3): a differentiable map of space, with its Jacobian, batches, creases and inverse.
//! - [`deform`]: free-form deformation and its relatives, typed and by name from text ([`Registry3`](deform::Registry3)).
//! - [`recipe`]: steps one after another as one map.
//! - [`mesh`]: polygon meshes with groups, materials and texture coordinates, and their files.
//! - [`artwork`]: outlines in the plane as triangles, and on a surface in space as OBJ.
//! - [`patch`]: Bézier patches and NURBS surfaces, with exact images where the map allows it.
//!
//! In space, x points right, y up and z towards the viewer. The crate is pure: no I/O, no globals, no printing.

pub mod artwork;
pub mod check;
pub mod deform;
mod hull;
mod lattice;
pub mod map;
pub mod mesh;
pub mod patch;
pub mod picture;
pub mod recipe;
mod settings;

pub use crate::settings::Box3;
pub use glam;
pub use lattice::{Lattice3, LatticeMap3};
pub use settings::{Extent, Frame3, Settings3};
