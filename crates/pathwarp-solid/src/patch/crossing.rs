//! The curves on a patch along which the derivative of a map jumps, as graphs over u where possible.

use super::surface::BezierPatch;
use crate::map::{Creases3, Jet3, Level3, Map3};
use glam::{DMat3, DVec3};
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::map::CreaseKind;
use std::cell::Cell;

/// Samples along u and along v at which the side of a crease is determined.
const PLACES: usize = 24;
/// Half the distance, in the parameters, between two samples on either side of a crease.
const BESIDE: f64 = 1e-6;
/// Jump of a derivative, as a fraction of its size, below which a crease is not visible.
const JUMP: f64 = 1e-4;
/// The largest slope of a curve that counts as a graph.
const MAX_SLOPE: f64 = 6.0;
/// Distance from a side of the patch, in the parameters, at which rounding no longer decides the side of a crease.
const SIDE: f64 = 1e-9;
/// Distance from the sides of a patch within which it is not cut.
const RIM: f64 = 0.02;

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
fn place(i: usize) -> f64 {
    (i as f64 + 0.5) / PLACES as f64
}

/// Returns the level sets on which the derivative of a map jumps.
pub(super) fn levels(creases: &Creases3) -> Vec<Level3> {
    creases.items().iter().filter(|c| c.kind == CreaseKind::Kink).map(|c| c.level.clone()).collect()
}

/// Returns those level sets across which the derivative does jump somewhere on the patch.
pub(super) fn crossing(patch: &Searched<'_>, map: &dyn Map3, levels: &[Level3]) -> Vec<Level3> {
    let grid: Vec<_> = (0..PLACES * PLACES).map(|k| patch.point(place(k % PLACES), place(k / PLACES))).collect();
    let mut out = Vec::new();
    for level in levels {
        let side: Vec<bool> = grid.iter().map(|p| level(*p) > 0.0).collect();
        let at = |k: usize| [place(k % PLACES), place(k / PLACES)];
        let right = (0..side.len()).filter(|k| k % PLACES + 1 < PLACES && side[*k] != side[k + 1]).map(|k| (k, k + 1));
        let up = (0..side.len() - PLACES).filter(|k| side[*k] != side[k + PLACES]).map(|k| (k, k + PLACES));
        let pairs: Vec<(usize, usize)> = right.chain(up).collect();
        if pairs.iter().any(|(a, b)| jumps(patch, map, level, at(*a), at(*b))) {
            out.push(level.clone());
        }
    }
    out
}

/// Returns a point at which the map itself jumps across a level set, found along the edges of a coarse grid.
pub(super) fn tear(patch: &Searched<'_>, map: &dyn Map3, levels: &[Level3]) -> Option<DVec3> {
    /// Lines of the grid, including the sides.
    const LINES: usize = 8;
    let at = |k: usize| [k % LINES, k / LINES].map(|i| i as f64 / (LINES - 1) as f64);
    let point = |k: usize| patch.point(at(k)[0], at(k)[1]);
    levels.iter().find_map(|level| {
        let side: Vec<bool> = (0..LINES * LINES).map(|k| level(point(k)) > 0.0).collect();
        let right = (0..side.len()).filter(|k| (k + 1) % LINES > 0).map(|k| (k, k + 1));
        let up = (0..side.len() - LINES).map(|k| (k, k + LINES));
        let mut crossed = right.chain(up).filter(|(a, b)| side[*a] != side[*b]);
        crossed.find_map(|(a, b)| {
            let [p, q] = beside(patch, level, at(a), at(b));
            let (from, to) = (map.jet(p), map.jet(q));
            moved_apart(&from, &to, p.distance(q)).then_some(p)
        })
    })
}

/// Returns two points close to a level set, one on either side, on the line between two samples that it separates.
fn beside(patch: &Searched<'_>, level: &Level3, a: [f64; 2], b: [f64; 2]) -> [DVec3; 2] {
    let between = |t: f64| patch.point(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]));
    let t = bisected(|t| level(between(t)), 0.0, 1.0);
    let off = BESIDE * PLACES as f64;
    [between(t - off), between(t + off)]
}

fn size(d: DMat3) -> f64 {
    d.to_cols_array().iter().fold(0.0, |m: f64, v| m.max(v.abs()))
}

/// Returns `true` if the images of two points at distance `apart` are much farther apart than the derivatives explain.
fn moved_apart(p: &Jet3, q: &Jet3, apart: f64) -> bool {
    p.p.distance(q.p) > 10.0 * size(p.d).max(size(q.d)) * apart
}

