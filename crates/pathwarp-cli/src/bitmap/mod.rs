//! Bitmaps and gradients bent pixel by pixel, and pictures as files.

mod bender;
mod counted;
mod encode;
mod inverse;

pub use bender::Bender;
pub(crate) use counted::{count_decoded, count_warped};
pub(crate) use encode::encode;
pub(crate) use inverse::{ROUNDING, inverse};
