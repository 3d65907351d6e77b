//! Fits the two handle lengths of a cubic to samples of the *image*, the curve that the cubic is to replace.
//!
//! **The unknowns.** A cubic that shares its ends P₀, P₃ and its unit end tangents T₀, T₁ with the image has two unknowns left, its
//! handle lengths a and b. With the Bernstein polynomials Bₖ,
//!
//! > C(s) = P₀(B₀+B₁) + P₃(B₂+B₃) + a·T₀·B₁ − b·T₁·B₂
//!
//! Coordinates are relative to P₀, so C(0) = 0 and C(1) = q = P₃−P₀. Chosen well, the handles bring the error down to sixth order in the
//! piece's length (de Boor, Höllig, Sabin, *High accuracy geometric Hermite interpolation*, CAGD 4, 1987). The Hermite cubic, whose end
//! derivatives are those of the image, gives fourth order.
//!
//! **Variable projection.** Each sample gᵢ has a foot point sᵢ, the parameter of the nearest point of the cubic. There the residual
//! ρᵢ = C(sᵢ) − gᵢ is normal to the curve, so its length nᵢ does not depend on sᵢ to first order. Gauss–Newton therefore minimises Σnᵢ²
//! over (a, b) alone, with two by two normal equations, and the foot points follow by a Newton step
//!
//! > δsᵢ = −(ρᵢ + δa·T₀B₁ − δb·T₁B₂)·C′ / |C′|²
//!
//! The terms with δa and δb are the movement of the curve under the foot point. Without them, the foot points lag one step behind.
//!
//! **The curved valley.** To leading order nᵢ ≈ s²(1−s)²·(mismatch of the area under the curve). The sum of squares is therefore a valley
//! along the curves of equal area in the (a, b) plane. The area is proportional to α(a, b) = k₀a + k₁b − k₂ab with k₀ = q×T₀, k₁ = T₁×q,
//! k₂ = (T₁×T₀)/2 (compare Levien's quartic in *Fitting cubic Bézier curves*, 2021, which solves for area and moment). A straight step
//! (δa, δb) leaves the valley by −k₂δaδb; one Newton step along ∇α returns to it.
//!
//! **Minimax.** Where least squares just miss the tolerance, Gauss–Newton for the uniform norm makes the largest of sixteen residuals as
//! small as possible. To first order the residuals are nᵢ + δa·aᵢ + δb·bᵢ, and the step is their best uniform approximation by zero. It
//! is levelled on three of the samples, a *reference* (E. Stiefel, *Über diskrete und lineare Tschebyscheff-Approximationen*, Numer.
//! Math. 1, 1959):
//!
//! > λᵢ = (aⱼ, bⱼ) × (aₖ, bₖ), and so on in turn; h = Σλᵢnᵢ / Σ|λᵢ|; nᵢ + δa·aᵢ + δb·bᵢ = h·sgn λᵢ
//!
//! |h| is the least error that three residuals allow, and the least error of all sixteen is the largest |h| of any three. So the sample
//! with the largest residual replaces the one of the reference that leaves the largest |h|, until no residual exceeds |h|.
//!
//! In the code a *state* is (a, b, s), `g` are the samples, `n` is a normal residual with the derivatives `na`, `nb` by the handles, and `ds`
//! the Newton step of a foot point with the derivatives `sa`, `sb`. Every stage works on eight samples at once (`Lane`, `Lanes`).

use crate::limits::{
    GIVE_UP, GOOD_ENOUGH, MAX_EVALUATIONS, MIN_GAIN, MINIMAX_HOPE, MINIMAX_WITHIN, PROMISE_AFTER, RESTART_FACTOR,
    RESTART_WITHIN, RUN_EVALUATIONS, TRUST_RADIUS,
};
use crate::sample::{Lane, Lanes, clamp_unit, fma, larger, largest, norm_squared, residual_at};
use crate::source::{BreakPoint, Result, Source, images};
use kurbo::{CubicBez, Point, Vec2};

