//! Proofs that a fitted cubic lies within a distance of the true image, where map and segment are quotients of polynomials.
//!
//! Let g be the image over one piece, τ in [0, 1], and C the cubic. For any continuous φ from [0, 1] onto [0, 1], the Hausdorff
//! distance of the two curves is at most sup |g(τ) − C(φ(τ))|: every point of g has a partner on C, and, φ being onto, every
//! point of C has one on g. With a polynomial φ that follows the foot points of the fit, D = g − C∘φ is a polynomial of known
//! degree, and a bound for it follows from finitely many values.
//!
//! [`piece()`] tries proofs in the order of their cost: first from the samples that the fit has taken, or sixteen more (`sampled`), with
//! φ(τ) = τ (`identity`) or through foot points; then from D at 24 to 48 Chebyshev nodes, as follows. Nodes also serve merged pieces,
//! whose ends are not on the image ([`stretch()`]). Lines have a proof by themselves ([`line()`]).
//!
//! **φ** is a polynomial through the foot points of the fit, φ(τ) = τ + τ(1−τ)·p(2τ−1) with P coefficients in p. Since
//! φ = τ·(1 + (1−τ)p) and 1−φ = (1−τ)·(1 − τp), it stays in [0, 1] if the two brackets, polynomials of degree P, are not
//! negative. That holds if |p| ≤ 1, for which it suffices that the absolute values of p's Chebyshev coefficients add up to
//! at most 1; otherwise the bound below is applied to the brackets.
//!
//! **The bound.** D is a polynomial of a known degree less than N. Its values at the N Chebyshev nodes therefore
//! give its Chebyshev coefficients exactly (a discrete cosine transform), and for every d
//!
//! > sup |D| ≤ (max over nodes |D| + r_d) / cos(πd / 2N) + r_d,   r_d = Σ over k > d of |coefficient k|
//!
//! since a polynomial of degree d < N is at most 1/cos(πd/2N) times its largest value at the nodes (Ehlich and Zeller,
//! *Schwankung von Polynomen zwischen Gitterpunkten*, Math. Z. 86, 1964). The best d is taken. D is a vector; the theorem
//! holds for its component in any direction, hence for its length. A bound from few nodes with a simple φ comes first, as it is cheap;
//! if it is above the tolerance, many nodes follow, which lose less.
//!
//! **Denominators.** If g = G/W with W of degree `below` > 0, D is no polynomial. But with a polynomial V close to 1/W, the product
//! F = V·W·D is one, and |D| ≤ |F| / (1−ε) where |VW − 1| ≤ ε. VW is a polynomial too, bounded in the same way.
//!
//! **Rounding** of the samples (some 1e-14 of the coordinates) is added to the bound.

use crate::fit::{Candidate, ChordFrame};
use crate::sample::{CHECKED, FITTED, Lane, Lanes, fma, larger, largest, sum};
use crate::sampled::{MAX_VARIATION, ROUNDING, SampledProof, inverse};
use crate::source::{BreakPoint, NotFinite, Quotient, Result, Source};
use kurbo::{CubicBez, Point, Vec2};
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Bound for the Hausdorff distance between candidate and image from Chebyshev nodes: few, or more if that bound is above the tolerance;
/// infinite if none was found. `feet` approximate the foot points of the samples j/17.
fn by_nodes(source: &impl Source, form: &Quotient, c: &Candidate, feet: &Feet, tolerance: f64) -> Result<f64> {
    let is_low = form.total(4, 4) < 24;
    let quick = if is_low { bound_from_nodes::<24, 4, 4>(&FEW, source, form, c, feet)? } else { f64::INFINITY };
    let proven = quick <= tolerance;
    if proven { Ok(quick) } else { bound_from_nodes::<_, _, V_COEFFICIENTS>(&MANY, source, form, c, feet) }
}

