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
//!
//! **The frame.** A cubic that shares its ends P₀, P₃ and its unit end tangents T₀, T₁ with the image has two unknowns left, its handle
//! lengths a, b:
//!
//! > C(s) = P₀(B₀+B₁) + P₃(B₂+B₃) + a·T₀·B₁ − b·T₁·B₂
//!
//! Everything here is relative to P₀, so C(0) = 0 and C(1) = q = P₃−P₀.

use crate::limits::{
    DAMPING, FAR_MISS, FOOT_DRIFT, GIVE_UP, MAX_EVALUATIONS, MIN_GAIN, PROMISE_AFTER, PROMISE_GAIN, RESTART_LONGER,
    RESTART_SHORTER, RESTART_TURN, RESTART_WITHIN, RESTART_WITHIN_TURNED, RUN_EVALUATIONS, RUN_TRUST_RADIUS,
    TRUST_RADIUS,
};
use crate::sample::{Lane, Lanes, clamp_unit, fma, largest, norm_squared, residual_at};
use crate::source::{BreakPoint, NotFinite, Source, images};
use kurbo::{CubicBez, Point, Vec2};

/// The state with the smallest sum of squares that was found.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fit {
    pub(crate) z: FitState,
    /// The largest normal residual.
    pub(crate) error: f64,
    /// If the fit was given up, a prediction of the largest residual it would have reached; otherwise `error`.
    pub(crate) reach: f64,
    /// The Newton step that the foot points still have to take.
    pub(crate) ds: Lane,
    /// Squares of the normal residuals.
    pub(crate) squares: Lane,
}

/// Limits on the steps of a fit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Effort {
    evaluations: usize,
    /// Longest first step, as a share of twice the piece's size.
    trust_radius: f64,
    /// Ends a fit that is far above the tolerance: it only has to predict the number of pieces.
    gives_up: bool,
}

/// For single segments, most of which one cubic fits.
pub(crate) const USUAL: Effort = Effort { evaluations: MAX_EVALUATIONS, trust_radius: TRUST_RADIUS, gives_up: true };

/// For several segments under one cubic: it may turn much, so that the handles to start from are far off.
pub(crate) const THOROUGH: Effort =
    Effort { evaluations: RUN_EVALUATIONS, trust_radius: RUN_TRUST_RADIUS, gives_up: false };

/// Fits from `start` until the largest residual is at most `enough` or stops improving. If it stays far above `wanted`, a
/// rough fit suffices: it only has to predict the number of pieces.
///
/// The foot points of `start` must be within a Newton step of the right places; see [`ChordFrame::settle`].
#[inline(always)]
pub(crate) fn fit(frame: &ChordFrame, g: &Lanes, start: FitState, wanted: [f64; 2]) -> Fit {
    fit_with(&USUAL, frame, g, start, wanted)
}

