//! Judges a fit: its error by the cheapest test that can decide, from eight samples to a dense check or a proof.

use super::check;
use super::fit::Fit;
use super::frame::ChordFrame;
use super::lanes::{Lane, Lanes, clamp_unit, larger, largest};
use super::limits::{DENSE_ACCEPTED, EIGHT_ACCEPTED, EIGHT_GROWTH, FOOT_DRIFT, PEAK_ACCEPTED, SMALL_ERROR};
use super::peaks::highest_peak;
use super::request::FitRequest;
use super::residuals::FitState;
use super::resolution::{Resolution, steady};
use super::samples::{Evenly, between, interleaved};
use super::stretch::StretchFitter;
use kurbo::Point;

/// A state with foot points and squared distances of the fitted samples.
pub(super) struct Measured<'a> {
    z: &'a FitState,
    pub(super) s: Lane,
    pub(super) squares: Lane,
    pub(super) error: f64,
}

/// Moves the foot points by the Newton step that is left to do. A normal residual is the distance up to κδ²/2, with δ the rest
/// of the way; if that is too much, measures the distances anew.
#[inline(always)]
pub(super) fn settled<'f>(frame: &ChordFrame, g: &Lanes, fit: &'f Fit, tolerance: f64) -> Measured<'f> {
    let z = &fit.z;
    let mut s = [0.0; 8];
    let mut drift = [0.0; 8];
    for i in 0..8 {
        s[i] = clamp_unit(z.s[i] + fit.ds[i]);
        drift[i] = fit.ds[i].abs();
    }
    let drift = largest(&drift);
    let (mut error, mut squares) = (fit.error, fit.squares);
    if drift * drift * frame.size > FOOT_DRIFT * tolerance {
        s = z.s;
        squares = frame.distances(g, z.a, z.b, &mut s, 2);
        error = largest(&squares).sqrt();
    }
    Measured { z, s, squares, error }
}

impl StretchFitter<'_> {
    /// The error of a fit; above the tolerance if it must be rejected.
    #[inline(never)]
    pub(super) fn judge(&self, request: &mut FitRequest<'_>, fit: &Fit) -> Result<f64, Point> {
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
        if !(self.trusts_samples(request) && fitted.error <= limit && self.degree.is_some()) {
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
    ) -> Result<Option<f64>, Point> {
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
        if peak <= if even && self.degree.is_some() { PEAK_ACCEPTED } else { SMALL_ERROR } * tol {
            return Ok(Some(peak));
        }
        if !even {
            return Ok(None);
        }
        let closer = check::halfway(self.source, &request.candidate(z), feet, &errors, tol)?;
        Ok(closer.filter(|closer| *closer <= DENSE_ACCEPTED * tol).map(|closer| closer.max(error)))
    }

    /// Many samples.
    #[inline(never)]
    fn by_dense_check(&self, request: &FitRequest<'_>, z: &FitState, feet: &Evenly, error: f64) -> Result<f64, Point> {
        let c = request.candidate(z);
        let (e, thorough) = check::dense(self.source, &c, feet, self.slow, self.tolerance)?;
        self.thorough.set(self.thorough.get() + usize::from(thorough));
        let e = e.max(error);
        Ok(if e > DENSE_ACCEPTED * self.tolerance { e / DENSE_ACCEPTED } else { e })
    }

    /// Returns `true` if samples may decide: no proof is wanted, and no slow spot lies in the stretch.
    #[inline(always)]
    fn trusts_samples(&self, request: &FitRequest<'_>) -> bool {
        self.form.is_none() && !request.careful
    }
}
