//! Descriptions of deformations, of the plane or of space: all that reading a command line or a recipe needs of a registry.

use crate::edits;
use pathwarp::deform::{Info, Registry};
use pathwarp_solid::deform::Registry3;

/// A registry, as its deformations' descriptions.
pub trait Catalogue {
    /// The descriptions, in the order of help.
    fn infos(&self) -> Vec<&Info>;

    /// The description of the deformation called `name`; of the plane, also of an edit.
    fn info(&self, name: &str) -> Option<&Info>;

    /// Returns `true` if the deformations are those of space.
    fn is_solid(&self) -> bool;
}

impl Catalogue for Registry {
    fn infos(&self) -> Vec<&Info> {
        self.entries().iter().map(|e| e.info()).collect()
    }

    fn info(&self, name: &str) -> Option<&Info> {
        self.get(name).map(|e| e.info()).or_else(|| edits::info(name))
    }

    fn is_solid(&self) -> bool {
        false
    }
}

impl Catalogue for Registry3 {
    fn infos(&self) -> Vec<&Info> {
        self.entries().iter().map(|e| &e.about().info).collect()
    }

    fn info(&self, name: &str) -> Option<&Info> {
        self.get(name).map(|e| &e.about().info)
    }

    fn is_solid(&self) -> bool {
        true
    }
}
