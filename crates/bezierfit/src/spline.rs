//! Quadratics: a smooth run as a quadratic spline, whose inner points on the curve lie midway between control points.
//!
//! A spline of n pieces has n control points; the first and the last lie on the end tangents, so 2n − 2 numbers are free. They minimise the
//! residuals along the normals at the foot points of samples, by banded normal equations, in turn with the foot points. Weights that
//! grow with the residual (Lawson) bring the largest one down. The least n whose spline passes its check is taken. A single piece has no
//! freedom: its control point is where the end tangents meet.

use crate::banded::solve_banded;
use crate::limits::{ACCEPTED, SPLINE_SAMPLES, STRAIGHT};
use crate::report::{Assurance, REPORT_MARGIN, Report};
use crate::source::{BreakPoint, NotFinite, Source};
use kurbo::{BezPath, Point, Vec2};

/// Rounds of a fit, the first five of which are plain least squares.
const ROUNDS: usize = 30;
/// Control points of a spline, at most: a longer run is divided.
const MOST: usize = 48;
/// Stretches shorter than this share of a curve are not divided, nor are any after so many for which nothing was found.
const SHORTEST: f64 = 1e-6;
const MOST_FUTILE: usize = 100;
/// Samples to a piece, at least, that measure an error: it has corners where the curvature of the curve or of the spline jumps.
const CLOSELY: f64 = 64.0;
/// By how much samples are refined for that, at most.
const MOST_CLOSELY: f64 = 32.0;
/// Error that is recorded for what fails a check.
const MISSED: f64 = 1.001;
/// Share of the residual along the tangent: it keeps the system regular.
const ALONG: f64 = 0.02;

/// Curves that are covered together, at most, so that the time is linear.
const MOST_CURVES: usize = 128;
/// Pieces of a run of several curves, at most.
const TOGETHER: usize = 24;

/// A stretch of one of the curves of a run, and the number of pieces that it needs alone.
#[derive(Debug, Clone, Copy)]
struct Span {
    curve: usize,
    t: [f64; 2],
    pieces: usize,
}

/// Curves that follow each other smoothly, and the tolerance.
pub(crate) struct Run<'a, S> {
    pub(crate) curves: &'a [S],
    pub(crate) tolerance: f64,
    /// Tells when no more evaluations are allowed.
    pub(crate) is_spent: &'a dyn Fn() -> bool,
}

/// Samples of a stretch: points, the length up to each, and its share of the pieces by what the curves need alone.
struct Samples {
    p: Vec<Point>,
    length: Vec<f64>,
    share: Vec<f64>,
}

/// Spans that are covered together.
struct Covered {
    spans: Vec<Span>,
    ends: [BreakPoint; 2],
    /// A line if there is none.
    spline: Option<Spline>,
    error: f64,
    resolved: bool,
}

impl Covered {
    fn pieces(&self) -> usize {
        self.spline.as_ref().map_or(1, |s| s.c.len())
    }
}

