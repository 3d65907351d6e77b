//! Finds the place where the image nearly stops.

use super::limits::{CUSP_MARGIN, CUSP_SPEED};
use super::source::BreakPoint;
use super::stretch::StretchFitter;

/// Samples of the search; golden sections then close in on the minimum.
const SAMPLES: usize = 48;
const SECTIONS: usize = 60;

/// Work of an evaluation that is not one of a batch.
const SINGLY: usize = 2;

impl StretchFitter<'_> {
    /// The parameter at which the image is slowest within the stretch of the given length, if it nearly stops there.
    #[cold]
    pub(super) fn cusp(&self, from: &BreakPoint, to: &BreakPoint, length: f64) -> Option<f64> {
        self.extra.set(self.extra.get() + SINGLY * SAMPLES);
        let h = to.t - from.t;
        let speed = |tau: f64| self.source.image(from.t + h * tau).1.hypot() * h;
        let mut best = (0, f64::INFINITY);
        for i in 1..SAMPLES {
            let v = speed(i as f64 / SAMPLES as f64);
            if v < best.1 {
                best = (i, v);
            }
        }
        // Towards a cusp the speed falls linearly: half a sample away it is already far below this.
        if best.1 > 2.0 * CUSP_SPEED * length {
            return None;
        }
        let (mut lo, mut hi) = ((best.0 as f64 - 1.0) / SAMPLES as f64, (best.0 as f64 + 1.0) / SAMPLES as f64);
        self.extra.set(self.extra.get() + SINGLY * 2 * SECTIONS);
        const GOLD: f64 = 0.381_966_011_250_105;
        for _ in 0..SECTIONS {
            let (a, b) = (lo + GOLD * (hi - lo), hi - GOLD * (hi - lo));
            if speed(a) <= speed(b) { hi = b } else { lo = a }
        }
        let tau = 0.5 * (lo + hi);
        let inside = tau > CUSP_MARGIN && tau < 1.0 - CUSP_MARGIN;
        (speed(tau) < CUSP_SPEED * length && inside).then_some(from.t + h * tau)
    }
}
