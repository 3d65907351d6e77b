//! Proofs that a fitted cubic lies within a distance of the true image, where map and segment are quotients of polynomials.
//!
//! Let g be the image over one piece, τ in [0, 1], and C the cubic. For any continuous φ from [0, 1] onto [0, 1], the Hausdorff
//! distance of the two curves is at most sup |g(τ) − C(φ(τ))|: every point of g has a partner on C, and, φ being onto, every
//! point of C has one on g. With a polynomial φ that follows the foot points of the fit, D = g − C∘φ is a polynomial of known
//! degree, and a bound for it follows from finitely many values.
//!
//! **Denominators.** If g = G/W, D is no polynomial. But with a polynomial V close to 1/W, the product F = V·W·D is one, and
//! |D| ≤ |F| / (1−ε) where |VW − 1| ≤ ε. VW is a polynomial too, bounded in the same way.
//!
//! [`piece()`] tries the proofs in the order of their cost:
//!
//! - `sampled`: from the samples that the fit has taken anyway, or sixteen more.
//! - `nodes`: from 24 to 48 Chebyshev nodes. Also for merged pieces, whose ends do not coincide with the image's.
//! - `straight`: for lines.
//!
//! # Proofs from the values of D at Chebyshev nodes
//!
//! **φ** is a polynomial through the foot points of the fit, φ(τ) = τ + τ(1−τ)·p(2τ−1) with P coefficients in p. Since
//! φ = τ·(1 + (1−τ)p) and 1−φ = (1−τ)·(1 − τp), it stays in [0, 1] if the two brackets, polynomials of degree P, are not
//! negative. That holds if |p| ≤ 1, for which it suffices that the absolute values of p's Chebyshev coefficients add up to
//! at most 1; otherwise the bound below is applied to the brackets.
//!
//! **The bound.** D = g − C∘φ is a polynomial of a known degree less than N. Its values at the N Chebyshev nodes therefore
//! give its Chebyshev coefficients exactly (a discrete cosine transform), and for every d
//!
//! > sup |D| ≤ (max over nodes |D| + r_d) / cos(πd / 2N) + r_d,   r_d = Σ over k > d of |coefficient k|
//!
//! since a polynomial of degree d < N is at most 1/cos(πd/2N) times its largest value at the nodes (Ehlich and Zeller,
//! *Schwankung von Polynomen zwischen Gitterpunkten*, Math. Z. 86, 1964). The best d is taken. D is a vector; the theorem
//! holds for its component in any direction, hence for its length.
//!
//! **Few nodes, then many.** The cost goes with the number of nodes, the loss with their scarcity. A bound from few nodes with
//! a simple φ comes first ([`quick`]); if it is not good enough, many nodes follow ([`bound`]).
//!
//! Rounding of the samples (some 1e-14 of the coordinates) is added to the bound.

use crate::chebyshev::{ChebyshevTables, FEET, SAMPLES, SharedTables};
use crate::fit::{Candidate, ChordFrame};
use crate::limits::{LONG_PROOF_ERROR, LONG_PROOF_WITHIN, MAX_DENOMINATOR_VARIATION, PROOF_ROUNDING};
use crate::sample::{CHECKED, FITTED, Lane, Lanes, fma, largest, sum};
use crate::sampled::SampledProof;
use crate::source::{BreakPoint, NotFinite, Quotient, Source, images};
use kurbo::{CubicBez, Vec2};

/// Coefficients of V in the quick proof.
pub(crate) const QUICK_CLEARING: usize = 4;

/// A bound for the distance between candidate and image, both ways; infinite if none was found. `feet` approximate the foot
/// points of the samples j/17.
pub(crate) fn bound(
    source: &impl Source,
    form: &Quotient,
    c: &Candidate,
    feet: &[f64; FEET],
) -> Result<f64, NotFinite> {
    with_nodes::<NODES, PHI, CLEARING>(source, form, c, feet)
}

