//! Covers a smooth run with a quadratic spline, whose inner points on the curve lie midway between control points.
//!
//! A spline of n pieces has n control points; the first and the last lie on the end tangents, so 2n − 2 numbers are free. They minimise the
//! residuals along the normals at the foot points of samples, by banded normal equations, in turn with the foot points. Weights that
//! grow with the residual (Lawson) bring the largest one down. The least n whose spline passes its check is taken. A single piece has no
//! freedom: its control point is the crossing of the end tangents. In the code `c` are the control points, and the spline's parameter `u`
//! runs from 0 to n.
//!
//! A quadratic that touches an arc of radius R and angle θ at both ends is R·θ⁴/128 off in its middle. From the turns between samples,
//! this law gives the number of pieces at which the search for n begins, and the layout of the foot points.

use crate::banded::solve_banded;
use crate::limits::{ACCEPTED, SPLINE_SAMPLES, STRAIGHT};
use crate::report::{Assurance, REPORT_MARGIN, Report};
use crate::source::{BreakPoint, NotFinite, Result, Source};
use kurbo::{BezPath, Point, Vec2};

/// Most rounds of a fit. The first is plain least squares.
const ROUNDS: usize = 16;
/// Most control points of a spline; a longer run is divided.
const MAX_PIECES: usize = 48;
/// Shortest stretch that is divided, as a share of a curve, and the number of stretches in vain after which none is divided.
const SHORTEST: f64 = 1e-6;
const MAX_FUTILE: usize = 100;
/// Least number of samples for each piece that measure an error, which has corners where the curvature of curve or spline jumps.
const CHECK_SAMPLES: f64 = 64.0;
/// Largest factor by which samples are refined for that.
const MAX_REFINEMENT: f64 = 32.0;
/// Error that is recorded for a spline that fails a check, in tolerances: a near miss.
const MISSED: f64 = 1.001;
/// Share of the residual along the tangent that is counted, to keep the system regular.
const TANGENTIAL: f64 = 0.005;
/// Factor by which the error of quadratics that touch the curve exceeds that of least squares.
const BALANCED: f64 = 1.3;
/// A fit ends if the bound of its error exceeds the tolerance by this factor.
const HOPELESS: f64 = 1.02;
/// Weights begin when a round lowers the mean to no less than this share. A fit goes on if this many more rounds like the last would bring
/// the mean to the tolerance.
const SETTLED: f64 = 0.95;
const PATIENCE: i32 = 8;
/// Largest difference of layouts, in pieces, that lead to the same spline.
const ALIKE: f64 = 0.25;
/// Most curves that are covered together, so that the time is linear.
const MAX_CURVES: usize = 32;
/// A spline with more pieces than this multiple of the estimate may do better on parts of its curves.
const UNSUITED: f64 = 1.5;

/// A stretch of one of the curves of a run.
#[derive(Debug, Clone, Copy)]
struct Span {
    curve: usize,
    t: [f64; 2],
}

/// Consecutive curves that join smoothly, and the tolerance.
pub(crate) struct CurveRun<'a, S> {
    pub(crate) curves: &'a [S],
    pub(crate) tolerance: f64,
    /// Returns `true` when no more evaluations are allowed.
    pub(crate) is_spent: &'a dyn Fn() -> bool,
}

/// Samples of a stretch: points, the length of the polygon up to each, and the number of pieces expected up to each.
struct Samples {
    points: Vec<Point>,
    ends: [BreakPoint; 2],
    /// Intervals between samples of each curve.
    each: usize,
    length: Vec<f64>,
    expected: Vec<f64>,
}

/// Consecutive spans with the points and tangents at their ends.
struct Stretch {
    spans: Vec<Span>,
    ends: [BreakPoint; 2],
}

/// A line or a spline that covers a stretch.
struct Covered {
    ends: [BreakPoint; 2],
    /// The spline; a line if `None`.
    spline: Option<Spline>,
    error: f64,
    /// Set if the error is within the tolerance.
    resolved: bool,
}

impl Covered {
    fn pieces(&self) -> usize {
        self.spline.as_ref().map_or(1, |s| s.c.len())
    }

