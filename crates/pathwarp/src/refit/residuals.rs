//! One evaluation of a fit: normal residuals at eight samples, the normal equations, and the Gauss–Newton step.

use super::frame::ChordFrame;
use super::lanes::{Lane, Lanes, clamp_unit, fma, largest, norm_squared, residual_at};
use super::limits::DAMPING;
use kurbo::Vec2;

/// The unknowns of a fit.
#[derive(Debug, Clone, Copy)]
pub(super) struct FitState {
    /// Handle lengths.
    pub(super) a: f64,
    pub(super) b: f64,
    /// Foot points: the parameters of the points of the cubic nearest to the samples.
    pub(super) s: Lane,
}

/// One evaluation of a state. Kept in memory and written by separate functions, so that LLVM finds only the order lane by lane,
/// and vectorises it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Residuals {
    /// Normal equations (`JᵀJ` and `Jᵀn`) and the sum of squares, each in four partial sums.
    parts: [[f64; 4]; 6],
    /// Squares of the normal residuals.
    pub(super) squares: Lane,
    /// Newton step of the foot points, −ρ·C′/|C′|², and its derivatives with respect to a and b.
    pub(super) ds: Lane,
    pub(super) sa: Lane,
    pub(super) sb: Lane,
}

/// One sample's residual ρ = C(s) − g at its foot point, with its derivatives by the handles.
pub(super) struct SampleResidual {
    /// 1/|C′|².
    pub(super) k: f64,
    /// The normal part times |C′|: ρ×C′.
    pub(super) n: f64,
    pub(super) na: f64,
    pub(super) nb: f64,
    /// Newton step of the foot point, −ρ·C′/|C′|².
    pub(super) ds: f64,
    pub(super) sa: f64,
    pub(super) sb: f64,
}

impl SampleResidual {
    /// For the cubic `c` in the power basis with unit end tangents `t0` and `t1`.
    #[inline(always)]
    pub(super) fn new(c: &[Vec2; 3], [t0, t1]: [Vec2; 2], s: f64, [x, y]: [f64; 2]) -> Self {
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
pub(super) type NormalEquations = ([f64; 5], f64, f64);

impl Residuals {
    pub(super) const NONE: Self =
        Self { parts: [[0.0; 4]; 6], squares: [0.0; 8], ds: [0.0; 8], sa: [0.0; 8], sb: [0.0; 8] };

    #[inline(always)]
    pub(super) fn sums(&self) -> NormalEquations {
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
    pub(super) fn pulled(&self, (mut sums, squares, error): NormalEquations, z: &FitState) -> NormalEquations {
        let (da, db) = (z.a - self.home[0], z.b - self.home[1]);
        sums[0] += self.pull;
        sums[2] += self.pull;
        sums[3] += self.pull * da;
        sums[4] += self.pull * db;
        (sums, squares + self.pull * (da * da + db * db), error)
    }

    /// Moves the handles of `z` by (da, db) and the foot points along with them, and evaluates the result.
    #[inline(never)]
    pub(super) fn advance(
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
    pub(super) fn bent(&self, [mut da, mut db]: [f64; 2], z: &FitState, most: f64) -> (f64, f64, f64) {
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
pub(super) fn gauss_newton(sums: &[f64; 5]) -> Option<([f64; 2], f64)> {
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
