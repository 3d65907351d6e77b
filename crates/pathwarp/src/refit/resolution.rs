//! Tests if the samples resolve a fit: if nothing of the image or the cubic can hide between them.

use super::lanes::{Lane, Lanes, larger, largest, sum};
use super::limits::{FOOT_LEAD, FOOT_STEP, PACE_EASY, PACE_EIGHT, PACE_SIXTEEN};
use super::request::FitRequest;
use super::residuals::FitState;
use super::samples::{CHECKED, Evenly, FITTED, MIDDLE, SIDE, UNIT, neighbours};
use kurbo::Vec2;

/// Verdict on sixteen samples.
pub(super) struct Resolution {
    /// The samples resolve image and cubic.
    pub(super) resolved: bool,
    /// The image's speed is even besides.
    pub(super) even: bool,
}

impl FitRequest<'_> {
    /// Tests if sixteen samples with foot points `s0`, `s1` resolve the state.
    #[inline(always)]
    pub(super) fn resolution(&self, check: &Lanes, z: &FitState, s0: &Lane, s1: &Lane) -> Resolution {
        let ratio = self.pace_ratio(z, s0, (check, s1, &CHECKED));
        Resolution { resolved: ratio < PACE_SIXTEEN, even: ratio < PACE_EIGHT }
    }

    /// The largest error in the widest gap between the fitted samples, extrapolated from their residuals; infinite if
    /// eight samples do not resolve the state. `squares` are the squared residuals.
    #[inline(always)]
    pub(super) fn middle_error(&self, z: &FitState, s0: &Lane, squares: &Lane) -> f64 {
        let next = Lanes { x: neighbours(&self.g.x), y: neighbours(&self.g.y) };
        if self.pace_ratio(z, s0, (&next, &neighbours(s0), &neighbours(&FITTED))) >= PACE_EASY {
            return f64::INFINITY;
        }
        let n = self.frame.signed_distances(self.g, z.a, z.b, s0, squares);
        let (mut left, mut right) = ([0.0; 8], [0.0; 8]);
        for i in 0..8 {
            left[i] = n[i] * MIDDLE[i];
            right[i] = n[i] * MIDDLE[7 - i];
        }
        larger(sum(&left).abs(), sum(&right).abs())
    }

    /// The squared ratio of the image's largest speed to its least; infinite unless the foot points advance evenly and the
    /// cubic's direction at every foot point is that of the image. Each fitted sample is paired with its neighbour towards
    /// the middle: that one's image, foot point and place.
    #[inline(always)]
    fn pace_ratio(&self, z: &FitState, s0: &Lane, (next, s1, set): (&Lanes, &Lane, &Lane)) -> f64 {
        let [c1, c2, c3] = self.frame.power(z.a, z.b);
        let mut margin = [0.0; 8];
        let mut pace = [0.0; 8];
        let mut slowness = [0.0; 8];
        for i in 0..8 {
            let a = FOOT_LEAD - (s0[i] - FITTED[i] * UNIT).abs();
            let b = FOOT_LEAD - (s1[i] - set[i] * UNIT).abs();
            let s = s0[i];
            let (dx, dy) = ((c3.x * 3.0 * s + c2.x * 2.0) * s + c1.x, (c3.y * 3.0 * s + c2.y * 2.0) * s + c1.y);
            let (x, y) = (next.x[i] - self.g.x[i], next.y[i] - self.g.y[i]);
            let (d2, l2) = (dx * dx + dy * dy, x * x + y * y);
            // The neighbour follows in the first half and precedes in the second.
            let along = (dx * x + dy * y) * SIDE[i];
            let order = (s1[i] - s0[i]) * SIDE[i];
            let straight = 2.0 * along * along - d2 * l2;
            // The least of all these, negated, so that one reduction tests them all.
            let m = if a < b { a } else { b };
            let m = if m < order { m } else { order };
            let m = if m < along { m } else { along };
            margin[i] = -(if m < straight { m } else { straight });
            pace[i] = l2;
            slowness[i] = -l2;
        }
        // The cubic must not turn back between the outermost foot points and its ends either.
        let slope = |s: f64| c1 + (c2 * 2.0 + c3 * (3.0 * s)) * s;
        let resolved = largest(&margin) < 0.0
            && turns_little(self.frame.t0, slope(s0[0]))
            && turns_little(slope(s0[7]), self.frame.t1);
        if resolved { largest(&pace) / -largest(&slowness) } else { f64::INFINITY }
    }
}

