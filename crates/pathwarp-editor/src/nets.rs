//! Conversion between nets with different numbers of control points.
//!
//! A net is a sum of basis functions. If the new functions span the old ones, as after raising a degree or halving cells, the map stays the
//! same; otherwise it is approximated by least squares on a grid of samples. Rational nets are converted in homogeneous coordinates (w·x,
//! w·y, w).

use pathwarp::kurbo::{Point, Rect, Vec2};
use pathwarp::map::Lattice;

/// Number of samples per control point along each axis.
const SAMPLES: usize = 6;
/// Relative size of differences that count as rounding, of points and of weights.
const ROUNDING: f64 = 1e-9;

type Matrix = Vec<Vec<f64>>;

/// Control points with their indices as typed, and the lines that connect them.
pub(crate) struct Net {
    pub(crate) space: Space,
    pub(crate) names: Vec<String>,
    pub(crate) points: Vec<Point>,
    pub(crate) weights: Vec<f64>,
    pub(crate) lines: Vec<Vec<usize>>,
}

/// The basis functions of a net: products of clamped uniform B-splines, or Bernstein polynomials of a degree on a triangle.
pub(crate) enum Space {
    Grid { degree: [usize; 2], cells: [usize; 2] },
    Triangle(usize),
}

/// Moves the control points of `net`, which is undistorted, so that it bends like `old`.
pub(crate) fn carry_over(old: &Net, net: &mut Net) {
    let Some(matrix) = matrix(&old.space, &net.space) else { return };
    let undistorted = net.points.clone();
    let homogeneous: Vec<[f64; 3]> = old.points.iter().zip(&old.weights).map(|(p, w)| [w * p.x, w * p.y, *w]).collect();
    for (k, row) in matrix.iter().enumerate() {
        let sum = |c: usize| row.iter().zip(&homogeneous).map(|(m, v)| m * v[c]).sum::<f64>();
        let w = sum(2);
        net.weights[k] = if (w - 1.0).abs() < ROUNDING { 1.0 } else { w };
        net.points[k] = Point::new(sum(0) / w, sum(1) / w);
    }
    // The nearest net may need weights that are not positive, which would tear the artwork.
    if net.weights.iter().any(|w| *w <= ROUNDING) {
        net.weights.fill(1.0);
        for (k, row) in matrix.iter().enumerate() {
            let sum = row.iter().zip(&old.points).fold(Vec2::ZERO, |sum, (m, p)| sum + p.to_vec2() * *m);
            net.points[k] = sum.to_point();
        }
    }
    let size = undistorted.iter().map(|p| p.to_vec2().hypot()).fold(0.0, f64::max);
    for (p, rest) in net.points.iter_mut().zip(undistorted) {
        if p.distance(rest) < ROUNDING * size {
            *p = rest;
        }
    }
}

/// Returns the matrix that computes the new control points from the old ones.
fn matrix(old: &Space, new: &Space) -> Option<Matrix> {
    match (old, new) {
        (Space::Grid { degree: n, cells: c }, Space::Grid { degree: m, cells: d }) => {
            let [across, down] = [0, 1].map(|k| {
                let count = SAMPLES * (n[k] + c[k]).max(m[k] + d[k]);
                least_squares(splines(m[k], d[k], count), splines(n[k], c[k], count))
            });
            let product = |y: &[f64], x: &[f64]| y.iter().flat_map(|y| x.iter().map(move |x| y * x)).collect();
            Some(down.iter().flat_map(|y| across.iter().map(|x| product(y, x)).collect::<Matrix>()).collect())
        }
        (Space::Triangle(n), Space::Triangle(m)) => {
            let count = 2 * n.max(m);
            let rows =
                |degree| indices(count).map(|ijk| bernstein(degree, ijk.map(|i| i as f64 / count as f64))).collect();
            Some(least_squares(rows(*m), rows(*n)))
        }
        _ => None,
    }
}

/// Returns the B-splines of a uniform, clamped net along one axis, at `count` + 1 parameters from 0 to 1.
fn splines(degree: usize, cells: usize, count: usize) -> Matrix {
    let line = Lattice::regular(Rect::new(0.0, 0.0, 1.0, 1.0), [degree, 1], [cells, 1]);
    let values = |i: usize| {
        let mut out = vec![0.0; degree + cells];
        for ((k, _), value) in line.influence(Point::new(i as f64 / count as f64, 0.0)) {
            out[k] += value;
        }
        out
    };
    (0..=count).map(values).collect()
}

/// Returns the indices of a triangular net, in the order of its control points.
pub(crate) fn indices(n: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..=n).flat_map(move |i| (0..=n - i).map(move |j| [i, j, n - i - j]))
}

/// Returns the Bernstein polynomials n!/(i!j!k!)·uⁱvʲwᵏ for every i + j + k = n.
fn bernstein(n: usize, u: [f64; 3]) -> Vec<f64> {
    let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
    let term = |ijk: [usize; 3]| ijk.iter().zip(u).map(|(i, u)| u.powi(*i as i32) / factorial(*i)).product::<f64>();
    indices(n).map(|ijk| factorial(n) * term(ijk)).collect()
}

/// Returns the matrix X that minimizes the distance of A·X from B, by Householder reflections and back substitution.
fn least_squares(a: Matrix, b: Matrix) -> Matrix {
    let n = a[0].len();
    let mut rows: Matrix = a.into_iter().zip(b).map(|(a, b)| [a, b].concat()).collect();
    let width = rows[0].len();
    for k in 0..n {
        let mut v: Vec<f64> = rows[k..].iter().map(|r| r[k]).collect();
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v[0] += length.copysign(v[0]);
        let square: f64 = v.iter().map(|x| x * x).sum();
        for c in k..width {
            let dot: f64 = rows[k..].iter().zip(&v).map(|(r, v)| r[c] * v).sum();
            for (r, v) in rows[k..].iter_mut().zip(&v) {
                r[c] -= (2.0 * dot / square) * v;
            }
        }
    }
    let mut out = vec![vec![0.0; width - n]; n];
    for k in (0..n).rev() {
        for c in 0..width - n {
            let known: f64 = (k + 1..n).map(|j| rows[k][j] * out[j][c]).sum();
            out[k][c] = (rows[k][n + c] - known) / rows[k][k];
        }
    }
    out
}
