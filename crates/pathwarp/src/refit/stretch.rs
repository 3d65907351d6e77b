//! One stretch of a curve: its samples, and the two quick outcomes, a line and the Hermite cubic.

use super::frame::ChordFrame;
use super::hermite::HermiteResiduals;
use super::lanes::{Lane, Lanes, clamp_unit, larger};
use super::limits::{
    EIGHT_ACCEPTED, EIGHT_GROWTH, FOOT_DRIFT, HANDLE_FLOOR, HANDLE_FLOOR_STOPPED, HANDLE_PULL, SMALL_ERROR,
};
use super::outcome::FitOutcome;
use super::piece::FittedPiece;
use super::proof::{self, RationalForm};
use super::request::FitRequest;
use super::residuals::FitState;
use super::samples::{CHECKED, FITTED, UNIT, spaced};
use super::source::{BreakPoint, SourceCurve};
use super::split::SlowSpots;
use super::straight::straight;
use crate::map::RationalDegree;
use kurbo::{Line, Point};
use std::cell::Cell;

/// Fits pieces to stretches of one smooth curve.
pub(super) struct StretchFitter<'a> {
    pub(super) source: &'a SourceCurve<'a>,
    pub(super) slow: &'a SlowSpots,
    pub(super) tolerance: f64,
    /// The image as a quotient of polynomials, if proofs are wanted and possible.
    pub(super) form: Option<RationalForm>,
    /// The map's degree, if it is a quotient of polynomials and the ends of the pieces lie on its image.
    pub(super) degree: Option<RationalDegree>,
    pub(super) attempts: usize,
    /// Evaluations besides those of attempts with their usual checks, so far.
    pub(super) extra: Cell<usize>,
    /// The number of attempts at which the work ends.
    pub(super) most_attempts: usize,
}

impl StretchFitter<'_> {
    /// Takes the fitted samples and sets up the frame.
    #[inline(always)]
    pub(super) fn start<'r>(
        &mut self,
        from: &'r BreakPoint,
        to: &'r BreakPoint,
        g: &'r mut Lanes,
    ) -> Result<FitRequest<'r>, Point> {
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
    pub(super) fn hermite_error(&self, request: &mut FitRequest<'_>) -> Result<Option<f64>, Point> {
        let (tol, size) = (self.tolerance, request.frame.size);
        let first = request.hermite_at_fitted();
        request.ds = first.ds;
        let [a, b] = request.frame.home;
        let within = |worst: f64, share: f64| worst <= (share * tol).powi(2) && a > 0.0 && b > 0.0 && !request.careful;
        let settled = |drift: f64| drift * drift * size <= FOOT_DRIFT * tol;
        if !(within(first.worst, SMALL_ERROR) && settled(first.drift) && first.resolved(None)) {
            return Ok(None);
        }
        let low_degree = self.degree.is_some() && self.form.is_none();
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
    ) -> Result<Option<f64>, Point> {
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
    pub(super) fn line(&self, request: &FitRequest<'_>) -> Result<Option<FitOutcome>, Point> {
        let size = request.frame.size;
        match straight(request.g, request.from, request.to, size, self.tolerance) {
            None => Ok(None),
            Some(line) => self.line_outcome(request, line).map(Some),
        }
    }

    #[cold]
    fn line_outcome(&self, request: &FitRequest<'_>, (line, off): (Line, f64)) -> Result<FitOutcome, Point> {
        let piece = FittedPiece::Line(line);
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
    pub(super) fn checked<'r>(&self, request: &'r mut FitRequest<'_>) -> Result<&'r Lanes, Point> {
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
    pub(super) fn proven(
        &self,
        request: &mut FitRequest<'_>,
        z: &FitState,
        feet: [&Lane; 2],
        error: f64,
    ) -> Result<f64, Point> {
        let Some(form) = &self.form else { return Ok(error) };
        let check = *self.checked(request)?;
        proof::piece(self.source, form, &request.candidate(z), [request.g, &check], feet, [error, self.tolerance])
    }

    /// Images at the samples `set` of a stretch of length `h`, relative to its first point.
    #[inline(always)]
    fn sample(&self, from: &BreakPoint, h: f64, set: &Lane, g: &mut Lanes) -> Result<(), Point> {
        self.source.images_into(&spaced(from.t, h, set), g)?;
        for i in 0..8 {
            g.x[i] -= from.p.x;
            g.y[i] -= from.p.y;
        }
        Ok(())
    }
}
