//! Images of surfaces that creases cross: they are cut into parts, each with a smooth image.
//!
//! If the crease is a graph over u or v, a part is fitted by layers that follow the crease. Otherwise the part is cut at a parameter where
//! the crease meets its sides, or else in the middle, and the new parts are treated alike. A part without a crease keeps its exact image
//! if it has one. Trimming loops are cut along with the parts, and parts outside them are omitted.

use super::crossing::{Graphs, Searched};
use super::part::LocalMap;
use super::refit::{Cells, Corner, INSET, MAX_CELLS};
use super::surface::{BezierPatch, Surface};
use super::trims::Trims;
use super::{crossing, refit, surface};
use crate::map::{Chain3, Level3, Map3};
use glam::{DVec3, Vec4Swizzles as _};
use pathwarp::budget::{Budget, Exceeded};

/// Number of successive cuts in the middle after which a part is fitted as it is.
const MAX_HALVINGS: usize = 6;
/// Number of successive cuts of any kind after which a part is fitted as it is.
const MAX_CUTS: usize = 24;
/// Cells along a part that may still be cut; if it needs more, it is cut.
const ENOUGH: usize = 16;

/// The parts of a surface's image.
#[derive(Default)]
pub(super) struct Parts {
    pub(super) surfaces: Vec<Surface>,
    /// The largest distance of a fitted part from the exact image.
    pub(super) distance: f64,
}

/// Cuts surfaces for one map.
pub(super) struct Cutter<'a> {
    pub(super) map: &'a Chain3,
    pub(super) levels: &'a [Level3],
    pub(super) tolerance: f64,
    pub(super) budget: &'a Budget,
}

