//! One cubic for a stretch of a run, fitted to sixteen of the run's samples. Takes no further ones.

use crate::fit::{ChordFrame, Fit, FitState, THOROUGH, fit_with, settled};
use crate::limits::{COARSE, GOOD_ENOUGH, HANDLE_FLOOR, HANDLE_PULL, PEAK_NEAR, RESTART_GAIN, RUN_MINIMAX_WITHIN};
use crate::minimax::minimax;
use crate::quick::straight;
use crate::report::Piece;
use crate::run::SegmentRun;
use crate::sample::{ALL, Evenly, Lane, Lanes, UNIT, extreme, interleaved, larger, largest};
use crate::source::{BreakPoint, Source};
use kurbo::{CubicBez, Line, Point};

/// A cubic over a stretch of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RunCubic {
    pub(crate) frame: ChordFrame,
    /// First and last point.
    pub(crate) ends: [Point; 2],
    pub(crate) a: f64,
    pub(crate) b: f64,
    /// The image is a line to rounding.
    line: bool,
    /// Samples of the run at which it begins and ends.
    pub(crate) samples: [usize; 2],
    /// Lengths of sixteen samples and the ends as shares of the whole, and their foot points.
    pub(crate) shares: Evenly,
    pub(crate) feet: Evenly,
}

impl RunCubic {
    pub(crate) fn piece(&self) -> Piece {
        let [p, q] = self.ends;
        if self.line { Piece::Line(Line::new(p, q)) } else { Piece::Cubic(self.cubic()) }
    }

    pub(crate) fn cubic(&self) -> CubicBez {
        self.frame.cubic(self.ends[0], self.ends[1], self.a, self.b)
    }
}

/// The best cubic found for a stretch.
pub(crate) struct Trial {
    /// The error at the samples; or, if that is above the tolerance, an estimate of the least possible.
    pub(crate) error: f64,
    /// Set if the error is within the tolerance.
    pub(crate) cubic: Option<RunCubic>,
}

/// A fit with its error: at all samples if its fitted ones are within the tolerance, else what it would have reached.
struct BestFit {
    fit: Fit,
    error: f64,
    feet: Evenly,
}

/// A stretch of a run with its sixteen samples, relative to its first point.
pub(crate) struct Stretch {
    pub(crate) tolerance: f64,
    ends: [BreakPoint; 2],
    samples: [usize; 2],
    frame: ChordFrame,
    g: Lanes,
    check: Lanes,
    shares: Evenly,
}

impl Stretch {
    /// Picks the run's samples nearest to seventeenths of the length between two of them, or interpolates if those are too coarse.
    pub(crate) fn new(
        run: &SegmentRun<impl Source>,
        ends: [BreakPoint; 2],
        samples: [usize; 2],
        tolerance: f64,
    ) -> Self {
        let [from, to] = ends;
        let ([first, last], length) = (samples, to.t - from.t);
        let mut shares = [0.0; ALL];
        let (mut x, mut y) = ([0.0; ALL], [0.0; ALL]);
        let inner = first + 1..last;
        let (lengths, xs, ys) = (&run.length[inner.clone()], &run.x[inner.clone()], &run.y[inner]);
        let scale = 1.0 / length;
        let (mut i, mut furthest_off) = (0, 0.0);
        for j in 1..ALL - 1 {
            let share = UNIT * j as f64;
            let twice = 2.0 * (from.t + length * share);
            i = nearest(lengths, i, twice);
            shares[j] = (lengths[i] - from.t) * scale;
            (x[j], y[j]) = (xs[i] - from.p.x, ys[i] - from.p.y);
            furthest_off = larger(furthest_off, (shares[j] - share).abs());
        }
        shares[ALL - 1] = 1.0;
        if furthest_off > COARSE * UNIT {
            for j in 1..ALL - 1 {
                shares[j] = UNIT * j as f64;
            }
            run.between(samples, &shares, [&mut x, &mut y]);
            for j in 1..ALL - 1 {
                (x[j], y[j]) = (x[j] - from.p.x, y[j] - from.p.y);
            }
        }
        let g = Lanes { x: picked(&x, &FITTED_AT), y: picked(&y, &FITTED_AT) };
        let check = Lanes { x: picked(&x, &CHECKED_AT), y: picked(&y, &CHECKED_AT) };
        let q = to.p - from.p;
        let far = |i: usize| g.x[i] * g.x[i] + g.y[i] * g.y[i];
        let size = larger(larger(q.hypot2(), far(3)), far(6)).sqrt();
        let third = length * (1.0 / 3.0);
        let floor = third.min(HANDLE_FLOOR * size);
        let pull = (HANDLE_PULL * tolerance / size).powi(2);
        let frame = ChordFrame { q, t0: from.away, t1: to.into, floor: [floor; 2], size, home: [third; 2], pull };
        Self { tolerance, ends, samples, frame, g, check, shares }
    }

