//! Proofs that a fitted cubic lies within a distance of the true image, where map and segment are quotients of polynomials.
//!
//! Let g be the image over one piece, τ in [0, 1], and C the cubic. For any continuous φ from [0, 1] onto [0, 1] the distance
//! between the two curves, both ways, is at most sup |g(τ) − C(φ(τ))|: every point of g has a partner on C, and φ being onto,
//! every point of C one on g.
//!
//! **φ** is a polynomial through the feet of the fit, φ(τ) = τ + τ(1−τ)·p(2τ−1) with p of degree 7. Since φ = τ·(1 + (1−τ)p) and
//! 1−φ = (1−τ)·(1 − τp), it stays in [0, 1] if the two brackets, polynomials of degree 8, are not negative: which they are not
//! if |p| ≤ 1, for which it is enough that p's Chebyshev coefficients add up to at most 1 in absolute value, or if the bound
//! below says so.
//!
//! **The bound.** D = g − C∘φ is a polynomial of a known degree less than N. Its values at the N Chebyshev nodes therefore give
//! its Chebyshev coefficients exactly (a discrete cosine transform), and for every d
//!
//! > sup |D| ≤ (max over nodes |D| + r_d) / cos(πd / 2N) + r_d,   r_d = Σ over k > d of |coefficient k|
//!
//! since a polynomial of degree d < N is at most 1/cos(πd/2N) times its largest value at the nodes (Ehlich and Zeller,
//! *Schwankung von Polynomen zwischen Gitterpunkten*, Math. Z. 86, 1964). The best d is taken. D is a vector; the theorem holds
//! for its component in any direction, hence for its length.
//!
//! **Denominators.** If g = G/W, D is no polynomial; but with a polynomial V close to 1/W, the product F = V·W·D is one, and
//! |D| ≤ |F| / (1−ε) where |VW − 1| ≤ ε, a polynomial too, bounded in the same way.
//!
//! Rounding of the samples (some 1e-13 of the coordinates) is added to the bound.

use super::source::{Curve, Lane, Source};
use super::verify::Candidate;
use crate::map::RationalBezier;
use kurbo::Point;
use std::sync::OnceLock;

/// Chebyshev nodes of a proof: more than the degree of D for a bicubic map of a cubic (max(18, 3·9)) and for a rational map of
/// degree 4 (12 + 27 + 5), enough for the bound to lose little.
const N: usize = 48;
/// Batches of eight.
const BATCHES: usize = N / 8;
/// Degree of p, and number of its coefficients.
const P: usize = 8;
/// Degree of C∘φ.
const COMPOSED: usize = 3 * (P + 1);
/// Coefficients of V.
const V: usize = 6;
/// Samples of the feet.
const FEET: usize = 16;

/// What is known of a segment's image as a quotient of polynomials.
#[derive(Debug, Clone)]
pub(super) struct Algebra {
    /// Degree of numerators and denominator in the segment's parameter.
    degree: usize,
    /// Degree of the denominator; 0 if there is none.
    below: usize,
    /// The denominator's Bernstein coefficients, where the map gives them as such.
    weights: Option<Vec<f64>>,
    /// Degree of the map, the power of the source's own denominator.
    power: i32,
    /// Degree of D, or of F.
    total: usize,
}

impl Algebra {
    /// `None`: nothing is known, the image can only be checked.
    pub(super) fn of(source: &Source<'_>) -> Option<Self> {
        let (degree, rational) = source.degree()?;
        let out = if let Some(a) = source.map.algebra() {
            let below = if a.rational || rational { a.degree * degree } else { 0 };
            Self { degree: a.degree * degree, below, weights: None, power: a.degree as i32, total: 0 }
        } else {
            if rational {
                return None;
            }
            let image = source.map.image_of(&RationalBezier::from_seg(source.seg)?)?;
            let n = image.degree();
            let weights = (!image.is_polynomial()).then(|| image.points.iter().map(|p| p[2]).collect::<Vec<_>>());
            Self { degree: n, below: if weights.is_some() { n } else { 0 }, weights, power: 1, total: 0 }
        };
        // F has the degree of VW·C∘φ at most.
        let all = if out.below > 0 { (out.below + COMPOSED).max(out.degree) + V - 1 } else { out.degree.max(COMPOSED) };
        (all < N && out.below + V - 1 < N).then_some(Self { total: all, ..out })
    }
}

