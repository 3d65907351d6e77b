//! Judges a fit: finds its error by the cheapest test that can decide, from eight samples to a closer check or a proof.
//!
//! - [`dense`] takes 64 samples, and closer ones around every maximum.
//! - [`thorough`] takes 160 samples each way and searches for every nearest point. It serves where foot points cannot be followed along
//!   the cubic, or where the cubic turns sharply between two of them.

use crate::fit::{Candidate, FOOT_ROUNDING, Fit, FitRequest, FitState, Measured, settled};
use crate::limits::{
    ACCEPTED, DENSE_BATCHES, FOOT_LEAD, FOOT_LEAP, FOOT_STEP, MAX_HALFWAY, PACE_EIGHT, PACE_SIXTEEN, PEAK_FACTOR,
    PEAK_NEAR, SMALL_ERROR, THOROUGH_SAMPLES, ZOOM_RISE,
};
use crate::sample::{
    CHECKED, FITTED, IN_ORDER, InOrder, Lane, Lanes, MIDDLE, SIDE, UNIT, feet_between, highest_peak, interleaved,
    larger, largest, neighbours, parabola_peak, predicted_peak, sum, turns_little,
};
use crate::source::{Result, SlowSpots, Source};
use crate::stretch::{EIGHT_GROWTH, StretchFitter, THOROUGH_WORK};
use kurbo::Vec2;

impl<S: Source> StretchFitter<'_, S> {
    /// Error of a fit; above the tolerance if the fit must be rejected.
    #[inline(never)]
    pub(crate) fn judge(&self, request: &mut FitRequest<'_>, fit: &Fit) -> Result<f64> {
        // The foot points after the Newton step that is left, and the errors there.
        let fitted = settled(&request.frame, request.g, fit, self.tolerance);
        if let Some(error) = self.by_eight(request, &fitted) {
            return Ok(error);
        }
        let check = self.checked(request)?;
        let mut s = feet_between(&fitted.s);
        let squares = request.frame.distances(&check, fitted.state.a, fitted.state.b, &mut s, 1);
        let error = fitted.error.max(largest(&squares).sqrt());
        if error > self.tolerance {
            return Ok(error);
        }
        if self.form.is_some() {
            return self.proven(request, fitted.state, [&fitted.s, &s], error);
        }
        let checked = Measured { state: fitted.state, s, squares, error };
        let feet = interleaved(&fitted.s, &checked.s, 1.0);
        if let Some(error) = self.by_sixteen(request, &fitted, (&check, &checked), &feet)? {
            return Ok(error);
        }
        self.by_dense_check(request, fitted.state, &feet, error)
    }

    /// Error by eight samples, which suffice if it is small and the map of low degree. `None` if they do not.
    #[inline(always)]
    fn by_eight(&self, request: &FitRequest<'_>, fitted: &Measured<'_>) -> Option<f64> {
        let limit = SMALL_ERROR * self.tolerance;
        if !(self.trusts_samples(request) && fitted.error <= limit && self.simple) {
            return None;
        }
        let error = larger(request.middle_error(fitted.state, &fitted.s, &fitted.squares), fitted.error);
        (error <= limit).then_some(EIGHT_GROWTH * error)
    }

    /// Error by sixteen samples, with peaks predicted between them, and more samples beside doubtful ones. `None` if that cannot decide.
    #[inline(always)]
    fn by_sixteen(
        &self,
        request: &FitRequest<'_>,
        fitted: &Measured<'_>,
        (check, checked): (&Lanes, &Measured<'_>),
        feet: &InOrder,
    ) -> Result<Option<f64>> {
        let tol = self.tolerance;
        let (state, error) = (fitted.state, checked.error);
        let Resolution { resolved, even } = request.resolution(check, state, &fitted.s, &checked.s);
        // A map of unknown degree may swing where the image slows down.
        let resolved = if self.simple { resolved } else { even };
        if !(self.trusts_samples(request) && resolved && steady(feet) && error <= ACCEPTED * tol) {
            return Ok(None);
        }
        let frame = &request.frame;
        let e0 = frame.signed_distances(request.g, state.a, state.b, &fitted.s, &fitted.squares);
        let e1 = frame.signed_distances(check, state.a, state.b, &checked.s, &checked.squares);
        let errors = interleaved(&e0, &e1, 0.0);
        let peak = larger(highest_peak(&errors), error);
        if peak <= if even && self.simple { ACCEPTED } else { SMALL_ERROR } * tol {
            return Ok(Some(peak));
        }
        if !even {
            return Ok(None);
        }
        let closer = halfway(self.source, &request.candidate(state), feet, &errors, tol)?;
        Ok(closer.filter(|closer| *closer <= ACCEPTED * tol).map(|closer| closer.max(error)))
    }

    /// Error by many samples; above the tolerance if it exceeds the share [`ACCEPTED`] for errors at samples.
    #[inline(never)]
    fn by_dense_check(&self, request: &FitRequest<'_>, state: &FitState, feet: &InOrder, error: f64) -> Result<f64> {
        let c = request.candidate(state);
        let (dense_error, was_thorough) = dense(self.source, &c, feet, self.slow, self.tolerance)?;
        if was_thorough {
            self.extra.set(self.extra.get() + THOROUGH_WORK);
        }
        let error = dense_error.max(error);
        Ok(if error > ACCEPTED * self.tolerance { error / ACCEPTED } else { error })
    }

    /// Returns `true` if samples may decide: no proof is wanted, and no slow spot lies in the stretch.
    #[inline(always)]
    fn trusts_samples(&self, request: &FitRequest<'_>) -> bool {
        self.form.is_none() && !request.careful
    }
}

