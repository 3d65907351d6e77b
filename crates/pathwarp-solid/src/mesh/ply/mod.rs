//! PLY, as text and binary, by the crate ply-rs-bw. Faces keep their corners.

mod element;
mod read;
#[cfg(test)]
mod tests;
mod write;

pub use read::{read, sniff};
pub use write::write;