/// Bound for the Hausdorff distance between a cubic and the image of the stretch `t`, whose ends need not be those of the cubic.
pub(crate) fn stretch(
    source: &impl Source,
    form: &Quotient,
    [t0, t1]: [f64; 2],
    cubic: &CubicBez,
    tolerance: f64,
) -> Result<f64> {
    let unit = |v: Vec2| if v == Vec2::ZERO { (v, 0.0) } else { (v / v.hypot(), v.hypot()) };
    let q = cubic.p3 - cubic.p0;
    let ((u0, a), (u1, b)) = (unit(cubic.p1 - cubic.p0), unit(cubic.p3 - cubic.p2));
    let (size, home) = (q.hypot() + a + b, [a, b]);
    let frame = ChordFrame { q, t0: u0, t1: u1, floor: [0.0; 2], size, home, pull: 0.0 };
    let c = Candidate { t0, t1, p0: cubic.p0, frame, a, b };
    // Foot points by four Newton steps; their distances, and the frame's bounds and pulls of handles, do not matter.
    let mut feet = SAMPLES;
    for half in feet.as_chunks_mut::<8>().0 {
        let g = c.images(source, half)?;
        frame.distances(&g, a, b, half, 4);
    }
    by_nodes(source, form, &c, &feet, tolerance)
}

/// The bound from N nodes, with P coefficients in p and V in the polynomial V.
#[inline(never)]
fn bound_from_nodes<const N: usize, const P: usize, const V: usize>(
    tables: &ChebyshevTables<N, P>,
    source: &impl Source,
    form: &Quotient,
    c: &Candidate,
    feet: &Feet,
) -> Result<f64> {
    let Some(p) = fit_p(tables, feet) else { return Ok(f64::INFINITY) };
    let mut x = [0.0; N];
    let mut y = [0.0; N];
    let mut w = [1.0; N];
    let h = c.t1 - c.t0;
    for b in (0..N).step_by(8) {
        let t: Lane = std::array::from_fn(|i| fma(h, tables.tau[b + i], c.t0));
        let mut g = Lanes::default();
        source.points(&t, &mut g);
        x[b..b + 8].copy_from_slice(&g.x);
        y[b..b + 8].copy_from_slice(&g.y);
        if form.below > 0 {
            w[b..b + 8].copy_from_slice(&form.denominators(source, &t));
        }
    }
    let f = phi(tables, &p);
    let [c1, c2, c3] = c.frame.power(c.a, c.b);
    subtract_cubic(&mut x, &f, [c.p0.x, c1.x, c2.x, c3.x]);
    subtract_cubic(&mut y, &f, [c.p0.y, c1.y, c2.y, c3.y]);
    let mut share = 1.0;
    if form.below > 0 {
        let variation = clear_denominator::<N, P, V>(tables, &mut w, form.below + V - 1);
        let Some(variation) = variation else { return Ok(f64::INFINITY) };
        for k in 0..N {
            x[k] *= w[k];
            y[k] *= w[k];
        }
        share = 1.0 - variation;
    }
    // The loop over lanes is vectorised. NaN and infinity show in the sum.
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
        // Finite values whose squares overflow have no bound.
        let k = (0..N).find(|&k| !(x[k] + y[k]).is_finite());
        return k.map_or(Ok(f64::INFINITY), |k| Err(NotFinite { t: t[k], at: source.place(t[k]) }));
    }
    Ok(tables.supremum(&x, &y, largest(&most).sqrt(), form.total(P, V)) / share + rounding(c.p0, c.frame.size))
}

/// The coefficients of p by least squares from the foot points. `None` if φ leaves [0, 1].
#[inline(always)]
fn fit_p<const N: usize, const P: usize>(tables: &ChebyshevTables<N, P>, feet: &Feet) -> Option<[f64; P]> {
    let mut parts = [[0.0; 8]; 2];
    for i in 0..FOOT_POINTS {
        let lead = feet[i] - SAMPLES[i];
        for k in 0..8 {
            parts[i % 2][k] = fma(tables.feet[i][k], lead, parts[i % 2][k]);
        }
    }
    let p: [f64; P] = std::array::from_fn(|k| parts[0][k] + parts[1][k]);
    (p.iter().map(|v| v.abs()).sum::<f64>() <= 1.0 || in_range_by_bound(tables, &p)).then_some(p)
}

