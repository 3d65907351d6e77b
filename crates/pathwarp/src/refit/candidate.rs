//! A fitted cubic with the stretch of the image it stands for: what checks and proofs are given.

use super::frame::ChordFrame;
use super::lanes::{Lane, Lanes};
use super::source::SourceCurve;
use kurbo::Point;

/// A fitted cubic.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    /// Parameters of the stretch.
    pub(super) t0: f64,
    pub(super) t1: f64,
    /// First point; everything else is relative to it.
    pub(super) p0: Point,
    pub(super) frame: ChordFrame,
    /// Handle lengths.
    pub(super) a: f64,
    pub(super) b: f64,
}

impl Candidate {
    /// The curve's parameter at `tau` in [0, 1] of the piece.
    pub(super) fn param(&self, tau: f64) -> f64 {
        self.t0 + (self.t1 - self.t0) * tau
    }

    /// The place of the curve's parameter `t` on the piece; inside it if in [0, 1].
    pub(super) fn tau(&self, t: f64) -> f64 {
        (t - self.t0) / (self.t1 - self.t0)
    }

    /// Images at `tau`, relative to the first point.
    pub(super) fn images(&self, source: &SourceCurve<'_>, tau: &Lane) -> Result<Lanes, Point> {
        let mut t = [0.0; 8];
        for i in 0..8 {
            t[i] = self.param(tau[i]);
        }
        let mut g = source.images(&t)?;
        for i in 0..8 {
            g.x[i] -= self.p0.x;
            g.y[i] -= self.p0.y;
        }
        Ok(g)
    }
}
