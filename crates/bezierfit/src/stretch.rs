//! One piece for one stretch of a curve: its samples, the quick outcomes, and the attempts after them.

use crate::check::THOROUGH_WORK;
use crate::fit::{ChordFrame, Fit, FitRequest, FitState, fit};
use crate::limits::{
    CUSP_MARGIN, CUSP_SPEED, EIGHT_ACCEPTED, EIGHT_GROWTH, FOOT_DRIFT, GOOD_ENOUGH, HANDLE_FLOOR, HANDLE_FLOOR_STOPPED,
    HANDLE_PULL, MAX_ATTEMPTS, MAX_DIFFICULTY, MIN_RELATIVE_ERROR, MINIMAX_WITHIN, RESTART_GAIN, SHARP_PACE,
    SMALL_ERROR,
};
use crate::minimax::minimax;
use crate::proof;
use crate::quick::{HermiteResiduals, straight};
use crate::report::Piece;
use crate::sample::{CHECKED, FITTED, Lane, Lanes, UNIT, between, clamp_unit, larger, spaced};
use crate::source::{BreakPoint, NotFinite, Quotient, SlowSpots, Source, images_into};
use kurbo::{Line, Vec2};
use std::cell::Cell;

/// Evaluations of the source for an attempt at a piece with its usual checks.
const EVALUATIONS: usize = 32;

/// A part with more attempts may be one where the curve oscillates faster than samples can tell, so that most need the thorough check:
/// fewer are allowed from there on.
const HARD: usize = 64;

/// Fits pieces to stretches of one smooth curve.
pub struct StretchFitter<'a, S> {
    pub(crate) source: &'a S,
    pub(crate) slow: &'a SlowSpots,
    pub(crate) tolerance: f64,
    /// The curve as a quotient of polynomials, if proofs are wanted and possible.
    pub(crate) form: Option<Quotient>,
    /// The curve is simple, and the ends of the pieces lie on it.
    pub(crate) simple: bool,
    pub(crate) attempts: usize,
    /// Evaluations besides those of attempts with their usual checks, so far.
    pub(crate) extra: Cell<usize>,
    /// The number of attempts at which the work ends, …
    most_attempts: usize,
    /// … and that of evaluations.
    pub(crate) most_evaluations: usize,
}

impl<'a, S: Source> StretchFitter<'a, S> {
    /// For pieces whose ends are at most `blur` from the curve. Ends after the attempts that exceed `left` evaluations by themselves, so
    /// that the result does not depend on what others count at the same time.
    #[inline(always)]
    pub fn new(source: &'a S, slow: &'a SlowSpots, tolerance: f64, (prove, blur): (bool, f64), left: f64) -> Self {
        let (usual, hard) = (left / EVALUATIONS as f64, left / THOROUGH_WORK as f64);
        let most = if usual < HARD as f64 { usual } else { hard.max(HARD as f64) };
        let most_attempts = MAX_ATTEMPTS.min((most as usize).saturating_add(1));
        let form = if prove { source.quotient().and_then(Quotient::provable) } else { None };
        let form = form.map(|f| Quotient { blur, ..f });
        let simple = blur == 0.0 && source.is_simple();
        Self {
            source,
            slow,
            tolerance,
            form,
            simple,
            attempts: 0,
            extra: Cell::new(0),
            most_attempts,
            most_evaluations: usize::MAX,
        }
    }

    /// Returns `true` if the work ends here.
    pub(crate) fn is_spent(&self) -> bool {
        self.attempts >= self.most_attempts || self.evaluations() >= self.most_evaluations
    }

    /// Evaluations so far, at most.
    #[inline(always)]
    pub fn evaluations(&self) -> usize {
        let each = if self.attempts > HARD { THOROUGH_WORK } else { EVALUATIONS };
        (self.attempts * each).max(self.attempts * EVALUATIONS + self.extra.get())
    }
}

