//! Proofs that a fitted cubic lies within a distance of the true image, where map and segment are quotients of polynomials.
//!
//! Let g be the image over one piece, τ in [0, 1], and C the cubic. For any continuous φ from [0, 1] onto [0, 1] the distance
//! between the two curves, both ways, is at most sup |g(τ) − C(φ(τ))|: every point of g has a partner on C, and φ being onto,
//! every point of C one on g.
//!
//! **φ** is a polynomial through the feet of the fit, φ(τ) = τ + τ(1−τ)·p(2τ−1) with P coefficients in p. Since φ = τ·(1 + (1−τ)p)
//! and 1−φ = (1−τ)·(1 − τp), it stays in [0, 1] if the two brackets, polynomials of degree P, are not negative: which they are not
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
//! **Twice.** The work goes with the number of nodes, the loss with their scarcity. A bound from few nodes with a simple φ comes
//! first ([`quick`]); most pieces need no other. What it does not prove, many nodes may ([`bound`]).
//!
//! Rounding of the samples (some 1e-13 of the coordinates) is added to the bound.

use super::chebyshev::{FEET, SAMPLES, Shared, Tables};
use super::fit::{Frame, fma, largest, sum};
use super::source::{Curve, Lane, Source};
use super::verify::Candidate;
use crate::map::RationalBezier;
use kurbo::{CubicBez, Point, Vec2};

/// Chebyshev nodes of the second proof: more than the degree of D for a bicubic map of a cubic (max(18, 3·9)) and for a rational
/// map of degree 4 (12 + 27 + 5), enough for the bound to lose little.
const N: usize = 48;
/// Coefficients of its p, and of its V.
const P: usize = 8;
const V: usize = 6;
/// Coefficients of the first proof's V.
const QUICK_V: usize = 4;

/// What is known of a segment's image as a quotient of polynomials.
#[derive(Debug, Clone)]
pub(super) struct Algebra {
    /// Degree of numerators and denominator in the segment's parameter.
    pub(super) degree: usize,
    /// Degree of the denominator; 0 if there is none.
    pub(super) below: usize,
    /// The denominator's Bernstein coefficients, where the map gives them as such.
    weights: Option<Vec<f64>>,
    /// Degree of the map, the power of the source's own denominator.
    power: i32,
    /// How far the ends of the pieces may be from the image, where more than rounding puts them elsewhere.
    pub(super) blur: f64,
}

impl Algebra {
    /// `map` is what the source's map says of itself. `None`: nothing is known, the image can only be checked.
    pub(super) fn of(source: &Source<'_>, map: Option<crate::map::RationalDegree>) -> Option<Self> {
        let (degree, rational) = source.degree()?;
        let out = if let Some(a) = map {
            let below = if a.rational || rational { a.degree * degree } else { 0 };
            Self { degree: a.degree * degree, below, weights: None, power: a.degree as i32, blur: 0.0 }
        } else {
            if rational {
                return None;
            }
            let image = source.map.image(&RationalBezier::from_seg(source.seg)?)?;
            let n = image.degree();
            let weights = (!image.is_polynomial()).then(|| image.points.iter().map(|p| p[2]).collect::<Vec<_>>());
            Self { degree: n, below: if weights.is_some() { n } else { 0 }, weights, power: 1, blur: 0.0 }
        };
        (out.total(P, V) < N && out.below + V - 1 < N).then_some(out)
    }

    /// For pieces whose ends may be that far from the image.
    pub(super) fn with_blur(self, blur: f64) -> Self {
        Self { blur, ..self }
    }

    /// Degree of D, or of F: that of VW·C∘φ at most.
    fn total(&self, p: usize, v: usize) -> usize {
        let composed = 3 * (p + 1);
        if self.below > 0 { (self.below + composed).max(self.degree) + v - 1 } else { self.degree.max(composed) }
    }

    /// The denominators at eight parameters.
    pub(super) fn denominators(&self, source: &Source<'_>, t: &Lane) -> Lane {
        match &self.weights {
            Some(w) => bernstein(w, t),
            None => source.denominators(t, &source.points(t), self.power),
        }
    }
}

/// A bound for the distance between candidate and image, both ways; infinite if none was found. `feet` are about those of the
/// samples j/17.
pub(super) fn bound(source: &Source<'_>, algebra: &Algebra, c: &Candidate, feet: &[f64; FEET]) -> Result<f64, Point> {
    with::<N, P, V>(source, algebra, c, feet)
}

/// A looser one, quickly.
pub(super) fn quick(source: &Source<'_>, algebra: &Algebra, c: &Candidate, feet: &[f64; FEET]) -> Result<f64, Point> {
    match algebra.total(4, QUICK_V) {
        _ if algebra.below == 0 && algebra.total(5, QUICK_V) < 24 => with::<24, 5, QUICK_V>(source, algebra, c, feet),
        ..24 => with::<24, 4, QUICK_V>(source, algebra, c, feet),
        _ if algebra.total(5, QUICK_V) < 40 => with::<40, 5, QUICK_V>(source, algebra, c, feet),
        _ => Ok(f64::INFINITY),
    }
}