/// Result of a fit: the state with the smallest sum of squares.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fit {
    pub(crate) state: FitState,
    /// The largest normal residual.
    pub(crate) error: f64,
    /// If the fit was given up, a prediction of the largest residual it would have reached; otherwise `error`.
    pub(crate) predicted: f64,
    /// Newton step that the foot points still have to take.
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

/// Limits for parts of one segment, most of which one cubic fits.
pub(crate) const USUAL: Effort = Effort { evaluations: MAX_EVALUATIONS, trust_radius: TRUST_RADIUS, gives_up: true };

/// Limits for several segments under one cubic. It may turn much, so that the handles to start from are far off.
pub(crate) const THOROUGH: Effort = Effort { evaluations: RUN_EVALUATIONS, trust_radius: 1.0, gives_up: false };

/// Fits from `start` until the largest residual is at most `enough` or stops improving. With [`Effort::gives_up`], the fit also ends where
/// it is bound to stay far above `wanted`. The foot points of `start` must be within a Newton step ([`ChordFrame::settle`]) of the nearest
/// points.
#[inline(never)]
pub(crate) fn fit(effort: &Effort, frame: &ChordFrame, g: &Lanes, start: FitState, [enough, wanted]: [f64; 2]) -> Fit {
    let (enough, beyond) = (enough * enough, (GIVE_UP * wanted).powi(2));
    // The best state so far and the trial state alternate between two slots. Errors are squared in this function.
    let mut states = [start, start];
    let mut r = [Residuals::NONE; 2];
    let (mut best, mut error) = (0, f64::INFINITY);
    let (mut sums, mut squares) = ([0.0; 5], f64::INFINITY);
    let (mut step, mut length) = ([0.0; 2], 0.0);
    let mut trust = 0.5 * effort.trust_radius * frame.size;
    let mut remaining = 1.0;
    for evaluation in 1.. {
        let [state0, state1] = &mut states;
        let [r0, r1] = &mut r;
        let (from, to) = if best == 0 { ((&*state0, &*r0), (state1, r1)) } else { ((&*state1, &*r1), (state0, r0)) };
        frame.advance(g, step, from, to.0, to.1);
        let (new_sums, new_squares, new_error) = frame.add_pull(to.1.sums(), to.0);
        // A step that raises the sum of squares is not taken; the next one from the best state is shorter.
        if new_squares <= squares {
            (sums, squares, error) = (new_sums, new_squares, new_error);
            best = 1 - best;
            trust *= 2.0;
        } else if evaluation == 1 {
            // The sum is NaN.
            break;
        } else {
            trust = 0.25 * length;
        }
        if evaluation == effort.evaluations || error <= enough {
            break;
        }
        let Some((newton, gain)) = gauss_newton(&sums) else { break };
        if evaluation > 1 && gain < MIN_GAIN * squares {
            break;
        }
        if effort.gives_up && evaluation > PROMISE_AFTER && error * (squares - gain) > beyond * squares {
            remaining = 1.0 - gain / squares;
            break;
        }
        (step[0], step[1], length) = frame.bend_step(newton, &states[best], trust);
    }
    let Residuals { ds, squares, .. } = r[best];
    Fit { state: states[best], error: error.sqrt(), predicted: (error * remaining).sqrt(), ds, squares }
}

/// Chord, end tangents and limits of the handles of a piece.
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
    /// Size of the piece: roughly the largest distance of the image from its first point.
    pub size: f64,
    /// Handles of the Hermite cubic, towards which the fit is pulled.
    pub home: [f64; 2],
    /// Weight of that pull in the sum of squares; nearly straight pieces leave the handles undetermined.
    pub pull: f64,
}

/// Size of a piece with chord `q`: the largest distance of the chord's end and of samples 3 and 6 from its first point; if `evenly`, also
/// of their mirror images 4 and 1 from its last point.
#[inline(always)]
pub(crate) fn size(q: Vec2, g: &Lanes, evenly: bool) -> f64 {
    let far = |i: usize, p: Vec2| (Vec2::new(g.x[i], g.y[i]) - p).hypot2();
    let size = larger(larger(q.hypot2(), far(3, Vec2::ZERO)), far(6, Vec2::ZERO));
    if evenly { larger(larger(far(4, q), far(1, q)), size).sqrt() } else { size.sqrt() }
}

