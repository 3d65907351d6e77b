//! Maps made of smooth pieces with creases between them.

mod coons;
mod local;
pub(crate) mod ruled;
mod tiled;

pub use coons::{Coons, Sides};
pub(crate) use local::Local;
pub(crate) use tiled::{TileRow, Tiled};
