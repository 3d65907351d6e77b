//! Advice: the libraries say what is wrong and where; this adds what to do about it, in flags.

mod flags;
mod messages;
mod names;

pub(crate) use flags::Flags;
pub(crate) use messages::{error, lettering_frame, overhang, surface};
pub(crate) use names::unknown;
