//! Surfaces in exact arithmetic, by their definition.

use num_rational::BigRational;
use num_traits::{FromPrimitive, One, ToPrimitive, Zero};
use pathwarp_solid::patch::Surface;

/// A fraction of big integers.
pub(crate) type Q = BigRational;

/// A floating-point number exactly.
pub(crate) fn q(v: f64) -> Q {
    Q::from_float(v).unwrap()
}

pub(crate) fn float(v: &Q) -> f64 {
    v.to_f64().unwrap()
}

/// The length of a vector.
pub(crate) fn size_of(v: &[Q; 3]) -> f64 {
    float(&v.iter().map(|c| c * c).sum::<Q>()).sqrt()
}

pub(crate) fn bernstein(n: usize, i: usize, t: &Q) -> Q {
    let binomial = (0..i).fold(Q::one(), |b, k| b * Q::from_usize(n - k).unwrap() / Q::from_usize(k + 1).unwrap());
    let power = |v: &Q, k: usize| (0..k).fold(Q::one(), |p, _| p * v);
    binomial * power(t, i) * power(&(Q::one() - t), n - i)
}

/// The recursion of Cox and de Boor; the last span includes its end.
fn b_spline(knots: &[f64], i: usize, d: usize, x: &Q) -> Q {
    if *x < q(knots[i]) || *x > q(knots[i + d + 1]) {
        return Q::zero();
    }
    if d == 0 {
        let last = *x == q(*knots.last().unwrap());
        let (a, b) = (q(knots[i]), q(knots[i + 1]));
        return if a < b && (a <= *x && *x < b || last && *x == b) { Q::one() } else { Q::zero() };
    }
    let part = |num: Q, den: f64, b: Q| if den > 0.0 { num / q(den) * b } else { Q::zero() };
    part(x - q(knots[i]), knots[i + d] - knots[i], b_spline(knots, i, d - 1, x))
        + part(q(knots[i + d + 1]) - x, knots[i + d + 1] - knots[i + 1], b_spline(knots, i + 1, d - 1, x))
}

/// A point of a surface: Σ N·w·P / Σ N·w.
pub(crate) fn rational_point(s: &Surface, u: &Q, v: &Q) -> [Q; 3] {
    let size = s.size();
    let along = |a: usize, t: &Q| -> Vec<Q> { (0..size[a]).map(|i| b_spline(&s.knots[a], i, s.degree[a], t)).collect() };
    let (across, up) = (along(0, u), along(1, v));
    let (mut sum, mut weights) = ([Q::zero(), Q::zero(), Q::zero()], Q::zero());
    for (k, (p, w)) in s.points.iter().zip(&s.weights).enumerate() {
        let influence = &across[k % size[0]] * &up[k / size[0]] * q(*w);
        if influence.is_zero() {
            continue;
        }
        for (s, a) in sum.iter_mut().zip(p.to_array()) {
            *s += &influence * q(a);
        }
        weights += influence;
    }
    sum.map(|c| c / &weights)
}
