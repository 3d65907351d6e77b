//! The curves on a patch along which the derivative of a map jumps, as graphs over u where possible.

use super::surface::BezierPatch;
use crate::map::{Creases3, Jet3, Level3, Map3};
use glam::{DMat3, DVec3};
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::map::CreaseKind;
use std::cell::Cell;

/// Samples along u and along v at which the side of a crease is determined.
const SAMPLES: usize = 24;
/// Half the distance, in the parameters, between two samples on either side of a crease.
const BESIDE: f64 = 1e-6;
/// Jump of a derivative, as a fraction of its size, below which a crease is not visible.
const JUMP: f64 = 1e-4;
/// The largest slope of a curve that counts as a graph.
const MAX_SLOPE: f64 = 6.0;
/// Distance from a side of the patch, in the parameters, at which rounding no longer decides the side of a crease.
const ROUNDING: f64 = 1e-9;
/// Distance from the sides of a patch within which it is not cut.
const MARGIN: f64 = 0.02;

/// A patch that counts the points for which searches ask. Their number is known only afterwards.
pub(super) struct Searched<'a> {
    patch: &'a BezierPatch,
    points: Cell<usize>,
}

impl<'a> Searched<'a> {
    pub(super) fn new(patch: &'a BezierPatch) -> Self {
        Self { patch, points: Cell::new(0) }
    }

    fn point(&self, u: f64, v: f64) -> DVec3 {
        self.points.set(self.points.get() + 1);
        self.patch.point(u, v)
    }

    /// Charges the budget for the points since the last call.
    pub(super) fn spend(&self, budget: &Budget) -> Result<(), Exceeded> {
        budget.spend(self.points.take() as f64 * self.patch.work_of_points())
    }
}

/// Returns the parameter of the i-th sample. All are inside the patch, since curves may end on its sides without crossing it.
fn sample(i: usize) -> f64 {
    (i as f64 + 0.5) / SAMPLES as f64
}

/// Returns the level sets on which the derivative of a map jumps.
pub(super) fn levels(creases: &Creases3) -> Vec<Level3> {
    creases.items().iter().filter(|c| c.kind == CreaseKind::Kink).map(|c| c.level.clone()).collect()
}

/// Returns those level sets across which the derivative does jump somewhere on the patch.
pub(super) fn crossing(patch: &Searched<'_>, map: &dyn Map3, levels: &[Level3]) -> Vec<Level3> {
    let parameters = |k: usize| [sample(k % SAMPLES), sample(k / SAMPLES)];
    let points: Vec<_> = (0..SAMPLES * SAMPLES).map(parameters).map(|[u, v]| patch.point(u, v)).collect();
    let crosses = |level: &&Level3| {
        let side: Vec<bool> = points.iter().map(|p| level(*p) > 0.0).collect();
        let mut pairs = grid_edges(SAMPLES).filter(|(a, b)| side[*a] != side[*b]);
        pairs.any(|(a, b)| jumps(patch, map, level, parameters(a), parameters(b)))
    };
    levels.iter().filter(crosses).cloned().collect()
}

/// Iterates over the edges of a square grid with `n` points along a side: those along u, then those along v.
fn grid_edges(n: usize) -> impl Iterator<Item = (usize, usize)> {
    let along_u = (0..n * n).filter(move |k| (k + 1) % n > 0).map(|k| (k, k + 1));
    along_u.chain((0..n * (n - 1)).map(move |k| (k, k + n)))
}

