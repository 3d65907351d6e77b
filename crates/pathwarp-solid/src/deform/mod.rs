//! Deformations of space, and the registry that builds them from text.
//!
//! Each is a type with a constructor, chainable setters and `build`, such as [`Ffd3`]. [`Registry3`] holds the same as entries
//! that read their parameters from text, as the command line and recipes do.

mod anamorph;
mod bend;
mod built;
mod entry;
mod ffd;
mod registry;
mod wrap;

pub use anamorph::{Anamorph3, Push3, Reference3};
pub use bend::{Bend3, Handle3, Spine3};
pub use built::Built3;
pub use entry::{About3, Case3, Deformation3, Law3};
pub use ffd::{Change3, Ffd3};
pub use registry::Registry3;
pub use wrap::Wrap3;

use std::sync::Arc;

/// The deformations of this crate, in the order of help.
pub(crate) fn builtin() -> Vec<Arc<dyn Deformation3>> {
    vec![Arc::new(ffd::Entry), Arc::new(anamorph::Entry), Arc::new(bend::Entry), Arc::new(wrap::Entry)]
}
