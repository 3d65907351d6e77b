//! Directly manipulated free-form deformation: points of the artwork are moved, and the lattice follows.
//!
//! The image of a point is Σ Rₖ Pₖ with influences Rₖ that do not depend on the control points' positions. Pins p → q ask for
//! Σₖ Rₖ(p) dₖ = q − F(p), one row of a linear system per pin, whose smallest solution is taken (W. M. Hsu, J. F. Hughes,
//! H. Kaufman, *Direct manipulation of free-form deformations*, SIGGRAPH 1992).

use crate::map::Lattice;
use crate::solve::{misses, smallest_change};
use kurbo::{Point, Vec2};

/// Limit on pins: the work grows with the cube of their number.
pub(crate) const MAX_PINS: usize = 256;

/// Moves the control points that are `free` so that the lattice takes the first point of each pin to the second. Returns the
/// distance by which each pin is missed: rounding, unless the pins ask for more than the lattice can do.
pub(crate) fn pull(lattice: &mut Lattice, free: impl Fn(usize, usize) -> bool, pins: &[(Point, Point)]) -> Vec<f64> {
    let n = pins.len();
    let columns = lattice.columns();
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(n);
    let mut want: Vec<[f64; 2]> = Vec::with_capacity(n);
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
        let off = to.to_vec2() - image;
        want.push([off.x, off.y]);
    }
    let moved = smallest_change(&rows, &want);
    for (k, [x, y]) in moved.iter().enumerate().filter(|(_, d)| **d != [0.0; 2]) {
        lattice.shift(k % columns, k / columns, Vec2::new(*x, *y));
    }
    misses(&rows, &want, &moved)
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
