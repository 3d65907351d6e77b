//! Descriptions of deformations of the plane or of space: the part of a registry that reading a command line or a recipe needs.

use crate::edits;
use pathwarp::deform::{Info, Registry};
use pathwarp_solid::deform::Registry3;

/// A registry, reduced to its deformations' descriptions.
pub trait Catalogue {
    /// Returns the descriptions, in the order of help.
    fn infos(&self) -> Vec<&Info>;

    /// Returns the description of the deformation called `name`, or, in the plane, of the edit.
    fn info(&self, name: &str) -> Option<&Info>;

    /// Returns `true` for deformations of space.
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
