//! glTF 2.0, `.glb` and `.gltf`, read by the crate gltf.
//!
//! Every node with a mesh becomes an object in the scene's coordinates. Materials, textures and pictures are carried along as they are.
//! Nothing outside the file is opened.

mod accessor;
mod primitive;
mod read;
#[cfg(test)]
mod tests;
mod write;

pub use read::{read, sniff};
pub use write::{write_binary, write_text};