/// Verdict on sixteen samples.
pub(crate) struct Resolution {
    /// Set if the samples resolve image and cubic: the image's speed varies by less than [`PACE_SIXTEEN`].
    pub(crate) resolved: bool,
    /// Set if they do and the speed varies by less than [`PACE_EIGHT`].
    pub(crate) even: bool,
}

impl FitRequest<'_> {
    /// Tests if sixteen samples with foot points `s0`, `s1` resolve the state.
    #[inline(always)]
    pub(crate) fn resolution(&self, check: &Lanes, state: &FitState, s0: &Lane, s1: &Lane) -> Resolution {
        let ratio = self.pace_ratio(state, s0, (check, s1, &CHECKED));
        Resolution { resolved: ratio < PACE_SIXTEEN, even: ratio < PACE_EIGHT }
    }

    /// Largest error in the two widest gaps between the fitted samples, extrapolated from their residuals, whose squares are `squares`.
    /// Infinite if eight samples do not resolve the state.
    #[inline(always)]
    pub(crate) fn middle_error(&self, state: &FitState, s0: &Lane, squares: &Lane) -> f64 {
        let next = Lanes { x: neighbours(&self.g.x), y: neighbours(&self.g.y) };
        if self.pace_ratio(state, s0, (&next, &neighbours(s0), &neighbours(&FITTED))) >= PACE_EIGHT {
            return f64::INFINITY;
        }
        let n = self.frame.signed_distances(self.g, state.a, state.b, s0, squares);
        let (mut left, mut right) = ([0.0; 8], [0.0; 8]);
        for i in 0..8 {
            left[i] = n[i] * MIDDLE[i];
            right[i] = n[i] * MIDDLE[7 - i];
        }
        larger(sum(&left).abs(), sum(&right).abs())
    }

    /// Squared ratio of the image's largest speed to its least; infinite unless the foot points advance evenly and the cubic's direction
    /// at every foot point is nearly that of the image. Each fitted sample is paired with its neighbour towards the middle: the
    /// neighbours' images, foot points and parameters (in units of 1/17) are the last argument.
    #[inline(always)]
    fn pace_ratio(&self, state: &FitState, s0: &Lane, (next, s1, set): (&Lanes, &Lane, &Lane)) -> f64 {
        let [c1, c2, c3] = self.frame.power(state.a, state.b);
        let mut margin = [0.0; 8];
        let mut pace = [0.0; 8];
        let mut slowness = [0.0; 8];
        for i in 0..8 {
            let lead0 = FOOT_LEAD - (s0[i] - FITTED[i] * UNIT).abs();
            let lead1 = FOOT_LEAD - (s1[i] - set[i] * UNIT).abs();
            let s = s0[i];
            let (dx, dy) = ((c3.x * 3.0 * s + c2.x * 2.0) * s + c1.x, (c3.y * 3.0 * s + c2.y * 2.0) * s + c1.y);
            let (x, y) = (next.x[i] - self.g.x[i], next.y[i] - self.g.y[i]);
            let (speed2, pace2) = (dx * dx + dy * dy, x * x + y * y);
            // The neighbour follows in the first half and precedes in the second.
            let along = (dx * x + dy * y) * SIDE[i];
            let order = (s1[i] - s0[i]) * SIDE[i];
            // Positive up to 45° between the cubic's direction and the neighbour's.
            let straight = 2.0 * along * along - speed2 * pace2;
            // The least of all these, negated, so that one reduction tests them all.
            let least = if lead0 < lead1 { lead0 } else { lead1 };
            let least = if least < order { least } else { order };
            let least = if least < along { least } else { along };
            margin[i] = -(if least < straight { least } else { straight });
            pace[i] = pace2;
            slowness[i] = -pace2;
        }
        // The cubic must not turn back between its ends and the outermost foot points either.
        let slope = |s: f64| c1 + (c2 * 2.0 + c3 * (3.0 * s)) * s;
        let resolved = largest(&margin) < 0.0
            && turns_little(self.frame.t0, slope(s0[0]))
            && turns_little(slope(s0[7]), self.frame.t1);
        if resolved { largest(&pace) / -largest(&slowness) } else { f64::INFINITY }
    }
}

