//! A mesh under a map: vertices by value, normals by the cofactors of the Jacobian.

use super::model::{Corner, Mesh, NONE};
use crate::box3::Box3;
use crate::map::{Creases3, Jet3, Map3};
use glam::DVec3;
use pathwarp::map::CreaseKind;
use rayon::prelude::*;
use std::collections::HashMap;

/// Vertices that one thread takes at a time.
const CHUNK: usize = 1 << 14;

/// What happened to a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deformed {
    /// Vertices that moved.
    pub moved: usize,
    /// Vertices at which the map turns space inside out.
    pub folded: usize,
    /// The first of them, before the map.
    pub folded_at: Option<DVec3>,
    /// Edges across which the map jumps: their faces are stretched over a gap.
    pub torn: usize,
    /// A place on the first of them, before the map.
    pub torn_at: Option<DVec3>,
    /// The largest distance between the middles of edges, which stay straight, and their exact images, among a few thousand edges.
    pub bulge: f64,
}

/// A vertex at which the map is not defined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Undefined3 {
    /// Its index.
    pub vertex: usize,
    /// Its place before the map.
    pub at: DVec3,
}

/// Maps a mesh in place.
///
/// A normal that several vertices share becomes one for each of them, since the map turns it differently at each.
///
/// # Errors
/// The first vertex at which the map is not defined; the mesh is then unspecified.
pub fn deform(mesh: &mut Mesh, map: &dyn Map3) -> Result<Deformed, Undefined3> {
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    let bounded = creases.items().iter().any(|c| c.kind == CreaseKind::Edge);
    let before = mesh.positions.clone();
    let undefined =
        mesh.positions.par_chunks_mut(CHUNK).zip(before.par_chunks(CHUNK)).enumerate().map(|(n, (to, from))| {
            map.points(to);
            let bad = |(p, q): (&DVec3, &DVec3)| !q.is_finite() || bounded && !creases.defined_at(*p);
            from.iter().zip(to.iter()).position(bad).map(|i| n * CHUNK + i)
        });
    if let Some(vertex) = undefined.min_by_key(|v| v.unwrap_or(usize::MAX)).flatten() {
        return Err(Undefined3 { vertex, at: before[vertex] });
    }
    if !mesh.normals.is_empty() {
        turn_normals(mesh, &before, map);
    }
    let moved = before.par_iter().zip(&mesh.positions).filter(|(p, q)| p != q).count();
    let mut out = Deformed { moved, ..Deformed::default() };
    // The determinant of a collineation's Jacobian has the sign of its matrix's.
    if map.collineation().is_none_or(|c| c.matrix().determinant() < 0.0) {
        let folded: Vec<(usize, DVec3)> = before
            .par_chunks(CHUNK)
            .filter_map(|ps| {
                let mut jets = vec![Jet3::default(); ps.len()];
                map.jets(ps, &mut jets);
                let mut all = ps.iter().zip(&jets).filter(|(_, j)| j.det() < 0.0).map(|(p, _)| *p);
                let first = all.next()?;
                Some((1 + all.count(), first))
            })
            .collect();
        out.folded = folded.iter().map(|f| f.0).sum();
        out.folded_at = folded.first().map(|f| f.1);
    }
    (out.torn, out.torn_at) = tears(mesh, &before, map, &creases);
    if map.collineation().is_none() {
        out.bulge = bulge(mesh, &before, map);
    }
    Ok(out)
}

/// The largest distance between the middle of an edge and its image, among edges all over the mesh.
fn bulge(mesh: &Mesh, before: &[DVec3], map: &dyn Map3) -> f64 {
    /// Polygons that are looked at.
    const MOST: usize = 10_000;
    let every = mesh.polygons.len().div_ceil(MOST).max(1);
    let edges = mesh.polygons().step_by(every).flat_map(|(_, corners)| {
        (0..corners.len()).map(move |i| (corners[i].vertex as usize, corners[(i + 1) % corners.len()].vertex as usize))
    });
    let off = edges
        .map(|(a, b)| map.point(before[a].midpoint(before[b])).distance(mesh.positions[a].midpoint(mesh.positions[b])));
    off.filter(|d| d.is_finite()).fold(0.0, f64::max)
}

