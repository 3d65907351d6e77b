//! The interface between deformations of space and the registry: the trait [`Deformation3`] and the data that describes one.

use crate::map::Map3;
use crate::settings::{Frame3, Settings3};
use glam::DVec3;
use pathwarp::Error;
use pathwarp::deform::{Info, Pairs, SavedFile};
use pathwarp::param::Args;
use std::fmt;
use std::sync::Arc;

/// An entry of the registry: turns [`Args`] in a [`Frame3`] into a map of space.
pub trait Deformation3: Send + Sync {
    /// Returns the deformation's description, for people and programs.
    fn about(&self) -> &About3;

    /// Builds the map for these settings.
    ///
    /// # Errors
    /// [`Error::Usage`] for values that contradict each other or are out of range.
    fn build(&self, settings: &Settings3<'_>) -> Result<Built3, Error>;

    /// Checks `args` against the parameter table and builds the map.
    ///
    /// # Errors
    /// [`Error::Usage`] or [`Error::Missing`] for arguments that do not fit the table, and the errors of [`Deformation3::build`].
    fn build_from(&self, args: &Args, frame: &Frame3) -> Result<Built3, Error> {
        let front = frame.front();
        self.build(&Settings3::new(self.about().info.params, args, frame, &front)?)
    }
}

/// A deformation of this crate: its description, and the function that builds it for settings.
pub(crate) struct Entry(pub(crate) &'static About3, pub(crate) fn(&Settings3<'_>) -> Result<Built3, Error>);

impl Deformation3 for Entry {
    fn about(&self) -> &About3 {
        self.0
    }

    fn build(&self, settings: &Settings3<'_>) -> Result<Built3, Error> {
        (self.1)(settings)
    }
}

/// The description of a deformation of space.
#[derive(Debug, Clone, Copy)]
pub struct About3 {
    /// Name, help, parameters and examples, as for the plane. The demo is for a model in the box from 0,0,0 to 100,100,100.
    pub info: Info,
    /// Properties of every instance; [`check::entry`](crate::check::entry) tests them.
    pub laws: &'static [Law3],
    /// Values known from elsewhere; [`check::entry`](crate::check::entry) tests them.
    pub cases: &'static [Case3],
}

/// A property of a deformation that [`check::entry`](crate::check::entry) tests.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum Law3 {
    /// With these values, nothing moves.
    Identity(Pairs),
    /// Both sets of values give the same map.
    Same(Pairs, Pairs),
    /// With these values, planes stay plane.
    KeepsPlanes(Pairs),
    /// With these values, straight lines in this direction stay straight.
    KeepsLinesAlong(Pairs, [f64; 3]),
    /// With these values, every point stays on its line through this one.
    KeepsRays(Pairs, [f64; 3]),
    /// With these values, nothing moves outside the box between two corners.
    FixedOutside(Pairs, [[f64; 3]; 2]),
    /// With these values, every volume is multiplied by this factor.
    Volume(Pairs, f64),
}

/// A point whose image is known.
#[derive(Debug, Clone, Copy)]
pub struct Case3 {
    /// The parameters, in the frame from 0,0,0 to 100,100,100.
    pub args: Pairs,
    /// A point of the source.
    pub at: [f64; 3],
    /// Its image.
    pub to: [f64; 3],
    /// The largest distance between the computed image and [`to`](Self::to).
    pub tolerance: f64,
}

/// The result of building a deformation of space: the map, and notes about it.
#[derive(Clone)]
#[non_exhaustive]
pub struct Built3 {
    /// The map.
    pub map: Arc<dyn Map3>,
    /// Decisions made on the user's behalf.
    pub notes: Vec<String>,
    /// Problems that the user should know about.
    pub warnings: Vec<String>,
    /// Polylines for a preview: control nets, skeletons, rays.
    pub guides: Vec<Vec<DVec3>>,
    /// The point from which a model looks unchanged, if there is one.
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