    /// Appends the line or the quadratics.
    fn append(&self, (tolerance, assurance): (f64, Assurance), path: &mut BezPath, report: &mut Report) {
        let error = if self.resolved { (self.error * REPORT_MARGIN).min(tolerance) } else { self.error };
        match &self.spline {
            None => path.line_to(self.ends[1].p),
            Some(s) => (0..s.c.len()).for_each(|k| path.quad_to(s.c[k], s.joint(k + 1))),
        }
        (0..self.pieces()).for_each(|_| report.add_error(error, assurance));
        if !self.resolved {
            report.unresolved.push(self.ends[0].p);
        }
    }
}

impl<S: Source> CurveRun<'_, S> {
    /// Appends few quadratics from the current point of `path`.
    pub(crate) fn cover(&self, ends: [BreakPoint; 2], path: &mut BezPath, report: &mut Report) -> Result<()> {
        let unknown = |s: &S| s.resolved([0.0, 1.0], SPLINE_SAMPLES, self.tolerance).is_none();
        let assurance = if self.curves.iter().any(unknown) { Assurance::Sampled } else { Assurance::Checked };
        let mut futile = 0;
        for stretch in self.stretches(ends)? {
            let covered = self.cover_stretch(stretch, &mut futile)?;
            covered.iter().for_each(|c| c.append((self.tolerance, assurance), path, report));
        }
        Ok(())
    }

    /// Groups the curves of the run: straight ones alone, and between them as many together as a spline may cover.
    fn stretches(&self, ends: [BreakPoint; 2]) -> Result<Vec<Stretch>> {
        let mut all: Vec<(Stretch, f64)> = Vec::new();
        let (mut from, last) = (ends[0], self.curves.len() - 1);
        for (curve, source) in self.curves.iter().enumerate() {
            let to = if curve == last { ends[1] } else { source.end(1.0)? };
            let span = Span { curve, t: [0.0, 1.0] };
            let samples = self.samples(&[span], SPLINE_SAMPLES, &[from, to])?;
            let straight = samples.straight(STRAIGHT * self.tolerance).is_some();
            // A line joins no group.
            let expected = if straight { f64::INFINITY } else { samples.pieces() };
            match all.last_mut() {
                Some((s, sum)) if *sum + expected <= 0.5 * MAX_PIECES as f64 && s.spans.len() < MAX_CURVES => {
                    s.spans.push(span);
                    s.ends[1] = to;
                    *sum += expected;
                }
                _ => all.push((Stretch { spans: vec![span], ends: [from, to] }, expected)),
            }
            from = if curve == last { to } else { self.curves[curve + 1].end(0.0)? };
        }
        Ok(all.into_iter().map(|(s, _)| s).collect())
    }

    /// Covers a stretch, divided if it needs too many pieces, or fewer when divided.
    fn cover_stretch(&self, stretch: Stretch, futile: &mut usize) -> Result<Vec<Covered>> {
        let (found, expected) = self.fewest(&stretch)?;
        let [t0, t1] = stretch.spans[0].t;
        let unsuited = |c: &Covered| c.pieces() as f64 > (UNSUITED * expected).max(2.0);
        let whole = match found {
            Some(c) if stretch.spans.len() == 1 || !unsuited(&c) => return Ok(vec![c]),
            None if stretch.spans.len() == 1 && (t1 - t0 < SHORTEST || *futile > MAX_FUTILE || (self.is_spent)()) => {
                let samples = self.samples(&stretch.spans, SPLINE_SAMPLES, &stretch.ends)?;
                let error = samples.straight(f64::INFINITY).unwrap_or(self.tolerance);
                let resolved = error <= self.tolerance;
                return Ok(vec![Covered { ends: stretch.ends, spline: None, error, resolved }]);
            }
            found => found,
        };
        *futile += usize::from(whole.is_none());
        let mut halves = Vec::new();
        for half in self.halves(stretch)? {
            halves.extend(self.cover_stretch(half, futile)?);
        }
        *futile = if halves.iter().all(|c| c.resolved) { 0 } else { *futile };
        // Count the stored points: a control point for each piece, and one between splines.
        let points: usize = halves.iter().map(|c| c.pieces() + 1).sum();
        Ok(match whole {
            Some(whole) if whole.pieces() < points => vec![whole],
            _ => halves,
        })
    }

    /// Divides a stretch between curves, or a curve in its middle.
    fn halves(&self, stretch: Stretch) -> Result<[Stretch; 2]> {
        let Stretch { spans, ends } = stretch;
        let (mut first, mut second) = (spans.clone(), spans);
        if let [span] = first[..] {
            let mid = 0.5 * (span.t[0] + span.t[1]);
            first[0].t[1] = mid;
            second[0].t[0] = mid;
        } else {
            first.truncate(second.len() / 2);
            second.drain(..first.len());
        }
        let end = |s: &Span, t: f64| self.curves[s.curve].end(t);
        let to = end(&first[first.len() - 1], first[first.len() - 1].t[1])?;
        let from = end(&second[0], second[0].t[0])?;
        Ok([Stretch { spans: first, ends: [ends[0], to] }, Stretch { spans: second, ends: [from, ends[1]] }])
    }

    /// Covers a stretch with the fewest pieces, if [`MAX_PIECES`] suffice. Also returns the expected number.
    fn fewest(&self, stretch: &Stretch) -> Result<(Option<Covered>, f64)> {
        let Stretch { spans, ends } = stretch;
        let sampled = |n: usize| {
            let each = (SPLINE_SAMPLES * (n + 1)).div_ceil(spans.len());
            self.samples(spans, each.max(SPLINE_SAMPLES), ends)
        };
        let mut samples = sampled(1)?;
        let covered = |spline, error| Some(Covered { ends: *ends, spline, error, resolved: true });
        if let Some(error) = samples.straight(STRAIGHT * self.tolerance) {
            return Ok((covered(None, error), 1.0));
        }
        let expected = samples.pieces();
        let mut n = ((0.5 * expected) as usize).clamp(1, MAX_PIECES / 2);
        let (mut too_few, mut found) = (0, None);
        // Go up by the error, which goes with the third to fourth power of the length, then down to the least that fits.
        while n <= MAX_PIECES && too_few < n {
            if samples.points.len() <= SPLINE_SAMPLES * n {
                samples = sampled(n)?;
            }
            match self.best(spans, n, &samples)? {
                Ok((spline, error, bound)) => {
                    found = Some((spline, error));
                    // One piece fewer raises the bound with the third to fourth power of the length; the square is cautious.
                    if bound * (n as f64 / (n as f64 - 1.0)).powi(2) > self.tolerance {
                        break;
                    }
                    n -= 1;
                }
                Err(_) if found.is_some() => break,
                Err(error) => {
                    too_few = n;
                    // The fourth root of the error, a little less of it, so that the least number is not passed.
                    let more = n as f64 * (error / self.tolerance).min(1e6).powf(0.25) * 0.85;
                    n = (more as usize).clamp(n + 1, 2 * n + 2);
                }
            }
        }
        Ok((found.and_then(|(spline, error)| covered(Some(spline), error)), expected))
    }

    /// The best spline of `n` pieces with its error, measured at samples that are close enough, and a lower bound for any error. `Err` is
    /// the least error found if none fits.
    fn best(&self, spans: &[Span], n: usize, samples: &Samples) -> Result<Result<(Spline, f64, f64), f64>> {
        let (spline, [error, bound], u) = match Spline::best(n, samples, self.tolerance) {
            Ok(found) => found,
            Err(error) => return Ok(Err(error)),
        };
        let step = u.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
        let by = (step * CHECK_SAMPLES).ceil().min(MAX_REFINEMENT) as usize;
        if by < 2 {
            return Ok(Ok((spline, error, bound)));
        }
        let closer = self.samples(spans, by * (samples.points.len() - 1) / spans.len(), &samples.ends)?;
        let foot = |i: usize| {
            let (k, part) = (i / by, (i % by) as f64 / by as f64);
            u[k] + (u[(k + 1).min(u.len() - 1)] - u[k]) * part
        };
        let mut feet: Vec<f64> = (0..closer.points.len()).map(foot).collect();
        let error = spline.checked(&closer, &mut feet).filter(|e| *e <= ACCEPTED * self.tolerance);
        Ok(error.map(|e| (spline, e, bound)).ok_or(MISSED * self.tolerance))
    }

    /// Samples `each` intervals of every span.
    fn samples(&self, spans: &[Span], each: usize, ends: &[BreakPoint; 2]) -> Result<Samples> {
        let mut points = vec![ends[0].p];
        for span in spans {
            let [t0, t1] = span.t;
            for i in 1..=each {
                let t = t0 + (t1 - t0) * i as f64 / each as f64;
                let p = self.curves[span.curve].eval(t).0;
                if !p.is_finite() {
                    return Err(NotFinite { t, at: self.curves[span.curve].place(t) });
                }
                points.push(p);
            }
        }
        points[each * spans.len()] = ends[1].p;
        Ok(Samples::new((points, each), ends, self.tolerance))
    }
}

