//! A deformation of space as the registry sees it: the trait [`Deformation3`] and the data that describes one.

use super::built::Built3;
use crate::settings::{Frame3, Settings3};
use pathwarp::Error;
use pathwarp::deform::{Info, Pairs};
use pathwarp::param::Args;

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
    /// As [`Settings3::new`] and [`Deformation3::build`].
    fn build_from(&self, args: &Args, frame: &Frame3) -> Result<Built3, Error> {
        let front = frame.front();
        self.build(&Settings3::new(self.about().info.params, args, frame, &front)?)
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
    /// With these values nothing moves.
    Identity(Pairs),
    /// Both sets of values give the same map.
    Same(Pairs, Pairs),
    /// With these values planes stay plane.
    KeepsPlanes(Pairs),
    /// With these values straight lines in this direction stay straight.
    KeepsLinesAlong(Pairs, [f64; 3]),
    /// With these values every point stays on its line through this one.
    KeepsRays(Pairs, [f64; 3]),
    /// With these values nothing moves outside the box between two corners.
    FixedOutside(Pairs, [[f64; 3]; 2]),
    /// With these values every volume is multiplied by this factor.
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
