//! Curves as the boundaries of maps, with a choice of parameter.

mod arc_length;
mod guide;
mod root;
mod side;

pub(crate) use arc_length::ArcLength;
pub(super) use guide::GuidePiece;
pub(crate) use guide::{Along, Guide};
pub(crate) use root::increasing_root;
pub use side::{Pace, Side};