impl ChordFrame {
    /// Makes a frame from chord, unit end tangents, size, and the handles `home` of the Hermite cubic. Where one of those vanishes, the
    /// fitted one starts tiny and may grow. A difference of `size` from `home` counts like a residual of a twentieth of the tolerance.
    #[inline(always)]
    pub(crate) fn new(q: Vec2, [t0, t1]: [Vec2; 2], size: f64, home: [f64; 2], tolerance: f64) -> Self {
        let floor = home.map(|a| if a > 0.0 { a.min(1e-3 * size) } else { 1e-5 * size });
        Self { q, t0, t1, floor, size, home, pull: (0.05 * tolerance / size).powi(2) }
    }

    /// The cubic with handles `a`, `b` in the power basis without its constant term: C(s) = ((c₃s + c₂)s + c₁)s.
    #[inline(always)]
    pub fn power(&self, a: f64, b: f64) -> [Vec2; 3] {
        let (u, v) = (self.t0 * (3.0 * a), self.t1 * (3.0 * b));
        [u, self.q * 3.0 - u * 2.0 - v, self.q * -2.0 + u + v]
    }

    /// The cubic from `p0` to `p3` with handles `a`, `b`.
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

    /// Square roots of `squares`, signed by the side of the cubic on which each sample lies.
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

    /// Adds the pull towards the Hermite handles to the equations.
    #[inline(always)]
    pub(crate) fn add_pull(&self, (mut sums, squares, error): NormalEquations, state: &FitState) -> NormalEquations {
        let (da, db) = (state.a - self.home[0], state.b - self.home[1]);
        sums[0] += self.pull;
        sums[2] += self.pull;
        sums[3] += self.pull * da;
        sums[4] += self.pull * db;
        (sums, squares + self.pull * (da * da + db * db), error)
    }

    /// Moves the handles of a state by (da, db) and the foot points along with them, and evaluates the result.
    #[inline(never)]
    pub(crate) fn advance(
        &self,
        g: &Lanes,
        [da, db]: [f64; 2],
        (state, residuals): (&FitState, &Residuals),
        next: &mut FitState,
        out: &mut Residuals,
    ) {
        (next.a, next.b) = (state.a + da, state.b + db);
        for i in 0..8 {
            let along = fma(da, residuals.sa[i], fma(db, residuals.sb[i], residuals.ds[i]));
            next.s[i] = clamp_unit(state.s[i] + along);
        }
        self.measure(g, next, out);
    }

