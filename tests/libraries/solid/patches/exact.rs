//! Surfaces in exact arithmetic, evaluated by their definition.

use dashu_ratio::RBig;
use pathwarp_solid::patch::Surface;

/// A fraction of big integers.
pub(crate) type Q = RBig;

/// Returns the exact value of a floating-point number.
pub(crate) fn q(v: f64) -> Q {
    Q::try_from(v).unwrap()
}

pub(crate) fn float(v: &Q) -> f64 {
    v.to_f64().value()
}

/// Returns the length of a vector.
pub(crate) fn size_of(v: &[Q; 3]) -> f64 {
    float(&v.iter().fold(Q::ZERO, |sum, c| sum + c * c)).sqrt()
}

pub(crate) fn bernstein(n: usize, i: usize, t: &Q) -> Q {
    let binomial = (0..i).fold(Q::ONE, |b, k| b * q((n - k) as f64) / q((k + 1) as f64));
    let power = |v: &Q, k: usize| (0..k).fold(Q::ONE, |p, _| p * v);
    binomial * power(t, i) * power(&(Q::ONE - t), n - i)
}

/// Returns a B-spline by the recursion of Cox and de Boor; the last span includes its end.
fn b_spline(knots: &[f64], i: usize, d: usize, x: &Q) -> Q {
    if *x < q(knots[i]) || *x > q(knots[i + d + 1]) {
        return Q::ZERO;
    }
    if d == 0 {
        let last = *x == q(*knots.last().unwrap());
        let (a, b) = (q(knots[i]), q(knots[i + 1]));
        return if a < b && (a <= *x && *x < b || last && *x == b) { Q::ONE } else { Q::ZERO };
    }
    let part = |num: Q, den: f64, b: Q| if den > 0.0 { num / q(den) * b } else { Q::ZERO };
    part(x - q(knots[i]), knots[i + d] - knots[i], b_spline(knots, i, d - 1, x))
        + part(q(knots[i + d + 1]) - x, knots[i + d + 1] - knots[i + 1], b_spline(knots, i + 1, d - 1, x))
}

/// Returns a point of a surface: Σ N·w·P / Σ N·w.
pub(crate) fn rational_point(s: &Surface, u: &Q, v: &Q) -> [Q; 3] {
    let size = s.size();
    let along =
        |a: usize, t: &Q| -> Vec<Q> { (0..size[a]).map(|i| b_spline(&s.knots[a], i, s.degree[a], t)).collect() };
    let (across, up) = (along(0, u), along(1, v));
    let (mut sum, mut weights) = ([Q::ZERO, Q::ZERO, Q::ZERO], Q::ZERO);
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
