//! Directly manipulated free-form deformation: points of the artwork are moved, and the lattice follows.
//!
//! The image of a point is Σ Rₖ Pₖ with influences Rₖ that do not depend on the control points' positions. Pins p → q ask for
//! Σₖ Rₖ(p) dₖ = q − F(p), one row of a linear system R·D = Δ per pin; the answer is the one of least squares and smallest
//! norm, D = Rᵀ(R·Rᵀ)⁺Δ (W. M. Hsu, J. F. Hughes, H. Kaufman, *Direct manipulation of free-form deformations*, SIGGRAPH 1992;
//! J. Gain, N. Dodgson, *Preserving topology under free-form deformation*, 2001). The pseudo-inverse comes from the
//! eigenvectors of the small symmetric matrix R·Rᵀ (C. G. J. Jacobi's rotations).

use crate::map::Lattice;
use kurbo::{Point, Vec2};

/// Limit on pins: the work grows with the cube of their number.
pub(crate) const MAX_PINS: usize = 256;

/// Eigenvalues below this share of the largest count as zero: two pins almost at one point.
const RANK: f64 = 1e-12;

/// Moves the control points that are `free` so that the lattice takes the first point of each pin to the second. Returns the
/// distance by which each pin is missed: rounding, unless the pins ask for more than the lattice can do.
pub(crate) fn pull(lattice: &mut Lattice, free: impl Fn(usize, usize) -> bool, pins: &[(Point, Point)]) -> Vec<f64> {
    let n = pins.len();
    let columns = lattice.columns();
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(n);
    let mut want: Vec<Vec2> = Vec::with_capacity(n);
    for (from, to) in pins {
        let mut row = vec![0.0; columns * lattice.rows()];
        let mut image = Vec2::ZERO;
        for ((i, j), r) in lattice.influence(*from) {
            image += lattice.point(i, j).to_vec2() * r;
            if free(i, j) {
                row[j * columns + i] = r;
            }
        }
        rows.push(row);
        want.push(to.to_vec2() - image);
    }
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let gram: Vec<Vec<f64>> = rows.iter().map(|a| rows.iter().map(|b| dot(a, b)).collect()).collect();
    let (values, vectors) = eigen(gram);
    let least = RANK * values.iter().fold(0.0, |a: f64, b| a.max(*b));
    // (R·Rᵀ)⁺·Δ, then back through Rᵀ.
    let mut y = vec![Vec2::ZERO; n];
    for (k, value) in values.iter().enumerate().filter(|(_, v)| **v > least) {
        let part: Vec2 = (0..n).fold(Vec2::ZERO, |sum, i| sum + want[i] * vectors[i][k]) / *value;
        for (y, v) in y.iter_mut().zip(&vectors) {
            *y += part * v[k];
        }
    }
    let mut moved = vec![Vec2::ZERO; columns * lattice.rows()];
    for (row, y) in rows.iter().zip(&y) {
        for (d, r) in moved.iter_mut().zip(row) {
            *d += *y * *r;
        }
    }
    for (k, d) in moved.iter().enumerate().filter(|(_, d)| **d != Vec2::ZERO) {
        lattice.shift(k % columns, k / columns, *d);
    }
    let reached = |row: &[f64]| row.iter().zip(&moved).fold(Vec2::ZERO, |sum, (r, d)| sum + *d * *r);
    rows.iter().zip(&want).map(|(row, want)| (reached(row) - *want).hypot()).collect()
}

/// Eigenvalues and eigenvectors (in columns) of a symmetric matrix, by Jacobi's rotations.
fn eigen(mut a: Vec<Vec<f64>>) -> (Vec<f64>, Vec<Vec<f64>>) {
    /// Convergence is quadratic, so ten sweeps suffice.
    const SWEEPS: usize = 30;
    let n = a.len();
    let mut v: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for _ in 0..SWEEPS {
        let mut done = true;
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q].abs() <= f64::EPSILON * (a[p][p] * a[q][q]).abs().sqrt() {
                    continue;
                }
                done = false;
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for row in &mut a {
                    let (x, y) = (row[p], row[q]);
                    (row[p], row[q]) = (c * x - s * y, s * x + c * y);
                }
                let (above, below) = a.split_at_mut(q);
                for (x, y) in above[p].iter_mut().zip(&mut below[0]) {
                    (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
                }
                for row in &mut v {
                    let (x, y) = (row[p], row[q]);
                    (row[p], row[q]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
        if done {
            break;
        }
    }
    ((0..n).map(|i| a[i][i]).collect(), v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{LatticeMap, Map};
    use kurbo::Rect;

    fn lattice() -> Lattice {
        Lattice::regular(Rect::new(10.0, 20.0, 110.0, 80.0), [3, 2], [1, 1])
    }

    #[test]
    fn pins_are_met_with_the_smallest_change() {
        let mut l = lattice();
        l.set_weight(1, 1, 2.0);
        let pins = [
            (Point::new(30.0, 40.0), Point::new(35.0, 38.0)),
            (Point::new(80.0, 60.0), Point::new(80.0, 66.0)),
            (Point::new(90.0, 30.0), Point::new(90.0, 30.0)),
        ];
        let off = pull(&mut l, |_, _| true, &pins);
        let map = LatticeMap::new(&l, false);
        for ((from, to), off) in pins.iter().zip(off) {
            assert!(map.point(*from).distance(*to) < 1e-12 && off < 1e-12);
        }
        // Smallest: the change is a combination of the pins' rows, so it is orthogonal to any change that keeps the pins.
        let norm = |l: &Lattice| -> f64 {
            (0..3)
                .flat_map(|j| (0..4).map(move |i| (i, j)))
                .map(|(i, j)| (l.point(i, j) - l.regular_point(i, j)).hypot2())
                .sum()
        };
        let mut other = l.clone();
        other.shift(0, 0, Vec2::new(3.0, -2.0));
        pull(&mut other, |i, j| (i, j) != (0, 0), &pins);
        let map = LatticeMap::new(&other, false);
        assert!(pins.iter().all(|(from, to)| map.point(*from).distance(*to) < 1e-12));
        assert!(norm(&other) > norm(&l));
    }

    #[test]
    fn frozen_points_stay_and_contradictions_are_reported() {
        let mut l = lattice();
        let at = Point::new(60.0, 50.0);
        let off = pull(&mut l, |i, _| i > 1, &[(at, Point::new(65.0, 50.0))]);
        assert!(off[0] < 1e-12 && (0..3).all(|j| !l.is_changed(0, j) && !l.is_changed(1, j)));
        let mut l = lattice();
        let off = pull(&mut l, |_, _| true, &[(at, Point::new(66.0, 50.0)), (at, Point::new(60.0, 50.0))]);
        assert!((off[0] - 3.0).abs() < 1e-12 && (off[1] - 3.0).abs() < 1e-12, "halfway: {off:?}");
    }
}
