//! Proofs from the values of D at Chebyshev nodes.
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

use super::chebyshev::{ChebyshevTables, FEET, SAMPLES, SharedTables};
use super::form::{CLEARING, NODES, PHI, RationalForm};
use crate::refit::candidate::Candidate;
use crate::refit::frame::ChordFrame;
use crate::refit::lanes::{Lane, fma, largest, sum};
use crate::refit::limits::{MAX_DENOMINATOR_VARIATION, PROOF_ROUNDING};
use crate::refit::source::SourceCurve;
use kurbo::{CubicBez, Point, Vec2};

/// Coefficients of V in the quick proof.
pub(super) const QUICK_CLEARING: usize = 4;

/// A bound for the distance between candidate and image, both ways; infinite if none was found. `feet` approximate the foot
/// points of the samples j/17.
pub(super) fn bound(
    source: &SourceCurve<'_>,
    form: &RationalForm,
    c: &Candidate,
    feet: &[f64; FEET],
) -> Result<f64, Point> {
    with_nodes::<NODES, PHI, CLEARING>(source, form, c, feet)
}

/// A looser bound from fewer nodes.
pub(super) fn quick(
    source: &SourceCurve<'_>,
    form: &RationalForm,
    c: &Candidate,
    feet: &[f64; FEET],
) -> Result<f64, Point> {
    const V: usize = QUICK_CLEARING;
    match form.total(4, V) {
        _ if form.below == 0 && form.total(5, V) < 24 => with_nodes::<24, 5, V>(source, form, c, feet),
        ..24 => with_nodes::<24, 4, V>(source, form, c, feet),
        _ if form.total(5, V) < 40 => with_nodes::<40, 5, V>(source, form, c, feet),
        _ => Ok(f64::INFINITY),
    }
}

/// A bound as by [`bound`] for any cubic over the stretch `t` of the source; the ends need not coincide.
pub(in crate::refit) fn stretch(
    source: &SourceCurve<'_>,
    form: &RationalForm,
    t: [f64; 2],
    cubic: &CubicBez,
    tolerance: f64,
) -> Result<f64, Point> {
    let unit = |v: Vec2| if v == Vec2::ZERO { (v, 0.0) } else { (v / v.hypot(), v.hypot()) };
    let q = cubic.p3 - cubic.p0;
    let ((t0, a), (t1, b)) = (unit(cubic.p1 - cubic.p0), unit(cubic.p3 - cubic.p2));
    let frame = ChordFrame { q, t0, t1, floor: [0.0; 2], size: q.hypot() + a + b, home: [a, b], pull: 0.0 };
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
    let first = quick(source, form, &c, &feet)?;
    if first <= tolerance { Ok(first) } else { bound(source, form, &c, &feet) }
}

/// The bound with N nodes, P coefficients in p, V in V.
#[inline(never)]
fn with_nodes<const N: usize, const P: usize, const V: usize>(
    source: &SourceCurve<'_>,
    form: &RationalForm,
    c: &Candidate,
    feet: &[f64; FEET],
) -> Result<f64, Point>
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
        let mut g = source.points(&t);
        source.map.lanes(&mut g.x, &mut g.y);
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
        return k.map_or(Ok(f64::INFINITY), |k| Err(source.at(t[k])));
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
pub(super) fn rounding(c: &Candidate) -> f64 {
    PROOF_ROUNDING * (c.p0.x.abs() + c.p0.y.abs() + c.frame.size)
}

/// Replaces W by V·W and returns a bound for |VW − 1|, a polynomial of degree `degree`. `None` if W is not positive or
/// varies too much.
pub(super) fn cleared<const N: usize, const P: usize, const V: usize>(
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