impl Samples {
    fn new((points, each): (Vec<Point>, usize), ends: &[BreakPoint; 2], tolerance: f64) -> Self {
        let (mut length, mut expected) = (vec![0.0], vec![0.0]);
        let last = points.len() - 1;
        let scale = (128.0 * BALANCED * tolerance).powf(-0.25);
        let turn = |a: Vec2, b: Vec2| a.cross(b).atan2(a.dot(b)).abs();
        let mut before = ends[0].away;
        for i in 1..=last {
            let chord = points[i] - points[i - 1];
            let step = chord.hypot();
            // The turns at both ends of the chord, of which inner samples share half with the next chord.
            let after = if i < last { points[i + 1] - points[i] } else { ends[1].into };
            let half = |inner: bool, turn: f64| if inner { 0.5 * turn } else { turn };
            let angle = half(i > 1, turn(before, chord)) + half(i < last, turn(chord, after));
            length.push(length[i - 1] + step);
            // With R = step/θ, the fourth root of R·θ⁴/128 over the tolerance.
            expected.push(expected[i - 1] + scale * angle.powf(0.75) * step.powf(0.25));
            before = chord;
        }
        Self { points, ends: *ends, each, length, expected }
    }

    /// Number of pieces that are expected.
    fn pieces(&self) -> f64 {
        self.expected[self.points.len() - 1]
    }

