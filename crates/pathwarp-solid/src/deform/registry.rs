//! The registry: the deformations of space that a program knows, by name.

use super::entry::Deformation3;
use std::fmt;
use std::sync::Arc;

/// The deformations of space that a program knows.
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
        Self { entries: super::builtin() }
    }

    /// Adds an entry; an entry of the same name is replaced.
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
