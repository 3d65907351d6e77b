//! Warps bitmaps and paints: the inverse map gives every pixel of the result its position in the source.
//!
//! The derivatives of the inverse give the footprint of a pixel in the source, a parallelogram to first order. If that is no
//! larger than a source pixel, the source is interpolated by the Catmull-Rom cubic, which reproduces the pixels. If it is larger,
//! the same cubic is stretched over the footprint, so that everything in it counts and nothing aliases. A footprint that is long
//! in one direction is stretched in that direction only. This is elliptical weighted averaging (P. S. Heckbert, *Fundamentals of
//! Texture Mapping and Image Warping*, 1989, chapter 3) with a sharper kernel than his Gaussian. Very large footprints read from
//! a pyramid of halved pictures (L. Williams, *Pyramidal Parametrics*, 1983), using two to four of its pixels along each side, so
//! the work per pixel is bounded.
//!
//! Colours are averaged as stored, in sRGB with premultiplied alpha, as browsers and resvg composite and as the edges of adjacent
//! warped shapes are antialiased. The surroundings of the source are transparent, and its edge is antialiased over one pixel of
//! the result.
//!
//! Within a tile, a cubic polynomial through a few values of the inverse is nearly always accurate enough ([`trace`]), and whole rows
//! of pixels are computed together ([`rows`]); elsewhere, the inverse is evaluated for every pixel.
//!
//! Tiles are independent and run in parallel. Memory is the source, the result, and a third of the source for the pyramid if the
//! map shrinks.

mod continued;
mod grid_inverse;
mod image_warp;
mod painter;
mod resolution;
mod rows;
mod sample;
mod shade;
mod tile;
mod trace;

pub use continued::Continued;
pub(crate) use continued::lattice;
pub use grid_inverse::GridInverse;
pub use image_warp::{Extent, ImageWarp, extent, shown};
pub(crate) use image_warp::{composed, lengths};
pub use painter::warp_image;
pub use resolution::{SeenColor, ShadeTolerance, SmoothShade};
pub use shade::{Colors, Shade, shade};

#[cfg(test)]
mod tests;
