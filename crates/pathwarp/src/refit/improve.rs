//! Attempts to find a better cubic where the Hermite cubic does not fit.

use super::fit::{Fit, fit};
use super::lanes::{clamp_unit, larger};
use super::limits::{GOOD_ENOUGH, MINIMAX_WITHIN, RESTART_GAIN};
use super::minimax::minimax;
use super::outcome::FitOutcome;
use super::piece::FittedPiece;
use super::polyline::SamplePolygon;
use super::request::FitRequest;
use super::residuals::FitState;
use super::samples::{CHECKED, FITTED, UNIT, between};
use super::stretch::StretchFitter;
use kurbo::Point;

/// The best fit so far, and its error: judged if its fit came within the tolerance, else what that would have reached.
struct BestFit {
    fit: Fit,
    error: f64,
}

impl StretchFitter<'_> {
    /// Fits a cubic where the Hermite cubic does not fit. Each attempt starts only if the ones before it have failed.
    #[inline(never)]
    pub(super) fn improve(&mut self, request: &mut FitRequest<'_>) -> Result<FitOutcome, Point> {
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
    fn exact_hermite(&self, request: &mut FitRequest<'_>) -> Result<Option<FitOutcome>, Point> {
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
        let piece = FittedPiece::Cubic(request.cubic(&z));
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
    fn converge(&self, request: &mut FitRequest<'_>, best: &mut BestFit) -> Result<(), Point> {
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
    fn restart_along_valley(&self, request: &mut FitRequest<'_>, best: &mut BestFit) -> Result<(), Point> {
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
    fn minimax(&self, request: &mut FitRequest<'_>, best: &mut BestFit) -> Result<(), Point> {
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
    fn judged(&self, request: &mut FitRequest<'_>, fit: &Fit) -> Result<f64, Point> {
        if fit.reach <= self.tolerance { self.judge(request, fit) } else { Ok(fit.reach) }
    }

    #[inline(always)]
    fn outcome(&self, request: &FitRequest<'_>, best: &BestFit) -> FitOutcome {
        let (fit, error) = (&best.fit, best.error);
        let piece = FittedPiece::Cubic(request.cubic(&fit.z));
        if error <= self.tolerance {
            return FitOutcome::Fits { piece, error, reach: fit.error };
        }
        let polygon = SamplePolygon::new(request.g, request.frame.q);
        let cusp = if polygon.sharp { self.cusp(request.from, request.to, polygon.length) } else { None };
        FitOutcome::Misses { piece, error: error.max(fit.error), reach: error, cusp }
    }
}
