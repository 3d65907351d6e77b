//! The fit of one cubic to samples of a curve: ends and end tangents fixed, the two handle lengths free.
//!
//! A cubic that shares ends P₀, P₃ and unit end tangents T₀, T₁ with the curve has two numbers left, its handle lengths a, b:
//!
//! > C(s) = P₀(B₀+B₁) + P₃(B₂+B₃) + a·T₀·B₁ − b·T₁·B₂
//!
//! Chosen well they bring the error down to the sixth order in the piece's length (de Boor, Höllig, Sabin, *High accuracy
//! geometric Hermite interpolation*, CAGD 4, 1987), where matching the parametrisation (Hermite) gives the fourth.
//!
//! **Variable projection.** With each sample gᵢ goes a foot sᵢ, the parameter of the closest point. At the foot the residual
//! ρᵢ = C(sᵢ) − gᵢ is normal to the curve, so its length nᵢ does not depend on sᵢ to first order: Gauss–Newton runs on (a, b)
//! alone, two by two normal equations, and the feet follow by their own Newton step
//!
//! > δsᵢ = −(ρᵢ + δa·T₀B₁ − δb·T₁B₂)·C′ / |C′|²
//!
//! whose middle part, the movement of the curve under the foot, must not be left out: without it the feet lag one step.
//!
//! **The curved valley.** To leading order nᵢ ≈ s²(1−s)²·(mismatch of the area under the curve): the sum of squares is a valley
//! along the curves of equal area in the (a, b) plane, and those are bent. The area is proportional to
//! α(a, b) = k₀a + k₁b − k₂ab with k₀ = q×T₀, k₁ = T₁×q, k₂ = (T₁×T₀)/2, q = P₃−P₀ (cf. Levien's quartic in *Fitting cubic
//! Bézier curves*, 2021, which solves area and moment). A straight Gauss–Newton step (δa, δb) leaves the valley by −k₂δaδb; one
//! Newton step along ∇α puts it back.

use super::source::{Lane, Lanes};
use kurbo::{CubicBez, Point, Vec2};

/// Evaluations of one fit at most; more gain nothing.
const MOST_EVALUATIONS: usize = 6;
/// Damping relative to the diagonal: just enough to keep the two by two system from being singular.
const DAMPING: f64 = 1e-11;
/// A step longer than this share of the samples' length is not trusted.
const TRUST: f64 = 0.15;

/// What is fitted: a curve from the origin to `q` with given end tangents.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub(super) q: Vec2,
    pub(super) t0: Vec2,
    pub(super) t1: Vec2,
    /// Smallest handles allowed.
    pub(super) floor: [f64; 2],
    /// How far the samples get from the first point, more or less.
    pub(super) size: f64,
    /// Where the handles are pulled to, and how strongly: nearly straight pieces leave them undetermined.
    pub(super) home: [f64; 2],
    pub(super) pull: f64,
}

/// A state of the fit.
#[derive(Debug, Clone, Copy)]
pub(super) struct State {
    pub(super) a: f64,
    pub(super) b: f64,
    /// Feet of the samples.
    pub(super) s: Lane,
}

/// What one evaluation of a state tells. Kept in memory and written by a function of its own: lane after lane is then the only
/// order the compiler finds, and it stays with vectors.
#[derive(Debug, Clone, Copy)]
struct Residuals {
    /// Weighted normal equations (`JᵀJ` and `Jᵀn`) and the weighted sum of squares, each in four parts.
    parts: [[f64; 4]; 6],
    /// Squares of the normal residuals.
    squares: Lane,
    /// Movement of the feet: −ρ·C′/|C′|², and its derivatives.
    ds: Lane,
    sa: Lane,
    sb: Lane,
}

impl Residuals {
    const NONE: Self = Self { parts: [[0.0; 4]; 6], squares: [0.0; 8], ds: [0.0; 8], sa: [0.0; 8], sb: [0.0; 8] };