impl<S: Source> StretchFitter<'_, S> {
    /// Takes the fitted samples and sets up the frame.
    #[inline(always)]
    pub(crate) fn start<'r>(
        &mut self,
        from: &'r BreakPoint,
        to: &'r BreakPoint,
        g: &'r mut Lanes,
    ) -> Result<FitRequest<'r>, NotFinite> {
        self.attempts += 1;
        let (t0, h) = (from.t, to.t - from.t);
        let tol = self.tolerance;
        self.sample(from, h, &FITTED, g)?;
        let q = to.p - from.p;
        let far = |i: usize| g.x[i] * g.x[i] + g.y[i] * g.y[i];
        let size = larger(larger(q.hypot2(), far(3)), far(6)).sqrt();
        // A vanishing Hermite handle starts tiny and may grow.
        let third = h * (1.0 / 3.0);
        let home = [from.speed * third, to.speed * third];
        let floor = home.map(|a| if a > 0.0 { a.min(HANDLE_FLOOR * size) } else { HANDLE_FLOOR_STOPPED * size });
        let pull = (HANDLE_PULL * tol / size).powi(2);
        let frame = ChordFrame { q, t0: from.away, t1: to.into, floor, size, home, pull };
        let careful = !self.slow.all().is_empty() && self.slow.inside(t0, to.t).is_some();
        Ok(FitRequest { from, to, frame, g, check: None, ds: [0.0; 8], careful })
    }

    /// The error of the Hermite cubic, if it fits and nothing more needs to be looked at.
    #[inline(always)]
    pub(crate) fn hermite_error(&self, request: &mut FitRequest<'_>) -> Result<Option<f64>, NotFinite> {
        let (tol, size) = (self.tolerance, request.frame.size);
        let first = request.hermite_at_fitted();
        request.ds = first.ds;
        let [a, b] = request.frame.home;
        let within = |worst: f64, share: f64| worst <= (share * tol).powi(2) && a > 0.0 && b > 0.0 && !request.careful;
        let settled = |drift: f64| drift * drift * size <= FOOT_DRIFT * tol;
        if !(within(first.worst, SMALL_ERROR) && settled(first.drift) && first.resolved(None)) {
            return Ok(None);
        }
        let low_degree = self.simple && self.form.is_none();
        if within(first.worst, EIGHT_ACCEPTED) && first.even() && low_degree {
            return Ok(Some(EIGHT_GROWTH * first.worst.sqrt()));
        }
        self.hermite_error_at_sixteen(request, &first)
    }

    #[inline(never)]
    fn hermite_error_at_sixteen(
        &self,
        request: &mut FitRequest<'_>,
        first: &HermiteResiduals,
    ) -> Result<Option<f64>, NotFinite> {
        let (tol, size) = (self.tolerance, request.frame.size);
        let check = *self.checked(request)?;
        let second = request.hermite_at_checked(&check);
        let worst = larger(first.worst, second.worst).sqrt();
        let settled = second.drift * second.drift * size <= FOOT_DRIFT * tol;
        if !(worst <= SMALL_ERROR * tol && settled && first.resolved(Some(&second))) {
            return Ok(None);
        }
        if self.form.is_none() {
            return Ok(Some(worst));
        }
        let [a, b] = request.frame.home;
        let (mut s0, mut s1) = ([0.0; 8], [0.0; 8]);
        for i in 0..8 {
            s0[i] = clamp_unit(FITTED[i] * UNIT + first.ds[i]);
            s1[i] = clamp_unit(CHECKED[i] * UNIT + second.ds[i]);
        }
        let error = self.proven(request, &FitState { a, b, s: s0 }, [&s0, &s1], worst)?;
        Ok((error <= tol).then_some(error))
    }

    /// The outcome, if the image is straight to rounding.
    #[inline(always)]
    pub(crate) fn line(&self, request: &FitRequest<'_>) -> Result<Option<FitOutcome>, NotFinite> {
        let size = request.frame.size;
        match straight(request.g, request.from, request.to, size, self.tolerance) {
            None => Ok(None),
            Some(line) => self.line_outcome(request, line).map(Some),
        }
    }

    #[cold]
    fn line_outcome(&self, request: &FitRequest<'_>, (line, off): (Line, f64)) -> Result<FitOutcome, NotFinite> {
        let piece = Piece::Line(line);
        if self.form.is_none() || request.frame.size == 0.0 {
            return Ok(FitOutcome::Fits { piece, error: off, reach: off });
        }
        let error = match &self.form {
            None => 0.0,
            Some(form) => proof::line(self.source, form, request.from, request.to, request.frame.size, self.tolerance)?,
        };
        if error <= self.tolerance {
            return Ok(FitOutcome::Fits { piece, error, reach: error });
        }
        Ok(FitOutcome::Misses { piece, error, reach: error, cusp: None })
    }

    /// The checked samples, taken on first use.
    #[inline(always)]
    pub(crate) fn checked<'r>(&self, request: &'r mut FitRequest<'_>) -> Result<&'r Lanes, NotFinite> {
        if request.check.is_none() {
            let mut check = Lanes::default();
            self.sample(request.from, request.to.t - request.from.t, &CHECKED, &mut check)?;
            request.check = Some(check);
        }
        Ok(request.check.get_or_insert_default())
    }

    /// The proven error of a state whose measured error is `error` with these foot points; `error` itself if there is
    /// nothing to prove it with.
    #[inline(never)]
    pub(crate) fn proven(
        &self,
        request: &mut FitRequest<'_>,
        z: &FitState,
        feet: [&Lane; 2],
        error: f64,
    ) -> Result<f64, NotFinite> {
        let Some(form) = &self.form else { return Ok(error) };
        let check = *self.checked(request)?;
        proof::piece(self.source, form, &request.candidate(z), [request.g, &check], feet, [error, self.tolerance])
    }

    /// Images at the samples `set` of a stretch of length `h`, relative to its first point.
    #[inline(always)]
    fn sample(&self, from: &BreakPoint, h: f64, set: &Lane, g: &mut Lanes) -> Result<(), NotFinite> {
        images_into(self.source, &spaced(from.t, h, set), g)?;
        for i in 0..8 {
            g.x[i] -= from.p.x;
            g.y[i] -= from.p.y;
        }
        Ok(())
    }
}

