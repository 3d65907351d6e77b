//! The drawing as it is painted: every shape with its outline, its transform and the element it comes from.

pub(crate) mod geometry;
pub(crate) mod lettering;
pub(crate) mod letters;
pub(crate) mod model;
pub(crate) mod resolve;
