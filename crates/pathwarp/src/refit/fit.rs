//! Fits the two handle lengths of a cubic to samples of the image.
//!
//! Chosen well, the handles bring the error down to sixth order in the piece's length (de Boor, Höllig, Sabin, *High accuracy
//! geometric Hermite interpolation*, CAGD 4, 1987); matching the parametrisation (Hermite) gives fourth order.
//!
//! **Variable projection.** Each sample gᵢ has a foot point sᵢ, the parameter of the nearest point of the cubic. There the
//! residual ρᵢ = C(sᵢ) − gᵢ is normal to the curve, so its length nᵢ does not depend on sᵢ to first order. Gauss–Newton
//! therefore runs on (a, b) alone, with two by two normal equations, and the foot points follow by a Newton step of their own
//!
//! > δsᵢ = −(ρᵢ + δa·T₀B₁ − δb·T₁B₂)·C′ / |C′|²
//!
//! Its middle part, the movement of the curve under the foot point, must not be left out: without it the foot points lag one
//! step behind.
//!
//! **The curved valley.** To leading order nᵢ ≈ s²(1−s)²·(mismatch of the area under the curve). The sum of squares is
//! therefore a valley along the curves of equal area in the (a, b) plane, and those are bent. The area is proportional to
//! α(a, b) = k₀a + k₁b − k₂ab with k₀ = q×T₀, k₁ = T₁×q, k₂ = (T₁×T₀)/2, q = P₃−P₀ (compare Levien's quartic in *Fitting
//! cubic Bézier curves*, 2021, which solves for area and moment). A straight Gauss–Newton step (δa, δb) leaves the valley by
//! −k₂δaδb; one Newton step along ∇α returns to it.

use super::frame::ChordFrame;
use super::lanes::{Lane, Lanes};
use super::limits::{
    FAR_MISS, GIVE_UP, MAX_EVALUATIONS, MIN_GAIN, PROMISE_AFTER, PROMISE_GAIN, RUN_EVALUATIONS, RUN_TRUST_RADIUS,
    TRUST_RADIUS,
};
use super::residuals::{FitState, Residuals, gauss_newton};

/// The state with the smallest sum of squares that was found.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    pub(super) z: FitState,
    /// The largest normal residual.
    pub(super) error: f64,
    /// If the fit was given up, a prediction of the largest residual it would have reached; otherwise `error`.
    pub(super) reach: f64,
    /// The Newton step that the foot points still have to take.
    pub(super) ds: Lane,
    /// Squares of the normal residuals.
    pub(super) squares: Lane,
}

/// Limits on the steps of a fit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    evaluations: usize,
    /// Longest first step, as a share of twice the piece's size.
    trust_radius: f64,
    /// Ends a fit that is far above the tolerance: it only has to predict the number of pieces.
    gives_up: bool,
}

/// For single segments, most of which one cubic fits.
pub(super) const USUAL: Effort = Effort { evaluations: MAX_EVALUATIONS, trust_radius: TRUST_RADIUS, gives_up: true };

/// For several segments under one cubic: it may turn much, so that the handles to start from are far off.
pub(super) const THOROUGH: Effort =
    Effort { evaluations: RUN_EVALUATIONS, trust_radius: RUN_TRUST_RADIUS, gives_up: false };

/// Fits from `start` until the largest residual is at most `enough` or stops improving. If it stays far above `wanted`, a
/// rough fit suffices: it only has to predict the number of pieces.
///
/// The foot points of `start` must be within a Newton step of the right places; see [`ChordFrame::settle`].
#[inline(always)]
pub(super) fn fit(frame: &ChordFrame, g: &Lanes, start: FitState, wanted: [f64; 2]) -> Fit {
    fit_with(&USUAL, frame, g, start, wanted)
}

/// As [`fit`], with another effort.
#[inline(never)]
pub(super) fn fit_with(
    effort: &Effort,
    frame: &ChordFrame,
    g: &Lanes,
    start: FitState,
    [enough, wanted]: [f64; 2],
) -> Fit {
    let (enough, far, beyond) = (enough * enough, (FAR_MISS * wanted).powi(2), (GIVE_UP * wanted).powi(2));
    // The best state so far and the trial state alternate between two slots. Errors are squared in this function.
    let mut z = [start, start];
    let mut r = [Residuals::NONE; 2];
    let (mut best, mut error) = (0, f64::INFINITY);
    let (mut sums, mut squares) = ([0.0; 5], f64::INFINITY);
    let (mut step, mut length) = ([0.0; 2], 0.0);
    let mut trust = 0.5 * effort.trust_radius * frame.size;
    let mut left = 1.0;
    for k in 1.. {
        let [z0, z1] = &mut z;
        let [r0, r1] = &mut r;
        let (from, to) = if best == 0 { ((z0, r0), (z1, r1)) } else { ((z1, r1), (z0, r0)) };
        frame.advance(g, step, from.0, from.1, to.0, to.1);
        let (sn, sq, en) = frame.pulled(to.1.sums(), to.0);
        // The first steps also settle the foot points, which may raise the sum a little.
        if sq <= squares {
            (sums, squares, error) = (sn, sq, en);
            best = 1 - best;
            trust *= 2.0;
        } else if k == 1 {
            // NaN.
            break;
        } else {
            trust = 0.25 * length;
        }
        if k == effort.evaluations || error <= enough || (effort.gives_up && k > 4 && error > far) {
            break;
        }
        let Some((newton, gain)) = gauss_newton(&sums) else { break };
        if k > 1 && gain < MIN_GAIN * squares {
            break;
        }
        let predictable = effort.gives_up && (k > PROMISE_AFTER || k == PROMISE_AFTER && gain < PROMISE_GAIN * squares);
        if predictable && error * (squares - gain) > beyond * squares {
            left = 1.0 - gain / squares;
            break;
        }
        (step[0], step[1], length) = frame.bent(newton, &z[best], trust);
    }
    Fit { z: z[best], error: error.sqrt(), reach: (error * left).sqrt(), ds: r[best].ds, squares: r[best].squares }
}