/// Returns a point at which the map itself jumps across a level set, found along the edges of a coarse grid.
pub(super) fn tear(patch: &Searched<'_>, map: &dyn Map3, levels: &[Level3]) -> Option<DVec3> {
    /// Lines of the grid, including the sides.
    const LINES: usize = 8;
    let parameters = |k: usize| [k % LINES, k / LINES].map(|i| i as f64 / (LINES - 1) as f64);
    let points = || (0..LINES * LINES).map(parameters).map(|[u, v]| patch.point(u, v));
    levels.iter().find_map(|level| {
        let side: Vec<bool> = points().map(|p| level(p) > 0.0).collect();
        let mut crossed = grid_edges(LINES).filter(|(a, b)| side[*a] != side[*b]);
        crossed.find_map(|(a, b)| {
            let [p, q] = beside(patch, level, parameters(a), parameters(b));
            let (from, to) = (map.jet(p), map.jet(q));
            is_torn(&from, &to, p.distance(q)).then_some(p)
        })
    })
}

/// Returns two points close to a level set, one on either side, on the line between two samples that it separates.
fn beside(patch: &Searched<'_>, level: &Level3, a: [f64; 2], b: [f64; 2]) -> [DVec3; 2] {
    let between = |t: f64| patch.point(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]));
    let t = bisect(|t| level(between(t)), 0.0, 1.0);
    let distance = BESIDE * SAMPLES as f64;
    [between(t - distance), between(t + distance)]
}

fn largest_entry(d: DMat3) -> f64 {
    d.to_cols_array().iter().fold(0.0, |m: f64, v| m.max(v.abs()))
}

/// Returns `true` if the images of two points at a distance are much farther apart than the derivatives explain.
fn is_torn(p: &Jet3, q: &Jet3, distance: f64) -> bool {
    p.p.distance(q.p) > 10.0 * largest_entry(p.d).max(largest_entry(q.d)) * distance
}

/// Returns `true` if the value or the derivative jumps at the level set between two samples.
fn jumps(patch: &Searched<'_>, map: &dyn Map3, level: &Level3, a: [f64; 2], b: [f64; 2]) -> bool {
    let [from, to] = beside(patch, level, a, b);
    let (p, q) = (map.jet(from), map.jet(to));
    let derivative_jumps = largest_entry(p.d - q.d) > JUMP * largest_entry(p.d).max(largest_entry(q.d));
    derivative_jumps || is_torn(&p, &q, from.distance(to))
}

/// Returns a zero of a function with different signs at `a` and `b`, to the last bits.
fn bisect(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let rises = f(b) > 0.0;
    for _ in 0..60 {
        let m = 0.5 * (a + b);
        if (f(m) > 0.0) == rises { b = m } else { a = m }
    }
    0.5 * (a + b)
}

/// Curves v = g(u) across a whole patch, one above the other.
pub(super) struct Graphs<'a> {
    patch: &'a Searched<'a>,
    /// Each curve's level set, and its height at every sample of u (see [`sample`]).
    curves: Vec<(Level3, Vec<f64>)>,
}

impl<'a> Graphs<'a> {
    /// Finds the curves, if every line u = const meets the same ones in the same order, and none is too steep.
    pub(super) fn new(patch: &'a Searched<'a>, levels: &[Level3]) -> Option<Self> {
        let mut curves: Vec<(usize, Vec<f64>)> = Vec::new();
        for i in 0..SAMPLES {
            let found = crossings_at(patch, levels, sample(i));
            if i == 0 {
                curves = found.iter().map(|(n, _)| (*n, Vec::new())).collect();
            }
            if found.is_empty() || !found.iter().map(|f| f.0).eq(curves.iter().map(|c| c.0)) {
                return None;
            }
            curves.iter_mut().zip(found).for_each(|(curve, (_, v))| curve.1.push(v));
        }
        let is_steep = |heights: &[f64]| heights.windows(2).any(|w| (w[1] - w[0]).abs() * SAMPLES as f64 > MAX_SLOPE);
        if curves.iter().any(|(_, heights)| is_steep(heights)) {
            return None;
        }
        Some(Self { patch, curves: curves.into_iter().map(|(n, heights)| (levels[n].clone(), heights)).collect() })
    }

    /// Makes an empty list of curves.
    pub(super) fn none(patch: &'a Searched<'a>) -> Self {
        Self { patch, curves: Vec::new() }
    }

