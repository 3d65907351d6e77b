//! Curved surfaces: Bézier patches and NURBS, rational or not, with trimming curves; their files, their exact images, and approximate
//! images where the degree of an exact one would be too high.

pub mod bpt;
mod crossing;
mod cut;
pub mod json;
mod part;
mod refit;
mod surface;
mod tessellate;
mod trims;

use crate::map::{Chain3, Creases3, Map3};
use crossing::Searched;
use cut::Cutter;
use glam::DVec3;
use part::LocalMap;
use pathwarp::budget::{Budget, Exceeded};
use refit::{INSET, MAX_CELLS};
use thiserror::Error;

pub use surface::{BezierPatch, MAX_DEGREE, Surface, TrimCurve};
pub use tessellate::{tessellate, tessellate_image};

/// The outcome of [`deform_patches`], with the largest error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DeformedPatches {
    /// Surfaces whose image is exact.
    pub exact: usize,
    /// Surfaces that were refitted with bicubic patches.
    pub refitted: usize,
    /// Number of the refitted surfaces that were cut into parts because a crease crosses them; some of the parts may be exact.
    pub cut: usize,
    /// The largest distance measured between refitted surfaces and their exact images.
    pub distance: f64,
    /// Number of points of a grid on the surfaces at which the map turns space inside out.
    pub folded: usize,
    /// The first of those points, in the source.
    pub folded_at: Option<DVec3>,
    /// A point of a surface at which the map jumps, in the source.
    pub torn_at: Option<DVec3>,
}

/// The reason why surfaces have no image.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PatchError {
    /// The map is not defined at a point of a surface.
    #[error("surface {} at {at} has no image", .surface + 1)]
    Undefined {
        /// The surface's index.
        surface: usize,
        /// The point, in the source.
        at: DVec3,
    },
    /// The surfaces take more work than a limit allows.
    #[error("the surfaces take {0}")]
    Limit(#[from] Exceeded),
}

/// Replaces surfaces by their images. An image that is not exact is within `tolerance` of the exact one at equal parameters, unless
/// that takes more than 64 cells along a patch: see [`DeformedPatches::distance`]. A surface that a crease crosses is cut along it and
/// replaced by its parts.
///
/// # Errors
/// [`PatchError::Undefined`] when one of 8 × 8 points of a patch has no image, [`PatchError::Limit`] when the budget does not suffice.
pub fn deform_patches(
    surfaces: &mut Vec<Surface>,
    map: &Chain3,
    tolerance: f64,
    budget: &Budget,
) -> Result<DeformedPatches, PatchError> {
    let mut out = DeformedPatches::default();
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    let levels = crossing::levels(&creases);
    let cutter = Cutter { map, levels: &levels, tolerance, budget };
    let mut images: Vec<Vec<Surface>> = Vec::with_capacity(surfaces.len());
    let mut to_refit = Vec::new();
    for (n, surface) in surfaces.iter().enumerate() {
        let (pieces, breaks) = surface.pieces();
        examine(n, &pieces, map, &creases, &mut out, budget)?;
        if out.torn_at.is_none() {
            for piece in &pieces {
                let searched = Searched::new(piece);
                out.torn_at = out.torn_at.or_else(|| crossing::tear(&searched, map, &levels));
                searched.spend(budget)?;
            }
        }
        if let Some(image) = refit::exact_image(surface, map, budget)? {
            out.exact += 1;
            images.push(vec![image]);
        } else if !surface.is_curve()
            && let Some(parts) = cutter.image(surface, &pieces, &breaks)?
        {
            out.cut += 1;
            out.distance = out.distance.max(parts.distance);
            images.push(parts.surfaces);
        } else {
            images.push(Vec::new());
            let pieces = pieces.into_iter().map(|p| (LocalMap::new(&p, map), p)).collect();
            to_refit.push((n, pieces, breaks));
        }
    }
    out.refitted = to_refit.len() + out.cut;
    let distance = refit_together(surfaces, &to_refit, tolerance, &mut images, budget)?;
    out.distance = out.distance.max(distance);
    *surfaces = images.into_iter().flatten().collect();
    Ok(out)
}

/// A surface to refit: its index, its pieces with the map on each, and the parameters between them.
type ToRefit = (usize, Vec<(LocalMap, BezierPatch)>, [Vec<f64>; 2]);

/// Fits all surfaces with one number of cells, as many as the worst of them needs to get within the tolerance. Returns the largest
/// distance.
fn refit_together(
    surfaces: &[Surface],
    to_refit: &[ToRefit],
    tolerance: f64,
    images: &mut [Vec<Surface>],
    budget: &Budget,
) -> Result<f64, Exceeded> {
    // A crease may lie along sides. All surfaces take derivatives equally far inside, so that neighbours take them at the same points.
    let is_smooth = to_refit.iter().flat_map(|(_, pieces, _)| pieces).all(|(local, _)| local.is_smooth);
    let inset = if is_smooth { 0.0 } else { INSET };
    let mut n = 1;
    loop {
        let mut fitted = Vec::with_capacity(to_refit.len());
        let mut distance = 0.0_f64;
        for (_, pieces, _) in to_refit {
            let mut cells = Vec::with_capacity(pieces.len());
            for (local, piece) in pieces {
                budget.spend(refit::work(piece, n))?;
                let fit = refit::fit(piece, &local.map, n, inset);
                distance = distance.max(fit.distance);
                cells.push(fit);
            }
            fitted.push(cells);
        }
        if distance <= tolerance || n >= MAX_CELLS {
            for ((i, _, breaks), cells) in to_refit.iter().zip(&fitted) {
                images[*i] = vec![refit::join_cells(&surfaces[*i], breaks, cells)];
            }
            return Ok(distance);
        }
        n *= 2;
    }
}

/// Looks for points of a grid without an image, and for folds.
fn examine(
    surface: usize,
    pieces: &[BezierPatch],
    map: &Chain3,
    creases: &Creases3,
    out: &mut DeformedPatches,
    budget: &Budget,
) -> Result<(), PatchError> {
    const GRID: usize = 8;
    for piece in pieces {
        budget.spend((GRID * GRID) as f64)?;
        for k in 0..GRID * GRID {
            let [u, v] = [k % GRID, k / GRID].map(|i| i as f64 / (GRID - 1) as f64);
            let p = piece.point(u, v);
            let jet = map.jet(p);
            if !jet.p.is_finite() || !creases.defined_at(p) {
                return Err(PatchError::Undefined { surface, at: p });
            }
            if jet.det() < 0.0 {
                out.folded += 1;
                out.folded_at = out.folded_at.or(Some(p));
            }
        }
    }
    Ok(())
}