    /// Evaluates `state`. The normal part of a residual ρ is ρ×C′/|C′|; products of two such need only the factor 1/|C′|², no root.
    #[inline(always)]
    fn measure(&self, g: &Lanes, state: &FitState, out: &mut Residuals) {
        let c = self.power(state.a, state.b);
        let tangents = [self.t0, self.t1];
        let o = [0.0; 8];
        let (mut n, mut na, mut nb, mut kn, mut ka, mut kb) = (o, o, o, o, o, o);
        for i in 0..8 {
            let r = SampleResidual::new(&c, tangents, state.s[i], [g.x[i], g.y[i]]);
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
    pub(crate) fn bend_step(&self, [mut da, mut db]: [f64; 2], state: &FitState, most: f64) -> (f64, f64, f64) {
        let longest = da.abs().max(db.abs());
        if longest > most {
            [da, db] = [da, db].map(|d| d * (most / longest));
        }
        let k2 = 0.5 * self.t1.cross(self.t0);
        let (ga, gb) = (self.q.cross(self.t0) - k2 * state.b, self.t1.cross(self.q) - k2 * state.a);
        let g2 = ga * ga + gb * gb;
        let (va, vb) = (ga / g2, gb / g2);
        let e = k2 * da * db;
        // The correction is of second order in the step. If it is not small, the quadratic model of the valley is wrong.
        if e * e < 0.25 * (da * da + db * db) * g2 {
            da += e * va;
            db += e * vb;
        }
        ((state.a + da).max(self.floor[0]) - state.a, (state.b + db).max(self.floor[1]) - state.b, longest.min(most))
    }

    /// The state of equal area with handle number `scaled` (0 or 1) `factor` times as long. `None` if a handle is out of range.
    #[inline(always)]
    pub(crate) fn along_valley(&self, g: &Lanes, state: &FitState, (scaled, factor): (usize, f64)) -> Option<FitState> {
        let k2 = 0.5 * self.t1.cross(self.t0);
        let k = [self.q.cross(self.t0), self.t1.cross(self.q)];
        let (mut new, other) = ([state.a, state.b], 1 - scaled);
        new[scaled] *= factor;
        new[other] = (k[0] * state.a + k[1] * state.b - k2 * state.a * state.b - k[scaled] * new[scaled])
            / (k[other] - k2 * new[scaled]);
        if !(new[other] > self.floor[other] && new[other] < self.size) {
            return None;
        }
        let [a, b] = new;
        let mut start = FitState { a, b, s: state.s };
        self.settle(g, a, b, &mut start.s);
        Some(start)
    }
}

/// The unknowns of a fit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FitState {
    /// Handle lengths.
    pub(crate) a: f64,
    pub(crate) b: f64,
    /// Foot points: parameters of the points of the cubic nearest to the samples.
    pub(crate) s: Lane,
}

/// Evaluation of a state. It lies in memory and separate functions write it, so that LLVM sees nothing but loops over the lanes and
/// vectorises them.
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

/// Residual ρ = C(s) − g of one sample at its foot point, with the derivatives by the handles.
pub(crate) struct SampleResidual {
    /// 1/|C′|².
    pub(crate) k: f64,
    /// Normal part times |C′|: ρ×C′.
    pub(crate) n: f64,
    pub(crate) na: f64,
    pub(crate) nb: f64,
    /// Newton step of the foot point, −ρ·C′/|C′|².
    pub(crate) ds: f64,
    pub(crate) sa: f64,
    pub(crate) sb: f64,
}

impl SampleResidual {
    /// Evaluates the cubic `c`, in the power basis and with unit end tangents `t0` and `t1`, at `s` against the sample (`x`, `y`).
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

/// The Gauss–Newton step and the decrease of the sum of squares that it promises. `None` if the samples do not determine a step.
#[inline(always)]
pub(crate) fn gauss_newton(sums: &[f64; 5]) -> Option<([f64; 2], f64)> {
    let [aa, ab, bb, an, bn] = *sums;
    let det = aa * bb - ab * ab;
    let inverse = 1.0 / det;
    let (da, db) = ((ab * bn - bb * an) * inverse, (ab * an - aa * bn) * inverse);
    (det > 0.0 && inverse.is_finite()).then_some(([da, db], -(da * an + db * bn)))
}

/// Ends, frame and samples of a piece that is to be fitted.
pub(crate) struct FitRequest<'a> {
    pub(crate) from: &'a BreakPoint,
    pub(crate) to: &'a BreakPoint,
    pub(crate) frame: ChordFrame,
    /// Images at the fitted samples, relative to the first point.
    pub(crate) g: &'a Lanes,
    /// Images at the checked samples; taken on demand.
    pub(crate) check: Option<Lanes>,
    /// Set if a slow spot lies in the stretch: samples alone must not decide.
    pub(crate) careful: bool,
}

impl FitRequest<'_> {
    /// The cubic of a state.
    pub(crate) fn cubic(&self, state: &FitState) -> CubicBez {
        self.frame.cubic(self.from.p, self.to.p, state.a, state.b)
    }

    /// The cubic of a state, in the form that checks and proofs take.
    pub(crate) fn candidate(&self, state: &FitState) -> Candidate {
        Candidate { t0: self.from.t, t1: self.to.t, p0: self.from.p, frame: self.frame, a: state.a, b: state.b }
    }
}

