//! Bends a drawing by its maps: outlines, strokes, gradients and bitmaps.

pub(crate) mod bends;
pub(crate) mod drawing;
pub(crate) mod fits;
pub(crate) mod gradient_fit;
pub(crate) mod gradients;
pub(crate) mod line;
mod meshes;
pub(crate) mod options;
pub(crate) mod outcome;
pub(crate) mod part;
pub(crate) mod path;
pub(crate) mod pictures;
mod seam;
pub(crate) mod shading;
pub(crate) mod stroke;
pub(crate) mod task;
pub(crate) mod traced;
pub(crate) mod united;
mod visible;
pub(crate) mod width;
