//! Free-form deformation and its derivatives in exact arithmetic, by their definition.

use dashu_ratio::RBig;
use pathwarp::kurbo::{Point, Rect, Vec2};
use pathwarp::map::{Lattice, LatticeMap, Map};

/// Sides are powers of two, so that parameters of dyadic points are exact.
const REGION: Rect = Rect::new(-8.0, 4.0, 56.0, 36.0);

/// A fraction of big integers.
type Q = RBig;

/// Returns the exact value of a floating-point number.
fn q(v: f64) -> Q {
    Q::try_from(v).unwrap()
}

/// Returns all Bernstein polynomials of a degree with their derivatives.
fn bernstein(n: usize, t: &Q) -> Vec<[Q; 2]> {
    let values = |n: usize| -> Vec<Q> {
        let power = |v: &Q, k: usize| (0..k).fold(Q::ONE, |p, _| p * v);
        let binomial = |i: usize| (0..i).fold(Q::ONE, |b, k| b * q((n - k) as f64) / q((k + 1) as f64));
        (0..=n).map(|i| binomial(i) * power(t, i) * power(&(Q::ONE - t), n - i)).collect()
    };
    let (own, lower) = (values(n), values(n - 1));
    let at = |i: Option<usize>| i.and_then(|i| lower.get(i).cloned()).unwrap_or(Q::ZERO);
    own.into_iter().enumerate().map(|(i, b)| [b, q(n as f64) * (at(i.checked_sub(1)) - at(Some(i)))]).collect()
}

/// Returns the value of Σ B·w·P / Σ B·w with its derivatives by x and y, rounded once.
fn by_definition(l: &Lattice, p: Point) -> [Vec2; 3] {
    let (width, height) = (q(REGION.width()), q(REGION.height()));
    let across = bernstein(l.columns() - 1, &((q(p.x) - q(REGION.x0)) / &width));
    let up = bernstein(l.rows() - 1, &((q(p.y) - q(REGION.y0)) / &height));
    // Values and derivatives of the sums of w·x, w·y and w.
    let mut sums: [[Q; 3]; 3] = Default::default();
    for (j, up) in up.iter().enumerate() {
        for (i, across) in across.iter().enumerate() {
            let influences = [&across[0] * &up[0], &across[1] * &up[0] / &width, &across[0] * &up[1] / &height];
            let (at, w) = (l.point(i, j), q(l.weight(i, j)));
            for (sums, influence) in sums.iter_mut().zip(influences) {
                for (sum, c) in sums.iter_mut().zip([q(at.x) * &w, q(at.y) * &w, w.clone()]) {
                    *sum += &influence * c;
                }
            }
        }
    }
    let float = |v: Q| v.to_f64().value();
    let [[x, y, w], by_x, by_y] = &sums;
    let quotient = |[dx, dy, dw]: &[Q; 3]| {
        let slope = |v: &Q, dv: &Q| float((dv * w - v * dw) / (w * w));
        Vec2::new(slope(x, dx), slope(y, dy))
    };
    [Vec2::new(float(x / w), float(y / w)), quotient(by_x), quotient(by_y)]
}

#[test]
fn values_and_derivatives_of_lattices_are_exact_to_rounding() {
    for (m, n) in [(1, 1), (2, 3), (3, 3), (5, 2), (8, 8)] {
        let mut lattice = Lattice::regular(REGION, [m, n], [1, 1]);
        for j in 0..=n {
            for i in 0..=m {
                let k = (5 * i + 3 * j + i * j) as f64;
                lattice.shift(i, j, Vec2::new(6.0 * (k * 0.7).sin(), 5.0 * (k * 1.3).cos()));
                lattice.set_weight(i, j, 1.0 + 0.5 * (k * 2.1).sin());
            }
        }
        let map = LatticeMap::new(&lattice, false);
        for k in 0..=16 {
            let p = Point::new(REGION.x0 + f64::from(k) * 4.0, REGION.y0 + f64::from(k * 7 % 17) * 2.0);
            let jet = map.jet(p);
            let [value, by_x, by_y] = by_definition(&lattice, p);
            assert!((jet.p.to_vec2() - value).hypot() < 1e-12, "{m}x{n} at {p}: {} {value}", jet.p);
            assert!((jet.dx - by_x).hypot() < 1e-12, "{m}x{n} at {p}: {} {by_x}", jet.dx);
            assert!((jet.dy - by_y).hypot() < 1e-12, "{m}x{n} at {p}: {} {by_y}", jet.dy);
        }
    }
}