/// The outcome of fitting one piece to a stretch.
#[derive(Debug, Clone, Copy)]
pub(crate) enum FitOutcome {
    /// The piece is within the tolerance.
    Fits {
        piece: Piece,
        /// Proven, where a proof is wanted and possible.
        error: f64,
        /// Error at the fitted samples, to be compared with that of other pieces.
        reach: f64,
    },
    /// No piece within the tolerance was found.
    Misses {
        /// The best one, for use if the budget ends here.
        piece: Piece,
        error: f64,
        /// An estimate of the error that more iterations would reach: it predicts the number of pieces.
        reach: f64,
        /// A parameter at which the image nearly stops.
        cusp: Option<f64>,
    },
}

impl FitOutcome {
    pub(crate) fn fits(&self) -> bool {
        matches!(self, Self::Fits { .. })
    }

    /// The share of one piece's capacity that the stretch takes: the sixth root of error ÷ tolerance.
    pub(crate) fn difficulty(&self, tolerance: f64) -> f64 {
        let (Self::Fits { reach, .. } | Self::Misses { reach, .. }) = self;
        sixth_root((reach / tolerance).clamp(MIN_RELATIVE_ERROR, MAX_DIFFICULTY))
    }
}

/// x^(1/6) to a relative 1e-4: a sixth of the exponent as a start, then two Newton steps.
fn sixth_root(x: f64) -> f64 {
    /// Five sixths of the bits of 1.0, which hold the exponent's bias.
    const BIAS: u64 = 0x3FF0_0000_0000_0000 / 6 * 5;
    let mut y = f64::from_bits(x.to_bits() / 6 + BIAS);
    for _ in 0..2 {
        let y2 = y * y;
        y = (5.0 * y + x / (y2 * y2 * y)) * (1.0 / 6.0);
    }
    y
}

