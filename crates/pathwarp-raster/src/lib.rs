//! Bitmaps for [pathwarp](https://github.com/pathwarp/pathwarp): renders drawings, warps photographs, compares pictures.
//!
//! * [`render()`] draws a resolved SVG tree at a chosen [`Size`], within [limits](pathwarp::budget).
//! * [`encode_png`] and [`decode_png`] convert pictures to and from PNG.
//! * [`compare()`] measures the difference of two pictures; [`diff_image`] visualises it.
//! * [`Picture`] reads and writes photographs with orientation and colour profile.
//! * [`warp_image()`] warps a bitmap by a map; [`SmoothShade`] warps a paint, [`DrawingWarp`] what a drawing shows.
//! * [`Preview`] draws a drawing and its warped result side by side, with cages, bases and targets on top.
//!
//! All pictures are [`Pixmap`]s: RGBA, sRGB, 8 bits per channel, premultiplied alpha.
//!
//! The feature `parallel` (on by default) warps pictures on all processors. Results do not depend on it.
//!
//! ```
//! use pathwarp_raster::{Color, RenderOptions, Size, compare, render};
//!
//! let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="20" height="10"><circle cx="5" cy="5" r="4"/></svg>"#;
//! let tree = usvg::Tree::from_str(svg, &usvg::Options::default())?;
//!
//! let small = render(&tree, Size::Native)?;
//! let large = render(&tree, Size::Width(200))?;
//! assert_eq!((small.width(), small.height()), (20, 10));
//! assert_eq!((large.width(), large.height()), (200, 100));
//!
//! let on_white = RenderOptions { size: Size::Native, background: Some(Color::WHITE) }.render(&tree)?;
//! assert!(compare(&small, &small)?.is_same());
//! assert!(compare(&small, &on_white)?.max_channel == 255);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod compare;
mod error;
mod load;
mod picture;
mod pixmap;
mod png;
mod preview;
mod render;
mod warp_drawing;
mod warp_image;

pub use compare::{Difference, compare, diff_image};
pub use error::Error;
pub use picture::{EarlyEnd, Picture, PictureFormat, header_size};
pub use pixmap::enlarged;
pub use png::{decode_png, encode_png, encode_smooth_png};
pub use preview::{OverlayKind, Panel, Preview, PreviewOverlay};
pub use render::{RenderOptions, Size, render, render_group};
pub use tiny_skia::{Color, IntRect, Pixmap};
pub use warp_drawing::{Counter, DrawingWarp};
pub use warp_image::{
    Colors, Continued, Extent, GridInverse, ImageWarp, SeenColor, Shade, ShadeTolerance, SmoothShade, extent, shade,
    shown, warp_image,
};