    /// Largest distance from the chord, if that is at most `limit` and the samples advance along the chord.
    fn straight(&self, limit: f64) -> Option<f64> {
        let (a, b) = (self.points[0], self.points[self.points.len() - 1]);
        let (q, length) = (b - a, a.distance(b));
        let advances = self.points.windows(2).all(|w| (w[1] - w[0]).dot(q) >= 0.0);
        let off = |p: &Point| if length > 0.0 { (*p - a).cross(q).abs() / length } else { a.distance(*p) };
        let worst = self.points.iter().map(off).fold(0.0, f64::max);
        ((advances || limit == f64::INFINITY) && worst <= limit).then_some(worst)
    }

    /// Shares of the whole up to each sample, by which pieces are laid out at first: by the pieces expected of each curve, and by length.
    fn layouts(&self) -> [Vec<f64>; 2] {
        let all = self.points.len() - 1;
        let even: Vec<f64> = (0..=all)
            .map(|i| {
                let k = i / self.each * self.each;
                let next = (k + self.each).min(all);
                self.expected[k] + (self.expected[next] - self.expected[k]) * (i - k) as f64 / self.each as f64
            })
            .collect();
        [&even, &self.length].map(|up_to| {
            let whole = up_to[all].max(f64::MIN_POSITIVE);
            up_to.iter().map(|x| x / whole).collect()
        })
    }
}

/// A quadratic spline.
#[derive(Debug, Clone)]
struct Spline {
    ends: [Point; 2],
    /// Control points.
    c: Vec<Point>,
}

impl Spline {
    /// The point between pieces `k` − 1 and `k`.
    fn joint(&self, k: usize) -> Point {
        match k {
            0 => self.ends[0],
            _ if k == self.c.len() => self.ends[1],
            _ => self.c[k - 1].midpoint(self.c[k]),
        }
    }

    /// Point, first and second derivative at `u`, which runs from 0 to the number of pieces.
    fn jet(&self, u: f64) -> (Point, Vec2, Vec2) {
        let k = (u as usize).min(self.c.len() - 1);
        let (p, c, q, s) = (self.joint(k), self.c[k], self.joint(k + 1), u - k as f64);
        let (d0, d1) = (c - p, q - c);
        (p + (d0 * (2.0 - s) + d1 * s) * s, (d0 * (1.0 - s) + d1 * s) * 2.0, (d1 - d0) * 2.0)
    }

    /// Moves a foot point towards the point nearest to `p`. Returns the distance, signed by the side.
    fn settle(&self, p: Point, u: &mut f64, steps: usize) -> f64 {
        let n = self.c.len() as f64;
        let (mut r, mut d) = (Vec2::ZERO, Vec2::ZERO);
        for taken in 0..=steps {
            let (q, d1, d2) = self.jet(*u);
            (r, d) = (q - p, d1);
            if taken < steps {
                let slope = d1.hypot2();
                let full = slope + r.dot(d2);
                // Newton's step; where the second derivative is small or negative, Gauss–Newton's; at most half a piece.
                let step = r.dot(d1) / if full > 0.3 * slope { full } else { slope + f64::MIN_POSITIVE };
                *u = (*u - step.clamp(-0.5, 0.5)).clamp(0.0, n);
            }
        }
        r.hypot().copysign(d.cross(r))
    }