impl<S: Source> StretchFitter<'_, S> {
    /// Fits one piece to a stretch: a line, the Hermite cubic, or the best cubic that [`improve`](Self::improve) finds.
    #[inline(never)]
    pub(crate) fn attempt(&mut self, from: &BreakPoint, to: &BreakPoint) -> Result<FitOutcome, NotFinite> {
        let mut g = Lanes::default();
        let mut request = self.start(from, to, &mut g)?;
        if let Some(line) = self.line(&request)? {
            return Ok(line);
        }
        if let Some(error) = self.hermite_error(&mut request)? {
            return Ok(FitOutcome::Fits { piece: Piece::Cubic(request.hermite()), error, reach: error });
        }
        self.improve(&mut request)
    }
}

/// The best fit so far, and its error: judged if its fit came within the tolerance, else what that would have reached.
struct BestFit {
    fit: Fit,
    error: f64,
}

impl<S: Source> StretchFitter<'_, S> {
    /// Fits a cubic where the Hermite cubic does not fit. Each attempt starts only if the ones before it have failed.
    #[inline(never)]
    pub(crate) fn improve(&mut self, request: &mut FitRequest<'_>) -> Result<FitOutcome, NotFinite> {
        if let Some(outcome) = self.exact_hermite(request)? {
            return Ok(outcome);
        }
        let fit = self.fit_from_hermite(request);
        let error = self.judged(request, &fit)?;
        let mut best = BestFit { fit, error };
        self.converge(request, &mut best)?;
        self.restart_along_valley(request, &mut best)?;
        self.minimax(request, &mut best)?;
        Ok(self.outcome(request, &best))
    }

    /// The Hermite cubic itself, where the image is that to rounding but slow spots or vanishing handles made it fail the
    /// tests for an early exit.
    #[inline(always)]
    fn exact_hermite(&self, request: &mut FitRequest<'_>) -> Result<Option<FitOutcome>, NotFinite> {
        let [a, b] = request.frame.home;
        if !(request.careful || a == 0.0 || b == 0.0) {
            return Ok(None);
        }
        let check = *self.checked(request)?;
        if !request.hermite_is_exact(&check) {
            return Ok(None);
        }
        let s = FITTED.map(|j| j * UNIT);
        let z = FitState { a, b, s };
        let error = self.proven(request, &z, [&s, &CHECKED.map(|j| j * UNIT)], 0.0)?;
        let piece = Piece::Cubic(request.cubic(&z));
        Ok((error <= self.tolerance).then_some(FitOutcome::Fits { piece, error, reach: error }))
    }

    /// Least squares from the Hermite cubic, until the error is clearly below the tolerance.
    #[inline(always)]
    fn fit_from_hermite(&self, request: &FitRequest<'_>) -> Fit {
        let frame = &request.frame;
        let [a, b] = frame.home;
        let mut z = FitState { a: larger(a, frame.floor[0]), b: larger(b, frame.floor[1]), s: [0.0; 8] };
        for i in 0..8 {
            z.s[i] = clamp_unit(FITTED[i] * UNIT + request.ds[i]);
        }
        fit(frame, request.g, z, [GOOD_ENOUGH * self.tolerance, self.tolerance])
    }

    /// Iterates to convergence a fit that stopped early but was rejected when judged.
    #[inline(always)]
    fn converge(&self, request: &mut FitRequest<'_>, best: &mut BestFit) -> Result<(), NotFinite> {
        if best.error > self.tolerance && best.fit.error <= GOOD_ENOUGH * self.tolerance {
            let mut start = best.fit.z;
            request.frame.settle(request.g, start.a, start.b, &mut start.s);
            best.fit = fit(&request.frame, request.g, start, [0.0, self.tolerance]);
            best.error = self.judged(request, &best.fit)?;
        }
        Ok(())
    }

    /// Starts again farther along the valley of equal area.
    #[inline(always)]
    fn restart_along_valley(&self, request: &mut FitRequest<'_>, best: &mut BestFit) -> Result<(), NotFinite> {
        let tol = self.tolerance;
        let frame = request.frame;
        for factor in frame.restarts(&best.fit.z, best.error, tol).into_iter().flatten() {
            let Some(start) = frame.along_valley(request.g, &best.fit.z, factor) else { continue };
            let other = fit(&frame, request.g, start, [GOOD_ENOUGH * tol, tol]);
            if other.reach < RESTART_GAIN * best.error {
                let error = self.judged(request, &other)?;
                if error < best.error {
                    *best = BestFit { fit: other, error };
                }
                if best.error <= tol {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Minimax on all sixteen samples, where that may bring the error below the tolerance.
    #[inline(always)]
    fn minimax(&self, request: &mut FitRequest<'_>, best: &mut BestFit) -> Result<(), NotFinite> {
        let tol = self.tolerance;
        if !(best.error > tol && best.error <= MINIMAX_WITHIN * tol) {
            return Ok(());
        }
        let z = best.fit.z;
        let other = FitState { s: between(&z.s), ..z };
        let check = *self.checked(request)?;
        let (z, error) = minimax(&request.frame, [request.g, &check], [z, other], [0.0, tol]);
        if error < best.error {
            let fit = Fit { z: z[0], error, reach: error, ds: [1.0; 8], squares: [0.0; 8] };
            *best = BestFit { fit, error };
            if error <= tol {
                best.error = self.judge(request, &best.fit)?;
            }
        }
        Ok(())
    }

    /// The error of a fit: judged if it comes within the tolerance, else predicted.
    #[inline(always)]
    fn judged(&self, request: &mut FitRequest<'_>, fit: &Fit) -> Result<f64, NotFinite> {
        if fit.reach <= self.tolerance { self.judge(request, fit) } else { Ok(fit.reach) }
    }

    #[inline(always)]
    fn outcome(&self, request: &FitRequest<'_>, best: &BestFit) -> FitOutcome {
        let (fit, error) = (&best.fit, best.error);
        let piece = Piece::Cubic(request.cubic(&fit.z));
        if error <= self.tolerance {
            return FitOutcome::Fits { piece, error, reach: fit.error };
        }
        let polygon = SamplePolygon::new(request.g, request.frame.q);
        let cusp = if polygon.sharp { self.cusp(request.from, request.to, polygon.length) } else { None };
        FitOutcome::Misses { piece, error: error.max(fit.error), reach: error, cusp }
    }
}

/// The polygon through the fitted samples.
pub(crate) struct SamplePolygon {
    pub(crate) length: f64,
    /// The polygon turns by more than 60° at a sample, or its speed varies more than [`SHARP_PACE`] times.
    pub(crate) sharp: bool,
}

impl SamplePolygon {
    /// From the fitted samples and the chord.
    #[inline(always)]
    pub(crate) fn new(g: &Lanes, q: Vec2) -> Self {
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

/// Samples of the search; golden sections then close in on the minimum.
const SAMPLES: usize = 48;
const SECTIONS: usize = 60;

/// Work of an evaluation that is not one of a batch.
const SINGLY: usize = 2;

impl<S: Source> StretchFitter<'_, S> {
    /// The parameter at which the image is slowest within the stretch of the given length, if it nearly stops there.
    #[cold]
    pub(crate) fn cusp(&self, from: &BreakPoint, to: &BreakPoint, length: f64) -> Option<f64> {
        self.extra.set(self.extra.get() + SINGLY * SAMPLES);
        let h = to.t - from.t;
        let speed = |tau: f64| self.source.eval(from.t + h * tau).1.hypot() * h;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixth_roots_are_near() {
        for x in [1e-3, 0.5, 1.0, 7.0, 64.0, 2.6e5] {
            let y = sixth_root(x);
            assert!((y / f64::powf(x, 1.0 / 6.0) - 1.0).abs() < 2e-4, "{x}: {y}");
        }
    }
}