/// Counts the edges of polygons that cross a crease at which the map jumps, and finds a place of the first.
fn tears(mesh: &Mesh, before: &[DVec3], map: &dyn Map3, creases: &Creases3) -> (usize, Option<DVec3>) {
    /// Jumps below this share of the model's size are rounding.
    const VISIBLE: f64 = 1e-6;
    /// The map is compared this far before and behind the crease, as a share of the edge.
    const BESIDE: f64 = 1e-9;
    let kinks: Vec<_> = creases.items().iter().filter(|c| c.kind == CreaseKind::Kink).take(64).collect();
    if kinks.is_empty() {
        return (0, None);
    }
    let sides = |p: &DVec3| kinks.iter().enumerate().fold(0u64, |m, (k, c)| m | u64::from((c.level)(*p) > 0.0) << k);
    let sides: Vec<u64> = before.par_iter().map(sides).collect();
    let size = Box3::around(before.iter().copied()).map_or(0.0, |b| b.diagonal());
    let jump = |a: DVec3, b: DVec3, level: &dyn Fn(DVec3) -> f64| {
        let (mut from, mut to, up) = (0.0, 1.0, level(b) > 0.0);
        for _ in 0..60 {
            let t = 0.5 * (from + to);
            if (level(a.lerp(b, t)) > 0.0) == up { to = t } else { from = t }
        }
        let (p, q) = (map.point(a.lerp(b, from - BESIDE)), map.point(a.lerp(b, to + BESIDE)));
        (p.distance(q) > VISIBLE * size).then(|| a.lerp(b, to))
    };
    let (mut count, mut first) = (0, None);
    for (_, corners) in mesh.polygons() {
        for (i, c) in corners.iter().enumerate() {
            let (a, b) = (c.vertex as usize, corners[(i + 1) % corners.len()].vertex as usize);
            let mut crossed = (0..kinks.len()).filter(|k| (sides[a] ^ sides[b]) >> k & 1 == 1);
            if let Some(at) = crossed.find_map(|k| jump(before[a], before[b], &*kinks[k].level)) {
                count += 1;
                first = first.or(Some(at));
            }
        }
    }
    (count, first)
}

/// Turns the normals with the surface.
fn turn_normals(mesh: &mut Mesh, before: &[DVec3], map: &dyn Map3) {
    // One normal for each pair of a vertex and a normal. Most files pair them one to one.
    let paired = mesh.corners.par_iter().all(|c| c.normal == NONE || c.normal == c.vertex);
    let pairs: Vec<(u32, u32)> = if paired && mesh.normals.len() <= before.len() {
        (0..u32::try_from(mesh.normals.len()).unwrap_or(NONE)).map(|n| (n, n)).collect()
    } else {
        let mut index: HashMap<(u32, u32), u32> = HashMap::new();
        let mut pairs = Vec::new();
        for Corner { vertex, normal, .. } in mesh.corners.iter_mut().filter(|c| c.normal != NONE) {
            let pair = (*vertex, *normal);
            *normal = *index.entry(pair).or_insert_with(|| {
                pairs.push(pair);
                u32::try_from(pairs.len() - 1).unwrap_or(NONE)
            });
        }
        pairs
    };
    let turn = |pairs: &[(u32, u32)]| -> Vec<DVec3> {
        let ps: Vec<DVec3> = pairs.iter().map(|(v, _)| before[*v as usize]).collect();
        let mut jets = vec![Jet3::default(); ps.len()];
        map.jets(&ps, &mut jets);
        let turned = pairs.iter().zip(&jets).map(|((_, n), j)| {
            let n = mesh.normals[*n as usize];
            // Without a tangent plane there is no better normal than the old one.
            j.normal(n).try_normalize().unwrap_or(n)
        });
        turned.collect()
    };
    mesh.normals = pairs.par_chunks(CHUNK).flat_map_iter(turn).collect();
}