/// A looser bound from fewer nodes.
pub(crate) fn quick(
    source: &impl Source,
    form: &Quotient,
    c: &Candidate,
    feet: &[f64; FEET],
) -> Result<f64, NotFinite> {
    const V: usize = QUICK_CLEARING;
    match form.total(4, V) {
        _ if form.below == 0 && form.total(5, V) < 24 => with_nodes::<24, 5, V>(source, form, c, feet),
        ..24 => with_nodes::<24, 4, V>(source, form, c, feet),
        _ if form.total(5, V) < 40 => with_nodes::<40, 5, V>(source, form, c, feet),
        _ => Ok(f64::INFINITY),
    }
}

/// A bound as by [`bound`] for any cubic over the stretch `t` of the source; the ends need not coincide.
pub(crate) fn stretch(
    source: &impl Source,
    form: &Quotient,
    t: [f64; 2],
    cubic: &CubicBez,
    tolerance: f64,
) -> Result<f64, NotFinite> {
    let unit = |v: Vec2| if v == Vec2::ZERO { (v, 0.0) } else { (v / v.hypot(), v.hypot()) };
    let q = cubic.p3 - cubic.p0;
    let ((t0, a), (t1, b)) = (unit(cubic.p1 - cubic.p0), unit(cubic.p3 - cubic.p2));
    let frame = ChordFrame { q, t0, t1, floor: [0.0; 2], size: q.hypot() + a + b, home: [a, b], pull: 0.0 };
    let c = Candidate { t0: t[0], t1: t[1], p0: cubic.p0, frame, a, b };
    let mut feet = [0.0; FEET];
    for half in feet.chunks_exact_mut(8).enumerate() {
        let (first, out) = (8 * half.0, half.1);
        let tau: Lane = std::array::from_fn(|i| SAMPLES[first + i]);
        let mut g = images(source, &tau.map(|tau| t[0] + (t[1] - t[0]) * tau))?;
        for i in 0..8 {
            g.x[i] -= cubic.p0.x;
            g.y[i] -= cubic.p0.y;
        }
        let mut s = tau;
        frame.distances(&g, a, b, &mut s, 4);
        out.copy_from_slice(&s);
    }
    let first = quick(source, form, &c, &feet)?;
    if first <= tolerance { Ok(first) } else { bound(source, form, &c, &feet) }
}

/// The bound with N nodes, P coefficients in p, V in V.
#[inline(never)]
fn with_nodes<const N: usize, const P: usize, const V: usize>(
    source: &impl Source,
    form: &Quotient,
    c: &Candidate,
    feet: &[f64; FEET],
) -> Result<f64, NotFinite>
where
    ChebyshevTables<N, P>: SharedTables,
{
    let tables = ChebyshevTables::<N, P>::shared();
    let Some(p) = through(tables, feet) else { return Ok(f64::INFINITY) };
    let mut x = [0.0; N];
    let mut y = [0.0; N];
    let mut w = [1.0; N];
    let h = c.t1 - c.t0;
    for b in (0..N).step_by(8) {
        let mut t: Lane = [0.0; 8];
        for i in 0..8 {
            t[i] = fma(h, tables.tau[b + i], c.t0);
        }
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
    subtract(&mut x, &f, [c.p0.x, c1.x, c2.x, c3.x]);
    subtract(&mut y, &f, [c.p0.y, c1.y, c2.y, c3.y]);
    let mut share = 1.0;
    if form.below > 0 {
        let Some(e) = cleared::<N, P, V>(tables, &mut w, form.below + V - 1) else { return Ok(f64::INFINITY) };
        for k in 0..N {
            x[k] *= w[k];
            y[k] *= w[k];
        }
        share = 1.0 - e;
    }
    // Lane by lane, which is vectorised. NaN and infinity show in the sum.
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
        // A value too large to be squared is too large to be fitted.
        let k = (0..N).find(|&k| !(x[k] + y[k]).is_finite());
        return k.map_or(Ok(f64::INFINITY), |k| Err(NotFinite { t: t[k], at: source.place(t[k]) }));
    }
    Ok(tables.supremum(&x, &y, largest(&most).sqrt(), form.total(P, V)) / share + rounding(c))
}