    /// Fits a cubic, by least squares first and in further ways as long as the error is above the tolerance.
    pub(crate) fn fitted(&self) -> Trial {
        let [from, to] = &self.ends;
        if let Some((line, error)) = straight(&self.g, from, to, self.frame.size, self.tolerance) {
            let third = line.p0.distance(line.p1) / 3.0;
            return Trial { error, cubic: Some(self.with([third; 2], self.shares, true)) };
        }
        let [a, b] = self.frame.home;
        let mut start = FitState { a, b, s: picked(&self.shares, &FITTED_AT) };
        self.frame.settle(&self.g, a, b, &mut start.s);
        let mut best = self.judged(self.least_squares(start, GOOD_ENOUGH));
        self.converge(&mut best);
        self.restart_along_valley(&mut best);
        self.minimax(&mut best);
        self.trial(&best)
    }

    /// As [`fitted`](Self::fitted), but with the least error that can be reached.
    pub(crate) fn fitted_closely(&self, from: &RunCubic) -> Trial {
        let z = FitState { a: from.a, b: from.b, s: picked(&from.feet, &FITTED_AT) };
        let mut best = self.judged(self.least_squares(z, 0.0));
        self.minimised(&mut best, 0.0);
        self.trial(&best)
    }

    /// Least squares until the error is below a share of the tolerance.
    fn least_squares(&self, start: FitState, enough: f64) -> Fit {
        fit_with(&THOROUGH, &self.frame, &self.g, start, [enough * self.tolerance, self.tolerance])
    }

    fn trial(&self, best: &BestFit) -> Trial {
        let BestFit { fit, error, feet } = best;
        let fits = *error <= self.tolerance;
        Trial { error: *error, cubic: fits.then(|| self.with([fit.z.a, fit.z.b], *feet, false)) }
    }

    fn with(&self, [a, b]: [f64; 2], feet: Evenly, line: bool) -> RunCubic {
        let ends = [self.ends[0].p, self.ends[1].p];
        RunCubic { frame: self.frame, ends, a, b, line, samples: self.samples, shares: self.shares, feet }
    }

    /// Measures the error of a fit at all samples, if it comes within the tolerance.
    fn judged(&self, fit: Fit) -> BestFit {
        if fit.reach > self.tolerance {
            return BestFit { fit, error: fit.reach, feet: self.shares };
        }
        let (z, fitted) = (&fit.z, settled(&self.frame, &self.g, &fit, self.tolerance));
        let mut s = self.between(&fitted.s);
        let squares = self.frame.distances(&self.check, z.a, z.b, &mut s, 1);
        let mut error = larger(fitted.error, largest(&squares).sqrt());
        if error <= self.tolerance {
            let e0 = self.frame.signed_distances(&self.g, z.a, z.b, &fitted.s, &fitted.squares);
            let e1 = self.frame.signed_distances(&self.check, z.a, z.b, &s, &squares);
            error = highest_parabola(&interleaved(&e0, &e1, 0.0), error);
        }
        BestFit { fit, error, feet: interleaved(&fitted.s, &s, 1.0) }
    }