impl<S: Source> Run<'_, S> {
    /// Appends few quadratics from the current point of `path`: the fewest for each curve, then fewer for several together, as many as
    /// gain by it.
    pub(crate) fn cover(
        &self,
        ends: [BreakPoint; 2],
        path: &mut BezPath,
        report: &mut Report,
    ) -> Result<(), NotFinite> {
        let mut alone = Vec::with_capacity(self.curves.len());
        for (curve, source) in self.curves.iter().enumerate() {
            let from = if curve == 0 { ends[0] } else { source.end(0.0)? };
            let to = if curve + 1 == self.curves.len() { ends[1] } else { source.end(1.0)? };
            self.alone(Span { curve, t: [0.0, 1.0], pieces: 1 }, [from, to], &mut alone)?;
        }
        let unknown = |s: &S| s.resolved([0.0, 1.0], SPLINE_SAMPLES, self.tolerance).is_none();
        let assurance = if self.curves.iter().any(unknown) { Assurance::Sampled } else { Assurance::Checked };
        let mut i = 0;
        while i < alone.len() {
            let mut group: Option<Covered> = None;
            let (mut end, mut stride) = (i + 1, 1);
            while end < alone.len() {
                let to = (end + stride).min(alone.len());
                let now = group.as_ref().map_or(alone[i].pieces(), Covered::pieces);
                let most = now + alone[end..to].iter().map(Covered::pieces).sum::<usize>() - 1;
                let spans: Vec<Span> = alone[i..to].iter().flat_map(|c| c.spans.iter().copied()).collect();
                let is_line = |c: &Covered| c.spline.is_none();
                let too_many = now > TOGETHER || most > 2 * TOGETHER || to - i > MOST_CURVES;
                let found = if too_many || alone[i..to].iter().any(is_line) {
                    None
                } else {
                    self.together(spans, [alone[i].ends[0], alone[to - 1].ends[1]], most)?
                };
                match found {
                    Some(found) => (group, end, stride) = (Some(found), to, 2 * stride),
                    None if stride > 1 => stride = 1,
                    None => break,
                }
            }
            group.as_ref().unwrap_or(&alone[i]).append((self.tolerance, assurance), path, report);
            i = end;
        }
        Ok(())
    }

    /// Appends what covers a curve by itself, divided if it needs too many pieces.
    fn alone(&self, span: Span, ends: [BreakPoint; 2], out: &mut Vec<Covered>) -> Result<(), NotFinite> {
        let mut stack = vec![(span, ends)];
        let mut futile = 0;
        while let Some((span, ends)) = stack.pop() {
            let [t0, t1] = span.t;
            let mut samples = self.samples(&[span], 2 * SPLINE_SAMPLES, &ends)?;
            if let Some(error) = samples.straight(STRAIGHT * self.tolerance) {
                out.push(Covered { spans: vec![span], ends, spline: None, error, resolved: true });
                continue;
            }
            // Upwards by the error, which goes with the third to fourth power of the length, then back to the least that fits.
            let (mut n, mut too_few) = (1, 0);
            let mut found = None;
            while n <= MOST && too_few < n {
                if samples.p.len() <= SPLINE_SAMPLES * n {
                    samples = self.samples(&[span], (SPLINE_SAMPLES * n).next_power_of_two(), &ends)?;
                }
                match self.best(&[span], n, &samples, &ends)? {
                    Ok(fits) => (found, n) = (Some(fits), n - 1),
                    Err(_) if found.is_some() => break,
                    Err(error) => {
                        too_few = n;
                        let more = n as f64 * (error / self.tolerance).min(1e6).powf(0.25) * 0.85;
                        n = (more as usize).clamp(n + 1, 2 * n + 2);
                    }
                }
            }
            if let Some((spline, error)) = found {
                let span = Span { pieces: spline.c.len(), ..span };
                out.push(Covered { spans: vec![span], ends, spline: Some(spline), error, resolved: true });
            } else if t1 - t0 < SHORTEST || futile > MOST_FUTILE + out.len() || (self.is_spent)() {
                let error = samples.straight(f64::INFINITY).unwrap_or(self.tolerance);
                out.push(Covered { spans: vec![span], ends, spline: None, error, resolved: error <= self.tolerance });
            } else {
                futile += 1;
                let t = 0.5 * (t0 + t1);
                let mid = self.curves[span.curve].end(t)?;
                stack.push((Span { t: [t, t1], ..span }, [mid, ends[1]]));
                stack.push((Span { t: [t0, t], ..span }, [ends[0], mid]));
            }
        }
        Ok(())
    }

    /// The fewest pieces for several spans, if that is at most `most`.
    fn together(&self, spans: Vec<Span>, ends: [BreakPoint; 2], most: usize) -> Result<Option<Covered>, NotFinite> {
        let each = (SPLINE_SAMPLES * most).div_ceil(spans.len()).next_power_of_two().max(8);
        let samples = self.samples(&spans, each, &ends)?;
        let mut found = None;
        for n in (1..=most).rev() {
            match self.best(&spans, n, &samples, &ends)? {
                Ok(fits) => found = Some(fits),
                Err(_) => break,
            }
        }
        Ok(found.map(|(spline, error)| Covered { spans, ends, spline: Some(spline), error, resolved: true }))
    }

    /// The best spline of `n` pieces with its error, measured at samples as close as it needs; otherwise the least error found.
    fn best(
        &self,
        spans: &[Span],
        n: usize,
        samples: &Samples,
        ends: &[BreakPoint; 2],
    ) -> Result<Result<(Spline, f64), f64>, NotFinite> {
        let (spline, error, u) = match Spline::best(n, samples, ends, self.tolerance) {
            Ok(found) => found,
            Err(error) => return Ok(Err(error)),
        };
        let step = u.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
        let by = (step * CLOSELY).ceil().min(MOST_CLOSELY) as usize;
        if by < 2 {
            return Ok(Ok((spline, error)));
        }
        let closer = self.samples(spans, by * (samples.p.len() - 1) / spans.len(), ends)?;
        let mut feet: Vec<f64> = (0..closer.p.len())
            .map(|i| {
                let (k, part) = (i / by, (i % by) as f64 / by as f64);
                u[k] + (u[(k + 1).min(u.len() - 1)] - u[k]) * part
            })
            .collect();
        let error = spline.checked(&closer, &mut feet).filter(|e| *e <= ACCEPTED * self.tolerance);
        Ok(error.map(|e| (spline, e)).ok_or(MISSED * self.tolerance))
    }

    /// `each` intervals between samples of every span.
    fn samples(&self, spans: &[Span], each: usize, ends: &[BreakPoint; 2]) -> Result<Samples, NotFinite> {
        let all = each * spans.len() + 1;
        let (mut p, mut length) = (vec![ends[0].p], vec![0.0]);
        for span in spans {
            let [t0, t1] = span.t;
            for i in 1..=each {
                let t = t0 + (t1 - t0) * i as f64 / each as f64;
                let q = self.curves[span.curve].eval(t).0;
                if !q.is_finite() {
                    return Err(NotFinite { t, at: self.curves[span.curve].place(t) });
                }
                length.push(length[p.len() - 1] + q.distance(p[p.len() - 1]));
                p.push(q);
            }
        }
        p[all - 1] = ends[1].p;
        let pieces: usize = spans.iter().map(|s| s.pieces).sum();
        let mut share = vec![0.0];
        for span in spans {
            let (from, step) = (share[share.len() - 1], span.pieces as f64 / (pieces * each) as f64);
            share.extend((1..=each).map(|i| from + step * i as f64));
        }
        Ok(Samples { p, length, share })
    }
}

