//! Starts of fits along the valley of equal area, where the sum of squares has up to three minima, as Levien's quartic has roots.

use super::frame::ChordFrame;
use super::lanes::Lanes;
use super::limits::{RESTART_LONGER, RESTART_SHORTER, RESTART_TURN, RESTART_WITHIN, RESTART_WITHIN_TURNED};
use super::residuals::FitState;

impl ChordFrame {
    /// Factors for the first handle to start again with, or `None` if that would not help. Only near misses profit; and on
    /// pieces that turn much, only very near ones. The first factor makes the handles more even, which more often succeeds.
    #[inline(always)]
    pub(super) fn restarts(&self, z: &FitState, error: f64, tolerance: f64) -> Option<[f64; 2]> {
        let within = if self.t0.dot(self.t1) > RESTART_TURN { RESTART_WITHIN } else { RESTART_WITHIN_TURNED };
        let near = error > tolerance && error < within * tolerance;
        let longer_first = [RESTART_LONGER, RESTART_SHORTER];
        near.then(|| if z.a < z.b { longer_first } else { [longer_first[1], longer_first[0]] })
    }

    /// The state with the first handle `factor` times as long and the same area, if its handles are possible.
    #[inline(always)]
    pub(super) fn along_valley(&self, g: &Lanes, z: &FitState, factor: f64) -> Option<FitState> {
        let a = z.a * factor;
        let b = self.slide(z.a, z.b, a);
        if !(b > self.floor[1] && b < self.size) {
            return None;
        }
        let mut start = FitState { a, b, s: z.s };
        self.settle(g, a, b, &mut start.s);
        Some(start)
    }
}
