//! Judges a fit: its error by the cheapest test that can decide, from eight samples to a dense check or a proof.

use crate::check::{Probe, THOROUGH_WORK, dense, probe};
use crate::fit::{Candidate, Fit, FitRequest, FitState, Measured, settled};
use crate::limits::{
    DENSE_ACCEPTED, EIGHT_ACCEPTED, EIGHT_GROWTH, FOOT_LEAD, FOOT_STEP, MAX_HALFWAY, PACE_EASY, PACE_EIGHT,
    PACE_SIXTEEN, PEAK_ACCEPTED, PEAK_FACTOR, SMALL_ERROR, SURPRISE,
};
use crate::sample::{
    ALL, CHECKED, Evenly, FITTED, Lane, Lanes, MIDDLE, SIDE, UNIT, between, highest_peak, interleaved, larger, largest,
    neighbours, predicted_peak, sum, turns_little,
};
use crate::source::{NotFinite, Source};
use crate::stretch::StretchFitter;

impl<S: Source> StretchFitter<'_, S> {
    /// The error of a fit; above the tolerance if it must be rejected.
    #[inline(never)]
    pub(crate) fn judge(&self, request: &mut FitRequest<'_>, fit: &Fit) -> Result<f64, NotFinite> {
        let fitted = settled(&request.frame, request.g, fit, self.tolerance);
        if let Some(error) = self.by_eight(request, &fitted) {
            return Ok(error);
        }
        let check = *self.checked(request)?;
        let mut s = between(&fitted.s);
        let squares = request.frame.distances(&check, fitted.z.a, fitted.z.b, &mut s, 1);
        let error = fitted.error.max(largest(&squares).sqrt());
        if error > self.tolerance {
            return Ok(error);
        }
        if self.form.is_some() {
            return self.proven(request, fitted.z, [&fitted.s, &s], error);
        }
        let checked = Measured { z: fitted.z, s, squares, error };
        let feet = interleaved(&fitted.s, &checked.s, 1.0);
        if let Some(error) = self.by_sixteen(request, &fitted, (&check, &checked), &feet)? {
            return Ok(error);
        }
        self.by_dense_check(request, fitted.z, &feet, error)
    }

    /// A small error under a map of low degree: eight samples determine the rest.
    #[inline(always)]
    fn by_eight(&self, request: &FitRequest<'_>, fitted: &Measured<'_>) -> Option<f64> {
        let limit = EIGHT_ACCEPTED * self.tolerance;
        if !(self.trusts_samples(request) && fitted.error <= limit && self.simple) {
            return None;
        }
        let error = larger(request.middle_error(fitted.z, &fitted.s, &fitted.squares), fitted.error);
        (error <= limit).then_some(EIGHT_GROWTH * error)
    }

    /// Errors predicted between sixteen samples, or between those and more halfway beside doubtful ones.
    #[inline(always)]
    fn by_sixteen(
        &self,
        request: &FitRequest<'_>,
        fitted: &Measured<'_>,
        (check, checked): (&Lanes, &Measured<'_>),
        feet: &Evenly,
    ) -> Result<Option<f64>, NotFinite> {
        let tol = self.tolerance;
        let (z, error) = (fitted.z, checked.error);
        let Resolution { resolved, even } = request.resolution(check, z, &fitted.s, &checked.s);
        if !(self.trusts_samples(request) && resolved && steady(feet) && error <= PEAK_ACCEPTED * tol) {
            return Ok(None);
        }
        let frame = &request.frame;
        let e0 = frame.signed_distances(request.g, z.a, z.b, &fitted.s, &fitted.squares);
        let e1 = frame.signed_distances(check, z.a, z.b, &checked.s, &checked.squares);
        let errors = interleaved(&e0, &e1, 0.0);
        let peak = larger(highest_peak(&errors), error);
        if peak <= if even && self.simple { PEAK_ACCEPTED } else { SMALL_ERROR } * tol {
            return Ok(Some(peak));
        }
        if !even {
            return Ok(None);
        }
        let closer = halfway(self.source, &request.candidate(z), feet, &errors, tol)?;
        Ok(closer.filter(|closer| *closer <= DENSE_ACCEPTED * tol).map(|closer| closer.max(error)))
    }

    /// Many samples.
    #[inline(never)]
    fn by_dense_check(
        &self,
        request: &FitRequest<'_>,
        z: &FitState,
        feet: &Evenly,
        error: f64,
    ) -> Result<f64, NotFinite> {
        let c = request.candidate(z);
        let (e, thorough) = dense(self.source, &c, feet, self.slow, self.tolerance)?;
        if thorough {
            self.extra.set(self.extra.get() + THOROUGH_WORK);
        }
        let e = e.max(error);
        Ok(if e > DENSE_ACCEPTED * self.tolerance { e / DENSE_ACCEPTED } else { e })
    }

    /// Returns `true` if samples may decide: no proof is wanted, and no slow spot lies in the stretch.
    #[inline(always)]
    fn trusts_samples(&self, request: &FitRequest<'_>) -> bool {
        self.form.is_none() && !request.careful
    }
}

/// Verdict on sixteen samples.
pub(crate) struct Resolution {
    /// The samples resolve image and cubic.
    pub(crate) resolved: bool,
    /// The image's speed is even besides.
    pub(crate) even: bool,
}

