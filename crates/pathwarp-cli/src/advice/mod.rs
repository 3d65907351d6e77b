//! Advice in flags, added to the errors and warnings of the libraries, which know no command line.

mod flags;
mod messages;
pub(crate) mod mistakes;
mod names;

pub(crate) use flags::Flags;
pub(crate) use messages::{error, lacking, lettering_frame, outside, picture, raise, stretched, surface};
pub(crate) use names::unknown;