    /// The normal equations, the sum of squares, and the square of the largest residual.
    #[inline(always)]
    fn sums(&self) -> ([f64; 5], f64, f64) {
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

impl Frame {
    /// The cubic with handles `a`, `b`, power basis without the constant term: C(s) = ((c₃s + c₂)s + c₁)s.
    #[inline(always)]
    pub(super) fn power(&self, a: f64, b: f64) -> [Vec2; 3] {
        let (u, v) = (self.t0 * (3.0 * a), self.t1 * (3.0 * b));
        [u, self.q * 3.0 - u * 2.0 - v, self.q * -2.0 + u + v]
    }

    /// One Newton step for the feet. A function of its own for the same reason as [`Frame::residuals`].
    #[inline(never)]
    pub(super) fn settle(&self, g: &Lanes, a: f64, b: f64, s: &mut Lane) {
        let c = self.power(a, b);
        for foot in 0..8 {
            let t = s[foot];
            let (rx, ry, dx, dy) = at(&c, t, g.x[foot], g.y[foot]);
            s[foot] = unit(t - fma(rx, dx, ry * dy) / square(dx, dy));
        }
    }

    /// Adds the pull to the normal equations and the sum of squares.
    #[inline(always)]
    fn pulled(&self, (mut sums, squares, error): ([f64; 5], f64, f64), z: &State) -> ([f64; 5], f64, f64) {
        let (da, db) = (z.a - self.home[0], z.b - self.home[1]);
        sums[0] += self.pull;
        sums[2] += self.pull;
        sums[3] += self.pull * da;
        sums[4] += self.pull * db;
        (sums, squares + self.pull * (da * da + db * db), error)
    }

    /// The normal part of the residuals is ρ×C′/|C′|; 1/|C′|² makes squares of the products lengths.
    #[inline(never)]
    fn residuals(&self, g: &Lanes, z: &State, w: &Lane, out: &mut Residuals) {
        self.measure(g, z, w, out);
    }

    /// The state `z` with its handles moved and its feet after them, and its residuals.
    #[inline(never)]
    fn advance(&self, g: &Lanes, [da, db]: [f64; 2], z: &State, at: &Residuals, to: &mut State, out: &mut Residuals) {
        (to.a, to.b) = (z.a + da, z.b + db);
        for i in 0..8 {
            to.s[i] = unit(z.s[i] + fma(da, at.sa[i], fma(db, at.sb[i], at.ds[i])));
        }
        self.measure(g, to, &[1.0; 8], out);
    }

    #[inline(always)]
    fn measure(&self, g: &Lanes, z: &State, w: &Lane, out: &mut Residuals) {
        let c = self.power(z.a, z.b);
        let (t0, t1) = (self.t0, self.t1);
        let o = [0.0; 8];
        let (mut n, mut na, mut nb, mut kn, mut ka, mut kb) = (o, o, o, o, o, o);
        for i in 0..8 {
            let s = z.s[i];
            let u = 1.0 - s;
            let (rx, ry, dx, dy) = at(&c, s, g.x[i], g.y[i]);
            let k = 1.0 / square(dx, dy);
            let su = 3.0 * s * u;
            let (b1, b2) = (su * u, su * s);
            n[i] = fma(rx, dy, -(ry * dx));
            na[i] = fma(t0.x, dy, -(t0.y * dx)) * b1;
            nb[i] = fma(t1.y, dx, -(t1.x * dy)) * b2;
            let kw = k * w[i];
            (kn[i], ka[i], kb[i]) = (n[i] * kw, na[i] * kw, nb[i] * kw);
            out.squares[i] = n[i] * n[i] * k;
            out.ds[i] = -fma(rx, dx, ry * dy) * k;
            out.sa[i] = -fma(t0.x, dx, t0.y * dy) * (b1 * k);
            out.sb[i] = fma(t1.x, dx, t1.y * dy) * (b2 * k);
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

    /// Squared distances of the samples from the cubic, after `steps` Newton steps for the feet. A step that leads away (near
    /// a cusp of the cubic) is not taken.
    #[inline(always)]
    pub(super) fn distances(&self, g: &Lanes, a: f64, b: f64, s: &mut Lane, steps: usize) -> Lane {
        let c = self.power(a, b);
        let mut best = [f64::INFINITY; 8];
        let mut next = *s;
        for _ in 0..=steps {
            for i in 0..8 {
                let t = next[i];
                let (rx, ry, dx, dy) = at(&c, t, g.x[i], g.y[i]);
                let d = fma(rx, rx, ry * ry);
                let better = d < best[i];
                best[i] = if better { d } else { best[i] };
                s[i] = if better { t } else { s[i] };
                next[i] = unit(t - fma(rx, dx, ry * dy) / square(dx, dy));
            }
        }
        best
    }

    /// The distances whose squares these are, with the sign of the side of the cubic that the samples are on.
    #[inline(always)]
    pub(super) fn sided(&self, g: &Lanes, a: f64, b: f64, s: &Lane, squares: &Lane) -> Lane {
        let c = self.power(a, b);
        let mut out = [0.0; 8];
        for i in 0..8 {
            let (rx, ry, dx, dy) = at(&c, s[i], g.x[i], g.y[i]);
            out[i] = squares[i].sqrt().copysign(fma(rx, dy, -(ry * dx)));
        }
        out
    }

    /// The other handle on the curve of equal area through `z` whose first handle is `a`.
    pub(super) fn slide(&self, z: &State, a: f64) -> f64 {
        let k2 = 0.5 * self.t1.cross(self.t0);
        let (k0, k1) = (self.q.cross(self.t0), self.t1.cross(self.q));
        (k0 * z.a + k1 * z.b - k2 * z.a * z.b - k0 * a) / (k1 - k2 * a)
    }

    /// The cubic in the plane.
    pub(super) fn cubic(&self, p0: Point, p3: Point, a: f64, b: f64) -> CubicBez {
        CubicBez::new(p0, p0 + self.t0 * a, p3 - self.t1 * b, p3)
    }

    /// One Gauss–Newton step, and how much it promises to take off the sum of squares; `None` where the samples do not
    /// determine one.
    #[inline(always)]
    fn gauss_newton(sums: &[f64; 5]) -> Option<([f64; 2], f64)> {
        let [mut aa, ab, mut bb, an, bn] = *sums;
        aa += aa * DAMPING;
        bb += bb * DAMPING;
        let det = aa * bb - ab * ab;
        let k = 1.0 / det;
        let (da, db) = ((ab * bn - bb * an) * k, (ab * an - aa * bn) * k);
        (det > 0.0 && k.is_finite()).then_some(([da, db], -(da * an + db * bn)))
    }

    /// The step shortened to `most` and bent along the valley.
    #[inline(always)]
    fn bent(&self, [mut da, mut db]: [f64; 2], z: &State, most: f64) -> (f64, f64, f64) {
        let longest = da.abs().max(db.abs());
        if longest > most {
            // Seldom; the division would hold all the rest up.
            [da, db] = shortened([da, db], most / longest);
        }
        let k2 = 0.5 * self.t1.cross(self.t0);
        let (ga, gb) = (self.q.cross(self.t0) - k2 * z.b, self.t1.cross(self.q) - k2 * z.a);
        let g2 = ga * ga + gb * gb;
        let (va, vb) = (ga / g2, gb / g2);
        let e = k2 * da * db;
        // The correction is of second order in the step; where it is not, the valley's floor is not where this says.
        if e * e < 0.25 * (da * da + db * db) * g2 {
            da += e * va;
            db += e * vb;
        }
        ((z.a + da).max(self.floor[0]) - z.a, (z.b + db).max(self.floor[1]) - z.b, longest.min(most))
    }
}

#[cold]
#[inline(never)]
fn shortened([da, db]: [f64; 2], by: f64) -> [f64; 2] {
    [da * by, db * by]
}

/// a·b + c: one instruction where the target has one; elsewhere `mul_add` would be a call.
#[inline(always)]
pub(super) fn fma(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}

/// What the cubic with these power coefficients lacks to (x, y) at `s`, and its derivative.
#[inline(always)]
pub(super) fn at(c: &[Vec2; 3], s: f64, x: f64, y: f64) -> (f64, f64, f64, f64) {
    let [c1, c2, c3] = c;
    (
        fma(fma(fma(c3.x, s, c2.x), s, c1.x), s, -x),
        fma(fma(fma(c3.y, s, c2.y), s, c1.y), s, -y),
        fma(fma(c3.x * 3.0, s, c2.x * 2.0), s, c1.x),
        fma(fma(c3.y * 3.0, s, c2.y * 2.0), s, c1.y),
    )
}

/// |(x, y)|², never zero.
#[inline(always)]
pub(super) fn square(x: f64, y: f64) -> f64 {
    fma(x, x, fma(y, y, f64::MIN_POSITIVE))
}

/// Clamped to [0, 1]. Comparisons in this form are one instruction each.
#[inline(always)]
pub(super) fn unit(s: f64) -> f64 {
    let s = if s > 0.0 { s } else { 0.0 };
    if s < 1.0 { s } else { 1.0 }
}

/// Halves first, as vectors do it.
#[inline(always)]
pub(super) fn sum(v: &Lane) -> f64 {
    let mut h = [0.0; 4];
    for i in 0..4 {
        h[i] = v[i] + v[i + 4];
    }
    (h[0] + h[2]) + (h[1] + h[3])
}

#[inline(always)]
pub(super) fn largest(v: &Lane) -> f64 {
    let mut h = [0.0; 4];
    for i in 0..4 {
        h[i] = larger(v[i], v[i + 4]);
    }
    larger(larger(h[0], h[2]), larger(h[1], h[3]))
}

/// The larger of two numbers; of one that is not a number, the second. One instruction, unlike `f64::max`.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// A fit: the state with the smallest sum of squares, and the largest normal residual there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    pub(super) z: State,
    pub(super) error: f64,
    /// What the residual would have come down to, where the fit was given up; else the same.
    pub(super) reach: f64,
    /// The Newton step that is still to be taken by the feet.
    pub(super) ds: Lane,
    /// Squares of the normal residuals.
    pub(super) squares: Lane,
}

/// Fits from `z` until the largest residual is at most `enough`, or no longer improves. Where it stays far above `wanted`, a
/// rough fit will do: it only tells how many pieces are needed.
///
/// The feet of `start` are to be one Newton step from where they belong at most; see [`Frame::settle`].
pub(super) fn fit(frame: &Frame, g: &Lanes, start: State, [enough, wanted]: [f64; 2]) -> Fit {
    /// Far above.
    const FAR: f64 = 6.0;
    /// A step that promises less than this share of the sum of squares is not taken.
    const GAIN: f64 = 0.1;
    /// After so many evaluations the next step's promise tells what there is to reach, if it is less than this share of the sum
    /// of squares; after more of them whatever it is.
    const TELLS: (usize, f64) = (3, 0.5);
    /// Where what there is to reach is this many times what is wanted, it is not gone for.
    const BEYOND: f64 = 2.0;
    let (enough, far, beyond) = (enough * enough, (FAR * wanted).powi(2), (BEYOND * wanted).powi(2));
    // The best state so far and the one to be tried take turns in two places. Errors are squared in here.
    let mut z = [start, start];
    let mut r = [Residuals::NONE; 2];
    let (mut best, mut error) = (0, f64::INFINITY);
    let (mut sums, mut squares) = ([0.0; 5], f64::INFINITY);
    let (mut step, mut length) = ([0.0; 2], 0.0);
    let mut trust = 0.5 * TRUST * frame.size;
    let mut left = 1.0;
    for k in 1.. {
        let [z0, z1] = &mut z;
        let [r0, r1] = &mut r;
        let (from, to) = if best == 0 { ((z0, r0), (z1, r1)) } else { ((z1, r1), (z0, r0)) };
        frame.advance(g, step, from.0, from.1, to.0, to.1);
        let (sn, sq, en) = frame.pulled(to.1.sums(), to.0);
        // The first steps also settle the feet, which may raise the sum a little.
        if sq <= squares {
            (sums, squares, error) = (sn, sq, en);
            best = 1 - best;
            trust *= 2.0;
        } else if k == 1 {
            // Not a number.
            break;
        } else {
            trust = 0.25 * length;
        }
        if k == MOST_EVALUATIONS || error <= enough || (k > 4 && error > far) {
            break;
        }
        let Some((newton, gain)) = Frame::gauss_newton(&sums) else { break };
        if k > 1 && gain < GAIN * squares {
            break;
        }
        let told = k > TELLS.0 || k == TELLS.0 && gain < TELLS.1 * squares;
        if told && error * (squares - gain) > beyond * squares {
            left = 1.0 - gain / squares;
            break;
        }
        (step[0], step[1], length) = frame.bent(newton, &z[best], trust);
    }
    Fit { z: z[best], error: error.sqrt(), reach: (error * left).sqrt(), ds: r[best].ds, squares: r[best].squares }
}

/// Minimax by Lawson's reweighting on sixteen samples: weights grow with the residuals, and the largest ones even out.
/// Returns the best state's handles, feet, and largest residual.
pub(super) fn lawson(frame: &Frame, g: [&Lanes; 2], start: [State; 2], steps: usize) -> ([State; 2], f64) {
    let mut w = [[1.0; 8]; 2];
    let mut z = start;
    let mut best = (start, f64::INFINITY);
    let mut r = [Residuals::NONE; 2];
    for k in 0..=steps {
        for h in 0..2 {
            frame.residuals(g[h], &z[h], &w[h], &mut r[h]);
        }
        let ([mut sums, more], error) = {
            let (s0, _, e0) = frame.pulled(r[0].sums(), &z[0]);
            let (s1, _, e1) = r[1].sums();
            ([s0, s1], e0.max(e1).sqrt())
        };
        if error < best.1 {
            best = (z, error);
        }
        if k == steps {
            break;
        }
        for (a, b) in sums.iter_mut().zip(more) {
            *a += b;
        }
        let Some((step, _)) = Frame::gauss_newton(&sums) else { break };
        let (da, db, _) = frame.bent(step, &z[0], TRUST * frame.size);
        for h in 0..2 {
            z[h].a += da;
            z[h].b += db;
            for i in 0..8 {
                z[h].s[i] = unit(z[h].s[i] + r[h].ds[i] + da * r[h].sa[i] + db * r[h].sb[i]);
                w[h][i] *= r[h].squares[i].sqrt() / error + 1e-3;
            }
        }
        let total = sum(&w[0]) + sum(&w[1]);
        for h in &mut w {
            for v in h {
                *v *= 16.0 / total;
            }
        }
    }
    best
}
