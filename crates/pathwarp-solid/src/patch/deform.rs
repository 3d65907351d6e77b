//! Surfaces under a chain of maps: exactly where the degree allows it, otherwise refitted.

use super::bezier::BezierPatch;
use super::compose;
use super::refit::{self, MOST_CELLS};
use super::surface::Surface;
use crate::map::{Chain3, Creases3, Map3};
use glam::DVec3;
use pathwarp::budget::{Budget, Exceeded, Limit};
use thiserror::Error;

/// Counts of deformed surfaces, and the largest error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DeformedPatches {
    /// Surfaces whose image is exact.
    pub exact: usize,
    /// Surfaces that were refitted by bicubic patches.
    pub refitted: usize,
    /// The largest distance between those and their exact images that was measured.
    pub distance: f64,
    /// Places of a grid on the surfaces at which the map turns space inside out.
    pub folded: usize,
    /// The first of them, before the map.
    pub folded_at: Option<DVec3>,
}

/// The reason why surfaces have no image.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PatchError {
    /// The map is not defined at a point of a surface.
    #[error("surface {} at {at} has no image", .surface + 1)]
    Undefined {
        /// The surface's index.
        surface: usize,
        /// The point, before the map.
        at: DVec3,
    },
    /// More work than a limit allows.
    #[error("the surfaces take {0}")]
    Limit(#[from] Exceeded),
}

/// Replaces surfaces by their images. Those that are not exact are within `tolerance` of the image at equal parameters, if that
/// is reached with 64 cells along a patch; [`DeformedPatches::distance`] tells.
///
/// # Errors
/// A place without image on a grid of 8 × 8 points of a patch, or more evaluations than the limit allows.
pub fn deform_patches(
    surfaces: &mut [Surface],
    map: &Chain3,
    tolerance: f64,
    budget: &Budget,
) -> Result<DeformedPatches, PatchError> {
    let mut out = DeformedPatches::default();
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    let mut left = Vec::new();
    for (n, surface) in surfaces.iter_mut().enumerate() {
        let (pieces, breaks) = surface.pieces();
        examine(n, &pieces, map, &creases, &mut out, budget)?;
        let mut image = Some(surface.clone());
        for step in map.steps() {
            image = match image {
                Some(s) => compose::image(&s, step, budget)?,
                None => None,
            };
        }
        match image {
            Some(image) => {
                *surface = image;
                out.exact += 1;
            }
            None => left.push((n, pieces, breaks)),
        }
    }
    out.refitted = left.len();
    let mut n = 1;
    while !left.is_empty() {
        let mut fitted = Vec::with_capacity(left.len());
        out.distance = 0.0;
        for (_, pieces, _) in &left {
            let mut cells = Vec::with_capacity(pieces.len());
            for piece in pieces {
                let fit = refit::fit(piece, map, n, budget)?;
                out.distance = out.distance.max(fit.distance);
                cells.push(fit);
            }
            fitted.push(cells);
        }
        if out.distance <= tolerance || n >= MOST_CELLS {
            for ((i, _, breaks), cells) in left.iter().zip(&fitted) {
                surfaces[*i] = refit::joined(&surfaces[*i], breaks, cells);
            }
            break;
        }
        n *= 2;
    }
    Ok(out)
}

/// Looks for places without image and folds on a grid.
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
        budget.spend(Limit::Evaluations, (GRID * GRID) as u64)?;
        for k in 0..GRID * GRID {
            let at = |i: usize| i as f64 / (GRID - 1) as f64;
            let p = piece.point(at(k % GRID), at(k / GRID));
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
