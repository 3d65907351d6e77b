//! Minimax fit of the two handle lengths: the largest of sixteen residuals as small as possible.
//!
//! Gauss–Newton for the uniform norm. To first order the normal residuals are nᵢ + δa·aᵢ + δb·bᵢ, and the step is their best uniform
//! approximation by zero. It is levelled on three of the samples, a *reference* (E. Stiefel, *Über diskrete und lineare
//! Tschebyscheff-Approximationen*, Numer. Math. 1, 1959):
//!
//! > λᵢ = (aⱼ, bⱼ) × (aₖ, bₖ), and so on in turn; h = Σλᵢnᵢ / Σ|λᵢ|; nᵢ + δa·aᵢ + δb·bᵢ = h·sgn λᵢ
//!
//! |h| is the least error that three residuals allow, and over four it is the largest |h| of any three. So the sample with the
//! largest residual replaces the one of the reference that leaves the largest |h|, until no residual exceeds |h|.

use crate::fit::{ChordFrame, FitState, SampleResidual};
use crate::limits::{MAX_EXCHANGES, MINIMAX_HOPE, MINIMAX_STEPS, TRUST_RADIUS};
use crate::sample::{Lane, Lanes, clamp_unit, fma, larger, largest};

/// Normal residuals at eight samples, with their derivatives.
struct Normals {
    n: Lane,
    /// By the handles.
    na: Lane,
    nb: Lane,
    /// Newton step of the foot points, and its derivatives by the handles.
    ds: Lane,
    sa: Lane,
    sb: Lane,
}

impl Normals {
    const NONE: Self = Self { n: [0.0; 8], na: [0.0; 8], nb: [0.0; 8], ds: [0.0; 8], sa: [0.0; 8], sb: [0.0; 8] };
}

impl ChordFrame {
    /// Not inlined: alone, the loop is vectorised.
    #[inline(never)]
    fn normals(&self, g: &Lanes, z: &FitState, out: &mut Normals) {
        let c = self.power(z.a, z.b);
        for i in 0..8 {
            let r = SampleResidual::new(&c, [self.t0, self.t1], z.s[i], [g.x[i], g.y[i]]);
            let unit = r.k.sqrt();
            (out.n[i], out.na[i], out.nb[i]) = (r.n * unit, r.na * unit, r.nb * unit);
            (out.ds[i], out.sa[i], out.sb[i]) = (r.ds, r.sa, r.sb);
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
    [wanted, tolerance]: [f64; 2],
) -> ([FitState; 2], f64) {
    let mut z = start;
    let mut best = (start, f64::INFINITY);
    let mut r = [Normals::NONE; 2];
    for k in 0..=MINIMAX_STEPS {
        for h in 0..2 {
            frame.normals(g[h], &z[h], &mut r[h]);
        }
        let error = larger(largest(&r[0].n.map(f64::abs)), largest(&r[1].n.map(f64::abs)));
        let gains = error < best.1;
        if gains {
            best = (z, error);
        }
        if !gains || error <= wanted || k == MINIMAX_STEPS {
            break;
        }
        let Some((step, level)) = levelled(&r) else { break };
        if level > MINIMAX_HOPE * tolerance {
            break;
        }
        let (da, db, _) = frame.bent(step, &z[0], TRUST_RADIUS * frame.size);
        for h in 0..2 {
            z[h].a += da;
            z[h].b += db;
            for i in 0..8 {
                z[h].s[i] = clamp_unit(z[h].s[i] + fma(da, r[h].sa[i], fma(db, r[h].sb[i], r[h].ds[i])));
            }
        }
    }
    best
}

/// The samples of the first reference: those next to a fifth, a half and four fifths, where the leading form of the residual,
/// s²(1−s)²((s−½)²−c), has its extremes.
const EXTREMES: [usize; 3] = [1, 11, 14];

/// The step that makes the largest of the linearised residuals as small as possible, and that residual. `None` if the samples do not
/// determine a step.
fn levelled(r: &[Normals; 2]) -> Option<([f64; 2], f64)> {
    let row = |i: usize| -> [f64; 3] {
        let (h, j) = (&r[i / 8], i % 8);
        [h.n[j], h.na[j], h.nb[j]]
    };
    let mut reference = EXTREMES;
    let mut rows = reference.map(row);
    let mut found = None;
    for _ in 0..MAX_EXCHANGES {
        let Some((step, level)) = Level::of(&rows).step(&rows) else { break };
        found = Some((step, level));
        let mut residuals = [0.0; 16];
        for (half, r) in residuals.chunks_exact_mut(8).zip(r) {
            for i in 0..8 {
                half[i] = fma(step[0], r.na[i], fma(step[1], r.nb[i], r.n[i])).abs();
            }
        }
        let most = (0..16).fold(0, |m, i| if residuals[i] > residuals[m] { i } else { m });
        // Rounding may leave the reference's own residuals a little above the level.
        if residuals[most] <= LEVELLED * level || reference.contains(&most) {
            break;
        }
        let new = row(most);
        let mut highest = (0, -1.0);
        for k in 0..3 {
            let mut other = rows;
            other[k] = new;
            let level = Level::of(&other).height().abs();
            if level > highest.1 {
                highest = (k, level);
            }
        }
        rows[highest.0] = new;
        reference[highest.0] = most;
    }
    found
}

/// Residuals that exceed the level by less than a thousandth are level: the step is only of first order.
const LEVELLED: f64 = 1.001;

/// Three residuals levelled: λ and Σλᵢnᵢ.
struct Level {
    weights: [f64; 3],
    sum: f64,
}

impl Level {
    fn of([p, q, r]: &[[f64; 3]; 3]) -> Self {
        let cross = |u: &[f64; 3], v: &[f64; 3]| u[1] * v[2] - u[2] * v[1];
        let weights = [cross(q, r), cross(r, p), cross(p, q)];
        Self { weights, sum: weights[0] * p[0] + weights[1] * q[0] + weights[2] * r[0] }
    }

    /// h; 0 if the derivatives of all three are parallel.
    fn height(&self) -> f64 {
        let size: f64 = self.weights.iter().map(|w| w.abs()).sum();
        if size > 0.0 { self.sum / size } else { 0.0 }
    }

    /// The step that levels the three rows, from the two that are furthest from parallel; and |h|.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows from smooth functions like those of a fit, with phases at random.
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

    /// By duality the least possible maximum is the largest level of any three residuals (de la Vallée Poussin).
    #[test]
    fn the_step_is_the_best_uniform_approximation() {
        for seed in 0..200 {
            let r = rows(seed);
            let (step, level) = levelled(&r).unwrap();
            let mut least = 0.0f64;
            for i in 0..16 {
                for j in 0..i {
                    for k in 0..j {
                        least = least.max(Level::of(&[row(&r, i), row(&r, j), row(&r, k)]).height().abs());
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
        assert!(levelled(&r).is_none());
    }
}