impl Cutter<'_> {
    /// Returns the image of a surface in parts, if a crease crosses it or the map tears it apart between two patches, else `None`. `pieces`
    /// are its patches, and `breaks` the parameters between them.
    ///
    /// # Errors
    /// [`Exceeded`] when it takes more evaluations than the budget allows.
    pub(super) fn image(
        &self,
        surface: &Surface,
        pieces: &[BezierPatch],
        breaks: &[Vec<f64>; 2],
    ) -> Result<Option<Parts>, Exceeded> {
        if self.levels.is_empty() {
            return Ok(None);
        }
        let across = breaks[0].len() - 1;
        let mut crossed = Vec::with_capacity(pieces.len());
        for piece in pieces {
            let searched = Searched::new(piece);
            crossed.push(crossing::crossing(&searched, self.map, self.levels));
            searched.spend(self.budget)?;
        }
        if crossed.iter().all(Vec::is_empty) && !self.is_torn(pieces, across)? {
            return Ok(None);
        }
        let mut out = Parts::default();
        let trims = Trims::from_surface(surface);
        for (n, (piece, levels)) in pieces.iter().zip(crossed).enumerate() {
            let corner = |k: usize| [breaks[0][(n % across) + k], breaks[1][(n / across) + k]];
            let trims = self.trims_of(trims.as_ref(), corner(0), corner(1))?;
            self.part(&Part { patch: piece.clone(), trims }, &levels, [0, 0], &mut out)?;
        }
        for part in &mut out.surfaces {
            part.name.clone_from(&surface.name);
        }
        Ok(Some(out))
    }

    /// Returns `true` if the images of any two neighbouring patches do not join.
    fn is_torn(&self, pieces: &[BezierPatch], across: usize) -> Result<bool, Exceeded> {
        /// Parameters along a shared side.
        const SAMPLES: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
        if pieces.len() == 1 {
            return Ok(false);
        }
        self.budget.spend((4 * SAMPLES.len() * pieces.len()) as f64)?;
        let local: Vec<LocalMap> = pieces.iter().map(|p| LocalMap::new(p, self.map)).collect();
        let image = |k: usize, u: f64, v: f64| local[k].map.point(pieces[k].point(u, v));
        let are_apart = |p: DVec3, q: DVec3| p.distance(q) > self.tolerance;
        Ok((0..pieces.len()).any(|k| {
            let (has_right, has_upper) = ((k + 1) % across > 0, k + across < pieces.len());
            SAMPLES.into_iter().any(|t| {
                (has_right && are_apart(image(k, 1.0, t), image(k + 1, 0.0, t)))
                    || (has_upper && are_apart(image(k, t, 1.0), image(k + across, t, 0.0)))
            })
        }))
    }

    /// Returns the trimming loops of a part.
    fn trims_of(&self, trims: Option<&Trims>, from: [f64; 2], to: [f64; 2]) -> Result<Option<Trims>, Exceeded> {
        /// Work of clipping a curve, in evaluations of a map.
        const WORK: usize = 16;
        let Some(trims) = trims else { return Ok(None) };
        self.budget.spend((WORK * trims.count()) as f64)?;
        Ok(trims.part(from, to))
    }

    /// Adds the image of a part that the creases `levels` may cross. `cuts` counts the cuts in the middle, and all cuts, that led to it.
    fn part(&self, part: &Part, levels: &[Level3], cuts: [usize; 2], out: &mut Parts) -> Result<(), Exceeded> {
        if part.trims.as_ref().is_some_and(Trims::is_empty) {
            return Ok(());
        }
        let patch = &part.patch;
        let transposed = part.transposed();
        let searched = [patch, &transposed.patch].map(Searched::new);
        let crossing = crossing::crossing(&searched[0], self.map, levels);
        searched[0].spend(self.budget)?;
        let max_cells = if cuts[0] < MAX_HALVINGS && cuts[1] < MAX_CUTS { ENOUGH } else { MAX_CELLS };
        if let Some((surfaces, distance)) = self.whole([part, &transposed], &searched, &crossing, max_cells)?
            && (distance <= self.tolerance || max_cells == MAX_CELLS)
        {
            out.distance = out.distance.max(distance);
            out.surfaces.extend(surfaces);
            return Ok(());
        }
        let [u, v] = searched.each_ref().map(|patch| crossing::cut(patch, &crossing));
        searched.iter().try_for_each(|patch| patch.spend(self.budget))?;
        let parts = match (u, v) {
            (Some(u), _) => vec![([0.0, 0.0], [u, 1.0]), ([u, 0.0], [1.0, 1.0])],
            (None, Some(v)) => vec![([0.0, 0.0], [1.0, v]), ([0.0, v], [1.0, 1.0])],
            (None, None) => (0..4)
                .map(|k| [f64::from(k % 2) / 2.0, f64::from(k / 2) / 2.0])
                .map(|from| (from, from.map(|f| f + 0.5)))
                .collect(),
        };
        let cuts = [cuts[0] + usize::from(parts.len() == 4), cuts[1] + 1];
        for (from, to) in parts {
            let trims = self.trims_of(part.trims.as_ref(), from, to)?;
            self.part(&Part { patch: patch.part(from, to), trims }, levels, cuts, out)?;
        }
        Ok(())
    }

    /// Returns the image of a part without further cuts, with up to `max_cells` cells along a layer, and its distance from the exact image.
    /// `None` if the part must be cut because a crease crosses it that is not a graph. `swapped` is the part with u and v exchanged.
    fn whole(
        &self,
        [part, swapped]: [&Part; 2],
        searched: &[Searched<'_>; 2],
        crossing: &[Level3],
        max_cells: usize,
    ) -> Result<Option<(Vec<Surface>, f64)>, Exceeded> {
        if !crossing.is_empty() {
            if let Some(graphs) = Graphs::new(&searched[0], crossing) {
                return self.layers(part, &graphs, self.map, max_cells).map(Some);
            }
            if let Some(graphs) = Graphs::new(&searched[1], crossing) {
                let (images, distance) = self.layers(swapped, &graphs, self.map, max_cells)?;
                return Ok(Some((images.into_iter().map(transposed).collect(), distance)));
            }
            if max_cells < MAX_CELLS {
                return Ok(None);
            }
        }
        if let Some(image) = refit::exact_image(&part.surface(), self.map, self.budget)? {
            return Ok(Some((vec![image], 0.0)));
        }
        let local = LocalMap::new(&part.patch, self.map);
        self.layers(part, &Graphs::none(&searched[0]), &local.map, max_cells).map(Some)
    }

    /// Returns layers as surfaces with their trimming loops. Each layer has different loops, so the layers cannot be stacked.
    fn trimmed(&self, fits: &[Cells], n: usize, trims: &Trims, graphs: &Graphs<'_>) -> Result<Vec<Surface>, Exceeded> {
        /// Fraction of the tolerance left for the loops, which are fitted too where the sides of a layer are curved.
        const FRACTION: f64 = 0.1;
        /// Work of fitting a curve, in evaluations of a map.
        const WORK: usize = 4096;
        let mut out = Vec::with_capacity(fits.len());
        for (k, cells) in fits.iter().enumerate() {
            let Some(mut surface) = stacked(std::slice::from_ref(cells), n, self.tolerance).pop() else { continue };
            let loops = if graphs.count() == 0 {
                Some(trims.clone())
            } else {
                self.budget.spend((WORK * trims.count()) as f64)?;
                let loops = trims.layer(graphs, k, FRACTION * self.tolerance / max_derivative(&surface, n));
                graphs.spend(self.budget)?;
                loops
            };
            if loops.as_ref().is_some_and(Trims::is_empty) {
                continue;
            }
            surface.trims = loops.as_ref().map(Trims::curves).unwrap_or_default();
            out.push(surface);
        }
        Ok(out)
    }

    /// Returns the images of the layers of a part, and their distance from the exact ones: within the tolerance if `max_cells` suffice.
    fn layers(
        &self,
        part: &Part,
        graphs: &Graphs<'_>,
        map: &dyn Map3,
        max_cells: usize,
    ) -> Result<(Vec<Surface>, f64), Exceeded> {
        let layers = Layers { patch: &part.patch, graphs, map };
        let mut n = 1;
        loop {
            self.budget.spend(refit::work(&part.patch, n) * (graphs.count() + 1) as f64)?;
            let fits: Vec<Cells> = (0..=graphs.count()).map(|k| layers.fit(k, n)).collect();
            graphs.spend(self.budget)?;
            let distance = fits.iter().fold(0.0, |d: f64, c| d.max(c.distance));
            if distance <= self.tolerance || n >= max_cells {
                let surfaces = match &part.trims {
                    None => stacked(&fits, n, self.tolerance),
                    Some(trims) => self.trimmed(&fits, n, trims, graphs)?,
                };
                return Ok((surfaces, distance));
            }
            n *= 2;
        }
    }
}

