//! Errors of making, reading and comparing pictures.

use pathwarp::budget::Exceeded;
use thiserror::Error;

/// The reason why a picture cannot be made, read or compared.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// The size of the picture is zero.
    #[error("a picture of {width} x {height} pixels is empty: both sides must be at least one pixel")]
    Empty {
        /// Requested width in pixels.
        width: u32,
        /// Requested height in pixels.
        height: u32,
    },
    /// The size of the picture exceeds the limit.
    #[error("a picture of {width:.0} x {height:.0} pixels is too large: it takes {exceeded}; choose a smaller one")]
    TooLarge {
        /// Requested width in pixels.
        width: f64,
        /// Requested height in pixels.
        height: f64,
        /// The limit.
        exceeded: Exceeded,
    },
    /// Drawing the picture takes more work or memory than a limit allows.
    #[error("drawing it takes {0}; draw it smaller, or simplify its masks, filters and patterns")]
    TooMuch(#[from] Exceeded),
    /// Geometry extends farther than the renderer can handle.
    #[error(
        "a shape or a stroke extends more than {:.0e} pixels from the picture, or has coordinates that are not finite, which \
         cannot be drawn; remove it, or draw the picture smaller",
        crate::load::MAX_COORDINATE
    )]
    TooFar,
    /// A turbulence filter has more octaves than have any effect.
    #[error("a turbulence filter has {0} octaves, which cannot be drawn; lower them to 24, as more change nothing")]
    Octaves(u32),
    /// The renderer failed.
    #[error("the renderer failed on this drawing; please report it")]
    Renderer,
    /// The scale is not a positive number.
    #[error("the scale {0} is not a positive number")]
    BadScale(f32),
    /// The bytes are not a picture that this crate can read.
    #[error("not a readable picture: {0}")]
    Decode(String),
    /// The picture cannot be encoded.
    #[error("cannot write the picture: {0}")]
    Encode(String),
    /// Pictures of different sizes cannot be compared.
    #[error(
        "the pictures differ in size: {} x {} and {} x {} pixels; render both at the same size",
        .a.0, .a.1, .b.0, .b.1
    )]
    SizesDiffer {
        /// Width and height of the first picture.
        a: (u32, u32),
        /// Width and height of the second picture.
        b: (u32, u32),
    },
    /// The map takes no point to the area that the picture shows.
    #[error("no pixel of the picture has an inverse image")]
    NoInverse,
    /// The page and the overlays of a preview are empty or not finite.
    #[error("the preview has nothing to show: {0}")]
    NoView(&'static str),
}
