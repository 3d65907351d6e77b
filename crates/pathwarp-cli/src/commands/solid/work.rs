//! The shared state of a run over models, and the outcome for one model.

use super::args::Own;
use crate::advice::{self, Flags};
use crate::failure::Failure;
use crate::options::CommonOptions;
use crate::output::PendingFile;
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::recipe::Recipe;
use pathwarp::{Error, GeometryError};
use pathwarp_solid::deform::Registry3;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::recipe::{self, BuiltRecipe3};
use pathwarp_solid::{Box3, Frame3};
use std::path::Path;
use std::sync::Arc;

/// A run with everything looked up.
pub(super) struct Work<'a> {
    pub(super) registry: &'a Registry3,
    pub(super) recipe: &'a Recipe,
    pub(super) options: &'a CommonOptions,
    pub(super) own: &'a Own,
    pub(super) flags: &'a Flags,
}

/// A model that was deformed.
pub(super) struct Done {
    pub(super) files: Vec<PendingFile>,
    pub(super) warnings: Vec<String>,
    pub(super) notes: Vec<String>,
    /// Omitted unless one is wanted.
    pub(super) report: Option<String>,
    /// Something was left out or missed the tolerance.
    pub(super) partial: bool,
}

impl Work<'_> {
    /// Builds the recipe for a model called `name` with these points.
    pub(super) fn build(
        &self,
        name: &str,
        bounds: Option<Box3>,
        points: &[DVec3],
        budget: &Arc<Budget>,
    ) -> Result<(Frame3, BuiltRecipe3), Failure> {
        let bounds = bounds.unwrap_or(Box3 { min: DVec3::ZERO, max: DVec3::ZERO });
        let frame = Frame3::new(self.own.frame.unwrap_or(bounds));
        let built = recipe::build_within(self.recipe, self.registry, frame, points, budget).map_err(|e| match e {
            Error::Geometry(GeometryError::Limit(e)) => too_much(name, &e),
            other => Failure::of_recipe(other),
        })?;
        Ok((frame, built))
    }

    /// Notes on the frame and the steps.
    pub(super) fn notes(&self, frame: &Frame3, built: &BuiltRecipe3) -> Vec<String> {
        let size = frame.bounds.size();
        let first = format!("box: {:.6} × {:.6} × {:.6}", size.x, size.y, size.z);
        let steps = built.steps.iter().flat_map(|s| &s.notes).map(|n| self.flags.in_text(n));
        std::iter::once(first).chain(steps).collect()
    }

    /// Warnings of the steps.
    pub(super) fn warnings(&self, built: &BuiltRecipe3) -> Vec<String> {
        built.steps.iter().flat_map(|s| &s.warnings).map(|w| self.flags.in_text(w)).collect()
    }

    /// Files that parameters ask for, such as a saved lattice.
    pub(super) fn saves(built: &BuiltRecipe3) -> Result<Vec<PendingFile>, Failure> {
        let save = |f: &pathwarp::deform::SavedFile| PendingFile::new(Path::new(&f.name), f.text.as_bytes());
        built.steps.iter().flat_map(|s| &s.saves).map(save).collect()
    }
}

/// Fails if searches for an inverse have exceeded the limit. Nothing that was computed with it is used, not even another error.
pub(super) fn check(name: &str, built: &BuiltRecipe3) -> Result<(), Failure> {
    built.exceeded().map_or(Ok(()), |e| Err(too_much(name, &e)))
}

/// The failure of a map that takes too much work.
fn too_much(name: &str, e: &Exceeded) -> Failure {
    Failure::Geometry(format!("{name}: deforming takes {e}; {}", advice::raise(e)))
}

/// The failure of a point without image.
pub(super) fn undefined(name: &str, what: &str, DVec3 { x, y, z }: DVec3) -> Failure {
    Failure::Geometry(format!(
        "{name}: {what} at {x:.6},{y:.6},{z:.6} has no image: the map is infinite or undefined there; move its control points \
         less, or choose another eye or region"
    ))
}

/// A place in a message.
pub(super) fn shown(p: DVec3) -> String {
    format!("{:.6},{:.6},{:.6}", p.x, p.y, p.z)
}