/// A bound for the distance between candidate and image, both ways; infinite if none was found. `feet` are the feet of the
/// samples j/17.
pub(super) fn bound(source: &Source<'_>, algebra: &Algebra, c: &Candidate, feet: &[f64; FEET]) -> Result<f64, Point> {
    let tables = tables();
    // p by least squares from the feet.
    let mut p = [0.0; P];
    for (row, f) in tables.feet.iter().zip(feet) {
        for k in 0..P {
            p[k] += row[k] * (f - row[P]);
        }
    }
    if !inside(&p) {
        return Ok(f64::INFINITY);
    }
    let mut x = [0.0; N];
    let mut y = [0.0; N];
    let mut w = [1.0; N];
    let [c1, c2, c3] = c.frame.power(c.a, c.b);
    for b in 0..BATCHES {
        let mut t: Lane = [0.0; 8];
        for i in 0..8 {
            t[i] = c.t0 + (c.t1 - c.t0) * tables.tau[8 * b + i];
        }
        let s = source.points(&t);
        let (mut gx, mut gy) = (s.x, s.y);
        source.map.lanes(&mut gx, &mut gy);
        for i in 0..8 {
            let k = 8 * b + i;
            let (tau, base) = (tables.tau[k], &tables.t[k]);
            let mut v = 0.0;
            for j in 0..P {
                v += base[j] * p[j];
            }
            let f = tau + tau * (1.0 - tau) * v;
            x[k] = gx[i] - c.p0.x - ((c3.x * f + c2.x) * f + c1.x) * f;
            y[k] = gy[i] - c.p0.y - ((c3.y * f + c2.y) * f + c1.y) * f;
        }
        if algebra.below > 0 {
            let d = match &algebra.weights {
                Some(w) => bernstein(w, &t),
                None => source.denominators(&t, &s, algebra.power),
            };
            w[8 * b..8 * b + 8].copy_from_slice(&d);
        }
    }
    let mut share = 1.0;
    if algebra.below > 0 {
        let Some(e) = cleared(&mut w, algebra.below + V - 1) else { return Ok(f64::INFINITY) };
        for k in 0..N {
            x[k] *= w[k];
            y[k] *= w[k];
        }
        share = 1.0 - e;
    }
    let most = (0..N).map(|k| x[k] * x[k] + y[k] * y[k]).fold(0.0, f64::max).sqrt();
    if !most.is_finite() {
        let t = tables.tau.map(|tau| c.t0 + (c.t1 - c.t0) * tau);
        let k = (0..N).find(|&k| !(x[k] + y[k]).is_finite()).unwrap_or(0);
        return Err(source.at(t[k]));
    }
    Ok(supremum(&x, &y, most, algebra.total) / share + noise(c))
}

/// Whether φ stays in [0, 1].
fn inside(p: &[f64; P]) -> bool {
    if p.iter().map(|v| v.abs()).sum::<f64>() <= 1.0 {
        return true;
    }
    let tables = tables();
    let (mut a, mut b) = ([0.0; N], [0.0; N]);
    for k in 0..N {
        let v: f64 = (0..P).map(|j| p[j] * tables.t[k][j]).sum();
        a[k] = 1.0 + (1.0 - tables.tau[k]) * v;
        b[k] = 1.0 - tables.tau[k] * v;
    }
    least(&a, P) >= 0.0 && least(&b, P) >= 0.0
}

/// A lower bound for a polynomial of the given degree from its values at the nodes: its distance from their middle is bounded
/// as in the module's documentation.
fn least(f: &[f64; N], degree: usize) -> f64 {
    let lo = f.iter().copied().fold(f64::INFINITY, f64::min);
    let hi = f.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mid = 0.5 * (lo + hi);
    mid - supremum(&f.map(|v| v - mid), &[0.0; N], hi - mid, degree)
}

/// As [`bound`] where the candidate is a straight line: the part of D across the line, if the image runs along it one way.
/// Then the point of the image with the same part along is each point's partner.
#[cold]
pub(super) fn line(source: &Source<'_>, algebra: &Algebra, c: &Candidate) -> Result<f64, Point> {
    let tables = tables();
    let unit = c.frame.t0;
    let (mut across, mut pace, mut w) = ([0.0; N], [0.0; N], [1.0; N]);
    for b in 0..BATCHES {
        let mut t: Lane = [0.0; 8];
        for i in 0..8 {
            t[i] = c.t0 + (c.t1 - c.t0) * tables.tau[8 * b + i];
        }
        let s = source.points(&t);
        if algebra.below > 0 {
            let d = match &algebra.weights {
                Some(w) => bernstein(w, &t),
                None => source.denominators(&t, &s, algebra.power),
            };
            w[8 * b..8 * b + 8].copy_from_slice(&d);
        }
        for i in 0..8 {
            let (p, d) = source.image(t[i]);
            if !p.is_finite() || !d.is_finite() {
                return Err(source.at(t[i]));
            }
            let k = 8 * b + i;
            across[k] = (p - c.p0).cross(unit);
            // W²·g' = G'W − GW' is a polynomial and has the sign of g'.
            pace[k] = d.dot(unit) * (w[k] * w[k]);
        }
    }
    let mut share = 1.0;
    if algebra.below > 0 {
        let Some(e) = cleared(&mut w, algebra.below + V - 1) else { return Ok(f64::INFINITY) };
        for k in 0..N {
            across[k] *= w[k];
        }
        share = 1.0 - e;
    }
    let degree = (algebra.degree + algebra.below).min(N);
    if degree >= N || least(&pace, degree) < 0.0 {
        return Ok(f64::INFINITY);
    }
    let most = across.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    Ok(supremum(&across, &[0.0; N], most, algebra.total) / share + noise(c))
}

