//! The drawing as it is painted, with the outline, transform and source element of every shape.

pub(crate) mod areas;
pub(crate) mod drawing;
pub(crate) mod geometry;
pub(crate) mod lettering;
pub(crate) mod model;
pub(crate) mod plot;
pub(crate) mod resolve;
pub(crate) mod selected_lettering;