/// Returns `true` if the value or the derivative jumps at the level set between two samples.
fn jumps(patch: &Searched<'_>, map: &dyn Map3, level: &Level3, a: [f64; 2], b: [f64; 2]) -> bool {
    let [from, to] = beside(patch, level, a, b);
    let (p, q) = (map.jet(from), map.jet(to));
    size(p.d - q.d) > JUMP * size(p.d).max(size(q.d)) || moved_apart(&p, &q, from.distance(to))
}

/// Returns a zero of a function with different signs at `a` and `b`, to the last bits.
fn bisected(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
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
    /// Each curve's level set, and its height at every sample of u (see [`place`]).
    curves: Vec<(Level3, Vec<f64>)>,
}

impl<'a> Graphs<'a> {
    /// Finds the curves, if every line u = const meets the same ones in the same order, and none is too steep.
    pub(super) fn new(patch: &'a Searched<'a>, levels: &[Level3]) -> Option<Self> {
        let mut curves: Vec<(usize, Vec<f64>)> = Vec::new();
        for i in 0..PLACES {
            let u = place(i);
            let found = met(patch, levels, u);
            if i == 0 {
                curves = found.iter().map(|(n, _)| (*n, Vec::new())).collect();
            }
            if found.is_empty() || !found.iter().map(|f| f.0).eq(curves.iter().map(|c| c.0)) {
                return None;
            }
            curves.iter_mut().zip(found).for_each(|(curve, (_, v))| curve.1.push(v));
        }
        let steep = |heights: &[f64]| heights.windows(2).any(|w| (w[1] - w[0]).abs() * PLACES as f64 > MAX_SLOPE);
        if curves.iter().any(|(_, heights)| steep(heights)) {
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
        let low = if layer == 0 { [0.0, 0.0] } else { self.at(layer - 1, u) };
        if layer == self.count() {
            return [low, [1.0, 0.0]];
        }
        let high = self.at(layer, u);
        [low, [high[0].max(low[0]), high[1]]]
    }

    /// Returns height and slope of a curve at `u`.
    fn at(&self, curve: usize, u: f64) -> [f64; 2] {
        /// Step of difference quotients, in the parameters.
        const H: f64 = 1e-6;
        let Some((level, heights)) = self.curves.get(curve) else { return [f64::from(curve > 0), 0.0] };
        let f = |u: f64, v: f64| level(self.patch.point(u, v));
        let by_v = |v: f64| (f(u, v + H) - f(u, v - H)) / (2.0 * H);
        // Newton's method, starting on the line through the neighbouring samples. No curve is steep, so the derivative is not small.
        let x = u * PLACES as f64 - 0.5;
        let i = (x.floor().max(0.0) as usize).min(PLACES - 2);
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
fn met(patch: &Searched<'_>, levels: &[Level3], u: f64) -> Vec<(usize, f64)> {
    let mut out = Vec::new();
    for (n, level) in levels.iter().enumerate() {
        let f = |v: f64| level(patch.point(u, v));
        let values: Vec<bool> = (0..PLACES).map(|j| f(place(j)) > 0.0).collect();
        // Search below the first sample and, further down, above the last one. A level set along the side itself is not met.
        if (f(SIDE) > 0.0) != values[0] {
            out.push((n, bisected(f, SIDE, place(0))));
        }
        for j in 1..PLACES {
            if values[j] != values[j - 1] {
                out.push((n, bisected(f, place(j - 1), place(j))));
            }
        }
        if (f(1.0 - SIDE) > 0.0) != values[PLACES - 1] {
            out.push((n, bisected(f, place(PLACES - 1), 1.0 - SIDE)));
        }
    }
    out.sort_by(|a, b| a.1.total_cmp(&b.1));
    out
}

/// Returns a value of u, not too close to 0 or 1, at which a level set meets the side v = 0 or v = 1. To its left and right, curves are
/// more likely to be graphs.
pub(super) fn cut(patch: &Searched<'_>, levels: &[Level3]) -> Option<f64> {
    let inside = RIM..=1.0 - RIM;
    for v in [0.0, 1.0] {
        for level in levels {
            let f = |u: f64| level(patch.point(u, v));
            let at = |i: usize| i as f64 / PLACES as f64;
            let found = (0..PLACES).filter(|i| (f(at(*i)) > 0.0) != (f(at(i + 1)) > 0.0));
            let mut roots = found.map(|i| bisected(f, at(i), at(i + 1)));
            if let Some(u) = roots.find(|u| inside.contains(u)) {
                return Some(u);
            }
        }
    }
    None
}