/// As [`fit`], with another effort.
#[inline(never)]
pub(crate) fn fit_with(
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

/// Chord and end tangents of a piece, and the limits of its handles.
#[derive(Debug, Clone, Copy)]
pub struct ChordFrame {
    /// The chord.
    pub q: Vec2,
    /// Unit tangent at the start.
    pub t0: Vec2,
    /// Unit tangent at the end.
    pub t1: Vec2,
    /// Shortest handles allowed.
    pub floor: [f64; 2],
    /// Scale of the piece: roughly the largest distance of the image from its first point.
    pub size: f64,
    /// Handles of the Hermite cubic, to which the handles are pulled.
    pub home: [f64; 2],
    /// Weight of that pull in the sum of squares; nearly straight pieces leave the handles undetermined.
    pub pull: f64,
}

impl ChordFrame {
    /// The cubic with handles `a`, `b` in the power basis without its constant term: C(s) = ((c₃s + c₂)s + c₁)s.
    #[inline(always)]
    pub fn power(&self, a: f64, b: f64) -> [Vec2; 3] {
        let (u, v) = (self.t0 * (3.0 * a), self.t1 * (3.0 * b));
        [u, self.q * 3.0 - u * 2.0 - v, self.q * -2.0 + u + v]
    }

    /// The cubic in the plane.
    pub fn cubic(&self, p0: Point, p3: Point, a: f64, b: f64) -> CubicBez {
        CubicBez::new(p0, p0 + self.t0 * a, p3 - self.t1 * b, p3)
    }

    /// Moves the foot points by one Newton step. Not inlined: alone, the loop is vectorised.
    #[inline(never)]
    pub(crate) fn settle(&self, g: &Lanes, a: f64, b: f64, s: &mut Lane) {
        let c = self.power(a, b);
        for foot in 0..8 {
            let t = s[foot];
            let (rx, ry, dx, dy) = residual_at(&c, t, g.x[foot], g.y[foot]);
            s[foot] = clamp_unit(t - fma(rx, dx, ry * dy) / norm_squared(dx, dy));
        }
    }

    /// Squared distances of the samples from the cubic, after `steps` Newton steps for the foot points. A step that
    /// increases the distance, as happens near a cusp of the cubic, is not taken.
    #[inline(always)]
    pub fn distances(&self, g: &Lanes, a: f64, b: f64, s: &mut Lane, steps: usize) -> Lane {
        let c = self.power(a, b);
        let mut best = [f64::INFINITY; 8];
        let mut next = *s;
        for _ in 0..=steps {
            for i in 0..8 {
                let t = next[i];
                let (rx, ry, dx, dy) = residual_at(&c, t, g.x[i], g.y[i]);
                let d = fma(rx, rx, ry * ry);
                let better = d < best[i];
                best[i] = if better { d } else { best[i] };
                s[i] = if better { t } else { s[i] };
                next[i] = clamp_unit(t - fma(rx, dx, ry * dy) / norm_squared(dx, dy));
            }
        }
        best
    }

    /// The distances whose squares are given, signed by the side of the cubic on which each sample lies.
    #[inline(always)]
    pub fn signed_distances(&self, g: &Lanes, a: f64, b: f64, s: &Lane, squares: &Lane) -> Lane {
        let c = self.power(a, b);
        let mut out = [0.0; 8];
        for i in 0..8 {
            let (rx, ry, dx, dy) = residual_at(&c, s[i], g.x[i], g.y[i]);
            out[i] = squares[i].sqrt().copysign(fma(rx, dy, -(ry * dx)));
        }
        out
    }

    /// The second handle with which a cubic of first handle `to` has the same area as the one with handles `a`, `b`.
    pub(crate) fn slide(&self, a: f64, b: f64, to: f64) -> f64 {
        let k2 = 0.5 * self.t1.cross(self.t0);
        let (k0, k1) = (self.q.cross(self.t0), self.t1.cross(self.q));
        (k0 * a + k1 * b - k2 * a * b - k0 * to) / (k1 - k2 * to)
    }
}

/// The unknowns of a fit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FitState {
    /// Handle lengths.
    pub(crate) a: f64,
    pub(crate) b: f64,
    /// Foot points: the parameters of the points of the cubic nearest to the samples.
    pub(crate) s: Lane,
}

/// One evaluation of a state. Kept in memory and written by separate functions, so that LLVM finds only the order lane by lane,
/// and vectorises it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Residuals {
    /// Normal equations (`JᵀJ` and `Jᵀn`) and the sum of squares, each in four partial sums.
    parts: [[f64; 4]; 6],
    /// Squares of the normal residuals.
    pub(crate) squares: Lane,
    /// Newton step of the foot points, −ρ·C′/|C′|², and its derivatives with respect to a and b.
    pub(crate) ds: Lane,
    pub(crate) sa: Lane,
    pub(crate) sb: Lane,
}