/// A part of a surface with parameters 0..1 × 0..1, and its loops if it is trimmed.
struct Part {
    patch: BezierPatch,
    trims: Option<Trims>,
}

impl Part {
    fn transposed(&self) -> Self {
        Self { patch: self.patch.transposed(), trims: self.trims.as_ref().map(Trims::transposed) }
    }

    fn surface(&self) -> Surface {
        let points = &self.patch.points;
        let mut out = Surface::bezier("", self.patch.degree, points.iter().map(|p| p.xyz() / p.w).collect());
        out.weights = points.iter().map(|p| p.w).collect();
        out.trims = self.trims.as_ref().map(Trims::curves).unwrap_or_default();
        out
    }
}

/// Stacks layers into one surface, or into several if the map tears them apart.
fn stacked(layers: &[Cells], n: usize, tolerance: f64) -> Vec<Surface> {
    let mut stacks: Vec<Vec<Vec<DVec3>>> = Vec::new();
    for layer in layers {
        let mut rows: Vec<Vec<DVec3>> = layer.rows().map(<[DVec3]>::to_vec).collect();
        if let (Some(stack), Some(first)) = (stacks.last_mut(), rows.first())
            && let Some(last) = stack.last_mut()
            && last.iter().zip(first).all(|(p, q)| p.distance(*q) <= tolerance)
        {
            last.iter_mut().zip(first).for_each(|(p, q)| *p = p.midpoint(*q));
            stack.extend(rows.drain(1..));
        } else {
            stacks.push(rows);
        }
    }
    let breaks = |cells: usize| -> Vec<f64> { (0..=cells).map(|i| i as f64 / n as f64).collect() };
    let surface = |rows: Vec<Vec<DVec3>>| {
        let cells = [n, rows.len() / 3];
        let mut out = Surface::bezier("", [3, 3], rows.concat());
        out.knots = cells.map(|c| surface::bezier_knots(3, &breaks(c)));
        out
    };
    stacks.into_iter().map(surface).collect()
}