/// The coefficients of p by least squares from the foot points. `None` if φ leaves [0, 1].
#[inline(always)]
fn through<const N: usize, const P: usize>(tables: &ChebyshevTables<N, P>, feet: &[f64; FEET]) -> Option<[f64; P]> {
    let mut parts = [[0.0; 8]; 2];
    for i in 0..FEET {
        let lead = feet[i] - SAMPLES[i];
        for k in 0..8 {
            parts[i % 2][k] = fma(tables.feet[i][k], lead, parts[i % 2][k]);
        }
    }
    let p: [f64; P] = std::array::from_fn(|k| parts[0][k] + parts[1][k]);
    (p.iter().map(|v| v.abs()).sum::<f64>() <= 1.0 || in_range_by_bound(tables, &p)).then_some(p)
}

#[cold]
fn in_range_by_bound<const N: usize, const P: usize>(tables: &ChebyshevTables<N, P>, p: &[f64; P]) -> bool {
    let (mut a, mut b) = ([0.0; N], [0.0; N]);
    for k in 0..N {
        let v: f64 = (0..P).map(|j| p[j] * tables.t[j][k]).sum();
        a[k] = 1.0 + (1.0 - tables.tau[k]) * v;
        b[k] = 1.0 - tables.tau[k] * v;
    }
    tables.least(&a, P) >= 0.0 && tables.least(&b, P) >= 0.0
}

/// φ at the nodes. Not inlined, like [`subtract`], so that LLVM sees nothing but the loop.
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

/// Subtracts one coordinate of the cubic, c₀ + (c₁ + (c₂ + c₃f)f)f, from that of the image.
#[inline(never)]
fn subtract<const N: usize>(g: &mut [f64; N], f: &[f64; N], [c0, c1, c2, c3]: [f64; 4]) {
    for k in 0..N {
        g[k] = g[k] - c0 - fma(fma(c3, f[k], c2), f[k], c1) * f[k];
    }
}

/// A bound for the rounding of the samples.
pub(crate) fn rounding(c: &Candidate) -> f64 {
    PROOF_ROUNDING * (c.p0.x.abs() + c.p0.y.abs() + c.frame.size)
}

/// Replaces W by V·W and returns a bound for |VW − 1|, a polynomial of degree `degree`. `None` if W is not positive or
/// varies too much.
pub(crate) fn cleared<const N: usize, const P: usize, const V: usize>(
    tables: &ChebyshevTables<N, P>,
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
    (e < MAX_DENOMINATOR_VARIATION).then_some(e)
}

/// Chebyshev nodes of the longest proof: more than the degree of D for a bicubic map of a cubic (max(18, 3·9)) and for a
/// rational map of degree 4 (12 + 27 + 5), enough for the bound to lose little.
pub(crate) const NODES: usize = 48;
/// Coefficients of its p (see [`nodes`](super::nodes)), and of its V.
pub(crate) const PHI: usize = 8;
pub(crate) const CLEARING: usize = 6;

impl Quotient {
    /// The form itself if its degree is low enough for proofs.
    pub fn provable(self) -> Option<Self> {
        (self.total(PHI, CLEARING) < NODES && self.below + CLEARING - 1 < NODES).then_some(self)
    }

    /// Degree of D, or of F: at most that of VW·C∘φ, with `p` coefficients of φ's p and `v` of V.
    pub(crate) fn total(&self, p: usize, v: usize) -> usize {
        let composed = 3 * (p + 1);
        if self.below > 0 { (self.below + composed).max(self.degree) + v - 1 } else { self.degree.max(composed) }
    }
}