/// One sample's residual ρ = C(s) − g at its foot point, with its derivatives by the handles.
pub(crate) struct SampleResidual {
    /// 1/|C′|².
    pub(crate) k: f64,
    /// The normal part times |C′|: ρ×C′.
    pub(crate) n: f64,
    pub(crate) na: f64,
    pub(crate) nb: f64,
    /// Newton step of the foot point, −ρ·C′/|C′|².
    pub(crate) ds: f64,
    pub(crate) sa: f64,
    pub(crate) sb: f64,
}

impl SampleResidual {
    /// For the cubic `c` in the power basis with unit end tangents `t0` and `t1`.
    #[inline(always)]
    pub(crate) fn new(c: &[Vec2; 3], [t0, t1]: [Vec2; 2], s: f64, [x, y]: [f64; 2]) -> Self {
        let u = 1.0 - s;
        let (rx, ry, dx, dy) = residual_at(c, s, x, y);
        let k = 1.0 / norm_squared(dx, dy);
        let su = 3.0 * s * u;
        let (b1, b2) = (su * u, su * s);
        Self {
            k,
            n: fma(rx, dy, -(ry * dx)),
            na: fma(t0.x, dy, -(t0.y * dx)) * b1,
            nb: fma(t1.y, dx, -(t1.x * dy)) * b2,
            ds: -fma(rx, dx, ry * dy) * k,
            sa: -fma(t0.x, dx, t0.y * dy) * (b1 * k),
            sb: fma(t1.x, dx, t1.y * dy) * (b2 * k),
        }
    }
}

/// Normal equations `[aa, ab, bb, an, bn]`, the sum of squares, and the square of the largest residual.
pub(crate) type NormalEquations = ([f64; 5], f64, f64);

impl Residuals {
    pub(crate) const NONE: Self =
        Self { parts: [[0.0; 4]; 6], squares: [0.0; 8], ds: [0.0; 8], sa: [0.0; 8], sb: [0.0; 8] };

    #[inline(always)]
    pub(crate) fn sums(&self) -> NormalEquations {
        let mut s = [0.0; 6];
        self.add_up(&mut s);
        ([s[0], s[1], s[2], s[3], s[4]], s[5], largest(&self.squares))
    }

    #[inline(never)]
    fn add_up(&self, out: &mut [f64; 6]) {
        for (s, v) in out.iter_mut().zip(&self.parts) {
            *s = (v[0] + v[2]) + (v[1] + v[3]);
        }
    }
}

impl ChordFrame {
    /// Adds the pull towards the Hermite handles.
    #[inline(always)]
    pub(crate) fn pulled(&self, (mut sums, squares, error): NormalEquations, z: &FitState) -> NormalEquations {
        let (da, db) = (z.a - self.home[0], z.b - self.home[1]);
        sums[0] += self.pull;
        sums[2] += self.pull;
        sums[3] += self.pull * da;
        sums[4] += self.pull * db;
        (sums, squares + self.pull * (da * da + db * db), error)
    }

    /// Moves the handles of `z` by (da, db) and the foot points along with them, and evaluates the result.
    #[inline(never)]
    pub(crate) fn advance(
        &self,
        g: &Lanes,
        [da, db]: [f64; 2],
        z: &FitState,
        at: &Residuals,
        to: &mut FitState,
        out: &mut Residuals,
    ) {
        (to.a, to.b) = (z.a + da, z.b + db);
        for i in 0..8 {
            to.s[i] = clamp_unit(z.s[i] + fma(da, at.sa[i], fma(db, at.sb[i], at.ds[i])));
        }
        self.measure(g, to, out);
    }