/// As [`bound`], for any cubic over the stretch `t` of the source; the ends need not coincide.
pub(super) fn stretch(
    source: &Source<'_>,
    algebra: &Algebra,
    t: [f64; 2],
    cubic: &CubicBez,
    tolerance: f64,
) -> Result<f64, Point> {
    let unit = |v: Vec2| if v == Vec2::ZERO { (v, 0.0) } else { (v / v.hypot(), v.hypot()) };
    let q = cubic.p3 - cubic.p0;
    let ((t0, a), (t1, b)) = (unit(cubic.p1 - cubic.p0), unit(cubic.p3 - cubic.p2));
    let frame = Frame { q, t0, t1, floor: [0.0; 2], size: q.hypot() + a + b, home: [a, b], pull: 0.0 };
    let c = Candidate { t0: t[0], t1: t[1], p0: cubic.p0, frame, a, b };
    let mut feet = [0.0; FEET];
    for half in feet.chunks_exact_mut(8).enumerate() {
        let (first, out) = (8 * half.0, half.1);
        let tau: Lane = std::array::from_fn(|i| SAMPLES[first + i]);
        let mut g = source.images(&tau.map(|tau| t[0] + (t[1] - t[0]) * tau))?;
        for i in 0..8 {
            g.x[i] -= cubic.p0.x;
            g.y[i] -= cubic.p0.y;
        }
        let mut s = tau;
        frame.distances(&g, a, b, &mut s, 4);
        out.copy_from_slice(&s);
    }
    let first = quick(source, algebra, &c, &feet)?;
    if first <= tolerance { Ok(first) } else { bound(source, algebra, &c, &feet) }
}

/// The bound with N nodes, P coefficients in p, V in V.
#[inline(never)]
fn with<const N: usize, const P: usize, const V: usize>(
    source: &Source<'_>,
    algebra: &Algebra,
    c: &Candidate,
    feet: &[f64; FEET],
) -> Result<f64, Point>
where
    Tables<N, P>: Shared,
{
    let tables = Tables::<N, P>::shared();
    // p by least squares from the feet.
    let mut parts = [[0.0; 8]; 2];
    for i in 0..FEET {
        let lead = feet[i] - SAMPLES[i];
        for k in 0..8 {
            parts[i % 2][k] = fma(tables.feet[i][k], lead, parts[i % 2][k]);
        }
    }
    let p: [f64; P] = std::array::from_fn(|k| parts[0][k] + parts[1][k]);
    if !inside(tables, &p) {
        return Ok(f64::INFINITY);
    }
    let mut x = [0.0; N];
    let mut y = [0.0; N];
    let mut w = [1.0; N];
    let h = c.t1 - c.t0;
    for b in (0..N).step_by(8) {
        let mut t: Lane = [0.0; 8];
        for i in 0..8 {
            t[i] = fma(h, tables.tau[b + i], c.t0);
        }
        let mut g = source.points(&t);
        source.map.lanes(&mut g.x, &mut g.y);
        x[b..b + 8].copy_from_slice(&g.x);
        y[b..b + 8].copy_from_slice(&g.y);
        if algebra.below > 0 {
            w[b..b + 8].copy_from_slice(&algebra.denominators(source, &t));
        }
    }
    let f = phi(tables, &p);
    let [c1, c2, c3] = c.frame.power(c.a, c.b);
    subtract(&mut x, &f, [c.p0.x, c1.x, c2.x, c3.x]);
    subtract(&mut y, &f, [c.p0.y, c1.y, c2.y, c3.y]);
    let mut share = 1.0;
    if algebra.below > 0 {
        let Some(e) = cleared::<N, P, V>(tables, &mut w, algebra.below + V - 1) else { return Ok(f64::INFINITY) };
        for k in 0..N {
            x[k] *= w[k];
            y[k] *= w[k];
        }
        share = 1.0 - e;
    }
    // Lane by lane, a form that becomes vector instructions. What is not a number is seen in the sum.
    let (mut most, mut all) = ([0.0; 8], [0.0; 8]);
    for b in (0..N).step_by(8) {
        for i in 0..8 {
            let d = fma(x[b + i], x[b + i], y[b + i] * y[b + i]);
            most[i] = if d > most[i] { d } else { most[i] };
            all[i] += d;
        }
    }
    if !sum(&all).is_finite() {
        let t = tables.tau.map(|tau| c.t0 + h * tau);
        // Too large to be squared is too large to be fitted.
        let k = (0..N).find(|&k| !(x[k] + y[k]).is_finite());
        return k.map_or(Ok(f64::INFINITY), |k| Err(source.at(t[k])));
    }
    Ok(tables.supremum(&x, &y, largest(&most).sqrt(), algebra.total(P, V)) / share + noise(c))
}

/// φ at the nodes. Apart from its caller, like [`subtract`], so that the compiler sees nothing but the loop.
#[inline(never)]
fn phi<const N: usize, const P: usize>(tables: &Tables<N, P>, p: &[f64; P]) -> [f64; N] {
    let mut out = [0.0; N];
    for (base, p) in tables.t.iter().zip(p) {
        for k in 0..N {
            out[k] = fma(base[k], *p, out[k]);
        }
    }
    for k in 0..N {
        let tau = tables.tau[k];
        out[k] = fma(tau * (1.0 - tau), out[k], tau);
    }
    out
}