/// Returns `true` if the foot points step from sample to sample about as far as the samples do. A longer step means that
/// image or cubic nearly stops in between, and the distance has a corner there that may be far above its neighbours.
#[inline(always)]
pub(super) fn steady(feet: &Evenly) -> bool {
    let (mut first, mut second) = ([0.0; 8], [0.0; 8]);
    for i in 0..8 {
        first[i] = feet[i + 1] - feet[i];
        second[i] = feet[i + 9] - feet[i + 8];
    }
    let longest = larger(largest(&first), largest(&second));
    larger(feet[17] - feet[16], longest) < FOOT_STEP * UNIT
}

/// Returns `true` if two directions are less than 60° apart.
pub(super) fn turns_little(a: Vec2, b: Vec2) -> bool {
    let d = a.dot(b);
    d > 0.0 && 4.0 * d * d >= a.hypot2() * b.hypot2()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::refit::frame::ChordFrame;
    use crate::refit::samples::{ALL, between};
    use crate::refit::source::BreakPoint;
    use kurbo::Point;

    #[test]
    fn foot_points_that_leap_are_not_steady() {
        let even: Evenly = std::array::from_fn(|j| j as f64 * UNIT);
        // Foot point 6 late by a share of the spacing, so that the step after it is longer.
        let late = |share: f64| -> Evenly {
            let mut feet = even;
            feet[6] -= share * UNIT;
            feet
        };
        assert!(steady(&even) && steady(&late(0.55)));
        assert!(!steady(&late(0.65)));
        assert_eq!(ALL, 18);
    }

    /// The verdict on images at `x(τ)` of a line from 0 to 1, fitted by the line itself with foot points `s(τ)`.
    fn verdict(x: impl Fn(f64) -> f64, s: impl Fn(f64) -> f64) -> Resolution {
        let unit = Vec2::new(1.0, 0.0);
        let end = |t: f64| BreakPoint { t, p: Point::new(t, 0.0), speed: 1.0, into: unit, away: unit };
        let (from, to) = (end(0.0), end(1.0));
        let handles = [1.0 / 3.0; 2];
        let frame = ChordFrame { q: unit, t0: unit, t1: unit, floor: [0.0; 2], size: 1.0, home: handles, pull: 0.0 };
        let images = |set: &Lane| Lanes { x: set.map(|j| x(j * UNIT)), y: [0.0; 8] };
        let (g, check) = (images(&FITTED), images(&CHECKED));
        let request = FitRequest { from: &from, to: &to, frame, g: &g, check: None, ds: [0.0; 8], careful: false };
        let s0 = FITTED.map(|j| s(j * UNIT));
        let z = FitState { a: handles[0], b: handles[1], s: s0 };
        let s1 = between(&s0);
        request.resolution(&check, &z, &s0, &s1)
    }

    #[test]
    fn foot_points_far_from_even_ones_are_not_resolved() {
        // Ahead of the samples by up to 0.17 and 0.19.
        let ahead = |by: f64| verdict(|t| t, |t| t + 4.0 * by * t * (1.0 - t));
        assert!(ahead(0.17).resolved && !ahead(0.19).resolved);
    }

    #[test]
    fn uneven_speed_is_seen() {
        // Speed proportional to a power of τ: over the samples it varies 3.2, 6.5 and 16 times.
        let slowing = |power: f64| verdict(|t| t.powf(power), |t| t);
        assert!(slowing(1.5).resolved && slowing(1.5).even);
        assert!(slowing(1.8).resolved && !slowing(1.8).even);
        assert!(!slowing(2.2).resolved);
    }
}
