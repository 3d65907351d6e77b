//! Polygon meshes: vertices, faces of any number of corners, groups, materials, texture coordinates and normals.

mod assets;
mod deform;
mod error;
mod extrude;
mod flat;
pub mod gltf;
mod model;
pub mod obj;
pub mod ply;
mod refine;
pub mod stl;
mod topology;
mod unify;

pub use assets::Assets;
pub use deform::{Deformed, Undefined3, deform};
pub use error::{MeshError, MeshFault};
pub use extrude::extrude;
pub use flat::FlatShape;
pub use model::{Corner, Mark, Mesh, NONE, Polygon, PolygonKind};
pub use refine::refine;
pub use topology::{Topology, topology};
