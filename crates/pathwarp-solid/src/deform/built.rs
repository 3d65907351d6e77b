//! The result of building a deformation of space: the map, and everything about it that is not a map.

use crate::map::Map3;
use glam::DVec3;
use pathwarp::deform::SavedFile;
use std::fmt;
use std::sync::Arc;

/// A deformation of space with its parameters settled.
#[derive(Clone)]
#[non_exhaustive]
pub struct Built3 {
    /// The map.
    pub map: Arc<dyn Map3>,
    /// Decisions made on the user's behalf.
    pub notes: Vec<String>,
    /// Problems the user should know of.
    pub warnings: Vec<String>,
    /// Polylines that a preview draws: control nets, skeletons, rays.
    pub guides: Vec<Vec<DVec3>>,
    /// The place from which a model looks unchanged.
    pub eye: Option<DVec3>,
    /// Files requested by parameters of kind [`Save`](pathwarp::param::Kind::Save).
    pub saves: Vec<SavedFile>,
}

impl Built3 {
    /// Wraps a map that needs no explanation.
    #[must_use]
    pub fn new(map: Arc<dyn Map3>) -> Self {
        Self { map, notes: Vec::new(), warnings: Vec::new(), guides: Vec::new(), eye: None, saves: Vec::new() }
    }

    /// Adds a note.
    pub fn note(&mut self, text: impl Into<String>) {
        self.notes.push(text.into());
    }

    /// Adds a warning.
    pub fn warn(&mut self, text: impl Into<String>) {
        self.warnings.push(text.into());
    }
}

impl fmt::Debug for Built3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Built3").field("notes", &self.notes).field("warnings", &self.warnings).finish_non_exhaustive()
    }
}