impl FitRequest<'_> {
    /// Tests if sixteen samples with foot points `s0`, `s1` resolve the state.
    #[inline(always)]
    pub(crate) fn resolution(&self, check: &Lanes, z: &FitState, s0: &Lane, s1: &Lane) -> Resolution {
        let ratio = self.pace_ratio(z, s0, (check, s1, &CHECKED));
        Resolution { resolved: ratio < PACE_SIXTEEN, even: ratio < PACE_EIGHT }
    }

    /// The largest error in the widest gap between the fitted samples, extrapolated from their residuals; infinite if
    /// eight samples do not resolve the state. `squares` are the squared residuals.
    #[inline(always)]
    pub(crate) fn middle_error(&self, z: &FitState, s0: &Lane, squares: &Lane) -> f64 {
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
pub(crate) fn steady(feet: &Evenly) -> bool {
    let (mut first, mut second) = ([0.0; 8], [0.0; 8]);
    for i in 0..8 {
        first[i] = feet[i + 1] - feet[i];
        second[i] = feet[i + 9] - feet[i + 8];
    }
    let longest = larger(largest(&first), largest(&second));
    larger(feet[17] - feet[16], longest) < FOOT_STEP * UNIT
}

/// The highest error predicted between sixteen samples, with eight to sixteen more wherever a sample or its prediction is
/// above its limit. `errors` are signed by their side and go with `feet`.
///
/// `None` if nearly all samples are in doubt, or if an error halfway is far from the mean of its neighbours: then sixteen
/// samples do not resolve the error.
pub(crate) fn halfway(
    source: &impl Source,
    c: &Candidate,
    feet: &Evenly,
    errors: &Evenly,
    tolerance: f64,
) -> Result<Option<f64>, NotFinite> {
    let mut all = [0.0; 2 * ALL - 1];
    let mut in_doubt = [false; ALL];
    let mut highest = 0.0f64;
    for j in 1..ALL - 1 {
        let peak = predicted_peak([errors[j - 1], errors[j], errors[j + 1]], PEAK_FACTOR);
        in_doubt[j] = errors[j].abs() > SMALL_ERROR * tolerance || peak > PEAK_ACCEPTED * tolerance;
        highest = highest.max(if in_doubt[j] { 0.0 } else { peak });
        all[2 * j] = errors[j];
    }
    let mut gaps = [0; MAX_HALFWAY];
    let mut n = 0;
    for j in 0..ALL - 1 {
        if in_doubt[j] || in_doubt[j + 1] {
            if n == MAX_HALFWAY {
                return Ok(None);
            }
            gaps[n] = j;
            n += 1;
        }
    }
    let gaps = &gaps[..n];
    for gaps in gaps.chunks(8) {
        let tau = std::array::from_fn(|i| (gaps[i.min(gaps.len() - 1)] as f64 + 0.5) / (ALL - 1) as f64);
        let Probe { g, s, squares } = probe(source, c, feet, &tau, 2)?;
        let signed = c.frame.signed_distances(&g, c.a, c.b, &s, &squares);
        for (j, e) in gaps.iter().zip(signed) {
            all[2 * j + 1] = e;
            if (e - 0.5 * (errors[*j] + errors[j + 1])).abs() > SURPRISE * tolerance {
                return Ok(None);
            }
        }
    }
    // Between neighbours half as far apart, errors exceed the parabola half as much.
    let peak = |k: usize| predicted_peak([all[k - 1], all[k], all[k + 1]], 0.5 * PEAK_FACTOR);
    let doubtful = (1..ALL - 1).filter(|j| in_doubt[*j]).map(|j| 2 * j);
    Ok(Some(gaps.iter().map(|j| 2 * j + 1).chain(doubtful).map(peak).fold(highest, f64::max)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::ChordFrame;
    use crate::source::BreakPoint;
    use kurbo::{Point, Vec2};

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

    /// The line beside the x axis at this height.
    struct Beside(f64);
    impl Source for Beside {
        fn eval(&self, t: f64) -> (Point, Vec2) {
            (Point::new(t, self.0), Vec2::new(1.0, 0.0))
        }
    }

    #[test]
    fn an_error_halfway_that_its_neighbours_do_not_predict_resolves_nothing() {
        let unit = Vec2::new(1.0, 0.0);
        let third = [1.0 / 3.0; 2];
        let frame = ChordFrame { q: unit, t0: unit, t1: unit, floor: [0.0; 2], size: 1.0, home: third, pull: 0.0 };
        let c = Candidate { t0: 0.0, t1: 1.0, p0: Point::ZERO, frame, a: third[0], b: third[1] };
        let feet = std::array::from_fn(|j| j as f64 / 17.0);
        // One sample above the limit; the error halfway beside it is `beside` of the tolerance.
        let mut errors = [0.65; ALL];
        (errors[0], errors[8], errors[ALL - 1]) = (0.0, 0.75, 0.0);
        let found = |beside: f64| halfway(&Beside(beside), &c, &feet, &errors, 1.0).unwrap();
        assert!(found(0.7).is_some_and(|e| (0.7..1.0).contains(&e)), "{:?}", found(0.7));
        assert!(found(0.45).is_some() && found(0.35).is_none());
    }
}
