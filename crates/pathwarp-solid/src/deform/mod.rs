//! Deformations of space, and the registry that builds them from text.
//!
//! Each deformation is a type with a constructor, chainable setters and `build`, such as [`Ffd3`]. [`Registry3`] holds the same
//! deformations as entries that read their parameters from text, for the command line and recipes.

mod anamorph;
mod bend;
mod entry;
mod ffd;
mod wrap;

use std::fmt;
use std::sync::Arc;

pub use anamorph::{Anamorph3, Eye3, Push3, Reference3};
pub use bend::{Bend3, Handle3, Spine3};
pub use entry::{About3, Built3, Case3, Deformation3, Law3};
pub use ffd::{Change3, Ffd3};
pub use wrap::Wrap3;

/// The deformations of space that a program knows, by name.
#[derive(Clone)]
pub struct Registry3 {
    entries: Vec<Arc<dyn Deformation3>>,
}

impl fmt::Debug for Registry3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Registry3").field("entries", &self.entries.len()).finish_non_exhaustive()
    }
}

impl Registry3 {
    /// Returns the deformations of this crate.
    #[must_use]
    pub fn builtin() -> Self {
        let entries = [ffd::ENTRY, anamorph::ENTRY, bend::ENTRY, wrap::ENTRY];
        Self { entries: entries.map(|e| Arc::new(e) as Arc<dyn Deformation3>).to_vec() }
    }

    /// Adds an entry, replacing any of the same name.
    #[must_use]
    pub fn with(mut self, entry: impl Deformation3 + 'static) -> Self {
        self.entries.retain(|e| e.about().info.name != entry.about().info.name);
        self.entries.push(Arc::new(entry));
        self
    }

    /// Returns all entries, in the order of help.
    #[must_use]
    pub fn entries(&self) -> &[Arc<dyn Deformation3>] {
        &self.entries
    }

    /// Returns the entry called `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Arc<dyn Deformation3>> {
        self.entries.iter().find(|e| e.about().info.name == name)
    }
}
