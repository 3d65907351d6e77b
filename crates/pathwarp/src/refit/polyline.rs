//! The polygon through the samples of a piece that missed: its length, and signs of a cusp.

use super::lanes::Lanes;
use super::limits::SHARP_PACE;
use kurbo::Vec2;

/// The polygon through the fitted samples.
pub(super) struct SamplePolygon {
    pub(super) length: f64,
    /// The polygon turns by more than 60° at a sample, or its speed varies more than [`SHARP_PACE`] times.
    pub(super) sharp: bool,
}

impl SamplePolygon {
    /// From the fitted samples and the chord.
    #[inline(always)]
    pub(super) fn new(g: &Lanes, q: Vec2) -> Self {
        let mut dx = [0.0; 9];
        let mut dy = [0.0; 9];
        dx[0] = g.x[0];
        dy[0] = g.y[0];
        for i in 1..8 {
            dx[i] = g.x[i] - g.x[i - 1];
            dy[i] = g.y[i] - g.y[i - 1];
        }
        dx[8] = q.x - g.x[7];
        dy[8] = q.y - g.y[7];
        let mut l = [0.0; 9];
        for i in 0..9 {
            l[i] = dx[i] * dx[i] + dy[i] * dy[i];
        }
        let mut bent = [false; 8];
        for i in 0..8 {
            let dot = dx[i] * dx[i + 1] + dy[i] * dy[i + 1];
            bent[i] = dot <= 0.0 || 4.0 * dot * dot < l[i] * l[i + 1];
        }
        let mut length = 0.0;
        let (mut least, mut most) = ((0, f64::INFINITY), 0.0f64);
        for (i, l2) in l.iter().enumerate() {
            let l = l2.sqrt();
            length += l;
            // Length per unit of the parameter: the end stretches are half as long, the middle one half as long again.
            let pace = l * [2.0, 1.0, 1.0, 1.0, 2.0 / 3.0, 1.0, 1.0, 1.0, 2.0][i];
            if pace < least.1 {
                least = (i, pace);
            }
            most = most.max(pace);
        }
        // At the ends the image slows down because of a short handle, which is no cusp.
        let slows = SHARP_PACE * least.1 < most && (1..8).contains(&least.0);
        Self { length, sharp: bent.iter().any(|b| *b) || slows }
    }
}