/// A fitted cubic and the stretch of the source that it replaces.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Candidate {
    /// Ends of the stretch, in the source's parameter.
    pub(crate) t0: f64,
    pub(crate) t1: f64,
    /// First point; the frame and all images are relative to it.
    pub(crate) p0: Point,
    pub(crate) frame: ChordFrame,
    /// Handle lengths.
    pub(crate) a: f64,
    pub(crate) b: f64,
}

impl Candidate {
    /// The source's parameter at `tau` in [0, 1] of the piece.
    pub(crate) fn param(&self, tau: f64) -> f64 {
        self.t0 + (self.t1 - self.t0) * tau
    }

    /// Inverse of [`Self::param`]: in [0, 1] if `t` is on the piece.
    pub(crate) fn tau(&self, t: f64) -> f64 {
        (t - self.t0) / (self.t1 - self.t0)
    }

    /// Points of the image at `tau`, relative to the first point.
    pub(crate) fn images(&self, source: &impl Source, tau: &Lane) -> Result<Lanes> {
        let mut g = images(source, &tau.map(|tau| self.param(tau)))?;
        for i in 0..8 {
            g.x[i] -= self.p0.x;
            g.y[i] -= self.p0.y;
        }
        Ok(g)
    }
}

/// Consecutive foot points count as in order if the second is no further before the first than this.
pub const FOOT_ROUNDING: f64 = 1e-9;

/// A normal residual differs from the distance by κδ²/2, where κ is the curvature and δ the way that the foot point still has to go. Below
/// this share of the tolerance the difference is ignored; κ is taken as the inverse of the piece's size, δ as the size times the step of the
/// foot point.
pub(crate) const DRIFT: f64 = 0.02;

/// A state with settled foot points and the squared distances of the fitted samples.
pub(crate) struct Measured<'a> {
    pub(crate) state: &'a FitState,
    pub(crate) s: Lane,
    pub(crate) squares: Lane,
    pub(crate) error: f64,
}

/// Moves the foot points by the Newton step that is left to do. Measures the distances anew if a foot point moves too far.
#[inline(always)]
pub(crate) fn settled<'f>(frame: &ChordFrame, g: &Lanes, fit: &'f Fit, tolerance: f64) -> Measured<'f> {
    let state = &fit.state;
    let mut s = [0.0; 8];
    let mut drift = [0.0; 8];
    for i in 0..8 {
        s[i] = clamp_unit(state.s[i] + fit.ds[i]);
        drift[i] = fit.ds[i].abs();
    }
    let drift = largest(&drift);
    let (mut error, mut squares) = (fit.error, fit.squares);
    if drift * drift * frame.size > DRIFT * tolerance {
        s = state.s;
        squares = frame.distances(g, state.a, state.b, &mut s, 2);
        error = largest(&squares).sqrt();
    }
    Measured { state, s, squares, error }
}

/// Normal residuals at eight samples, with their derivatives.
struct Normals {
    n: Lane,
    /// Derivatives by the handles.
    na: Lane,
    nb: Lane,
    /// Newton step of the foot points, with its derivatives by the handles.
    ds: Lane,
    sa: Lane,
    sb: Lane,
}

impl Normals {
    const NONE: Self = Self { n: [0.0; 8], na: [0.0; 8], nb: [0.0; 8], ds: [0.0; 8], sa: [0.0; 8], sb: [0.0; 8] };

    /// Evaluates the state. Not inlined: alone, the loop is vectorised.
    #[inline(never)]
    fn measure(&mut self, frame: &ChordFrame, g: &Lanes, state: &FitState) {
        let c = frame.power(state.a, state.b);
        for i in 0..8 {
            let r = SampleResidual::new(&c, [frame.t0, frame.t1], state.s[i], [g.x[i], g.y[i]]);
            let unit = r.k.sqrt();
            (self.n[i], self.na[i], self.nb[i]) = (r.n * unit, r.na * unit, r.nb * unit);
            (self.ds[i], self.sa[i], self.sb[i]) = (r.ds, r.sa, r.sb);
        }
    }
}