/// Returns `true` if the bound for the brackets shows that φ stays in [0, 1].
#[cold]
fn in_range_by_bound<const N: usize, const P: usize>(tables: &ChebyshevTables<N, P>, p: &[f64; P]) -> bool {
    let (mut a, mut b) = ([0.0; N], [0.0; N]);
    for k in 0..N {
        let v: f64 = (0..P).map(|j| p[j] * tables.t[j][k]).sum();
        a[k] = 1.0 + (1.0 - tables.tau[k]) * v;
        b[k] = 1.0 - tables.tau[k] * v;
    }
    tables.lower_bound(&a, P) >= 0.0 && tables.lower_bound(&b, P) >= 0.0
}

/// φ at the nodes. Not inlined, so that LLVM sees nothing but the loop.
#[inline(never)]
fn phi<const N: usize, const P: usize>(tables: &ChebyshevTables<N, P>, p: &[f64; P]) -> [f64; N] {
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

/// Subtracts one coordinate of the cubic, c₀ + (c₁ + (c₂ + c₃f)f)f, from that coordinate of the image.
#[inline(never)]
fn subtract_cubic<const N: usize>(g: &mut [f64; N], f: &[f64; N], [c0, c1, c2, c3]: [f64; 4]) {
    for k in 0..N {
        g[k] = g[k] - c0 - fma(fma(c3, f[k], c2), f[k], c1) * f[k];
    }
}

/// Bound for the rounding of the samples.
fn rounding(p0: Point, size: f64) -> f64 {
    ROUNDING * (p0.x.abs() + p0.y.abs() + size)
}

/// Replaces W by VW and returns a bound for |VW − 1|, where VW has degree `degree`. `None` if W is not positive or varies too much.
pub(crate) fn clear_denominator<const N: usize, const P: usize, const V: usize>(
    tables: &ChebyshevTables<N, P>,
    w: &mut [f64; N],
    degree: usize,
) -> Option<f64> {
    if w.iter().any(|v| v.is_nan() || *v <= 0.0) {
        return None;
    }
    let v: [f64; V] = tables.leading_coefficients(&w.map(|w| 1.0 / w));
    let mut most = 0.0f64;
    for k in 0..N {
        let mut value = 0.0;
        for j in 0..V.min(P) {
            value += v[j] * tables.t[j][k];
        }
        w[k] *= value;
        most = larger((w[k] - 1.0).abs(), most);
    }
    let variation = most * tables.stretch[degree];
    (variation < MAX_VARIATION).then_some(variation)
}

/// Chebyshev nodes of the longest proof: more than the degree of D for a bicubic map of a cubic (max(18, 3·9)) and for a
/// rational map of degree 4 (12 + 27 + 5), enough for the bound to lose little.
pub(crate) const MAX_NODES: usize = 48;
/// Numbers of coefficients of p and of V in the longest proof.
pub(crate) const P_COEFFICIENTS: usize = 8;
pub(crate) const V_COEFFICIENTS: usize = 6;

impl Quotient {
    /// Returns the form if its degree is low enough for proofs.
    pub fn provable(self) -> Option<Self> {
        (self.total(P_COEFFICIENTS, V_COEFFICIENTS) < MAX_NODES && self.below + V_COEFFICIENTS - 1 < MAX_NODES)
            .then_some(self)
    }

    /// Degree of D or, with denominators, of F, for `p` coefficients of φ's p and `v` of V.
    pub(crate) fn total(&self, p: usize, v: usize) -> usize {
        let composed = 3 * (p + 1);
        if self.below > 0 { (self.below + composed).max(self.degree) + v - 1 } else { self.degree.max(composed) }
    }
}

/// Bound for the Hausdorff distance between candidate and image: at most the tolerance if one of the proofs succeeds; otherwise
/// larger or infinite. `g` and `feet` are images and foot points of the fitted and the checked samples.
pub(crate) fn piece(
    source: &impl Source,
    form: &Quotient,
    c: &Candidate,
    g: [&Lanes; 2],
    feet: [&Lane; 2],
    tolerance: f64,
) -> Result<f64> {
    let sampled = SampledProof::new(source, form, c, g, tolerance);
    let identity = sampled.identity()?;
    if identity <= tolerance {
        return Ok(identity);
    }
    let sixteen = sampled.sixteen(feet)?;
    if sixteen <= tolerance {
        return Ok(sixteen);
    }
    let (mut s0, mut s1) = (*feet[0], *feet[1]);
    c.frame.distances(g[0], c.a, c.b, &mut s0, 2);
    c.frame.distances(g[1], c.a, c.b, &mut s1, 2);
    let thirty_two = sampled.thirty_two([&s0, &s1])?;
    if thirty_two <= tolerance {
        return Ok(thirty_two);
    }
    // For a polynomial, more nodes would lower the bound little, and smaller pieces cost less.
    if form.below == 0 && thirty_two.is_finite() {
        return Ok(thirty_two);
    }
    let mut feet = [0.0; 16];
    for i in 0..8 {
        feet[FITTED[i] as usize - 1] = s0[i];
        feet[CHECKED[i] as usize - 1] = s1[i];
    }
    by_nodes(source, form, c, &feet, tolerance)
}

/// Bound for the distance between the image and the line between two break points, if the image runs along the line in one direction.
/// Then every point of the line has a partner on the image with the same component along the line, and their distance is the
/// component across. `size` is the scale of the image for rounding.
pub(crate) fn line(source: &impl Source, form: &Quotient, [from, to]: [&BreakPoint; 2], size: f64) -> Result<f64> {
    let q = to.p - from.p;
    let length = q.hypot();
    let unit = if length > 0.0 { q / length } else { Vec2::ZERO };
    const N: usize = MAX_NODES;
    let tables = &**MANY;
    let (mut across, mut pace, mut w) = ([0.0; N], [0.0; N], [1.0; N]);
    for b in (0..N).step_by(8) {
        let t: Lane = std::array::from_fn(|i| from.t + (to.t - from.t) * tables.tau[b + i]);
        if form.below > 0 {
            w[b..b + 8].copy_from_slice(&form.denominators(source, &t));
        }
        for i in 0..8 {
            let (p, d) = source.eval(t[i]);
            if !p.is_finite() || !d.is_finite() {
                return Err(NotFinite { t: t[i], at: source.place(t[i]) });
            }
            let k = b + i;
            across[k] = (p - from.p).cross(unit);
            // W²g′ = G′W − GW′ is a polynomial and has the sign of g′.
            pace[k] = d.dot(unit) * (w[k] * w[k]);
        }
    }
    let mut share = 1.0;
    if form.below > 0 {
        let degree = form.below + V_COEFFICIENTS - 1;
        let variation = clear_denominator::<_, _, V_COEFFICIENTS>(tables, &mut w, degree);
        let Some(variation) = variation else { return Ok(f64::INFINITY) };
        for k in 0..N {
            across[k] *= w[k];
        }
        share = 1.0 - variation;
    }
    let degree = (form.degree + form.below).min(N);
    if degree >= N || tables.lower_bound(&pace, degree) < 0.0 {
        return Ok(f64::INFINITY);
    }
    let most = across.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    Ok(tables.supremum(&across, &[0.0; N], most, form.total(P_COEFFICIENTS, V_COEFFICIENTS)) / share
        + rounding(from.p, size))
}

/// Number of samples with foot points, at j/17.
pub(crate) const FOOT_POINTS: usize = 16;
type Feet = [f64; FOOT_POINTS];

/// Even and odd coefficients are computed apart, in groups of four. This is the largest number of groups of each, N/8 for N = 48.
const MOST_QUARTERS: usize = 6;

/// Constant tables of the proofs with N nodes and P coefficients of p, shared by all threads.
pub(crate) struct ChebyshevTables<const N: usize, const P: usize> {
    /// The nodes on [0, 1].
    pub(crate) tau: [f64; N],
    /// The Chebyshev polynomials of degree less than P at the nodes.
    pub(crate) t: [[f64; N]; P],
    /// Row k: contributions of the value at node k to the coefficients 0, 2, 4… and 1, 3, 5…
    even: [[f64; N]; N],
    odd: [[f64; N]; N],
    /// 1/cos(πd/2N), by which a polynomial of degree d can exceed its values at the nodes.
    stretch: [f64; N],
    /// Row i: contributions of the foot point of sample i to the coefficients of p, by least squares. P of the eight are used.
    pub(crate) feet: [[f64; 8]; FOOT_POINTS],
}

/// Tables of the quick proof and of the longest.
static FEW: LazyLock<Box<ChebyshevTables<24, 4>>> = LazyLock::new(|| Box::new(ChebyshevTables::new()));
static MANY: LazyLock<Box<ChebyshevTables<MAX_NODES, P_COEFFICIENTS>>> =
    LazyLock::new(|| Box::new(ChebyshevTables::new()));

impl<const N: usize, const P: usize> ChebyshevTables<N, P> {
    fn new() -> Self {
        let angle = |k: usize| PI * (k as f64 + 0.5) / N as f64;
        let part = |k: usize, d: usize| (if d == 0 { 1.0 } else { 2.0 }) / N as f64 * (d as f64 * angle(k)).cos();
        Self {
            tau: std::array::from_fn(|k| 0.5 + 0.5 * angle(k).cos()),
            t: std::array::from_fn(|j| std::array::from_fn(|k| (j as f64 * angle(k)).cos())),
            even: std::array::from_fn(|k| std::array::from_fn(|i| part(k, 2 * i))),
            odd: std::array::from_fn(|k| std::array::from_fn(|i| part(k, 2 * i + 1))),
            stretch: std::array::from_fn(|d| 1.0 / (PI * d as f64 / (2 * N) as f64).cos()),
            feet: least_squares::<P>().map(|row| std::array::from_fn(|k| if k < P { row[k] } else { 0.0 })),
        }
    }

    /// The first V Chebyshev coefficients of the function with these values.
    pub(crate) fn leading_coefficients<const V: usize>(&self, f: &[f64; N]) -> [f64; V] {
        let mut out = [0.0; V];
        for k in 0..N {
            for d in 0..V {
                out[d] += (if d % 2 == 0 { self.even[k][d / 2] } else { self.odd[k][d / 2] }) * f[k];
            }
        }
        out
    }

    /// Bound for the length of the vector polynomial with these values at the nodes, the longest of which is `most`: the least
    /// over d of the bound in the text above.
    pub(crate) fn supremum(&self, x: &[f64; N], y: &[f64; N], most: f64, degree: usize) -> f64 {
        // Even and odd coefficients of x and y. The values at a node and at its mirror image contribute equally to the even
        // ones and oppositely to the odd ones.
        let mut c = [[[0.0; 4]; 4]; MOST_QUARTERS];
        let quarters = N / 8;
        for k in 0..N / 2 {
            let m = N - 1 - k;
            let f = [x[k] + x[m], y[k] + y[m], x[k] - x[m], y[k] - y[m]];
            let (even, odd) = (&self.even[k], &self.odd[k]);
            for q in 0..quarters {
                for i in 0..4 {
                    let (e, o) = (even[4 * q + i], odd[4 * q + i]);
                    c[q][0][i] = fma(e, f[0], c[q][0][i]);
                    c[q][1][i] = fma(e, f[1], c[q][1][i]);
                    c[q][2][i] = fma(o, f[2], c[q][2][i]);
                    c[q][3][i] = fma(o, f[3], c[q][3][i]);
                }
            }
        }
        let mut size = [0.0; N];
        for q in 0..quarters {
            let (mut even, mut odd) = ([0.0; 4], [0.0; 4]);
            for i in 0..4 {
                even[i] = fma(c[q][0][i], c[q][0][i], c[q][1][i] * c[q][1][i]).sqrt();
                odd[i] = fma(c[q][2][i], c[q][2][i], c[q][3][i] * c[q][3][i]).sqrt();
            }
            for i in 0..4 {
                size[8 * q + 2 * i] = even[i];
                size[8 * q + 2 * i + 1] = odd[i];
            }
        }
        let mut tail = 0.0;
        let mut best = f64::INFINITY;
        for d in (0..=degree).rev() {
            let bound = (most + tail) * self.stretch[d] + tail;
            best = if bound < best { bound } else { best };
            // Coefficient d joins the tail. Once the tail alone exceeds the best bound, smaller d cannot help.
            tail += size[d];
            if tail > best {
                break;
            }
        }
        best
    }

    /// Lower bound for a polynomial of the given degree, by an upper bound for its distance from the midrange of its values at the nodes.
    pub(crate) fn lower_bound(&self, f: &[f64; N], degree: usize) -> f64 {
        let lo = f.iter().copied().fold(f64::INFINITY, f64::min);
        let hi = f.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mid = 0.5 * (lo + hi);
        mid - self.supremum(&f.map(|v| v - mid), &[0.0; N], hi - mid, degree)
    }
}

/// Rows of the pseudo-inverse of `A[i][j]` = τᵢ(1−τᵢ) times the j-th Chebyshev polynomial at 2τᵢ−1: normal
/// equations, well conditioned for sixteen samples and degree seven.
fn least_squares<const P: usize>() -> [[f64; P]; FOOT_POINTS] {
    let a: [[f64; P]; FOOT_POINTS] = std::array::from_fn(|i| {
        let tau = SAMPLES[i];
        let u: f64 = 2.0 * tau - 1.0;
        std::array::from_fn(|j| tau * (1.0 - tau) * (j as f64 * u.acos()).cos())
    });
    let gram = inverse(std::array::from_fn::<[f64; P], P, _>(|r| {
        std::array::from_fn(|c| a.iter().map(|row| row[r] * row[c]).sum())
    }));
    a.map(|row| std::array::from_fn(|k| (0..P).map(|j| gram[k][j] * row[j]).sum()))
}

/// Parameters τ of the samples with foot points.
pub(crate) const SAMPLES: [f64; FOOT_POINTS] = {
    let mut out = [0.0; FOOT_POINTS];
    let mut i = 0;
    while i < FOOT_POINTS {
        out[i] = (i as f64 + 1.0) / (FOOT_POINTS as f64 + 1.0);
        i += 1;
    }
    out
};

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Vec2;

    fn the_bound_holds_with<const N: usize, const P: usize>(t: &ChebyshevTables<N, P>, worst: f64) {
        // A polynomial of degree 9, whose maximum is found by sampling.
        let f = |t: f64| {
            let u = 2.0 * t - 1.0;
            let v = (9.0 * u.acos()).cos() * 0.01 + (4.0 * u.acos()).cos() + 0.3 * u;
            Vec2::new(v, 0.5 * v)
        };
        let (x, y) = (t.tau.map(|t| f(t).x), t.tau.map(|t| f(t).y));
        let most = (0..N).map(|k| x[k].hypot(y[k])).fold(0.0, f64::max);
        let truth = (0..=10_000).map(|i| f(f64::from(i) / 10_000.0).hypot()).fold(0.0, f64::max);
        let b = t.supremum(&x, &y, most, N - 1);
        assert!(b >= truth && b < worst * truth, "{N}: {b} {truth}");
    }

    #[test]
    fn the_bound_holds_and_is_not_far_off() {
        the_bound_holds_with(&MANY, 1.06);
        the_bound_holds_with(&FEW, 1.13);
    }

    #[test]
    fn phi_goes_through_feet_it_can_represent() {
        let rows: [[f64; 8]; FOOT_POINTS] = least_squares();
        let want = [0.1, -0.05, 0.02, 0.0, 0.003, 0.0, 0.0, -0.001];
        let lead: Vec<f64> = (0..FOOT_POINTS)
            .map(|i| {
                let tau = SAMPLES[i];
                let u: f64 = 2.0 * tau - 1.0;
                tau * (1.0 - tau) * (0..8).map(|j| want[j] * (j as f64 * u.acos()).cos()).sum::<f64>()
            })
            .collect();
        for k in 0..8 {
            let got: f64 = rows.iter().zip(&lead).map(|(r, f)| r[k] * f).sum();
            assert!((got - want[k]).abs() < 1e-12);
        }
    }
}