/// Returns `true` if the foot points step from sample to sample about as far as the samples do. A longer step means that
/// image or cubic nearly stops in between. There the distance has a corner, which may be far above the errors beside it.
#[inline(always)]
pub(crate) fn steady(feet: &InOrder) -> bool {
    let (mut first, mut second) = ([0.0; 8], [0.0; 8]);
    for i in 0..8 {
        first[i] = feet[i + 1] - feet[i];
        second[i] = feet[i + 9] - feet[i + 8];
    }
    let longest = larger(largest(&first), largest(&second));
    larger(feet[17] - feet[16], longest) < FOOT_STEP * UNIT
}

/// The highest error predicted between sixteen samples, with up to sixteen more wherever a sample or its prediction is
/// above its limit. `errors` are signed by the side of the cubic and go with `feet`.
///
/// `None` if nearly all samples are in doubt, or if an error halfway is further than [`HALFWAY_DEVIATION`] from the mean of its
/// neighbours: then sixteen samples do not resolve the error.
pub(crate) fn halfway(
    source: &impl Source,
    c: &Candidate,
    feet: &InOrder,
    errors: &InOrder,
    tolerance: f64,
) -> Result<Option<f64>> {
    let mut all = [0.0; 2 * IN_ORDER - 1];
    let mut in_doubt = [false; IN_ORDER];
    let mut highest = 0.0f64;
    for j in 1..IN_ORDER - 1 {
        let peak = predicted_peak([errors[j - 1], errors[j], errors[j + 1]], PEAK_FACTOR);
        in_doubt[j] = errors[j].abs() > SMALL_ERROR * tolerance || peak > ACCEPTED * tolerance;
        highest = highest.max(if in_doubt[j] { 0.0 } else { peak });
        all[2 * j] = errors[j];
    }
    let mut gaps = [0; MAX_HALFWAY];
    let mut n = 0;
    for j in 0..IN_ORDER - 1 {
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
        let tau = std::array::from_fn(|i| (gaps[i.min(gaps.len() - 1)] as f64 + 0.5) / (IN_ORDER - 1) as f64);
        let Probe { g, s, squares } = probe(source, c, feet, &tau, 2)?;
        let signed = c.frame.signed_distances(&g, c.a, c.b, &s, &squares);
        for (j, e) in gaps.iter().zip(signed) {
            all[2 * j + 1] = e;
            if (e - 0.5 * (errors[*j] + errors[j + 1])).abs() > HALFWAY_DEVIATION * tolerance {
                return Ok(None);
            }
        }
    }
    // Between neighbours half as far apart, errors exceed the parabola half as much.
    let peak = |k: usize| predicted_peak([all[k - 1], all[k], all[k + 1]], 0.5 * PEAK_FACTOR);
    let doubtful = (1..IN_ORDER - 1).filter(|j| in_doubt[*j]).map(|j| 2 * j);
    Ok(Some(gaps.iter().map(|j| 2 * j + 1).chain(doubtful).map(peak).fold(highest, f64::max)))
}