/// Takes one coordinate of the cubic, c₀ + (c₁ + (c₂ + c₃f)f)f, from that of the image.
#[inline(never)]
fn subtract<const N: usize>(g: &mut [f64; N], f: &[f64; N], [c0, c1, c2, c3]: [f64; 4]) {
    for k in 0..N {
        g[k] = g[k] - c0 - fma(fma(c3, f[k], c2), f[k], c1) * f[k];
    }
}

/// Whether φ stays in [0, 1].
#[inline(always)]
fn inside<const N: usize, const P: usize>(tables: &Tables<N, P>, p: &[f64; P]) -> bool {
    p.iter().map(|v| v.abs()).sum::<f64>() <= 1.0 || inside_by_bound(tables, p)
}

#[cold]
fn inside_by_bound<const N: usize, const P: usize>(tables: &Tables<N, P>, p: &[f64; P]) -> bool {
    let (mut a, mut b) = ([0.0; N], [0.0; N]);
    for k in 0..N {
        let v: f64 = (0..P).map(|j| p[j] * tables.t[j][k]).sum();
        a[k] = 1.0 + (1.0 - tables.tau[k]) * v;
        b[k] = 1.0 - tables.tau[k] * v;
    }
    tables.least(&a, P) >= 0.0 && tables.least(&b, P) >= 0.0
}

/// As [`bound`] where the candidate is a straight line: the part of D across the line, if the image runs along it one way.
/// Then the point of the image with the same part along is each point's partner.
pub(super) fn line(source: &Source<'_>, algebra: &Algebra, c: &Candidate, tolerance: f64) -> Result<f64, Point> {
    if algebra.degree + algebra.below < 24 && algebra.total(4, QUICK_V) < 24 {
        let quick = line_with::<24, 4, QUICK_V>(source, algebra, c)?;
        if quick <= tolerance {
            return Ok(quick);
        }
    }
    line_with::<N, P, V>(source, algebra, c)
}

fn line_with<const N: usize, const P: usize, const V: usize>(
    source: &Source<'_>,
    algebra: &Algebra,
    c: &Candidate,
) -> Result<f64, Point>
where
    Tables<N, P>: Shared,
{
    let tables = Tables::<N, P>::shared();
    let unit = c.frame.t0;
    let (mut across, mut pace, mut w) = ([0.0; N], [0.0; N], [1.0; N]);
    for b in (0..N).step_by(8) {
        let t: Lane = std::array::from_fn(|i| c.t0 + (c.t1 - c.t0) * tables.tau[b + i]);
        if algebra.below > 0 {
            w[b..b + 8].copy_from_slice(&algebra.denominators(source, &t));
        }
        for i in 0..8 {
            let (p, d) = source.image(t[i]);
            if !p.is_finite() || !d.is_finite() {
                return Err(source.at(t[i]));
            }
            let k = b + i;
            across[k] = (p - c.p0).cross(unit);
            // W²·g' = G'W − GW' is a polynomial and has the sign of g'.
            pace[k] = d.dot(unit) * (w[k] * w[k]);
        }
    }
    let mut share = 1.0;
    if algebra.below > 0 {
        let Some(e) = cleared::<N, P, V>(tables, &mut w, algebra.below + V - 1) else { return Ok(f64::INFINITY) };
        for k in 0..N {
            across[k] *= w[k];
        }
        share = 1.0 - e;
    }
    let degree = (algebra.degree + algebra.below).min(N);
    if degree >= N || tables.least(&pace, degree) < 0.0 {
        return Ok(f64::INFINITY);
    }
    let most = across.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    Ok(tables.supremum(&across, &[0.0; N], most, algebra.total(P, V)) / share + noise(c))
}

/// Rounding of the samples.
fn noise(c: &Candidate) -> f64 {
    /// Relative to their coordinates.
    const ROUNDING: f64 = 1e-14;
    ROUNDING * (c.p0.x.abs() + c.p0.y.abs() + c.frame.size)
}

/// Replaces W by V·W and returns a bound for |VW − 1|, `degree` being VW's.
fn cleared<const N: usize, const P: usize, const V: usize>(
    tables: &Tables<N, P>,
    w: &mut [f64; N],
    degree: usize,
) -> Option<f64> {
    if w.iter().any(|v| v.is_nan() || *v <= 0.0) {
        return None;
    }
    let v: [f64; V] = tables.first(&w.map(|w| 1.0 / w));
    let mut most = 0.0f64;
    for k in 0..N {
        let mut at = 0.0;
        for j in 0..V.min(P) {
            at += v[j] * tables.t[j][k];
        }
        w[k] *= at;
        let off = (w[k] - 1.0).abs();
        most = if off > most { off } else { most };
    }
    let e = tables.between_nodes(most, degree);
    /// A denominator that varies so much is split instead.
    const WORST: f64 = 0.1;
    (e < WORST).then_some(e)
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

#[cfg(test)]
mod tests {
    use super::*;

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