    /// Foot points of the checked samples between those of the fitted ones.
    fn between(&self, s: &Lane) -> Lane {
        let (at, want) = (picked(&self.shares, &FITTED_AT), picked(&self.shares, &CHECKED_AT));
        let mut out = [0.0; 8];
        for i in 0..8 {
            let before = [0, 1, 2, 3, 3, 4, 5, 6][i];
            let (step, rest) = (at[before + 1] - at[before], want[i] - at[before]);
            out[i] = s[before] + if step > 0.0 { (s[before + 1] - s[before]) * (rest / step) } else { 0.0 };
        }
        out
    }

    /// Iterates to convergence a fit that stopped early but exceeds the tolerance at other samples.
    fn converge(&self, best: &mut BestFit) {
        if best.error > self.tolerance && best.fit.error <= GOOD_ENOUGH * self.tolerance {
            let mut start = best.fit.z;
            self.frame.settle(&self.g, start.a, start.b, &mut start.s);
            *best = self.judged(self.least_squares(start, 0.0));
        }
    }

    /// Starts again farther along the valley of equal area.
    fn restart_along_valley(&self, best: &mut BestFit) {
        let tol = self.tolerance;
        for factor in self.frame.restarts(&best.fit.z, best.error, tol).into_iter().flatten() {
            let Some(start) = self.frame.along_valley(&self.g, &best.fit.z, factor) else { continue };
            let other = self.least_squares(start, GOOD_ENOUGH);
            if other.reach < RESTART_GAIN * best.error {
                let other = self.judged(other);
                if other.error < best.error {
                    *best = other;
                }
                if best.error <= tol {
                    break;
                }
            }
        }
    }

    /// Minimax on all sixteen samples, where that may bring the error below the tolerance.
    fn minimax(&self, best: &mut BestFit) {
        if best.error > self.tolerance && best.error <= RUN_MINIMAX_WITHIN * self.tolerance {
            self.minimised(best, self.tolerance);
        }
    }

    /// Minimax until the error is at most `wanted`.
    fn minimised(&self, best: &mut BestFit, wanted: f64) {
        let z = best.fit.z;
        let other = FitState { s: self.between(&z.s), ..z };
        let (z, error) = minimax(&self.frame, [&self.g, &self.check], [z, other], [wanted, self.tolerance]);
        if error < best.error {
            let fit = Fit { z: z[0], error, reach: error, ds: [1.0; 8], squares: [0.0; 8] };
            let judged = self.judged(fit);
            *best = BestFit { error: judged.error.max(error), ..judged };
        }
    }
}

/// The index of the length nearest to half of `twice`, at or after `from`.
#[inline(always)]
fn nearest(lengths: &[f64], from: usize, twice: f64) -> usize {
    let is_before = |i: usize| i + 1 < lengths.len() && lengths[i] + lengths[i + 1] < twice;
    let (mut low, mut stride) = (from, 1);
    if !is_before(low) {
        return low;
    }
    // `low` is before it, `low + stride` is not.
    while is_before(low + stride) {
        low += stride;
        stride *= 2;
    }
    while stride > 1 {
        stride /= 2;
        if is_before(low + stride) {
            low += stride;
        }
    }
    low + 1
}

/// The height of the highest parabola through three neighbours whose middle one is an extreme, and nearly as far from zero as `most`.
fn highest_parabola(errors: &Evenly, most: f64) -> f64 {
    let is_top = |w: &[f64]| {
        let side = 1.0f64.copysign(w[1]);
        w[1].abs() >= PEAK_NEAR * most && w[1] * side >= w[0] * side && w[1] * side >= w[2] * side
    };
    errors.windows(3).filter(|w| is_top(w)).map(|w| extreme([w[0], w[1], w[2]])).fold(most, larger)
}

/// The values at some of the samples.
#[inline(always)]
fn picked(v: &Evenly, set: &[usize; 8]) -> Lane {
    let mut out = [0.0; 8];
    for i in 0..8 {
        out[i] = v[set[i]];
    }
    out
}

const FITTED_AT: [usize; 8] = [1, 3, 5, 7, 10, 12, 14, 16];
const CHECKED_AT: [usize; 8] = [2, 4, 6, 8, 9, 11, 13, 15];