/// Difference, in tolerances, of an error halfway from the mean of its neighbours up to which sixteen samples resolve the error.
const HALFWAY_DEVIATION: f64 = 0.3;

/// Newton steps from the nearest point of the chords through the samples, and further ones where the error is above the tolerance.
const STEPS: usize = 2;
const MORE_STEPS: usize = 4;

/// Hausdorff distance between candidate and image, by sampling: for each point the nearest sample by search, the nearest point of the
/// chords beside that, then Newton steps. Omitted steps only make distances larger.
#[cold]
pub(crate) fn thorough(source: &impl Source, c: &Candidate, slow: &SlowSpots, tolerance: f64) -> Result<f64> {
    let taus = thorough_parameters(c, slow);
    let mut images = Vec::with_capacity(taus.len() / 8);
    let lanes = taus.chunks_exact(8).map(|chunk| std::array::from_fn(|i| c.param(chunk[i])));
    Source::announce(&mut lanes.map(|t| (source, t)), &mut std::iter::empty());
    for chunk in taus.chunks_exact(8) {
        let tau: Lane = std::array::from_fn(|i| chunk[i]);
        images.push(c.images(source, &tau)?);
    }
    let [c1, c2, c3] = c.frame.power(c.a, c.b);
    let at = |s: f64| (c1 + (c2 + c3 * s) * s) * s;
    let curve: Vec<Vec2> = (0..=THOROUGH_SAMPLES).map(|i| at(i as f64 / THOROUGH_SAMPLES as f64)).collect();
    let enough = tolerance * tolerance;
    let worst = from_image(c, &images, &curve, enough);
    let images: Vec<Vec2> = images.iter().flat_map(|g| (0..8).map(|i| Vec2::new(g.x[i], g.y[i]))).collect();
    let images = SampledCurve { parameters: &taus, points: &images };
    Ok(from_cubic(source, c, &curve, &images, enough, worst)?.sqrt())
}

/// Evenly spaced parameters, with geometrically denser ones around slow spots, in order. Their number is a multiple of eight.
fn thorough_parameters(c: &Candidate, slow: &SlowSpots) -> Vec<f64> {
    let mut taus: Vec<f64> = (0..=THOROUGH_SAMPLES).map(|i| i as f64 / THOROUGH_SAMPLES as f64).collect();
    for spot in slow.all().iter().map(|t| c.tau(*t)).filter(|tau| *tau > 0.0 && *tau < 1.0) {
        taus.push(spot);
        // The nearest are a two-thousandth of the spacing away.
        let mut distance = 1.0 / THOROUGH_SAMPLES as f64;
        for _ in 0..16 {
            taus.extend([spot - distance, spot + distance].into_iter().filter(|t| (0.0..=1.0).contains(t)));
            distance *= 0.6;
        }
    }
    taus.sort_by(f64::total_cmp);
    taus.resize(taus.len().next_multiple_of(8), 1.0);
    taus
}

/// The sample of `set` nearest to `p` and its squared distance. Descends from the sample `from`; if the squared distance remains above
/// `enough`, searches all.
fn nearest(set: &[Vec2], from: usize, p: Vec2, enough: f64) -> (usize, f64) {
    let square = |i: usize| (set[i] - p).hypot2();
    let (mut nearest, mut least) = (from, square(from));
    while nearest + 1 < set.len() && square(nearest + 1) < least {
        nearest += 1;
        least = square(nearest);
    }
    // After a step ahead, samples behind are farther.
    while nearest <= from && nearest > 0 && square(nearest - 1) < least {
        nearest -= 1;
        least = square(nearest);
    }
    if least > enough {
        for i in 0..set.len() {
            if square(i) < least {
                (nearest, least) = (i, square(i));
            }
        }
    }
    (nearest, least)
}

