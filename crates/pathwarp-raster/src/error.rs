//! What can go wrong between a drawing and its picture.

use crate::render::MAX_PIXELS;
use thiserror::Error;

/// A picture cannot be made, read or compared.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// A picture without pixels was asked for.
    #[error("a picture of {width} x {height} pixels has nothing in it: both sides must be at least one pixel")]
    Empty {
        /// Width asked for, in pixels.
        width: u32,
        /// Height asked for, in pixels.
        height: u32,
    },
    /// A picture larger than the limit was asked for.
    #[error(
        "a picture of {width:.0} x {height:.0} pixels is too large: the limit is {MAX_PIXELS} pixels \
         (such as 16384 x 16384); ask for a smaller width, height or scale"
    )]
    TooLarge {
        /// Width asked for, in pixels.
        width: f64,
        /// Height asked for, in pixels.
        height: f64,
    },
    /// The scale is not a positive number.
    #[error("a picture cannot be scaled by {0}: the scale must be a positive number")]
    BadScale(f32),
    /// The bytes are no picture this crate can read.
    #[error("not a readable picture: {0}")]
    Decode(String),
    /// The picture could not be written.
    #[error("cannot write the picture: {0}")]
    Encode(String),
    /// Two pictures of different sizes were compared.
    #[error(
        "the pictures differ in size, {} x {} against {} x {} pixels: render both at one size",
        .a.0, .a.1, .b.0, .b.1
    )]
    SizesDiffer {
        /// Width and height of the first picture.
        a: (u32, u32),
        /// Width and height of the second picture.
        b: (u32, u32),
    },
    /// A preview has no area to show: its page and overlays are empty or not finite.
    #[error("the preview has nothing to show: {0}")]
    NoView(&'static str),
}