    /// Returns the number of curves.
    pub(super) fn count(&self) -> usize {
        self.curves.len()
    }

    /// Charges the budget for the searches since the last call.
    pub(super) fn spend(&self, budget: &Budget) -> Result<(), Exceeded> {
        self.patch.spend(budget)
    }

    /// Returns height and slope of the lower and of the upper side of a layer, at `u`.
    pub(super) fn sides(&self, layer: usize, u: f64) -> [[f64; 2]; 2] {
        let low = if layer == 0 { [0.0, 0.0] } else { self.height_at(layer - 1, u) };
        if layer == self.count() {
            return [low, [1.0, 0.0]];
        }
        let high = self.height_at(layer, u);
        [low, [high[0].max(low[0]), high[1]]]
    }

    /// Returns height and slope of a curve at `u`.
    fn height_at(&self, curve: usize, u: f64) -> [f64; 2] {
        /// Step of difference quotients, in the parameters.
        const H: f64 = 1e-6;
        let Some((level, heights)) = self.curves.get(curve) else { return [f64::from(curve > 0), 0.0] };
        let f = |u: f64, v: f64| level(self.patch.point(u, v));
        let by_v = |v: f64| (f(u, v + H) - f(u, v - H)) / (2.0 * H);
        // Newton's method, starting on the line through the neighbouring samples. No curve is steep, so the derivative is not small.
        let x = u * SAMPLES as f64 - 0.5;
        let i = (x.floor().max(0.0) as usize).min(SAMPLES - 2);
        let mut v = heights[i] + (x - i as f64) * (heights[i + 1] - heights[i]);
        for _ in 0..12 {
            let step = f(u, v) / by_v(v);
            if step.is_finite() {
                v -= step.clamp(-0.1, 0.1);
            }
        }
        let slope = -(f(u + H, v) - f(u - H, v)) / (2.0 * H) / by_v(v);
        [v.clamp(0.0, 1.0), if slope.is_finite() { slope } else { 0.0 }]
    }
}

/// Returns the indices of the level sets that the line u = const meets, with the values of v there, in order.
fn crossings_at(patch: &Searched<'_>, levels: &[Level3], u: f64) -> Vec<(usize, f64)> {
    // A level set along a side itself is not met.
    let inner = (0..SAMPLES).map(sample);
    let samples: Vec<f64> = std::iter::once(ROUNDING).chain(inner).chain([1.0 - ROUNDING]).collect();
    let mut out = Vec::new();
    for (n, level) in levels.iter().enumerate() {
        let f = |v: f64| level(patch.point(u, v));
        let side: Vec<bool> = samples.iter().map(|v| f(*v) > 0.0).collect();
        let crossed = (1..samples.len()).filter(|j| side[*j] != side[j - 1]);
        out.extend(crossed.map(|j| (n, bisect(f, samples[j - 1], samples[j]))));
    }
    out.sort_by(|a, b| a.1.total_cmp(&b.1));
    out
}

/// Returns a value of u, not too close to 0 or 1, at which a level set meets the side v = 0 or v = 1. To its left and right, curves are
/// more likely to be graphs.
pub(super) fn cut(patch: &Searched<'_>, levels: &[Level3]) -> Option<f64> {
    let parameter = |i: usize| i as f64 / SAMPLES as f64;
    let mut sides = [0.0, 1.0].into_iter().flat_map(|v| levels.iter().map(move |level| (v, level)));
    sides.find_map(|(v, level)| {
        let f = |u: f64| level(patch.point(u, v));
        let crossed = (0..SAMPLES).filter(|i| (f(parameter(*i)) > 0.0) != (f(parameter(i + 1)) > 0.0));
        let mut roots = crossed.map(|i| bisect(f, parameter(i), parameter(i + 1)));
        roots.find(|u| (MARGIN..=1.0 - MARGIN).contains(u))
    })
}