    /// The normal part of a residual ρ is ρ×C′/|C′|. Products of two of them need only the factor 1/|C′|², no root.
    #[inline(always)]
    fn measure(&self, g: &Lanes, z: &FitState, out: &mut Residuals) {
        let c = self.power(z.a, z.b);
        let tangents = [self.t0, self.t1];
        let o = [0.0; 8];
        let (mut n, mut na, mut nb, mut kn, mut ka, mut kb) = (o, o, o, o, o, o);
        for i in 0..8 {
            let r = SampleResidual::new(&c, tangents, z.s[i], [g.x[i], g.y[i]]);
            let k = r.k;
            (n[i], na[i], nb[i]) = (r.n, r.na, r.nb);
            (kn[i], ka[i], kb[i]) = (n[i] * k, na[i] * k, nb[i] * k);
            out.squares[i] = n[i] * n[i] * k;
            (out.ds[i], out.sa[i], out.sb[i]) = (r.ds, r.sa, r.sb);
        }
        for i in 0..4 {
            let j = i + 4;
            out.parts[0][i] = fma(ka[i], na[i], ka[j] * na[j]);
            out.parts[1][i] = fma(ka[i], nb[i], ka[j] * nb[j]);
            out.parts[2][i] = fma(kb[i], nb[i], kb[j] * nb[j]);
            out.parts[3][i] = fma(ka[i], n[i], ka[j] * n[j]);
            out.parts[4][i] = fma(kb[i], n[i], kb[j] * n[j]);
            out.parts[5][i] = fma(kn[i], n[i], kn[j] * n[j]);
        }
    }

    /// Shortens a step to `most` and bends it along the valley of equal area. Returns the step and its length.
    #[inline(always)]
    pub(crate) fn bent(&self, [mut da, mut db]: [f64; 2], z: &FitState, most: f64) -> (f64, f64, f64) {
        let longest = da.abs().max(db.abs());
        if longest > most {
            // Out of line: the division is rarely needed and would delay everything after it.
            [da, db] = shortened([da, db], most / longest);
        }
        let k2 = 0.5 * self.t1.cross(self.t0);
        let (ga, gb) = (self.q.cross(self.t0) - k2 * z.b, self.t1.cross(self.q) - k2 * z.a);
        let g2 = ga * ga + gb * gb;
        let (va, vb) = (ga / g2, gb / g2);
        let e = k2 * da * db;
        // The correction is of second order in the step. If it is not small, the quadratic model of the valley is wrong.
        if e * e < 0.25 * (da * da + db * db) * g2 {
            da += e * va;
            db += e * vb;
        }
        ((z.a + da).max(self.floor[0]) - z.a, (z.b + db).max(self.floor[1]) - z.b, longest.min(most))
    }
}

/// The Gauss–Newton step, and the amount by which it should lower the sum of squares. `None` if the samples do not
/// determine a step.
#[inline(always)]
pub(crate) fn gauss_newton(sums: &[f64; 5]) -> Option<([f64; 2], f64)> {
    let [mut aa, ab, mut bb, an, bn] = *sums;
    aa += aa * DAMPING;
    bb += bb * DAMPING;
    let det = aa * bb - ab * ab;
    let k = 1.0 / det;
    let (da, db) = ((ab * bn - bb * an) * k, (ab * an - aa * bn) * k);
    (det > 0.0 && k.is_finite()).then_some(([da, db], -(da * an + db * bn)))
}

#[cold]
#[inline(never)]
fn shortened([da, db]: [f64; 2], by: f64) -> [f64; 2] {
    [da * by, db * by]
}

impl ChordFrame {
    /// Factors for the first handle to start again with, or `None` if that would not help. Only near misses profit; and on
    /// pieces that turn much, only very near ones. The first factor makes the handles more even, which more often succeeds.
    #[inline(always)]
    pub(crate) fn restarts(&self, z: &FitState, error: f64, tolerance: f64) -> Option<[f64; 2]> {
        let within = if self.t0.dot(self.t1) > RESTART_TURN { RESTART_WITHIN } else { RESTART_WITHIN_TURNED };
        let near = error > tolerance && error < within * tolerance;
        let longer_first = [RESTART_LONGER, RESTART_SHORTER];
        near.then(|| if z.a < z.b { longer_first } else { [longer_first[1], longer_first[0]] })
    }

