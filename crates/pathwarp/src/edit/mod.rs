//! Edits of outlines that are not maps: offsets, operations on areas, and lines around areas.

mod area;
mod contour;
mod exact_edges;
mod offset;

pub use area::{Area, united};
pub use contour::{Around, Contour, around};
pub use offset::{Moved, Offset, OpenPaths, Side, moved};
