//! The drawing under a map: the image of every outline, stroke, gradient and bitmap.

pub(crate) mod gradient;
pub(crate) mod image;
pub(crate) mod letters;
pub(crate) mod options;
pub(crate) mod paint;
pub(crate) mod part;
pub(crate) mod stroke;