/// Fits all sixteen samples from `start`, whose halves have the same handles, until the largest residual is at most `wanted`. Ends
/// early where the next step would still leave it clearly above `tolerance`. Returns the best state of both halves, and its largest
/// residual.
pub(crate) fn minimax(
    frame: &ChordFrame,
    g: [&Lanes; 2],
    start: [FitState; 2],
    ([wanted, tolerance], enough): ([f64; 2], f64),
) -> ([FitState; 2], f64) {
    let mut state = start;
    let mut best = (start, f64::INFINITY);
    let mut r = [Normals::NONE; 2];
    for taken in 0..=STEPS {
        for h in 0..2 {
            r[h].measure(frame, g[h], &state[h]);
        }
        let error = larger(largest(&r[0].n.map(f64::abs)), largest(&r[1].n.map(f64::abs)));
        let gains = error < best.1;
        if gains {
            best = (state, error);
        }
        if !gains || error <= wanted || taken == STEPS {
            break;
        }
        let Some((step, level)) = levelled(&r, enough) else { break };
        if level > MINIMAX_HOPE * tolerance {
            break;
        }
        let (da, db, _) = frame.bend_step(step, &state[0], TRUST_RADIUS * frame.size);
        for h in 0..2 {
            state[h].a += da;
            state[h].b += db;
            for i in 0..8 {
                state[h].s[i] = clamp_unit(state[h].s[i] + fma(da, r[h].sa[i], fma(db, r[h].sb[i], r[h].ds[i])));
            }
        }
    }
    best
}

/// Number of minimax steps. They converge quadratically.
const STEPS: usize = 3;

/// Most exchanges of a sample in one step. Two or three usually suffice.
const EXCHANGES: usize = 8;

/// The samples of the first reference, counted over the fitted ones (0–7), then the checked ones (8–15): those next to a fifth, a half and
/// four fifths, where the leading form of the residual, s²(1−s)²((s−½)²−c), has its extremes.
const EXTREMES: [usize; 3] = [1, 11, 14];

/// The step that makes the largest linearised residual as small as possible, and the level |h| of that residual. `None` if the samples do
/// not determine a step.
fn levelled(r: &[Normals; 2], enough: f64) -> Option<([f64; 2], f64)> {
    let row = |i: usize| -> [f64; 3] {
        let (h, j) = (&r[i / 8], i % 8);
        [h.n[j], h.na[j], h.nb[j]]
    };
    let mut reference = EXTREMES;
    let mut rows = reference.map(row);
    let mut found = None;
    for _ in 0..EXCHANGES {
        let Some((step, level)) = Level::new(&rows).step(&rows) else { break };
        found = Some((step, level));
        let mut residuals = [0.0; 16];
        for (half, r) in residuals.chunks_exact_mut(8).zip(r) {
            for i in 0..8 {
                half[i] = fma(step[0], r.na[i], fma(step[1], r.nb[i], r.n[i])).abs();
            }
        }
        let most = (0..16).fold(0, |m, i| if residuals[i] > residuals[m] { i } else { m });
        // Rounding may leave the residuals of the reference a little above the level.
        if residuals[most] <= level * enough || reference.contains(&most) {
            break;
        }
        let new = row(most);
        let mut highest = (0, -1.0);
        for k in 0..3 {
            let mut other = rows;
            other[k] = new;
            let level = Level::new(&other).height().abs();
            if level > highest.1 {
                highest = (k, level);
            }
        }
        rows[highest.0] = new;
        reference[highest.0] = most;
    }
    found
}

/// Residuals below this multiple of the level count as level, as the step is only of first order.
const LEVELLED: f64 = 1.001;

/// Multiple of the level that counts as level in fits that must be alike from either end.
const LEVELLED_EVENLY: f64 = 1.0 + 1e-9;

/// Handles whose relative difference is less than this belong to a symmetrical curve.
const SAME_HANDLES: f64 = 1e-7;

/// Level of three residuals: the weights λᵢ and Σλᵢnᵢ.
struct Level {
    weights: [f64; 3],
    sum: f64,
}