impl Covered {
    /// Appends its line or its quadratics.
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

impl Samples {
    /// The largest distance from the chord, if it is at most `limit` and the samples advance along it.
    fn straight(&self, limit: f64) -> Option<f64> {
        let (a, b) = (self.p[0], self.p[self.p.len() - 1]);
        let (q, length) = (b - a, a.distance(b));
        let advances = self.p.windows(2).all(|w| (w[1] - w[0]).dot(q) >= 0.0);
        let worst = self.p.iter().map(|p| (*p - a).cross(q).abs()).fold(0.0, f64::max) / length.max(f64::MIN_POSITIVE);
        ((advances || limit == f64::INFINITY) && worst <= limit).then_some(worst)
    }

    /// Shares along which pieces are laid out to begin with: by what the curves need alone, and by length.
    fn layouts(&self) -> [Vec<f64>; 2] {
        let whole = self.length[self.p.len() - 1].max(f64::MIN_POSITIVE);
        [self.share.clone(), self.length.iter().map(|x| x / whole).collect()]
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

    /// The point and its two derivatives at `u`, from 0 to the number of pieces.
    fn at(&self, u: f64) -> (Point, Vec2, Vec2) {
        let k = (u as usize).min(self.c.len() - 1);
        let (p, c, q, s) = (self.joint(k), self.c[k], self.joint(k + 1), u - k as f64);
        let (d0, d1) = (c - p, q - c);
        (p + (d0 * (2.0 - s) + d1 * s) * s, (d0 * (1.0 - s) + d1 * s) * 2.0, (d1 - d0) * 2.0)
    }

    /// Moves a foot point towards the place nearest to `p`, and returns the distance, signed by the side.
    fn settle(&self, p: Point, u: &mut f64, steps: usize) -> f64 {
        let n = self.c.len() as f64;
        let (mut r, mut d) = (Vec2::ZERO, Vec2::ZERO);
        for step in 0..=steps {
            let (q, d1, d2) = self.at(*u);
            (r, d) = (q - p, d1);
            if step < steps {
                let slope = d1.hypot2();
                let full = slope + r.dot(d2);
                let by = r.dot(d1) / if full > 0.3 * slope { full } else { slope + f64::MIN_POSITIVE };
                *u = (*u - by.clamp(-0.5, 0.5)).clamp(0.0, n);
            }
        }
        r.hypot().copysign(d.cross(r))
    }

    /// The best spline of `n` pieces with its error and the foot points of the samples; otherwise the least error found.
    fn best(n: usize, samples: &Samples, ends: &[BreakPoint; 2], tolerance: f64) -> Result<(Self, f64, Vec<f64>), f64> {
        let mut least = f64::INFINITY;
        for layout in samples.layouts() {
            let mut u: Vec<f64> = layout.iter().map(|s| s * n as f64).collect();
            let Some((spline, error)) = Self::fitted(n, samples, ends, &mut u, tolerance) else { continue };
            least = least.min(error);
            if error <= ACCEPTED * tolerance
                && let Some(checked) = spline.checked(samples, &mut u)
                && checked <= ACCEPTED * tolerance
            {
                return Ok((spline, checked, u));
            }
            if n == 1 {
                break;
            }
        }
        Err(least.max(MISSED * tolerance))
    }

    /// Fits in rounds from the foot points `u`. Returns the largest error at the samples.
    fn fitted(
        n: usize,
        samples: &Samples,
        ends: &[BreakPoint; 2],
        u: &mut [f64],
        tolerance: f64,
    ) -> Option<(Self, f64)> {
        let [from, to] = ends;
        if n == 1 {
            let (q, turn) = (to.p - from.p, from.away.cross(to.into));
            let [a, b] = [q.cross(to.into) / turn, from.away.cross(q) / turn];
            let spline = Self { ends: [from.p, to.p], c: vec![from.p + from.away * a] };
            let worst = |spline: &Self, u: &mut [f64]| {
                u.iter_mut().zip(&samples.p).map(|(u, p)| spline.settle(*p, u, 6).abs()).fold(0.0, f64::max)
            };
            return (a > 0.0 && b > 0.0 && spline.c[0].is_finite()).then(|| {
                let error = worst(&spline, u);
                (spline, error)
            });
        }
        let mut weights = vec![1.0; u.len()];
        let mut normals = tangents(samples);
        let mut best: Option<(Self, f64, Vec<f64>)> = None;
        let mut errors = vec![0.0; u.len()];
        for round in 0..ROUNDS {
            let Some(spline) = solve(n, samples, ends, u, &weights, &normals) else { break };
            let mut worst = 0.0f64;
            for (i, p) in samples.p.iter().enumerate() {
                errors[i] = spline.settle(*p, &mut u[i], 2).abs();
                worst = worst.max(errors[i]);
                normals[i] = spline.at(u[i]).1.normalize();
            }
            (u[0], u[samples.p.len() - 1]) = (0.0, n as f64);
            if !worst.is_finite() {
                break;
            }
            if best.as_ref().is_none_or(|b| worst < b.1) {
                best = Some((spline, worst, u.to_vec()));
            }
            let least = best.as_ref().map_or(f64::INFINITY, |b| b.1);
            if least <= ACCEPTED * 0.98 * tolerance || (round >= 5 && least > 4.0 * tolerance) {
                break;
            }
            if round >= 5 {
                weights.iter_mut().zip(&errors).for_each(|(w, e)| *w *= 0.02 + e / worst);
                let most = weights.iter().copied().fold(0.0, f64::max);
                weights.iter_mut().for_each(|w| *w = (*w / most).max(1e-6));
            }
        }
        let (spline, worst, feet) = best?;
        u.copy_from_slice(&feet);
        Some((spline, worst))
    }

    /// The largest error at and between the samples; `None` if they may have missed something.
    fn checked(&self, samples: &Samples, u: &mut [f64]) -> Option<f64> {
        let errors: Vec<f64> = samples.p.iter().zip(u.iter_mut()).map(|(p, u)| self.settle(*p, u, 4)).collect();
        let slopes: Vec<Vec2> = u.iter().map(|u| self.at(*u).1).collect();
        let steady = u.windows(2).all(|w| w[1] >= w[0] - 1e-9 && w[1] - w[0] < 1.0)
            && slopes.windows(2).all(|w| w[0].dot(w[1]) > 0.5 * w[0].hypot() * w[1].hypot());
        let top = errors.windows(3).map(|w| crate::sample::extreme([w[0], w[1], w[2]])).fold(0.0, f64::max);
        (steady && errors.iter().all(|e| e.is_finite())).then(|| errors.iter().map(|e| e.abs()).fold(top, f64::max))
    }
}

/// Unit tangents at the samples.
fn tangents(samples: &Samples) -> Vec<Vec2> {
    let n = samples.p.len();
    let along = |i: usize| samples.p[(i + 1).min(n - 1)] - samples.p[i.saturating_sub(1)];
    (0..n).map(|i| along(i) / along(i).hypot().max(f64::MIN_POSITIVE)).collect()
}

/// Unknowns that a piece depends on, and so the width of the band.
const BAND: usize = 6;

/// The spline of `n` ≥ 2 pieces with the least weighted squares of the residuals.
fn solve(
    n: usize,
    samples: &Samples,
    [from, to]: &[BreakPoint; 2],
    u: &[f64],
    weights: &[f64],
    tangents: &[Vec2],
) -> Option<Spline> {
    let size = 2 * n - 2;
    let mut band = vec![[0.0; BAND]; size];
    let mut right = vec![0.0; size];
    for (j, p) in samples.p.iter().enumerate() {
        let k = (u[j] as usize).min(n - 1);
        let s = u[j] - k as f64;
        let (w0, w1, w2) = ((1.0 - s) * (1.0 - s), 2.0 * s * (1.0 - s), s * s);
        // Shares of the control points k − 1, k, k + 1, and what does not depend on them.
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
        for (direction, weight) in [(Vec2::new(-t.y, t.x), weights[j]), (t, weights[j] * ALONG * ALONG)] {
            let mut row = [(0, 0.0); BAND];
            let (mut count, mut rest) = (0, known.dot(direction));
            for (i, share) in share.into_iter().enumerate().filter(|(_, s)| *s != 0.0) {
                let c = k + i - 1;
                let mut put = |at: usize, v: f64| {
                    row[count] = (at, v * share);
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
    let floor = 1e-4 * samples.length[samples.p.len() - 1] / n as f64;
    let c = (0..n).map(|k| match k {
        0 => from.p + from.away * x[0].max(floor),
        _ if k + 1 == n => to.p - to.into * x[size - 1].max(floor),
        _ => Point::new(x[2 * k - 1], x[2 * k]),
    });
    Some(Spline { ends: [from.p, to.p], c: c.collect() })
}
