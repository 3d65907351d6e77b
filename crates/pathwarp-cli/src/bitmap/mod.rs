//! Bitmaps and gradients bent pixel by pixel.

mod bender;
mod inverse;

pub use bender::Bender;
pub(crate) use inverse::{ROUNDING, inverse};