    /// The state with the first handle `factor` times as long and the same area, if its handles are possible.
    #[inline(always)]
    pub(crate) fn along_valley(&self, g: &Lanes, z: &FitState, factor: f64) -> Option<FitState> {
        let a = z.a * factor;
        let b = self.slide(z.a, z.b, a);
        if !(b > self.floor[1] && b < self.size) {
            return None;
        }
        let mut start = FitState { a, b, s: z.s };
        self.settle(g, a, b, &mut start.s);
        Some(start)
    }
}

/// The data of one request.
pub(crate) struct FitRequest<'a> {
    pub(crate) from: &'a BreakPoint,
    pub(crate) to: &'a BreakPoint,
    pub(crate) frame: ChordFrame,
    /// Images at the fitted samples, relative to the first point.
    pub(crate) g: &'a Lanes,
    /// Images at the checked samples; taken on demand.
    pub(crate) check: Option<Lanes>,
    /// Newton steps of the foot points on the Hermite cubic.
    pub(crate) ds: Lane,
    /// Forces a dense check.
    pub(crate) careful: bool,
}

impl FitRequest<'_> {
    /// The cubic of a state.
    pub(crate) fn cubic(&self, z: &FitState) -> CubicBez {
        self.frame.cubic(self.from.p, self.to.p, z.a, z.b)
    }

    /// A state as checks and proofs want it.
    pub(crate) fn candidate(&self, z: &FitState) -> Candidate {
        Candidate { t0: self.from.t, t1: self.to.t, p0: self.from.p, frame: self.frame, a: z.a, b: z.b }
    }

    /// The Hermite cubic.
    #[inline(always)]
    pub(crate) fn hermite(&self) -> CubicBez {
        let [a, b] = self.frame.home;
        self.frame.cubic(self.from.p, self.to.p, a, b)
    }
}

/// A fitted cubic.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Candidate {
    /// Parameters of the stretch.
    pub(crate) t0: f64,
    pub(crate) t1: f64,
    /// First point; everything else is relative to it.
    pub(crate) p0: Point,
    pub(crate) frame: ChordFrame,
    /// Handle lengths.
    pub(crate) a: f64,
    pub(crate) b: f64,
}

impl Candidate {
    /// The curve's parameter at `tau` in [0, 1] of the piece.
    pub(crate) fn param(&self, tau: f64) -> f64 {
        self.t0 + (self.t1 - self.t0) * tau
    }

    /// The place of the curve's parameter `t` on the piece; inside it if in [0, 1].
    pub(crate) fn tau(&self, t: f64) -> f64 {
        (t - self.t0) / (self.t1 - self.t0)
    }

    /// Images at `tau`, relative to the first point.
    pub(crate) fn images(&self, source: &impl Source, tau: &Lane) -> Result<Lanes, NotFinite> {
        let mut t = [0.0; 8];
        for i in 0..8 {
            t[i] = self.param(tau[i]);
        }
        let mut g = images(source, &t)?;
        for i in 0..8 {
            g.x[i] -= self.p0.x;
            g.y[i] -= self.p0.y;
        }
        Ok(g)
    }
}

/// A state with foot points and squared distances of the fitted samples.
pub(crate) struct Measured<'a> {
    pub(crate) z: &'a FitState,
    pub(crate) s: Lane,
    pub(crate) squares: Lane,
    pub(crate) error: f64,
}

/// Moves the foot points by the Newton step that is left to do. A normal residual is the distance up to κδ²/2, with δ the rest
/// of the way; if that is too much, measures the distances anew.
#[inline(always)]
pub(crate) fn settled<'f>(frame: &ChordFrame, g: &Lanes, fit: &'f Fit, tolerance: f64) -> Measured<'f> {
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