/// Samples of a curve.
struct SampledCurve<'a> {
    parameters: &'a [f64],
    points: &'a [Vec2],
}

impl SampledCurve<'_> {
    /// Parameter of the point nearest to `p` on the two chords at sample `i`, and the derivative along that chord.
    fn beside(&self, i: usize, p: Vec2) -> (f64, Vec2) {
        let r = p - self.points[i];
        let along = |j: usize| (j, r.dot(self.points[j] - self.points[i]));
        let ahead = along((i + 1).min(self.points.len() - 1));
        let (j, dot) = if ahead.1 > 0.0 { ahead } else { along(i.saturating_sub(1)) };
        let (v, h) = (self.points[j] - self.points[i], self.parameters[j] - self.parameters[i]);
        let share = (dot / (v.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (self.parameters[i] + share * h, if h == 0.0 { Vec2::ZERO } else { v / h })
    }
}

/// Largest squared distance of an image from the cubic, whose samples are `curve`. A squared distance up to `enough` need not be refined.
fn from_image(c: &Candidate, images: &[Lanes], curve: &[Vec2], enough: f64) -> f64 {
    let parameters: [f64; THOROUGH_SAMPLES + 1] = std::array::from_fn(|i| i as f64 / THOROUGH_SAMPLES as f64);
    let sampled = SampledCurve { parameters: &parameters, points: curve };
    let mut last = 0;
    let mut worst = 0.0;
    for g in images {
        let mut s = [0.0; 8];
        for i in 0..8 {
            let p = Vec2::new(g.x[i], g.y[i]);
            last = nearest(curve, last, p, enough).0;
            s[i] = sampled.beside(last, p).0;
        }
        let mut squares = c.frame.distances(g, c.a, c.b, &mut s, STEPS);
        if largest(&squares) > enough {
            squares = c.frame.distances(g, c.a, c.b, &mut s, MORE_STEPS);
        }
        worst = larger(worst, largest(&squares));
    }
    worst
}

/// Largest squared distance of a point of the cubic from the image, or `worst` if that is larger.
fn from_cubic(
    source: &impl Source,
    c: &Candidate,
    curve: &[Vec2],
    images: &SampledCurve<'_>,
    enough: f64,
    mut worst: f64,
) -> Result<f64> {
    let mut last = 0;
    let mut waiting = Vec::with_capacity(8);
    for q in curve {
        let square;
        (last, square) = nearest(images.points, last, *q, enough);
        // A distance below the known error need not be refined.
        if square > worst {
            let (tau, slope) = images.beside(last, *q);
            waiting.push(Foot { q: *q, square, tau, slope });
        }
        if waiting.len() == 8 {
            worst = refined(source, c, &mut waiting, enough, worst)?;
            waiting.clear();
        }
    }
    if waiting.is_empty() { Ok(worst) } else { refined(source, c, &mut waiting, enough, worst) }
}

/// A point of the cubic, its squared distance from the image, and the parameter to try next.
#[derive(Debug, Clone, Copy)]
struct Foot {
    q: Vec2,
    square: f64,
    tau: f64,
    /// Approximate derivative of the image.
    slope: Vec2,
}

/// Measures the distances of up to eight points together. Returns the largest squared distance, or `worst` if that is larger.
fn refined(source: &impl Source, c: &Candidate, feet: &mut [Foot], enough: f64, mut worst: f64) -> Result<f64> {
    let origin = c.p0.to_vec2();
    for _ in 0..=STEPS {
        let last = feet.len() - 1;
        let g = c.images(source, &std::array::from_fn(|i| feet[i.min(last)].tau))?;
        for (i, foot) in feet.iter_mut().enumerate() {
            let r = Vec2::new(g.x[i], g.y[i]) - foot.q;
            foot.square = foot.square.min(r.hypot2());
            foot.tau = (foot.tau - r.dot(foot.slope) / (foot.slope.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        }
        if feet.iter().all(|f| f.square <= worst) {
            return Ok(worst);
        }
    }
    for foot in feet {
        // Where the chords lead to no point within the tolerance, take Newton steps with the derivative.
        let (mut tau, mut best) = (foot.tau, foot.square);
        for _ in 0..MORE_STEPS {
            if best <= larger(worst, enough) {
                break;
            }
            let (p, d) = source.eval(c.param(tau));
            let (r, v) = (p.to_vec2() - origin - foot.q, d * (c.t1 - c.t0));
            best = best.min(r.hypot2());
            tau = (tau - r.dot(v) / (v.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        }
        worst = worst.max(best);
    }
    Ok(worst)
}

/// Levels of a zoom on a maximum; each samples four times as closely.
const ZOOMS: usize = 4;

/// Spacing of the samples of the dense check.
const SPACING: f64 = 1.0 / (DENSE_BATCHES * 8) as f64;

/// Distance between the candidate and the image, by dense sampling, denser around slow spots, and `true` if the thorough
/// check was needed. `feet` are foot points of sixteen samples, to start from.
pub(crate) fn dense(
    source: &impl Source,
    c: &Candidate,
    feet: &InOrder,
    slow: &SlowSpots,
    tolerance: f64,
) -> Result<(f64, bool)> {
    let last = FootPoint { s: 0.0, slope: c.frame.t0 };
    let mut walk = Walk { source, c, feet, worst: 0.0, last };
    let by_search = || Ok((thorough(source, c, slow, tolerance)?, true));
    let mut even = [[0.0; 8]; DENSE_BATCHES];
    let tau = |batch: usize| -> Lane { std::array::from_fn(|i| ((batch * 8 + i) as f64 + 0.5) * SPACING) };
    Source::announce(&mut (0..DENSE_BATCHES).map(|b| (source, tau(b).map(|t| c.param(t)))), &mut std::iter::empty());
    for (batch, squares) in even.iter_mut().enumerate() {
        let Some(measured) = walk.advance(&tau(batch))? else { return by_search() };
        *squares = measured;
    }
    if !turns_little(walk.last.slope, c.frame.t1) {
        return by_search();
    }
    let mut worst = walk.worst;
    let peaks = walk.zoom_on_peaks(even.as_flattened())?;
    for spot in slow.all().iter().map(|t| c.tau(*t)).filter(|tau| *tau > 0.0 && *tau < 1.0) {
        let mut width = SPACING;
        // Each of three batches lies between the middle samples of the one before.
        for _ in 0..3 {
            let tau: Lane = std::array::from_fn(|i| (spot + width * (i as f64 - 3.5) / 4.0).clamp(0.0, 1.0));
            worst = worst.max(largest(&probe(source, c, feet, &tau, 4)?.squares));
            width *= 0.125;
        }
    }
    Ok((worst.sqrt().max(peaks), false))
}

/// A sample's foot point on the cubic.
#[derive(Debug, Clone, Copy)]
struct FootPoint {
    s: f64,
    slope: Vec2,
}

/// A walk along the image that measures its distance from the candidate.
struct Walk<'a, S> {
    source: &'a S,
    c: &'a Candidate,
    feet: &'a InOrder,
    /// Square of the largest distance so far.
    worst: f64,
    last: FootPoint,
}

impl<S: Source> Walk<'_, S> {
    /// Measures the next eight samples and returns their squared distances. `None` if the foot points do not advance, leap over a long part
    /// of the cubic, or if the cubic turns by 60° between two of them.
    fn advance(&mut self, tau: &Lane) -> Result<Option<Lane>> {
        let c = self.c;
        // Newton steps left out would only make distances larger.
        let Probe { s, squares, .. } = probe(self.source, c, self.feet, tau, 2)?;
        self.worst = self.worst.max(largest(&squares));
        let [c1, c2, c3] = c.frame.power(c.a, c.b);
        let (mut dx, mut dy) = ([0.0; 8], [0.0; 8]);
        for i in 0..8 {
            dx[i] = (c3.x * 3.0 * s[i] + c2.x * 2.0) * s[i] + c1.x;
            dy[i] = (c3.y * 3.0 * s[i] + c2.y * 2.0) * s[i] + c1.y;
        }
        if !advances_smoothly(self.last, &s, &dx, &dy) {
            return Ok(None);
        }
        self.last = FootPoint { s: s[7], slope: Vec2::new(dx[7], dy[7]) };
        Ok(Some(squares))
    }

    /// Takes eight more samples beside every local maximum that is nearly the largest. Returns the highest distance found.
    /// Where the cubic nearly stops, the distance has a corner that no parabola follows.
    fn zoom_on_peaks(&self, even: &[f64]) -> Result<f64> {
        let mut highest = 0.0f64;
        for i in 0..even.len() {
            let (before, after) = (if i > 0 { even[i - 1] } else { 0.0 }, even.get(i + 1).copied().unwrap_or(0.0));
            if even[i] < PEAK_NEAR * self.worst || even[i] < before || even[i] < after {
                continue;
            }
            let (mut mid, mut width) = ((i as f64 + 0.5) * SPACING, SPACING);
            for _ in 0..ZOOMS {
                let tau = spread(mid - width, mid + width).map(|t| t.clamp(0.0, 1.0));
                let squares = probe(self.source, self.c, self.feet, &tau, 3)?.squares;
                let top = (0..8).fold(0, |k, j| if squares[j] > squares[k] { j } else { k });
                let (sample, between) = (squares[top].sqrt(), highest_parabola(&squares, squares[top]));
                let rises = sample.max(between) > ZOOM_RISE * highest;
                highest = highest.max(sample).max(between);
                if !rises {
                    break;
                }
                (mid, width) = (tau[top], 0.25 * width);
            }
        }
        Ok(highest)
    }
}

/// Returns `true` if eight foot points `s` follow `last` in order, none of them far from the one before, and the cubic, with derivatives
/// `dx`, `dy`, turns by less than 60° between any two.
#[inline(always)]
fn advances_smoothly(last: FootPoint, s: &Lane, dx: &Lane, dy: &Lane) -> bool {
    let mut before = [(last.s, last.slope.x, last.slope.y); 8];
    for i in 1..8 {
        before[i] = (s[i - 1], dx[i - 1], dy[i - 1]);
    }
    let mut margin = [0.0; 8];
    for i in 0..8 {
        let (s0, x0, y0) = before[i];
        let dot = x0 * dx[i] + y0 * dy[i];
        let little = 4.0 * dot * dot - (x0 * x0 + y0 * y0) * (dx[i] * dx[i] + dy[i] * dy[i]);
        let order = s[i] - s0 + FOOT_ROUNDING;
        let near = FOOT_LEAP - order;
        // The least of all these, negated, so that one reduction tests them all.
        let least = if dot < little { dot } else { little };
        let least = if least < order { least } else { order };
        margin[i] = -(if least < near { least } else { near });
    }
    largest(&margin) < 0.0
}

/// Highest peak of the parabolas through a local maximum near `most` and its neighbours. Takes squares and returns the distance.
fn highest_parabola(squares: &[f64], most: f64) -> f64 {
    let tops = squares.windows(3).filter(|w| w[1] >= PEAK_NEAR * most && w[1] >= w[0] && w[1] >= w[2]);
    tops.map(|w| parabola_peak(w[0].sqrt(), w[1].sqrt(), w[2].sqrt())).fold(0.0, f64::max)
}

/// Eight even parameters after `a`, the last of them `b`.
fn spread(a: f64, b: f64) -> Lane {
    std::array::from_fn(|i| a + (b - a) * (i as f64 + 1.0) / 8.0)
}

/// Eight samples with foot points and squared distances.
pub(crate) struct Probe {
    pub(crate) g: Lanes,
    pub(crate) s: Lane,
    pub(crate) squares: Lane,
}

/// Samples the image at `tau` and measures its distance from the cubic, after `steps` Newton steps for the foot points.
pub(crate) fn probe(source: &impl Source, c: &Candidate, feet: &InOrder, tau: &Lane, steps: usize) -> Result<Probe> {
    let mut s: Lane = tau.map(|t| interpolated(feet, t));
    let g = c.images(source, tau)?;
    let squares = c.frame.distances(&g, c.a, c.b, &mut s, steps);
    Ok(Probe { g, s, squares })
}

/// Piecewise linear interpolation of the known foot points.
#[inline(always)]
fn interpolated(feet: &InOrder, tau: f64) -> f64 {
    let at = tau * (IN_ORDER - 1) as f64;
    let k = (at as usize).min(IN_ORDER - 2);
    feet[k] + (feet[k + 1] - feet[k]) * (at - k as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::ChordFrame;
    use crate::source::BreakPoint;
    use kurbo::{Point, Vec2};

    #[test]
    fn foot_points_that_leap_are_not_steady() {
        let even: InOrder = std::array::from_fn(|j| j as f64 * UNIT);
        // Delays foot point 6 by a share of the spacing, so that the step after it is longer.
        let late = |share: f64| -> InOrder {
            let mut feet = even;
            feet[6] -= share * UNIT;
            feet
        };
        assert!(steady(&even) && steady(&late(0.55)));
        assert!(!steady(&late(0.65)));
        assert_eq!(IN_ORDER, 18);
    }

    /// Verdict on a line from 0 to 1 with images at `x(τ)`, fitted by the line itself with foot points `s(τ)`.
    fn verdict(x: impl Fn(f64) -> f64, s: impl Fn(f64) -> f64) -> Resolution {
        let unit = Vec2::new(1.0, 0.0);
        let end = |t: f64| BreakPoint { t, p: Point::new(t, 0.0), speed: 1.0, into: unit, away: unit };
        let (from, to) = (end(0.0), end(1.0));
        let handles = [1.0 / 3.0; 2];
        let frame = ChordFrame { q: unit, t0: unit, t1: unit, floor: [0.0; 2], size: 1.0, home: handles, pull: 0.0 };
        let images = |set: &Lane| Lanes { x: set.map(|j| x(j * UNIT)), y: [0.0; 8] };
        let (g, check) = (images(&FITTED), images(&CHECKED));
        let request = FitRequest { from: &from, to: &to, frame, g: &g, check: None, careful: false };
        let s0 = FITTED.map(|j| s(j * UNIT));
        let state = FitState { a: handles[0], b: handles[1], s: s0 };
        let s1 = feet_between(&s0);
        request.resolution(&check, &state, &s0, &s1)
    }

    #[test]
    fn foot_points_far_from_even_ones_are_not_resolved() {
        // The foot points are ahead of the samples by up to 0.17 and 0.19.
        let ahead = |by: f64| verdict(|t| t, |t| t + 4.0 * by * t * (1.0 - t));
        assert!(ahead(0.17).resolved && !ahead(0.19).resolved);
    }

    #[test]
    fn uneven_speed_is_seen() {
        // Speed proportional to a power of τ: over the samples it varies 2, 6.5 and 16 times.
        let slowing = |power: f64| verdict(|t| t.powf(power), |t| t);
        assert!(slowing(1.3).resolved && slowing(1.3).even);
        assert!(slowing(1.8).resolved && !slowing(1.8).even);
        assert!(!slowing(2.2).resolved);
    }

    /// Line parallel to the x axis at this height.
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
        let mut errors = [0.55; IN_ORDER];
        (errors[0], errors[8], errors[IN_ORDER - 1]) = (0.0, 0.75, 0.0);
        let found = |beside: f64| halfway(&Beside(beside), &c, &feet, &errors, 1.0).unwrap();
        assert!(found(0.7).is_some_and(|e| (0.7..1.0).contains(&e)), "{:?}", found(0.7));
        assert!(found(0.4).is_some() && found(0.3).is_none());
    }
}
