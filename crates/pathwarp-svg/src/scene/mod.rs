//! The drawing as it is painted: every shape with its outline, its transform and its source element.

pub(crate) mod affine;
mod basic_shapes;
pub(crate) mod drawing;
pub(crate) mod far;
pub(crate) mod filter_area;
pub(crate) mod geometry;
pub(crate) mod lettering;
pub(crate) mod letters;
pub(crate) mod model;
pub(crate) mod plot;
pub(crate) mod resolve;
pub(crate) mod seen;
pub(crate) mod shape;
pub(crate) mod stroked;
pub(crate) mod unread;
pub(crate) mod usvg_path;
