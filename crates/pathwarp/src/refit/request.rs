//! One request for a fit: a stretch of the image between two break points, with its samples.

use super::candidate::Candidate;
use super::frame::ChordFrame;
use super::lanes::{Lane, Lanes};
use super::residuals::FitState;
use super::source::BreakPoint;
use kurbo::CubicBez;

/// The data of one request.
pub(super) struct FitRequest<'a> {
    pub(super) from: &'a BreakPoint,
    pub(super) to: &'a BreakPoint,
    pub(super) frame: ChordFrame,
    /// Images at the fitted samples, relative to the first point.
    pub(super) g: &'a Lanes,
    /// Images at the checked samples; taken on demand.
    pub(super) check: Option<Lanes>,
    /// Newton steps of the foot points on the Hermite cubic.
    pub(super) ds: Lane,
    /// Forces a dense check.
    pub(super) careful: bool,
}

impl FitRequest<'_> {
    /// The cubic of a state.
    pub(super) fn cubic(&self, z: &FitState) -> CubicBez {
        self.frame.cubic(self.from.p, self.to.p, z.a, z.b)
    }

    /// A state as checks and proofs want it.
    pub(super) fn candidate(&self, z: &FitState) -> Candidate {
        Candidate { t0: self.from.t, t1: self.to.t, p0: self.from.p, frame: self.frame, a: z.a, b: z.b }
    }

    /// The Hermite cubic.
    #[inline(always)]
    pub(super) fn hermite(&self) -> CubicBez {
        let [a, b] = self.frame.home;
        self.frame.cubic(self.from.p, self.to.p, a, b)
    }
}