/// Rounding of the samples.
fn noise(c: &Candidate) -> f64 {
    /// Relative to their coordinates.
    const ROUNDING: f64 = 1e-14;
    ROUNDING * (c.p0.x.abs() + c.p0.y.abs() + c.frame.size)
}

/// Replaces W by V·W and returns a bound for |VW − 1|, `degree` being VW's.
fn cleared(w: &mut [f64; N], degree: usize) -> Option<f64> {
    let tables = tables();
    if w.iter().any(|v| v.is_nan() || *v <= 0.0) {
        return None;
    }
    let mut v = [0.0; V];
    for k in 0..N {
        for j in 0..V {
            v[j] += tables.dct[j][k] / w[k];
        }
    }
    let mut most = 0.0f64;
    for k in 0..N {
        let at: f64 = (0..V).map(|j| v[j] * tables.t[k][j]).sum();
        w[k] *= at;
        most = most.max((w[k] - 1.0).abs());
    }
    let e = most / (std::f64::consts::PI * degree as f64 / (2 * N) as f64).cos();
    /// A denominator that varies so much is split instead.
    const WORST: f64 = 0.1;
    (e < WORST).then_some(e)
}

/// The bound of the module's documentation for the vector polynomial with these values at the nodes.
fn supremum(x: &[f64; N], y: &[f64; N], most: f64, degree: usize) -> f64 {
    let tables = tables();
    // Even nodes mirror odd ones: sums and differences halve the transform.
    let mut fold = [[0.0; N / 2]; 4];
    for k in 0..N / 2 {
        let (a, b) = (k, N - 1 - k);
        fold[0][k] = x[a] + x[b];
        fold[1][k] = y[a] + y[b];
        fold[2][k] = x[a] - x[b];
        fold[3][k] = y[a] - y[b];
    }
    let mut tail = 0.0;
    let mut best = f64::INFINITY;
    for d in (0..=degree).rev() {
        let limit = (most + tail) * tables.stretch[d] + tail;
        if limit < best {
            best = limit;
        }
        // The coefficient d joins the tail.
        let (fx, fy) = if d % 2 == 0 { (&fold[0], &fold[1]) } else { (&fold[2], &fold[3]) };
        let row = &tables.dct[d];
        let (mut sx, mut sy) = ([0.0; 4], [0.0; 4]);
        for k in (0..N / 2).step_by(4) {
            for l in 0..4 {
                sx[l] += row[k + l] * fx[k + l];
                sy[l] += row[k + l] * fy[k + l];
            }
        }
        let (cx, cy) = (sx.iter().sum::<f64>(), sy.iter().sum::<f64>());
        tail += (cx * cx + cy * cy).sqrt();
        // More in the tail cannot help any more.
        if tail > best {
            break;
        }
    }
    best
}

/// The Bernstein polynomial with coefficients `b` at eight parameters.
fn bernstein(b: &[f64], t: &Lane) -> Lane {
    let n = b.len() - 1;
    let mut out = [0.0; 8];
    for i in 0..8 {
        // Horner in s/(1−s) or its inverse, whichever is at most one.
        let flip = t[i] > 0.5;
        let (s, u) = if flip { (1.0 - t[i], t[i]) } else { (t[i], 1.0 - t[i]) };
        let r = s / u;
        let (mut sum, mut choose) = (0.0, 1.0);
        let mut power = u.powi(n as i32);
        for k in 0..=n {
            let c = if flip { b[n - k] } else { b[k] };
            sum += choose * power * c;
            power *= r;
            choose *= (n - k) as f64 / (k + 1) as f64;
        }
        out[i] = sum;
    }
    out
}

/// Numbers that every proof uses.
struct Tables {
    /// The nodes on [0, 1].
    tau: [f64; N],
    /// The Chebyshev polynomials of degree less than P at the nodes.
    t: [[f64; P]; N],
    /// Row d: values at the nodes to coefficient d.
    dct: [[f64; N]; N],
    /// 1 / cos(πd/2N).
    stretch: [f64; N],
    /// For sample j/17: its row of the pseudo-inverse (feet to coefficients of p), and j/17 itself.
    feet: [[f64; P + 1]; FEET],
}

