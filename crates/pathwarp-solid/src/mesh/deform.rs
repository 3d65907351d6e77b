//! Deforms meshes: maps vertices, turns normals by the cofactors of the Jacobian, and subdivides faces that the map bends.

use super::{Corner, Mesh, MeshError, NONE, PolygonKind, fan, index32, polygon_sides};
use crate::map::{Creases3, Jet3, Map3};
use crate::settings::Box3;
use glam::DVec3;
use pathwarp::budget::{Budget, cost};
use pathwarp::map::CreaseKind;
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};

/// Number of vertices in a chunk of parallel work.
const CHUNK: usize = 1 << 14;

/// Statistics of a deformed mesh.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deformed {
    /// Number of vertices that moved.
    pub moved: usize,
    /// Number of vertices at which the map turns space inside out.
    pub folded: usize,
    /// The first such vertex, before the map.
    pub folded_at: Option<DVec3>,
    /// Number of edges across which the map jumps, so that their faces are stretched over a gap.
    pub torn: usize,
    /// A point on the first such edge, before the map.
    pub torn_at: Option<DVec3>,
    /// The largest distance between the middle of an edge, which stays straight, and its exact image, among a few thousand edges.
    pub bulge: f64,
}

/// A vertex at which the map is not defined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Undefined3 {
    /// Index of the vertex.
    pub vertex: usize,
    /// Position before the map.
    pub at: DVec3,
}