/// Returns an upper bound for the derivatives of a bicubic surface of n × n cells.
fn max_derivative(surface: &Surface, n: usize) -> f64 {
    let width = 3 * n + 1;
    let across = surface.points.chunks(width).flat_map(|row| row.windows(2).map(|w| w[0].distance(w[1])));
    let up = surface.points.iter().zip(surface.points.iter().skip(width)).map(|(p, q)| p.distance(*q));
    across.chain(up).fold(0.0, f64::max) * (3 * n) as f64
}

fn transposed(mut surface: Surface) -> Surface {
    let [width, _] = surface.size();
    let turn = |i: usize| surface.points.iter().skip(i).step_by(width).copied();
    surface.points = (0..width).flat_map(turn).collect();
    surface.knots.swap(0, 1);
    surface.trims.iter_mut().flatten().flat_map(|t| &mut t.points).for_each(|p| p.swap(0, 1));
    surface
}

/// The parts of a patch between crease curves, from v = 0 upwards.
///
/// Between two curves v = g(u) and v = h(u) the patch is P(s, g(s) + t·(h(s) − g(s))), which no crease crosses. It is fitted by bicubic
/// cells, which have the position, tangents and twist of the image at their corners, as in the module `refit`. Derivatives at a curve are
/// taken on the layer's side of it.
struct Layers<'a> {
    patch: &'a BezierPatch,
    graphs: &'a Graphs<'a>,
    map: &'a dyn Map3,
}

/// A line s = const of a layer: height and slope of its lower and of its upper end.
struct Rung {
    s: f64,
    low: [f64; 2],
    high: [f64; 2],
}

impl Layers<'_> {
    /// Fits n × n cells to a layer and measures their distance from the image.
    fn fit(&self, layer: usize, n: usize) -> Cells {
        let parameter = |i: usize| i as f64 / n as f64;
        let rungs = (0..=n).map(parameter).map(|s| [s, s.clamp(INSET, 1.0 - INSET)].map(|s| self.rung(layer, s)));
        let rungs: Vec<[Rung; 2]> = rungs.collect();
        let corners = (0..=n).flat_map(|j| rungs.iter().map(move |rungs| self.corner(rungs, parameter(j), n)));
        let mut cells = Cells::new(n, corners.collect());
        let samples = n * refit::SAMPLES;
        let columns: Vec<Rung> = (0..samples).map(|i| self.rung(layer, (i as f64 + 0.5) / samples as f64)).collect();
        cells.measure(|i, _, t| self.map.point(self.point(&columns[i], t)));
        cells
    }

    fn rung(&self, layer: usize, s: f64) -> Rung {
        let [low, high] = self.graphs.sides(layer, s);
        Rung { s, low, high }
    }

    fn point(&self, rung: &Rung, t: f64) -> DVec3 {
        self.patch.point(rung.s, rung.low[0] + t * (rung.high[0] - rung.low[0]))
    }

    /// Returns the image of a point of a layer, and its derivatives by s and t.
    fn tangents(&self, rung: &Rung, t: f64) -> [DVec3; 3] {
        let v = rung.low[0] + t * (rung.high[0] - rung.low[0]);
        let [p, du, dv] = self.patch.jet(rung.s, v);
        let jet = self.map.jet(p);
        let slope = rung.low[1] + t * (rung.high[1] - rung.low[1]);
        [jet.p, jet.d * (du + dv * slope), jet.d * (dv * (rung.high[0] - rung.low[0]))]
    }

    /// Returns a corner of a cell from the line through it and a line inside the patch, at which derivatives are taken.
    fn corner(&self, [exact, inside]: &[Rung; 2], t: f64, n: usize) -> Corner {
        let h = 1e-4 / n as f64;
        let beside = self.tangents(inside, t.clamp(INSET, 1.0 - INSET));
        let (before, after) = ((t - h).max(INSET), (t + h).min(1.0 - INSET));
        let twist = (self.tangents(inside, after)[1] - self.tangents(inside, before)[1]) / (after - before);
        let p = self.map.point(self.point(exact, t));
        [if refit::is_torn(p, &beside, INSET) { beside[0] } else { p }, beside[1], beside[2], twist]
    }
}