    /// The best spline of `n` pieces with its error, the bound, and the foot points of the samples. `Err` is the least error found if none
    /// fits.
    fn best(n: usize, samples: &Samples, tolerance: f64) -> Result<(Self, [f64; 2], Vec<f64>), f64> {
        let mut least = f64::INFINITY;
        let layouts = samples.layouts();
        let alike = layouts[0].iter().zip(&layouts[1]).all(|(a, b)| (a - b).abs() * n as f64 <= ALIKE);
        for layout in &layouts[..if alike || n == 1 { 1 } else { 2 }] {
            let mut u: Vec<f64> = layout.iter().map(|s| s * n as f64).collect();
            let Some((spline, [error, bound])) = Self::fitted(n, samples, &mut u, tolerance) else { continue };
            least = least.min(error);
            if error <= ACCEPTED * tolerance
                && let Some(checked) = spline.checked(samples, &mut u)
                && checked <= ACCEPTED * tolerance
            {
                return Ok((spline, [checked, bound], u));
            }
        }
        Err(least.max(MISSED * tolerance))
    }

    /// Fits in rounds from the foot points `u`. Returns the spline with the largest error at the samples and the bound.
    fn fitted(n: usize, samples: &Samples, u: &mut [f64], tolerance: f64) -> Option<(Self, [f64; 2])> {
        if n == 1 {
            let [from, to] = &samples.ends;
            let (q, turn) = (to.p - from.p, from.away.cross(to.into));
            let [a, b] = [q.cross(to.into) / turn, from.away.cross(q) / turn];
            let spline = Self { ends: [from.p, to.p], c: vec![from.p + from.away * a] };
            if !(a > 0.0 && b > 0.0 && spline.c[0].is_finite()) {
                return None;
            }
            let errors = u.iter_mut().zip(&samples.points).map(|(u, p)| spline.settle(*p, u, 6).abs());
            let error = errors.fold(0.0, f64::max);
            return Some((spline, [error; 2]));
        }
        let mut weights = vec![1.0; u.len()];
        let mut tangents = tangents(samples);
        let mut best: Option<(Self, f64, Vec<f64>)> = None;
        let (mut errors, mut bound) = (vec![0.0; u.len()], f64::INFINITY);
        for _ in 0..ROUNDS {
            let Some(spline) = solve(n, samples, u, &weights, &tangents) else { break };
            let (mut worst, mut squares) = (0.0f64, 0.0);
            for (i, p) in samples.points.iter().enumerate() {
                errors[i] = spline.settle(*p, &mut u[i], 2).abs();
                worst = worst.max(errors[i]);
                squares += weights[i] * errors[i] * errors[i];
                tangents[i] = spline.jet(u[i]).1.normalize();
            }
            (u[0], u[samples.points.len() - 1]) = (0.0, n as f64);
            if !worst.is_finite() {
                break;
            }
            if best.as_ref().is_none_or(|b| worst < b.1) {
                best = Some((spline, worst, u.to_vec()));
            }
            let least = best.as_ref().map_or(f64::INFINITY, |b| b.1);
            // No spline has a largest error below the weighted mean of the least squares.
            let before = std::mem::replace(&mut bound, (squares / weights.iter().sum::<f64>()).sqrt());
            // Leaves room for errors between the samples, which are checked in the end.
            if least <= ACCEPTED * 0.98 * tolerance {
                break;
            }
            // The mean falls as long as foot points move.
            let falls = (bound / before).min(1.0);
            if bound * falls.powi(PATIENCE) > HOPELESS * tolerance {
                break;
            }
            if falls > SETTLED {
                // Samples without error keep a fiftieth of their weight, and no weight becomes rounding.
                weights.iter_mut().zip(&errors).for_each(|(w, e)| *w *= 0.02 + e / worst);
                let most = weights.iter().copied().fold(0.0, f64::max);
                weights.iter_mut().for_each(|w| *w = (*w / most).max(1e-6));
            }
        }
        let (spline, worst, feet) = best?;
        u.copy_from_slice(&feet);
        Some((spline, [worst, bound]))
    }

