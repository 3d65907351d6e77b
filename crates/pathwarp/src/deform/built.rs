//! The result of building a deformation: the map, and everything about it that is not a map.

use crate::error::Error;
use crate::map::Map;
use kurbo::{Affine, BezPath, Point};
use std::fmt;
use std::sync::Arc;

/// A deformation with its parameters settled.
#[derive(Clone)]
#[non_exhaustive]
pub struct Built {
    /// The map.
    pub map: Arc<dyn Map>,
    /// Notes, warnings and guides for the user.
    pub explanation: Explanation,
    /// Copies and letters, which are placed before the map or instead of it.
    pub placement: Placement,
    /// A ray in the image plane where the map brings two edges of the artwork together.
    pub seam: Option<Seam>,
    /// Files requested by parameters of kind [`Save`](crate::param::Kind::Save).
    pub saves: Vec<SavedFile>,
    /// The surface in space that the artwork lies on, for deformations onto surfaces.
    pub space: Option<InSpace>,
    /// Says why the map is undefined at a point, where it can.
    pub undefined: Option<Undefined>,
    /// Says how the map failed after it was built, for maps that can.
    pub failure: Option<Failure>,
}

/// The reason why a map is undefined at a point of its source plane; `None` if it is defined there.
pub type Undefined = Arc<dyn Fn(Point) -> Option<String> + Send + Sync>;

/// The failure of a map that asks another program; `None` while there is none. A map that has failed gives NaN.
pub type Failure = Arc<dyn Fn() -> Option<Error> + Send + Sync>;

impl Built {
    /// Wraps a map that needs no explanation.
    #[must_use]
    pub fn new(map: Arc<dyn Map>) -> Self {
        Self {
            map,
            explanation: Explanation::default(),
            placement: Placement::default(),
            seam: None,
            saves: Vec::new(),
            space: None,
            undefined: None,
            failure: None,
        }
    }

    /// Adds a note.
    pub fn note(&mut self, text: impl Into<String>) {
        self.explanation.notes.push(text.into());
    }

    /// Adds a warning.
    pub fn warn(&mut self, text: impl Into<String>) {
        self.explanation.warnings.push(text.into());
    }

    /// Adds a guide for the preview.
    pub fn overlay(&mut self, role: Role, path: BezPath) {
        self.explanation.overlays.push(Overlay { role, path });
    }

    /// Returns the same with this explanation.
    #[must_use]
    pub fn explained(self, explanation: Explanation) -> Self {
        Self { explanation, ..self }
    }
}

impl fmt::Debug for Built {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Built")
            .field("class", &self.map.class())
            .field("explanation", &self.explanation)
            .field("placement", &self.placement)
            .field("seam", &self.seam)
            .field("saves", &self.saves)
            .finish_non_exhaustive()
    }
}

/// Notes, warnings and guides for the user.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Explanation {
    /// Decisions made on the user's behalf.
    pub notes: Vec<String>,
    /// Problems the user should know of.
    pub warnings: Vec<String>,
    /// Guides that a preview draws over the artwork.
    pub overlays: Vec<Overlay>,
}

/// A guide for the preview.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// The part it plays.
    pub role: Role,
    /// The curve, in the order in which the deformation uses its anchors.
    pub path: BezPath,
}

/// The part that an overlay plays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The cage the artwork is bent into.
    Cage,
    /// The part of the source that the deformation takes hold of.
    Base,
    /// The image of the base.
    Target,
}

/// Copies and letters. Only the first step of a recipe can have a placement, and its inverse has none.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Placement {
    /// The positions of the artwork's copies in the source plane, the original included. A map gives every point one image, so
    /// copies are made before it. Empty: the artwork alone.
    pub copies: Vec<Affine>,
    /// For every letter of the frame, one affine map per copy of the artwork, which replaces the map for that letter. Empty:
    /// the map takes the letters as well.
    pub letters: Vec<Vec<Affine>>,
}

/// A ray in the image plane where the map brings two edges of the artwork together. The inverse map tears apart artwork that
/// crosses it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seam {
    /// The ray's end.
    pub end: Point,
    /// Another point of the ray.
    pub through: Point,
}

/// A file to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SavedFile {
    /// Its name as the user gave it.
    pub name: String,
    /// Its contents.
    pub text: String,
}

/// The surface in space that the artwork lies on.
#[derive(Clone)]
pub struct InSpace {
    /// Takes a point of the source to the surface: x right, y down, z away, user units. `None` where the ray misses the
    /// surface.
    pub place: Arc<dyn Fn(Point) -> Option<[f64; 3]> + Send + Sync>,
    /// Files requested by the parameters.
    pub files: Vec<SpaceFile>,
}

impl fmt::Debug for InSpace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("InSpace").field("files", &self.files).finish_non_exhaustive()
    }
}

/// A file of the artwork on its surface.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SpaceFile {
    /// The parameter that asked for it.
    pub param: &'static str,
    /// Its name as the user gave it.
    pub name: String,
    /// Filled shapes as a mesh, rather than outlines as polylines.
    pub filled: bool,
}
