//! Objects that remember their source: a warped element carries its source and its recipe in attributes, so that editors keep
//! them when they save, copy and paste it.
//!
//! [`remember`] adds the attributes to the result of a warp, [`restore`] puts sources back, and [`objects`] lists the elements of a file
//! with their recipes. They work on the file alone and do not resolve the drawing.

mod nodes;
mod remembering;
mod restoring;
mod restyling;

pub use nodes::{Guides, Object, objects};
pub use remembering::{Memory, remember};
pub use restoring::{Restored, RestoredObject, restore};
pub use restyling::{moved, restyled};

#[cfg(test)]
mod tests;