    /// Largest error at and between the samples; `None` if they may miss something.
    fn checked(&self, samples: &Samples, u: &mut [f64]) -> Option<f64> {
        let errors: Vec<f64> = samples.points.iter().zip(u.iter_mut()).map(|(p, u)| self.settle(*p, u, 4)).collect();
        let slopes: Vec<Vec2> = u.iter().map(|u| self.jet(*u).1).collect();
        let steady = u.windows(2).all(|w| w[1] >= w[0] - 1e-9 && w[1] - w[0] < 1.0)
            && slopes.windows(2).all(|w| w[0].dot(w[1]) > 0.5 * w[0].hypot() * w[1].hypot());
        let top = errors.windows(3).map(|w| crate::sample::parabola_extreme([w[0], w[1], w[2]])).fold(0.0, f64::max);
        (steady && errors.iter().all(|e| e.is_finite())).then(|| errors.iter().map(|e| e.abs()).fold(top, f64::max))
    }
}

/// Unit tangents at the samples.
fn tangents(samples: &Samples) -> Vec<Vec2> {
    let n = samples.points.len();
    let along = |i: usize| samples.points[(i + 1).min(n - 1)] - samples.points[i.saturating_sub(1)];
    (0..n).map(|i| along(i) / along(i).hypot().max(f64::MIN_POSITIVE)).collect()
}

/// Number of unknowns on which a piece depends: the width of the band.
const BAND: usize = 6;

/// The spline of `n` ≥ 2 pieces with the least weighted sum of squared residuals.
fn solve(n: usize, samples: &Samples, u: &[f64], weights: &[f64], tangents: &[Vec2]) -> Option<Spline> {
    let [from, to] = &samples.ends;
    let size = 2 * n - 2;
    let mut band = vec![[0.0; BAND]; size];
    let mut right = vec![0.0; size];
    for (j, p) in samples.points.iter().enumerate() {
        let k = (u[j] as usize).min(n - 1);
        let s = u[j] - k as f64;
        let (w0, w1, w2) = ((1.0 - s) * (1.0 - s), 2.0 * s * (1.0 - s), s * s);
        // Shares of the control points k − 1, k, k + 1, and the part that is independent of them.
        let first = if k > 0 { 0.5 * w0 } else { 0.0 };
        let last = if k + 1 < n { 0.5 * w2 } else { 0.0 };
        let share = [first, w1 + first + last, last];
        let mut known = p.to_vec2();
        if k == 0 {
            known -= from.p.to_vec2() * w0;
        }
        if k + 1 == n {
            known -= to.p.to_vec2() * w2;
        }
        let t = tangents[j];
        for (direction, weight) in [(Vec2::new(-t.y, t.x), weights[j]), (t, weights[j] * TANGENTIAL * TANGENTIAL)] {
            let mut row = [(0, 0.0); BAND];
            let (mut count, mut rest) = (0, known.dot(direction));
            for (i, share) in share.into_iter().enumerate().filter(|(_, s)| *s != 0.0) {
                let c = k + i - 1;
                let mut put = |unknown: usize, v: f64| {
                    row[count] = (unknown, v * share);
                    count += 1;
                };
                if c == 0 {
                    put(0, from.away.dot(direction));
                    rest -= share * from.p.to_vec2().dot(direction);
                } else if c + 1 == n {
                    put(size - 1, -to.into.dot(direction));
                    rest -= share * to.p.to_vec2().dot(direction);
                } else {
                    put(2 * c - 1, direction.x);
                    put(2 * c, direction.y);
                }
            }
            for (a, (i, v)) in row[..count].iter().enumerate() {
                right[*i] += weight * v * rest;
                for (k, w) in &row[a..count] {
                    band[*i][k - i] += weight * v * w;
                }
            }
        }
    }
    let x = solve_banded(band, right)?;
    // Handles must not turn round.
    let floor = 1e-4 * samples.length[samples.points.len() - 1] / n as f64;
    let c = (0..n).map(|k| match k {
        0 => from.p + from.away * x[0].max(floor),
        _ if k + 1 == n => to.p - to.into * x[size - 1].max(floor),
        _ => Point::new(x[2 * k - 1], x[2 * k]),
    });
    Some(Spline { ends: [from.p, to.p], c: c.collect() })
}