fn tables() -> &'static Tables {
    static TABLES: OnceLock<Box<Tables>> = OnceLock::new();
    TABLES.get_or_init(|| {
        use std::f64::consts::PI;
        let angle = |k: usize| PI * (k as f64 + 0.5) / N as f64;
        let mut out = Box::new(Tables {
            tau: std::array::from_fn(|k| 0.5 + 0.5 * angle(k).cos()),
            t: std::array::from_fn(|k| std::array::from_fn(|j| (j as f64 * angle(k)).cos())),
            dct: std::array::from_fn(|d| {
                let scale = if d == 0 { 1.0 } else { 2.0 } / N as f64;
                std::array::from_fn(|k| scale * (d as f64 * angle(k)).cos())
            }),
            stretch: std::array::from_fn(|d| 1.0 / (PI * d as f64 / (2 * N) as f64).cos()),
            feet: [[0.0; P + 1]; FEET],
        });
        out.feet = least_squares();
        out
    })
}

/// Rows of the pseudo-inverse of `A[i][j]` = τᵢ(1−τᵢ) times the j-th Chebyshev polynomial at 2τᵢ−1: normal equations by
/// Gauss–Jordan elimination, well conditioned for sixteen samples and degree seven.
fn least_squares() -> [[f64; P + 1]; FEET] {
    let tau: [f64; FEET] = std::array::from_fn(|i| (i as f64 + 1.0) / (FEET as f64 + 1.0));
    let a: [[f64; P]; FEET] = std::array::from_fn(|i| {
        let u: f64 = 2.0 * tau[i] - 1.0;
        std::array::from_fn(|j| tau[i] * (1.0 - tau[i]) * (j as f64 * u.acos()).cos())
    });
    let mut m = [[0.0; P + FEET]; P];
    for (r, row) in m.iter_mut().enumerate() {
        for c in 0..P {
            row[c] = (0..FEET).map(|i| a[i][r] * a[i][c]).sum();
        }
        for i in 0..FEET {
            row[P + i] = a[i][r];
        }
    }
    for c in 0..P {
        let pivot = m[c][c];
        for v in &mut m[c] {
            *v /= pivot;
        }
        let base = m[c];
        for (r, row) in m.iter_mut().enumerate() {
            if r != c {
                let f = row[c];
                for (v, b) in row.iter_mut().zip(&base) {
                    *v -= f * b;
                }
            }
        }
    }
    std::array::from_fn(|i| std::array::from_fn(|k| if k < P { m[k][P + i] } else { tau[i] }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Vec2;

    #[test]
    fn the_bound_holds_and_is_not_far_off() {
        // A polynomial of degree 9 with known maximum, given at the nodes.
        let f = |t: f64| {
            let u = 2.0 * t - 1.0;
            let v = (9.0 * u.acos()).cos() * 0.01 + (4.0 * u.acos()).cos() + 0.3 * u;
            Vec2::new(v, 0.5 * v)
        };
        let t = tables();
        let (x, y) = (t.tau.map(|t| f(t).x), t.tau.map(|t| f(t).y));
        let most = (0..N).map(|k| x[k].hypot(y[k])).fold(0.0, f64::max);
        let truth = (0..=10_000).map(|i| f(f64::from(i) / 10_000.0).hypot()).fold(0.0, f64::max);
        let b = supremum(&x, &y, most, N - 1);
        assert!(b >= truth && b < 1.06 * truth, "{b} {truth}");
    }

    #[test]
    fn phi_goes_through_feet_it_can_represent() {
        let rows = least_squares();
        let want = [0.1, -0.05, 0.02, 0.0, 0.003, 0.0, 0.0, -0.001];
        let feet: Vec<f64> = rows
            .iter()
            .map(|r| {
                let tau = r[P];
                let u: f64 = 2.0 * tau - 1.0;
                tau + tau * (1.0 - tau) * (0..P).map(|j| want[j] * (j as f64 * u.acos()).cos()).sum::<f64>()
            })
            .collect();
        for k in 0..P {
            let got: f64 = rows.iter().zip(&feet).map(|(r, f)| r[k] * (f - r[P])).sum();
            assert!((got - want[k]).abs() < 1e-12);
        }
    }

    #[test]
    fn bernstein_sums_are_right_at_both_halves() {
        // Coefficients k/n give the identity.
        let b: Vec<f64> = (0..=7).map(|k| f64::from(k) / 7.0).collect();
        let t = [0.0, 0.1, 0.3, 0.5, 0.6, 0.8, 0.99, 1.0];
        for (v, t) in bernstein(&b, &t).iter().zip(t) {
            assert!((v - t).abs() < 1e-14);
        }
    }
}
