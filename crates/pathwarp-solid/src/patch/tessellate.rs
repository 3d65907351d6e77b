//! Surfaces as meshes of quads.

use super::surface::{BezierPatch, Surface};
use crate::map::{Chain3, Map3};
use crate::mesh::{Corner, Mark, Mesh, NONE, PolygonKind};
use glam::DVec3;
use pathwarp::budget::{Budget, Exceeded, cost};
use std::collections::HashMap;

/// Quads along a side of a patch if no distance is given.
const DEFAULT_SIDE: usize = 8;
/// The most quads along a side of a patch.
const MAX_SIDE: usize = 256;

/// Turns surfaces into a mesh of quads no farther than `within` from them, as measured at the middles of edges and quads; without `within`,
/// into 8 × 8 quads per patch. Patches that share an edge share its vertices. Trimming curves are ignored.
///
/// # Errors
/// It would take more evaluations than the limit allows.
pub fn tessellate(surfaces: &[Surface], within: Option<f64>, budget: &Budget) -> Result<Mesh, Exceeded> {
    tessellate_image(surfaces, &Chain3::default(), within, budget)
}

/// Turns the images of surfaces under a map into a mesh of quads, as [`tessellate`] does. Every vertex is an exact image, and surfaces that
/// share an edge still do; refitted surfaces only share it within the tolerance.
///
/// # Errors
/// As for [`tessellate`].
pub fn tessellate_image(
    surfaces: &[Surface],
    map: &dyn Map3,
    within: Option<f64>,
    budget: &Budget,
) -> Result<Mesh, Exceeded> {
    let patches: Vec<(usize, BezierPatch)> =
        surfaces.iter().enumerate().flat_map(|(n, s)| s.pieces().0.into_iter().map(move |p| (n, p))).collect();
    let work: usize = patches.iter().map(|(_, p)| p.work()).sum();
    let mut side = if within.is_some() { 1 } else { DEFAULT_SIDE };
    if let Some(within) = within {
        // Powers of two, so that parameters counted from either end of an edge are the same numbers.
        while side < MAX_SIDE {
            budget.spend((work * 4 * side * side) as f64)?;
            if patches.iter().all(|(_, p)| is_close(p, map, side, within)) {
                break;
            }
            side *= 2;
        }
    }
    budget.spend((work * (side + 1) * (side + 1)) as f64 + cost::SEGMENT * (patches.len() * side * side) as f64)?;
    let mut mesh = Mesh::default();
    let mut places: HashMap<[u64; 3], u32> = HashMap::new();
    let mut last = None;
    for (n, patch) in &patches {
        if last != Some(n) && !surfaces[*n].name.is_empty() {
            let first = u32::try_from(mesh.polygons.len()).unwrap_or(NONE);
            mesh.marks.push((first, Mark::Object(surfaces[*n].name.clone())));
        }
        last = Some(n);
        quads(&mut mesh, &mut places, patch, map, side);
    }
    Ok(mesh)
}

fn quads(mesh: &mut Mesh, places: &mut HashMap<[u64; 3], u32>, patch: &BezierPatch, map: &dyn Map3, side: usize) {
    let at = |i: usize| i as f64 / side as f64;
    let mut vertex = |p: DVec3| {
        // Adding 0 turns −0 into 0.
        *places.entry((p + 0.0).to_array().map(f64::to_bits)).or_insert_with(|| {
            mesh.positions.push(p);
            u32::try_from(mesh.positions.len() - 1).unwrap_or(NONE)
        })
    };
    let grid: Vec<u32> = (0..=side)
        .flat_map(|j| (0..=side).map(move |i| (i, j)))
        .map(|(i, j)| vertex(map.point(patch.point(at(i), at(j)))))
        .collect();
    for j in 0..side {
        for i in 0..side {
            let k = j * (side + 1) + i;
            let mut corners = vec![grid[k], grid[k + 1], grid[k + side + 2], grid[k + side + 1]];
            // At a pole, an edge has no length.
            corners.dedup();
            if corners.len() > 1 && corners.first() == corners.last() {
                corners.pop();
            }
            if corners.len() > 2 {
                mesh.push(
                    PolygonKind::Face,
                    corners.into_iter().map(|vertex| Corner { vertex, uv: NONE, normal: NONE }),
                );
            }
        }
    }
}

/// Whether the middles of all edges and quads are close to the surface.
fn is_close(patch: &BezierPatch, map: &dyn Map3, side: usize, within: f64) -> bool {
    let at = |i: usize, j: usize| map.point(patch.point(i as f64 / (2 * side) as f64, j as f64 / (2 * side) as f64));
    let mean = |p: DVec3, q: DVec3| 0.5 * (p + q);
    (0..side * side).all(|k| {
        let (i, j) = (2 * (k % side), 2 * (k / side));
        let [a, b, c, d] = [at(i, j), at(i + 2, j), at(i, j + 2), at(i + 2, j + 2)];
        at(i + 1, j).distance(mean(a, b)) <= within
            && at(i + 1, j + 2).distance(mean(c, d)) <= within
            && at(i, j + 1).distance(mean(a, c)) <= within
            && at(i + 2, j + 1).distance(mean(b, d)) <= within
            && at(i + 1, j + 1).distance(mean(mean(a, b), mean(c, d))) <= within
    })
}
