//! Images of surfaces that are crossed by creases: cut into parts with a smooth image each.
//!
//! Layers that follow the crease fit a part if the crease is a graph over u or v. Any other part is cut at a place where the crease
//! meets its sides, or else in the middle, and the parts are looked at again. A part without crease keeps its exact image if it has one.

use super::bezier::BezierPatch;
use super::compose;
use super::crossing::{self, Graphs};
use super::knots;
use super::layers::Layers;
use super::refit::{Cells, MOST_CELLS};
use super::surface::Surface;
use crate::map::{Chain3, Level3};
use glam::{DVec3, Vec4Swizzles as _};
use pathwarp::budget::{Budget, Exceeded};

/// Cuts in the middle after which a part is fitted as it is.
const DEEPEST: usize = 6;
/// Cells along a part that may be cut instead of getting more of them.
const ENOUGH: usize = 16;
/// Cuts of any kind, in a row.
const MOST_CUTS: usize = 24;

/// The parts of a surface's image.
#[derive(Default)]
pub(super) struct Parts {
    pub(super) surfaces: Vec<Surface>,
    /// The largest distance of those that are fitted.
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
    /// The image of a surface in parts, if a crease crosses it. A trimmed surface is not cut: its loops go over all parts.
    ///
    /// # Errors
    /// More evaluations than the limit allows.
    pub(super) fn image(&self, surface: &Surface, pieces: &[BezierPatch]) -> Result<Option<Parts>, Exceeded> {
        if !surface.trims.is_empty() || self.levels.is_empty() {
            return Ok(None);
        }
        let mut crossed = Vec::with_capacity(pieces.len());
        for piece in pieces {
            crossed.push(crossing::crossing(piece, self.map, self.levels, self.budget)?);
        }
        if crossed.iter().all(Vec::is_empty) {
            return Ok(None);
        }
        let mut out = Parts::default();
        for (piece, levels) in pieces.iter().zip(crossed) {
            self.part(piece, &levels, [0, 0], &mut out)?;
        }
        for part in &mut out.surfaces {
            part.name.clone_from(&surface.name);
        }
        Ok(Some(out))
    }

    /// Adds the image of a part that these creases may cross, after so many cuts in the middle and of all kinds.
    fn part(&self, patch: &BezierPatch, levels: &[Level3], cuts: [usize; 2], out: &mut Parts) -> Result<(), Exceeded> {
        let crossing = crossing::crossing(patch, self.map, levels, self.budget)?;
        let most = if cuts[0] < DEEPEST && cuts[1] < MOST_CUTS { ENOUGH } else { MOST_CELLS };
        let turned = patch.transposed();
        if let Some((surfaces, off)) = self.whole(patch, &turned, &crossing, most)?
            && (off <= self.tolerance || most == MOST_CELLS)
        {
            out.distance = out.distance.max(off);
            out.surfaces.extend(surfaces);
            return Ok(());
        }
        let (u, v) = (crossing::cut(patch, &crossing), crossing::cut(&turned, &crossing));
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
            self.part(&patch.part(from, to), levels, cuts, out)?;
        }
        Ok(())
    }

    /// The image of a part that is not cut further, with `most` cells along a layer, and its distance. `None` if a crease crosses it
    /// and is no graph, unless this is the end.
    fn whole(
        &self,
        patch: &BezierPatch,
        turned: &BezierPatch,
        crossing: &[Level3],
        most: usize,
    ) -> Result<Option<(Vec<Surface>, f64)>, Exceeded> {
        if !crossing.is_empty() {
            if let Some(graphs) = Graphs::new(patch, crossing) {
                return self.layers(patch, &graphs, most).map(Some);
            }
            if let Some(graphs) = Graphs::new(turned, crossing) {
                let (images, off) = self.layers(turned, &graphs, most)?;
                return Ok(Some((images.into_iter().map(transposed).collect(), off)));
            }
            if most < MOST_CELLS {
                return Ok(None);
            }
        }
        let mut image = Some(of_patch(patch));
        for step in self.map.steps() {
            image = match image {
                Some(s) => compose::image(&s, step, self.budget)?,
                None => None,
            };
        }
        match image {
            Some(image) => Ok(Some((vec![image], 0.0))),
            None => self.layers(patch, &Graphs::none(patch), most).map(Some),
        }
    }

    /// The images of the layers of a part, fitted within the tolerance if that is reached, and their distance.
    fn layers(&self, patch: &BezierPatch, graphs: &Graphs<'_>, most: usize) -> Result<(Vec<Surface>, f64), Exceeded> {
        let layers = Layers { patch, graphs, map: self.map };
        let mut n = 1;
        loop {
            let fits = (0..=graphs.count()).map(|k| layers.fit(k, n, self.budget)).collect::<Result<Vec<_>, _>>()?;
            let off = fits.iter().fold(0.0, |d: f64, c| d.max(c.distance));
            if off <= self.tolerance || n >= most {
                return Ok((stacked(&fits, n, self.tolerance), off));
            }
            n *= 2;
        }
    }
}

fn of_patch(patch: &BezierPatch) -> Surface {
    let mut out = Surface::bezier("", patch.degree, patch.points.iter().map(|p| p.xyz() / p.w).collect());
    out.weights = patch.points.iter().map(|p| p.w).collect();
    out
}

/// Layers one above the other as one surface, or as several if the map tears them apart.
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
        out.knots = cells.map(|c| knots::joined(3, &breaks(c)));
        out
    };
    stacks.into_iter().map(surface).collect()
}

fn transposed(surface: Surface) -> Surface {
    let [width, _] = surface.size();
    let turn = |i: usize| surface.points.iter().skip(i).step_by(width).copied();
    let points = (0..width).flat_map(turn).collect();
    let [u, v] = surface.knots;
    Surface { points, knots: [v, u], ..surface }
}
