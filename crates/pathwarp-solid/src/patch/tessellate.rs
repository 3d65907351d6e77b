//! Surfaces as meshes of quads.

use super::surface::{BezierPatch, Surface};
use super::trims::Trims;
use crate::map::{Chain3, Map3};
use crate::mesh::{Corner, Mark, Mesh, NONE, PolygonKind, index32};
use crate::settings::grid;
use glam::DVec3;
use pathwarp::budget::{Budget, Exceeded, cost};
use std::collections::HashMap;

/// Quads along a side of a patch if no distance is given.
const DEFAULT_SIDE: usize = 8;
/// Quads along a side of a patch if any patch is trimmed, for few patches and for many.
const TRIMMED_SIDES: [usize; 2] = [256, 64];
/// Number of patches up to which they are few.
const FEW: usize = 8;
/// Limit on quads along a side of a patch.
const MAX_SIDE: usize = 256;

/// Turns surfaces into a mesh of quads no farther than `within` from them, as measured at the middles of edges and quads; without
/// `within`, into 8 × 8 quads per patch. Patches that share an edge share its vertices. Of a trimmed surface, the quads whose middles are
/// trimmed away are omitted, at a patch cut 64 × 64 or finer: enough for a picture. Curves become lines.
///
/// # Errors
/// [`Exceeded`] when it takes more evaluations than the budget allows.
pub fn tessellate(surfaces: &[Surface], within: Option<f64>, budget: &Budget) -> Result<Mesh, Exceeded> {
    tessellate_image(surfaces, &Chain3::default(), within, budget)
}

/// Turns the images of surfaces under a map into a mesh of quads, as [`tessellate`] does. Every vertex is an exact image, and surfaces
/// that share an edge still do; refitted surfaces share it only within the tolerance.
///
/// # Errors
/// [`Exceeded`] when it takes more evaluations than the budget allows.
pub fn tessellate_image(
    surfaces: &[Surface],
    map: &dyn Map3,
    within: Option<f64>,
    budget: &Budget,
) -> Result<Mesh, Exceeded> {
    let patches: Vec<(usize, BezierPatch)> =
        surfaces.iter().enumerate().flat_map(|(n, s)| s.pieces().0.into_iter().map(move |p| (n, p))).collect();
    let trims: Vec<Option<Polygons>> = surfaces.iter().flat_map(loops_of_patches).collect();
    let corners: usize = trims.iter().flatten().flatten().map(Vec::len).sum();
    let work: usize = patches.iter().map(|(_, p)| p.work()).sum();
    let mut side = match within {
        _ if corners > 0 => TRIMMED_SIDES[usize::from(patches.len() > FEW)],
        Some(_) => 1,
        None => DEFAULT_SIDE,
    };
    // Testing a quad against a side of a loop takes about a tenth of an evaluation.
    budget.spend((corners * side * side) as f64 * 0.1)?;
    if let Some(within) = within {
        // Powers of two, so that parameters counted from either end of an edge are equal numbers.
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
    let mut known: HashMap<[u64; 3], u32> = HashMap::new();
    let mut last = None;
    for ((n, patch), trims) in patches.iter().zip(&trims) {
        if last != Some(n) && !surfaces[*n].name.is_empty() {
            mesh.mark(Mark::Object(surfaces[*n].name.clone()));
        }
        last = Some(n);
        add_quads(&mut mesh, &mut known, (patch, trims.as_ref()), map, side);
    }
    Ok(mesh)
}

/// Polygons in a patch's parameters from 0 to 1. Points that an odd number of them surrounds belong to the surface.
type Polygons = Vec<Vec<[f64; 2]>>;

/// Returns the trimming loops of a surface's patches, u fastest; `None` for a whole patch.
fn loops_of_patches(surface: &Surface) -> Vec<Option<Polygons>> {
    let (pieces, [us, vs]) = surface.pieces();
    let Some(trims) = Trims::from_surface(surface) else { return vec![None; pieces.len()] };
    let spans = |k: &[f64]| k.windows(2).map(|w| (w[0], w[1])).collect::<Vec<_>>();
    let (us, vs) = (spans(&us), spans(&vs));
    let part = |(u, v): ((f64, f64), (f64, f64))| trims.part([u.0, v.0], [u.1, v.1]).map(|t| t.polygons());
    let parts: Vec<_> = vs.iter().flat_map(|v| us.iter().map(move |u| (*u, *v))).map(part).collect();
    // Ignore loops around nothing, which would leave nothing to see.
    if parts.iter().all(|p| p.as_ref().is_some_and(Vec::is_empty)) { vec![None; pieces.len()] } else { parts }
}

/// Returns `true` if an odd number of polygons surrounds a point.
fn is_surrounded(polygons: &Polygons, [x, y]: [f64; 2]) -> bool {
    let crosses = |(a, b): (&[f64; 2], &[f64; 2])| {
        (a[1] > y) != (b[1] > y) && x < a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1])
    };
    let crossings = |p: &Vec<[f64; 2]>| p.iter().zip(p.iter().cycle().skip(1)).filter(|s| crosses(*s)).count();
    polygons.iter().map(crossings).sum::<usize>() % 2 == 1
}

/// Adds the quads of a patch. `known` holds the vertices so far, by their coordinates.
fn add_quads(
    mesh: &mut Mesh,
    known: &mut HashMap<[u64; 3], u32>,
    (patch, trims): (&BezierPatch, Option<&Polygons>),
    map: &dyn Map3,
    side: usize,
) {
    let vertex = |[i, j, _]: [usize; 3]| {
        let p: DVec3 = map.point(patch.point(i as f64 / side as f64, j as f64 / side as f64));
        // Adding 0 turns −0 into 0.
        *known.entry((p + 0.0).to_array().map(f64::to_bits)).or_insert_with(|| {
            mesh.positions.push(p);
            index32(mesh.positions.len() - 1)
        })
    };
    let vertices: Vec<u32> = grid([side + 1, side + 1, 1]).map(vertex).collect();
    for [i, j, _] in grid([side, side, 1]) {
        let middle = [i, j].map(|k| (k as f64 + 0.5) / side as f64);
        if trims.is_some_and(|t| !is_surrounded(t, middle)) {
            continue;
        }
        let k = j * (side + 1) + i;
        let mut corners = vec![vertices[k], vertices[k + 1], vertices[k + side + 2], vertices[k + side + 1]];
        // At a pole, an edge has no length.
        corners.dedup();
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        let kind = match corners.len() {
            // Both rows of a curve are equal.
            2 if j == 0 && vertices[k] == vertices[k + (side + 1) * side] => PolygonKind::Line,
            0..=2 => continue,
            _ => PolygonKind::Face,
        };
        let corner = |vertex| Corner { vertex, uv: NONE, normal: NONE };
        mesh.push(kind, corners.into_iter().map(corner));
    }
}

/// Returns `true` if the middles of all edges and quads are close to the surface.
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