/// Maps a mesh in place.
///
/// A normal that several vertices share becomes a separate one for each, since the map turns it differently at each.
///
/// # Errors
/// [`Undefined3`] for the first vertex at which the map is not defined. The content of the mesh is then unspecified.
pub fn deform(mesh: &mut Mesh, map: &dyn Map3) -> Result<Deformed, Undefined3> {
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    let bounded = creases.items().iter().any(|c| c.kind == CreaseKind::Edge);
    let before = mesh.positions.clone();
    let undefined =
        mesh.positions.par_chunks_mut(CHUNK).zip(before.par_chunks(CHUNK)).enumerate().map(|(n, (to, from))| {
            map.points(to);
            let is_undefined = |(p, q): (&DVec3, &DVec3)| !q.is_finite() || (bounded && !creases.defined_at(*p));
            from.iter().zip(to.iter()).position(is_undefined).map(|i| n * CHUNK + i)
        });
    if let Some(vertex) = undefined.min_by_key(|v| v.unwrap_or(usize::MAX)).flatten() {
        return Err(Undefined3 { vertex, at: before[vertex] });
    }
    if !mesh.normals.is_empty() {
        turn_normals(mesh, &before, map);
    }
    let moved = before.par_iter().zip(&mesh.positions).filter(|(p, q)| p != q).count();
    let mut out = Deformed { moved, ..Deformed::default() };
    // The determinant of a collineation's Jacobian has the sign of that of its matrix.
    if map.collineation().is_none_or(|c| c.matrix().determinant() < 0.0) {
        let folded: Vec<(usize, DVec3)> = before
            .par_chunks(CHUNK)
            .filter_map(|ps| {
                let mut jets = vec![Jet3::default(); ps.len()];
                map.jets(ps, &mut jets);
                let mut inverted = ps.iter().zip(&jets).filter(|(_, j)| j.det() < 0.0).map(|(p, _)| *p);
                let first = inverted.next()?;
                Some((1 + inverted.count(), first))
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

/// Returns the largest distance between the middle of an edge and its exact image, among edges sampled from the whole mesh.
fn bulge(mesh: &Mesh, before: &[DVec3], map: &dyn Map3) -> f64 {
    /// Limit on the polygons to examine.
    const MAX_POLYGONS: usize = 10_000;
    let every = mesh.polygons.len().div_ceil(MAX_POLYGONS).max(1);
    let edges = mesh.polygons().step_by(every).flat_map(|(_, corners)| polygon_sides(corners));
    let middle = |points: &[DVec3], (a, b): (u32, u32)| points[a as usize].midpoint(points[b as usize]);
    let distances = edges.map(|e| map.point(middle(before, e)).distance(middle(&mesh.positions, e)));
    distances.filter(|d| d.is_finite()).fold(0.0, f64::max)
}

/// Counts the edges of polygons that cross a crease at which the map jumps, and returns a point of the first.
fn tears(mesh: &Mesh, before: &[DVec3], map: &dyn Map3, creases: &Creases3) -> (usize, Option<DVec3>) {
    /// Smaller jumps, as a fraction of the model's size, are rounding.
    const VISIBLE: f64 = 1e-6;
    /// Distance from the crease at which to compare the map, as a fraction of the edge.
    const BESIDE: f64 = 1e-9;
    // Bit k of a mask is set on the positive side of crease k; more than 64 creases are not examined.
    let kinks: Vec<_> = creases.items().iter().filter(|c| c.kind == CreaseKind::Kink).take(64).collect();
    if kinks.is_empty() {
        return (0, None);
    }
    let mask = |p: &DVec3| kinks.iter().enumerate().fold(0u64, |m, (k, c)| m | (u64::from((c.level)(*p) > 0.0) << k));
    let masks: Vec<u64> = before.par_iter().map(mask).collect();
    let size = Box3::around(before.iter().copied()).map_or(0.0, |b| b.diagonal());
    // Returns the point at which an edge crosses a crease, if the map jumps there.
    let jump = |a: DVec3, b: DVec3, level: &dyn Fn(DVec3) -> f64| {
        let (mut from, mut to, up) = (0.0, 1.0, level(b) > 0.0);
        // Bisection down to rounding.
        for _ in 0..60 {
            let t = 0.5 * (from + to);
            if (level(a.lerp(b, t)) > 0.0) == up { to = t } else { from = t }
        }
        let (p, q) = (map.point(a.lerp(b, from - BESIDE)), map.point(a.lerp(b, to + BESIDE)));
        (p.distance(q) > VISIBLE * size).then(|| a.lerp(b, to))
    };
    let (mut count, mut first) = (0, None);
    for (_, corners) in mesh.polygons() {
        for (a, b) in polygon_sides(corners).map(|(a, b)| (a as usize, b as usize)) {
            let mut crossed = (0..kinks.len()).filter(|k| ((masks[a] ^ masks[b]) >> k) & 1 == 1);
            if let Some(at) = crossed.find_map(|k| jump(before[a], before[b], &*kinks[k].level)) {
                count += 1;
                first = first.or(Some(at));
            }
        }
    }
    (count, first)
}

fn turn_normals(mesh: &mut Mesh, before: &[DVec3], map: &dyn Map3) {
    // Make one normal for each pair of a vertex and a normal. Most files pair them one to one.
    let are_paired = mesh.corners.par_iter().all(|c| c.normal == NONE || c.normal == c.vertex);
    let pairs: Vec<(u32, u32)> = if are_paired && mesh.normals.len() <= before.len() {
        (0..index32(mesh.normals.len())).map(|n| (n, n)).collect()
    } else {
        let mut index: HashMap<(u32, u32), u32> = HashMap::new();
        let mut pairs = Vec::new();
        for Corner { vertex, normal, .. } in mesh.corners.iter_mut().filter(|c| c.normal != NONE) {
            let pair = (*vertex, *normal);
            *normal = *index.entry(pair).or_insert_with(|| {
                pairs.push(pair);
                index32(pairs.len() - 1)
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
            // Without a tangent plane, keep the old normal.
            j.normal(n).try_normalize().unwrap_or(n)
        });
        turned.collect()
    };
    mesh.normals = pairs.par_chunks(CHUNK).flat_map_iter(turn).collect();
}

/// Limit on rounds of halving, which divide an edge into at most 2¹⁶ parts.
const MAX_ROUNDS: usize = 16;

/// Subdivides a mesh so that its image under `map` is within `tolerance` of the exact image of its surface, as measured at the quarters
/// and middles of edges and the middles of faces.
///
/// An edge is halved while the map bends it away from its chord by more than the tolerance; a face whose middle bulges gets all its
/// edges halved. Whether an edge is bent depends only on the positions of its ends, so faces that share them agree, also where a file
/// repeats vertices along a seam. Such a seam may open beside a bulging face, by about the tolerance. Faces without a split edge stay as
/// they are; others become triangles.
///
/// # Errors
/// [`MeshFault::Limit`](super::MeshFault::Limit) when the evaluations of the map or the number of edges exceed the budget.
pub fn refine(mesh: &mut Mesh, map: &dyn Map3, tolerance: f64, budget: &Budget) -> Result<(), MeshError> {
    let mut refiner = Refiner { images: mesh.positions.clone(), map, tolerance, budget, accepted: HashSet::new() };
    refiner.map.points(&mut refiner.images);
    for _ in 0..MAX_ROUNDS {
        let to_split = refiner.edges_to_split(mesh)?;
        if to_split.is_empty() {
            break;
        }
        budget.spend(cost::SEGMENT * (PER_SPLIT * sides_to_halve(mesh, &to_split)) as f64)?;
        refiner.split(mesh, &to_split);
    }
    Ok(())
}

/// Segments added when a side of a polygon is halved: one of its halves, and one across the face. The next round examines both.
const PER_SPLIT: u64 = 2;

/// Returns the number of polygon sides to halve; an edge may belong to any number of polygons. A face that is cut becomes triangles,
/// whose sides count as well.
fn sides_to_halve(mesh: &Mesh, to_split: &HashSet<Edge>) -> u64 {
    let in_polygon = |corners: &[Corner]| {
        let sides = polygon_edges(corners).filter(|e| to_split.contains(e)).count();
        if sides > 0 { sides + corners.len().saturating_sub(3) } else { 0 }
    };
    mesh.polygons().map(|(_, corners)| in_polygon(corners) as u64).sum()
}

/// An edge, whatever its direction: the smaller index first.
pub(crate) type Edge = (u32, u32);

pub(crate) fn edge(a: u32, b: u32) -> Edge {
    (a.min(b), a.max(b))
}

fn polygon_edges(corners: &[Corner]) -> impl Iterator<Item = Edge> {
    polygon_sides(corners).map(|(a, b)| edge(a, b))
}

struct Refiner<'a> {
    /// The images of the vertices.
    images: Vec<DVec3>,
    map: &'a dyn Map3,
    tolerance: f64,
    budget: &'a Budget,
    /// Edges whose images are within the tolerance.
    accepted: HashSet<Edge>,
}

impl Refiner<'_> {
    /// Returns the edges that are too far from their images.
    fn edges_to_split(&mut self, mesh: &Mesh) -> Result<HashSet<Edge>, MeshError> {
        let mut to_split = HashSet::new();
        for (kind, corners) in mesh.polygons() {
            let count = match kind {
                PolygonKind::Face => corners.len(),
                PolygonKind::Line => corners.len().saturating_sub(1),
                PolygonKind::Points => 0,
            };
            for e in polygon_edges(corners).take(count) {
                if e.0 == e.1 || to_split.contains(&e) || self.accepted.contains(&e) {
                    continue;
                }
                if self.is_bent(mesh, e)? {
                    to_split.insert(e);
                } else {
                    self.accepted.insert(e);
                }
            }
        }
        // A bulge only matters if no edge of the face is split.
        let mut bulging = Vec::new();
        for corners in mesh.faces() {
            if polygon_edges(corners).all(|e| !to_split.contains(&e)) && self.is_bulging(mesh, corners)? {
                bulging.extend(polygon_edges(corners));
            }
        }
        to_split.extend(bulging);
        Ok(to_split)
    }

    /// Returns `true` if the image of an edge is further from its chord than the tolerance.
    fn is_bent(&self, mesh: &Mesh, (i, j): Edge) -> Result<bool, MeshError> {
        let ends = [mesh.positions[i as usize], mesh.positions[j as usize]];
        // Evaluate every copy of an edge in the same order.
        let swap = ends[0].to_array().partial_cmp(&ends[1].to_array()) == Some(std::cmp::Ordering::Greater);
        let [a, b] = if swap { [ends[1], ends[0]] } else { ends };
        let [p, q] = (if swap { [j, i] } else { [i, j] }).map(|v| self.images[v as usize]);
        self.budget.spend(3.0)?;
        Ok([0.25, 0.5, 0.75].iter().any(|t| from_chord(p, q, self.map.point(a.lerp(b, *t))) > self.tolerance))
    }

    /// Returns `true` if the image of a face's middle is further than the tolerance, along the normal, from the middle of the image.
    fn is_bulging(&self, mesh: &Mesh, corners: &[Corner]) -> Result<bool, MeshError> {
        self.budget.spend(1.0)?;
        let n = corners.len() as f64;
        let mean = |points: &[DVec3]| corners.iter().map(|c| points[c.vertex as usize]).sum::<DVec3>() / n;
        let (middle, image) = (mean(&mesh.positions), mean(&self.images));
        let at = |c: &Corner| self.images[c.vertex as usize];
        let normal = corners.windows(2).map(|w| (at(&w[0]) - image).cross(at(&w[1]) - image)).sum::<DVec3>();
        Ok((self.map.point(middle) - image).dot(normal.normalize_or_zero()).abs() > self.tolerance)
    }

    fn split(&mut self, mesh: &mut Mesh, to_split: &HashSet<Edge>) {
        let mut out = Mesh {
            positions: std::mem::take(&mut mesh.positions),
            colors: std::mem::take(&mut mesh.colors),
            normals: std::mem::take(&mut mesh.normals),
            uvs: std::mem::take(&mut mesh.uvs),
            left_out: std::mem::take(&mut mesh.left_out),
            assets: mesh.assets.take(),
            ..Mesh::default()
        };
        let old = out.positions.len();
        let mut halves = Halves::default();
        let mut marks = std::mem::take(&mut mesh.marks).into_iter().peekable();
        for (n, (kind, corners)) in mesh.polygons().enumerate() {
            while let Some((_, mark)) = marks.next_if(|(first, _)| *first as usize <= n) {
                out.mark(mark);
            }
            let is_split = |a: Corner, b: Corner| to_split.contains(&edge(a.vertex, b.vertex));
            match kind {
                PolygonKind::Face if polygon_edges(corners).any(|e| to_split.contains(&e)) => {
                    for t in self.triangles(corners) {
                        let halved = std::array::from_fn(|i| is_split(t[i], t[(i + 1) % 3]));
                        add_triangle(&mut out, &mut halves, t, halved);
                    }
                }
                PolygonKind::Line => {
                    let mut line = Vec::with_capacity(2 * corners.len());
                    for (i, c) in corners.iter().enumerate() {
                        line.push(*c);
                        if let Some(next) = corners.get(i + 1).filter(|next| is_split(*c, **next)) {
                            line.push(halves.middle(&mut out, *c, *next));
                        }
                    }
                    out.push(kind, line);
                }
                _ => out.push(kind, corners.iter().copied()),
            }
        }
        marks.for_each(|(_, mark)| out.mark(mark));
        let mut images = out.positions[old..].to_vec();
        self.map.points(&mut images);
        self.images.append(&mut images);
        *mesh = out;
    }

    /// Divides a face into triangles. A quad is cut along the diagonal that is shorter in the image.
    fn triangles(&self, corners: &[Corner]) -> Vec<[Corner; 3]> {
        let at = |i: usize| self.images[corners[i].vertex as usize];
        if let [a, b, c, d] = *corners
            && at(1).distance_squared(at(3)) < at(0).distance_squared(at(2))
        {
            return vec![[b, c, d], [b, d, a]];
        }
        fan(corners).collect()
    }
}

/// Caches the middles of edges by pairs of indices.
#[derive(Default)]
struct Halves {
    vertices: HashMap<Edge, u32>,
    uvs: HashMap<Edge, u32>,
    normals: HashMap<Edge, u32>,
}

impl Halves {
    /// Returns the corner in the middle between two.
    fn middle(&mut self, mesh: &mut Mesh, a: Corner, b: Corner) -> Corner {
        let vertex = *self.vertices.entry(edge(a.vertex, b.vertex)).or_insert_with(|| {
            let (i, j) = (a.vertex as usize, b.vertex as usize);
            if mesh.is_colored() {
                let (p, q) = (mesh.colors[i], mesh.colors[j]);
                mesh.colors.push(std::array::from_fn(|k| 0.5 * (p[k] + q[k])));
            }
            let middle = 0.5 * (mesh.positions[i] + mesh.positions[j]);
            append(&mut mesh.positions, middle)
        });
        let uv = match (a.uv, b.uv) {
            (NONE, _) | (_, NONE) => NONE,
            (i, j) => *self.uvs.entry(edge(i, j)).or_insert_with(|| {
                let (p, q) = (mesh.uvs[i as usize], mesh.uvs[j as usize]);
                append(&mut mesh.uvs, std::array::from_fn(|k| 0.5 * (p[k] + q[k])))
            }),
        };
        let normal = match (a.normal, b.normal) {
            (NONE, _) | (_, NONE) => NONE,
            (i, j) => *self.normals.entry(edge(i, j)).or_insert_with(|| {
                let (p, q) = (mesh.normals[i as usize], mesh.normals[j as usize]);
                append(&mut mesh.normals, (p + q).try_normalize().unwrap_or(p))
            }),
        };
        Corner { vertex, uv, normal }
    }
}

/// Appends a value, and returns its index.
fn append<T>(list: &mut Vec<T>, value: T) -> u32 {
    list.push(value);
    index32(list.len() - 1)
}

/// Appends a triangle, some sides of which, each from a corner to the next, are halved.
fn add_triangle(mesh: &mut Mesh, halves: &mut Halves, t: [Corner; 3], halved: [bool; 3]) {
    let mut corners = [t[0], t[1], t[2], t[0], t[1], t[2]];
    // The middles are numbered from the end of a side that stays whole on, so that the triangle's first corner does not matter.
    let start = halved.iter().position(|h| !h).map_or(0, |i| i + 1);
    for i in (start..start + 3).map(|i| i % 3).filter(|i| halved[*i]) {
        corners[3 + i] = halves.middle(mesh, t[i], t[(i + 1) % 3]);
    }
    for part in parts_of_halved(halved) {
        mesh.push(PolygonKind::Face, part.map(|k| corners[k]));
    }
}

/// Returns the parts of a triangle some sides of which are halved. Its corners are 0, 1 and 2; 3, 4 and 5 are the middles of the sides
/// from each corner to the next.
pub(crate) fn parts_of_halved(sides: [bool; 3]) -> &'static [[usize; 3]] {
    match sides {
        [false, false, false] => &[[0, 1, 2]],
        [true, false, false] => &[[0, 3, 2], [3, 1, 2]],
        [false, true, false] => &[[1, 4, 0], [4, 2, 0]],
        [false, false, true] => &[[2, 5, 1], [5, 0, 1]],
        [true, true, false] => &[[3, 1, 4], [0, 3, 4], [0, 4, 2]],
        [false, true, true] => &[[4, 2, 5], [1, 4, 5], [1, 5, 0]],
        [true, false, true] => &[[5, 0, 3], [2, 5, 3], [2, 3, 1]],
        [true, true, true] => &[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
    }
}

/// Returns the distance of `q` from the segment between two points.
pub(crate) fn from_chord(a: DVec3, b: DVec3, q: DVec3) -> f64 {
    let chord = b - a;
    let n = chord.length_squared();
    let t = if n > 0.0 { ((q - a).dot(chord) / n).clamp(0.0, 1.0) } else { 0.0 };
    (q - a - chord * t).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::{Bend3, Spine3};
    use crate::mesh::{deform, obj, topology};
    use crate::settings::Box3;
    use pathwarp::budget::{Limit, Limits};

    /// A bar of quads with texture coordinates: 100 × 10 × 10, one face on each side.
    const BAR: &str = "v 0 0 0\nv 100 0 0\nv 100 10 0\nv 0 10 0\nv 0 0 10\nv 100 0 10\nv 100 10 10\nv 0 10 10\nvt 0 0\nvt 1 0\nvt 1 1\n\
                       vt 0 1\no bar\nf 4/1 3/2 2/3 1/4\nf 5/1 6/2 7/3 8/4\nf 1/1 2/2 6/3 5/4\nf 2 3 7 6\ng top\nf 3 4 8 7\nf 4 1 5 8\n";

    #[test]
    fn a_twisted_bar_follows_the_map_and_stays_closed() {
        let frame = Box3::new(DVec3::ZERO, DVec3::new(100.0, 10.0, 10.0));
        let map = Bend3::new(frame, Spine3::Twist(2.0)).build().unwrap().map;
        let mut faces = 0;
        for tolerance in [1.0, 0.1, 0.01] {
            let mut mesh = obj::read(BAR.as_bytes()).unwrap();
            let budget = Budget::new(Limits::default());
            refine(&mut mesh, &*map, tolerance, &budget).unwrap();
            deform(&mut mesh, &*map).unwrap();
            let t = topology(&mesh);
            assert!(t.is_closed() && t.euler() == 2 && t.faces > faces, "{tolerance}: {t:?}");
            faces = t.faces;
            // A twist keeps the volume.
            assert!((t.volume / 10_000.0 - 1.0).abs() < 0.1 * tolerance.sqrt(), "{tolerance}: {}", t.volume);
            assert!(
                mesh.uvs.iter().all(|uv| (0.0..=1.0).contains(&uv[0]))
                    && mesh.name_of(mesh.polygons.len() - 1) == "top"
            );
        }
    }

    #[test]
    fn straight_faces_stay_quads_and_too_fine_a_tolerance_is_refused() {
        let frame = Box3::new(DVec3::ZERO, DVec3::new(100.0, 10.0, 10.0));
        let taper = Bend3::new(frame, Spine3::Taper(0.5)).build().unwrap().map;
        let mut mesh = obj::read(BAR.as_bytes()).unwrap();
        refine(&mut mesh, &*taper, 0.01, &Budget::new(Limits::default())).unwrap();
        assert_eq!(mesh, obj::read(BAR.as_bytes()).unwrap());
        let twist = Bend3::new(frame, Spine3::Twist(2.0)).build().unwrap().map;
        let budget = Budget::new(Limits::default().with(Limit::Work, 1e4));
        assert!(refine(&mut mesh, &*twist, 1e-6, &budget).unwrap_err().to_string().contains("`work`"));
    }
}
