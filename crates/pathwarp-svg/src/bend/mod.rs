//! The drawing under a map: images of outlines, strokes, gradients and bitmaps.

mod arcs;
pub(crate) mod bends;
mod bent_gradient;
pub(crate) mod bitmap;
mod contours;
mod digits;
pub(crate) mod drawing;
pub(crate) mod gradient;
pub(crate) mod image;
pub(crate) mod letter_places;
pub(crate) mod letters;
pub(crate) mod options;
pub(crate) mod outcome;
pub(crate) mod paint;
mod part;
pub(crate) mod picture;
mod places;
pub(crate) mod plain;
mod shading;
pub(crate) mod slots;
mod spot;
mod stroke;
mod stubs;
mod task;
pub(crate) mod tiles;
pub(crate) mod warning;
mod width;
