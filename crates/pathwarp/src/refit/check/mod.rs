//! Checks of a fitted cubic against the true image, each more expensive than the last.
//!
//! - [`halfway`]: samples halfway beside those whose error is in doubt.
//! - [`dense`]: 64 samples, more where the cubic turns, and closer ones around every maximum.
//! - [`thorough`]: 160 samples each way, with a search for every nearest point. For curves whose foot points cannot be
//!   followed along the cubic.

mod dense;
mod halfway;
mod probe;
mod thorough;

pub(super) use dense::dense;
pub(super) use halfway::halfway;
pub(super) use thorough::THOROUGH_WORK;