/// A bound for the distance between candidate and image: at most the tolerance if one of the proofs succeeds; otherwise a
/// larger one, or infinity. `g` and `feet` are those of the fitted and the checked samples, at which `error` was measured.
pub(crate) fn piece(
    source: &impl Source,
    form: &Quotient,
    c: &Candidate,
    g: [&Lanes; 2],
    feet: [&Lane; 2],
    [error, tolerance]: [f64; 2],
) -> Result<f64, NotFinite> {
    let mut sampled = SampledProof::new(source, form, c, g, tolerance);
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
    let polynomial = form.below == 0;
    let hopeless = thirty_two > LONG_PROOF_WITHIN * tolerance || error > LONG_PROOF_ERROR * tolerance;
    if polynomial && thirty_two.is_finite() && hopeless {
        return Ok(thirty_two);
    }
    let mut feet = [0.0; 16];
    for i in 0..8 {
        feet[FITTED[i] as usize - 1] = s0[i];
        feet[CHECKED[i] as usize - 1] = s1[i];
    }
    if !polynomial {
        let quick = quick(source, form, c, &feet)?;
        if quick <= tolerance {
            return Ok(quick);
        }
    }
    bound(source, form, c, &feet)
}

/// A bound for the distance between the image and the line between two break points: the component of D across the line, if
/// the image runs along the line in one direction. Then each point's partner is the point of the image with the same
/// component along the line.
pub(crate) fn line(
    source: &impl Source,
    form: &Quotient,
    from: &BreakPoint,
    to: &BreakPoint,
    size: f64,
    tolerance: f64,
) -> Result<f64, NotFinite> {
    let q = to.p - from.p;
    let length = q.hypot();
    let unit = if length > 0.0 { q / length } else { Vec2::ZERO };
    let third = length / 3.0;
    let frame = ChordFrame { q, t0: unit, t1: unit, floor: [0.0; 2], size, home: [third; 2], pull: 0.0 };
    let c = Candidate { t0: from.t, t1: to.t, p0: from.p, frame, a: third, b: third };
    if form.degree + form.below < 24 && form.total(4, QUICK_CLEARING) < 24 {
        let quick = line_with_nodes::<24, 4, QUICK_CLEARING>(source, form, &c)?;
        if quick <= tolerance {
            return Ok(quick);
        }
    }
    line_with_nodes::<NODES, PHI, CLEARING>(source, form, &c)
}

fn line_with_nodes<const N: usize, const P: usize, const V: usize>(
    source: &impl Source,
    form: &Quotient,
    c: &Candidate,
) -> Result<f64, NotFinite>
where
    ChebyshevTables<N, P>: SharedTables,
{
    let tables = ChebyshevTables::<N, P>::shared();
    let unit = c.frame.t0;
    let (mut across, mut pace, mut w) = ([0.0; N], [0.0; N], [1.0; N]);
    for b in (0..N).step_by(8) {
        let t: Lane = std::array::from_fn(|i| c.t0 + (c.t1 - c.t0) * tables.tau[b + i]);
        if form.below > 0 {
            w[b..b + 8].copy_from_slice(&form.denominators(source, &t));
        }
        for i in 0..8 {
            let (p, d) = source.eval(t[i]);
            if !p.is_finite() || !d.is_finite() {
                return Err(NotFinite { t: t[i], at: source.place(t[i]) });
            }
            let k = b + i;
            across[k] = (p - c.p0).cross(unit);
            // W²·g' = G'W − GW' is a polynomial and has the sign of g'.
            pace[k] = d.dot(unit) * (w[k] * w[k]);
        }
    }
    let mut share = 1.0;
    if form.below > 0 {
        let Some(e) = cleared::<N, P, V>(tables, &mut w, form.below + V - 1) else { return Ok(f64::INFINITY) };
        for k in 0..N {
            across[k] *= w[k];
        }
        share = 1.0 - e;
    }
    let degree = (form.degree + form.below).min(N);
    if degree >= N || tables.least(&pace, degree) < 0.0 {
        return Ok(f64::INFINITY);
    }
    let most = across.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    Ok(tables.supremum(&across, &[0.0; N], most, form.total(P, V)) / share + rounding(c))
}
