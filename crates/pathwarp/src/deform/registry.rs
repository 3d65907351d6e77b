//! The registry: the deformations that a program knows, by name.

use super::entry::Deformation;
use std::sync::Arc;

/// The deformations that a program knows.
#[derive(Clone)]
pub struct Registry {
    entries: Vec<Arc<dyn Deformation>>,
}

impl Registry {
    /// Returns a registry of these entries, in menu order.
    #[must_use]
    pub fn new(entries: Vec<Arc<dyn Deformation>>) -> Self {
        Self { entries }
    }

    /// Returns the deformations of this crate.
    #[must_use]
    pub fn builtin() -> Self {
        Self::new(super::builtin())
    }

    /// Adds an entry; an entry of the same name is replaced.
    #[must_use]
    pub fn with(mut self, entry: impl Deformation + 'static) -> Self {
        self.entries.retain(|e| e.info().name != entry.info().name);
        self.entries.push(Arc::new(entry));
        self
    }

    /// Returns all entries, in menu order.
    #[must_use]
    pub fn entries(&self) -> &[Arc<dyn Deformation>] {
        &self.entries
    }

    /// Returns the entry called `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Arc<dyn Deformation>> {
        self.entries.iter().find(|e| e.info().name == name)
    }
}