impl Level {
    /// Makes the level of three rows, each a residual with its derivatives by the handles.
    fn new([p, q, r]: &[[f64; 3]; 3]) -> Self {
        let cross = |u: &[f64; 3], v: &[f64; 3]| u[1] * v[2] - u[2] * v[1];
        let weights = [cross(q, r), cross(r, p), cross(p, q)];
        Self { weights, sum: weights[0] * p[0] + weights[1] * q[0] + weights[2] * r[0] }
    }

    /// The level h; 0 if the derivatives of all three are parallel.
    fn height(&self) -> f64 {
        let size: f64 = self.weights.iter().map(|w| w.abs()).sum();
        if size > 0.0 { self.sum / size } else { 0.0 }
    }

    /// The step that levels the three rows, solved from the two that are furthest from parallel, and |h|.
    fn step(&self, rows: &[[f64; 3]; 3]) -> Option<([f64; 2], f64)> {
        let height = self.height();
        let k = (0..3).fold(0, |m, i| if self.weights[i].abs() > self.weights[m].abs() { i } else { m });
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let wanted = |i: usize| height * self.weights[i].signum() - rows[i][0];
        let (u, v) = (wanted(i), wanted(j));
        let scale = 1.0 / self.weights[k];
        let step = [(u * rows[j][2] - v * rows[i][2]) * scale, (v * rows[i][1] - u * rows[j][1]) * scale];
        (step[0].is_finite() && step[1].is_finite()).then_some((step, height.abs()))
    }
}

/// A piece with its samples, which judges its fits.
pub(crate) trait Fitting {
    /// Findings of a judgement besides the error.
    type Mark: Default;

    /// The frame and the fitted samples.
    fn samples(&self) -> (&ChordFrame, &Lanes);

    /// The checked samples, which lie between the fitted ones.
    fn checked(&mut self) -> Result<Lanes>;

    /// Foot points of the checked samples, interpolated from those of the fitted ones.
    fn feet_between(&self, s: &Lane) -> Lane;

    /// Returns `true` if fits must be the same from either end, so that even handles stay even.
    fn evenly(&self) -> bool;

    /// Error of a fit that promises to come within the tolerance; above the tolerance if the fit must be rejected.
    fn judge(&mut self, fit: &Fit) -> Result<(f64, Self::Mark)>;
}

/// The best fit so far, with its error: the judged one if the fit came within the tolerance, else [`Fit::predicted`].
pub(crate) struct BestFit<M> {
    pub(crate) fit: Fit,
    pub(crate) error: f64,
    pub(crate) mark: M,
}

impl<M: Default> BestFit<M> {
    /// Judges a fit, unless it is predicted to miss the tolerance.
    #[inline(always)]
    pub(crate) fn judged(fit: Fit, on: &mut impl Fitting<Mark = M>, tolerance: f64) -> Result<Self> {
        let (error, mark) = if fit.predicted <= tolerance { on.judge(&fit)? } else { (fit.predicted, M::default()) };
        Ok(Self { fit, error, mark })
    }

    /// Improves the fit by minimax on all sixteen samples until the error is at most `wanted`.
    pub(crate) fn minimise(&mut self, on: &mut impl Fitting<Mark = M>, [wanted, tolerance]: [f64; 2]) -> Result<()> {
        let (state, check) = (self.fit.state, on.checked()?);
        let other = FitState { s: on.feet_between(&state.s), ..state };
        let enough = if on.evenly() { LEVELLED_EVENLY } else { LEVELLED };
        let (frame, g) = on.samples();
        let (state, error) = minimax(frame, [g, &check], [state, other], ([wanted, tolerance], enough));
        if error < self.error {
            let fit = Fit { state: state[0], error, predicted: error, ds: [1.0; 8], squares: [0.0; 8] };
            *self = Self::judged(fit, on, tolerance)?;
            self.error = larger(self.error, error);
        }
        Ok(())
    }
}

