//! Images of patches that are cut by creases: bicubic cells that follow the curves instead of crossing them.
//!
//! Between two curves v = g(u) and v = h(u) the patch is P(s, g(s) + t·(h(s) − g(s))), which no crease crosses. Cells take over
//! position, tangents and twist at their corners, as in the grid of `refit`; derivatives beside a curve are those of its own side.

use super::bezier::BezierPatch;
use super::crossing::Graphs;
use super::refit::{self, Cells, Corner, INSIDE};
use crate::map::Map3;
use glam::DVec3;

/// The parts of a patch between the curves, from v = 0 upwards.
pub(super) struct Layers<'a> {
    pub(super) patch: &'a BezierPatch,
    pub(super) graphs: &'a Graphs<'a>,
    pub(super) map: &'a dyn Map3,
}

/// A line s = const of a layer: where it begins and ends, and how both change with s.
struct Rung {
    s: f64,
    low: [f64; 2],
    high: [f64; 2],
}

impl Layers<'_> {
    /// The work of fitting n × n cells to a layer.
    pub(super) fn work(&self, n: usize) -> f64 {
        refit::work(self.patch, n) + 16.0 * (n * refit::PLACES) as f64
    }

    /// Fits n × n cells to a layer and measures their distance from the image.
    pub(super) fn fit(&self, layer: usize, n: usize) -> Cells {
        let at = |i: usize| i as f64 / n as f64;
        let mut corners = Vec::with_capacity((n + 1) * (n + 1));
        let rungs: Vec<[Rung; 2]> =
            (0..=n).map(|i| [self.rung(layer, at(i)), self.rung(layer, at(i).clamp(INSIDE, 1.0 - INSIDE))]).collect();
        for j in 0..=n {
            corners.extend(rungs.iter().map(|rungs| self.corner(rungs, at(j), n)));
        }
        let mut cells = Cells::new(n, corners);
        let columns: Vec<Rung> =
            (0..n * refit::PLACES).map(|i| self.rung(layer, (i as f64 + 0.5) / (n * refit::PLACES) as f64)).collect();
        cells.measure(|i, _, t| self.map.point(self.place(&columns[i], t)));
        cells
    }

    fn rung(&self, layer: usize, s: f64) -> Rung {
        let [low, high] = self.graphs.sides(layer, s);
        Rung { s, low, high }
    }

    fn place(&self, rung: &Rung, t: f64) -> DVec3 {
        self.patch.point(rung.s, rung.low[0] + t * (rung.high[0] - rung.low[0]))
    }

    /// The image of a place and its derivatives by s and t.
    fn tangents(&self, rung: &Rung, t: f64) -> [DVec3; 3] {
        let v = rung.low[0] + t * (rung.high[0] - rung.low[0]);
        let [p, du, dv] = self.patch.jet(rung.s, v);
        let jet = self.map.jet(p);
        let slope = rung.low[1] + t * (rung.high[1] - rung.low[1]);
        [jet.p, jet.d * (du + dv * slope), jet.d * (dv * (rung.high[0] - rung.low[0]))]
    }

    fn corner(&self, [exact, inside]: &[Rung; 2], t: f64, n: usize) -> Corner {
        let h = 1e-4 / n as f64;
        let own = self.tangents(inside, t.clamp(INSIDE, 1.0 - INSIDE));
        let (before, after) = ((t - h).max(INSIDE), (t + h).min(1.0 - INSIDE));
        let twist = (self.tangents(inside, after)[1] - self.tangents(inside, before)[1]) / (after - before);
        let at = self.map.point(self.place(exact, t));
        [if refit::is_torn(at, &own, INSIDE) { own[0] } else { at }, own[1], own[2], twist]
    }
}
