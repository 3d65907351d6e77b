//! Bitmaps and gradients bent pixel by pixel, and pictures as files.

mod bender;
mod encode;
mod inverse;
pub(crate) mod work;

pub use bender::Bender;
pub(crate) use encode::encode;
pub(crate) use inverse::{ROUNDING, inverse};