/// The best fit from `start` on. Each further attempt is made only if the ones before it have failed.
#[inline(always)]
pub(crate) fn best_fit<F: Fitting>(
    on: &mut F,
    effort: &Effort,
    start: FitState,
    tolerance: f64,
) -> Result<BestFit<F::Mark>> {
    let fitted = |on: &F, start: FitState, enough: f64| {
        let (frame, g) = on.samples();
        fit(effort, frame, g, start, [enough * tolerance, tolerance])
    };
    let mut best = BestFit::judged(fitted(on, start, GOOD_ENOUGH), on, tolerance)?;
    if best.error <= tolerance {
        return Ok(best);
    }
    // Iterate to convergence a fit that stopped early but was rejected.
    if best.fit.error <= GOOD_ENOUGH * tolerance {
        let (mut start, (frame, g)) = (best.fit.state, on.samples());
        frame.settle(g, start.a, start.b, &mut start.s);
        best = BestFit::judged(fitted(on, start, 0.0), on, tolerance)?;
    }
    // Start again farther along the valley of equal area, from more even handles first, which more often succeeds. If fits must be the
    // same from either end, the shorter handle is scaled, and even handles are left alone.
    let FitState { a, b, .. } = best.fit.state;
    let even = if a < b || on.evenly() { RESTART_FACTOR } else { 1.0 / RESTART_FACTOR };
    let scaled = usize::from(on.evenly() && b < a);
    let near = best.error < RESTART_WITHIN * tolerance && !(on.evenly() && (a - b).abs() <= SAME_HANDLES * a);
    for factor in [even, 1.0 / even] {
        if !near || best.error <= tolerance {
            break;
        }
        let (frame, g) = on.samples();
        let Some(start) = frame.along_valley(g, &best.fit.state, (scaled, factor)) else { continue };
        let other = fitted(on, start, GOOD_ENOUGH);
        if other.predicted < best.error {
            let other = BestFit::judged(other, on, tolerance)?;
            if other.error < best.error {
                best = other;
            }
        }
    }
    if best.error > tolerance && best.error <= MINIMAX_WITHIN * tolerance {
        best.minimise(on, [0.0, tolerance])?;
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Residuals and derivatives from smooth functions, much as in a fit, with random phases.
    fn rows(seed: u64) -> [Normals; 2] {
        let mut state = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let (p, q, skew) = (random(), random(), random());
        let mut r = [Normals::NONE, Normals::NONE];
        for (h, half) in r.iter_mut().enumerate() {
            for i in 0..8 {
                let s = (2 * i + h + 1) as f64 / 17.0;
                let u = 1.0 - s;
                half.n[i] = s * s * u * u * ((s - 0.5 + 0.2 * p) * (s - 0.5 + 0.3 * q) - 0.1) + 0.001 * random();
                (half.na[i], half.nb[i]) = (s * u * u * (1.0 + skew * s), s * s * u * (1.0 - p * s));
            }
        }
        r
    }

    fn row(r: &[Normals; 2], i: usize) -> [f64; 3] {
        [r[i / 8].n[i % 8], r[i / 8].na[i % 8], r[i / 8].nb[i % 8]]
    }

    /// By duality, the least possible maximum is the largest level of any three residuals (de la Vallée Poussin).
    #[test]
    fn the_step_is_the_best_uniform_approximation() {
        for seed in 0..200 {
            let r = rows(seed);
            let (step, level) = levelled(&r, LEVELLED).unwrap();
            let mut least = 0.0f64;
            for i in 0..16 {
                for j in 0..i {
                    for k in 0..j {
                        least = least.max(Level::new(&[row(&r, i), row(&r, j), row(&r, k)]).height().abs());
                    }
                }
            }
            let reached = (0..16).map(|i| row(&r, i)).map(|[n, a, b]| (n + step[0] * a + step[1] * b).abs());
            let reached = reached.fold(0.0, f64::max);
            assert!(
                level <= least * (1.0 + 1e-12) && reached >= least * (1.0 - 1e-12),
                "{seed}: {level} {least} {reached}"
            );
            assert!(reached <= LEVELLED * least, "{seed}: {reached} above {least}");
        }
    }

    #[test]
    fn parallel_derivatives_determine_no_step() {
        let mut r = rows(1);
        for half in &mut r {
            half.nb = half.na.map(|a| 2.0 * a);
        }
        assert!(levelled(&r, LEVELLED).is_none());
    }
}
