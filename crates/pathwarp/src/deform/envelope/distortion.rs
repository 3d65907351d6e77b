//! Distortion of a map, measured by its stretches at points of the artwork.

use crate::map::Jet;
use kurbo::{Point, Vec2};

/// Returns `n` × `n` points of the unit square, in the middles of equal cells.
pub(super) fn grid(n: u32) -> impl Iterator<Item = Point> {
    let middle = move |i: u32| (f64::from(i) + 0.5) / f64::from(n);
    (0..n * n).map(move |k| Point::new(middle(k % n), middle(k / n)))
}

/// Returns the sum of the squared logarithms of both [`stretches`], averaged over all points.
pub(super) fn distortion(jets: &[Jet]) -> f64 {
    /// The limit at a point, reached at folds and where the artwork is squeezed to nothing.
    const MAX: f64 = 100.0;
    let at_point = |[a, b]: [f64; 2]| {
        let d = a.ln().powi(2) + b.ln().powi(2);
        if b > 0.0 && d < MAX { d } else { MAX }
    };
    stretches(jets).into_iter().map(at_point).sum::<f64>() / jets.len() as f64
}

/// Returns the cost of turning a box, from the images of its corners (bottom left, bottom right, top right, top left) with y downwards.
pub(super) fn turning_cost([a, b, c, d]: [Point; 4]) -> f64 {
    /// The cost of a radian.
    const RADIAN: f64 = 2.0;
    let (right, down) = ((b - a) + (c - d), (a - d) + (b - c));
    RADIAN * (right.y.atan2(right.x).powi(2) + down.x.atan2(down.y).powi(2))
}

/// Returns the largest and the smallest stretch at every point, relative to the mean stretches along both axes. The smallest is
/// negative where the map mirrors.
pub(super) fn stretches(jets: &[Jet]) -> Vec<[f64; 2]> {
    let mean = |v: fn(&Jet) -> Vec2| jets.iter().map(|j| v(j).hypot()).sum::<f64>() / jets.len() as f64;
    let (x, y) = (mean(|j| j.dx), mean(|j| j.dy));
    let singular_values = |j: &Jet| {
        let (dx, dy) = (j.dx / x, j.dy / y);
        // They are the sum and the difference of the conformal and the anticonformal part, halved.
        let (c, a) = ((dx.x + dy.y).hypot(dx.y - dy.x), (dx.x - dy.y).hypot(dx.y + dy.x));
        [0.5 * (c + a), 0.5 * (c - a)]
    };
    jets.iter().map(singular_values).collect()
}
