//! Subdivides triangles until the midpoints of their edges are close to the surface.

use crate::error::Error;
use crate::flatten::{chord_distance, spend};
use crate::shape::{Point3, SurfaceFn};
use crate::tessellate::FlatMesh;
use pathwarp::budget::Budget;
use pathwarp::kurbo::Point;
use std::collections::{HashMap, HashSet};

/// Sides of a mesh for each of its triangles: two triangles share a side.
const SIDES: f64 = 1.5;
/// Maximum number of rounds of halving, which gives at most 2^20 parts per edge.
const MOST_ROUNDS: usize = 20;

/// Triangles in space.
pub(crate) struct TriangleMesh {
    pub(crate) points: Vec<Point3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// An edge in either direction: the smaller index first.
type Edge = (u32, u32);

fn edge(a: u32, b: u32) -> Edge {
    (a.min(b), a.max(b))
}

/// Maps a flat mesh to the surface and subdivides it until it follows the surface.
pub(crate) fn to_surface(
    name: &str,
    flat: FlatMesh,
    space: &SurfaceFn<'_>,
    tolerance: f64,
    budget: &Budget,
) -> Result<TriangleMesh, Error> {
    let count = |triangles: usize| spend(name, SIDES * triangles as f64, budget);
    let place = |p: Point| space(p).ok_or_else(|| Error::NoPlace { shape: name.to_owned(), at: p });
    let mut plane = flat.points;
    let placed: Result<Vec<Point3>, Error> = plane.iter().map(|p| place(*p)).collect();
    let mut points = placed?;
    let mut triangles = flat.triangles;
    count(triangles.len())?;
    // Edges that are known to be close enough.
    let mut close: HashSet<Edge> = HashSet::new();
    for _ in 0..MOST_ROUNDS {
        let mut middles: HashMap<Edge, u32> = HashMap::new();
        for t in &triangles {
            for e in [edge(t[0], t[1]), edge(t[1], t[2]), edge(t[2], t[0])] {
                if close.contains(&e) || middles.contains_key(&e) {
                    continue;
                }
                let (a, b) = (e.0 as usize, e.1 as usize);
                let m = plane[a].midpoint(plane[b]);
                let q = place(m)?;
                if chord_distance(points[a], points[b], q) <= tolerance {
                    close.insert(e);
                } else {
                    middles.insert(e, points.len() as u32);
                    plane.push(m);
                    points.push(q);
                }
            }
        }
        if middles.is_empty() {
            return Ok(TriangleMesh { points, triangles });
        }
        let mut finer = Vec::with_capacity(triangles.len() * 2);
        for t in &triangles {
            split(*t, &middles, &mut finer);
        }
        count(finer.len() - triangles.len())?;
        triangles = finer;
    }
    Ok(TriangleMesh { points, triangles })
}

/// Splits a triangle at the midpoints of its edges, keeping the orientation.
fn split(t: [u32; 3], middles: &HashMap<Edge, u32>, out: &mut Vec<[u32; 3]>) {
    let [a, b, c] = t;
    let m = |x, y| middles.get(&edge(x, y)).copied();
    match (m(a, b), m(b, c), m(c, a)) {
        (None, None, None) => out.push(t),
        (Some(ab), None, None) => out.extend([[a, ab, c], [ab, b, c]]),
        (None, Some(bc), None) => out.extend([[b, bc, a], [bc, c, a]]),
        (None, None, Some(ca)) => out.extend([[c, ca, b], [ca, a, b]]),
        (Some(ab), Some(bc), None) => out.extend([[ab, b, bc], [a, ab, bc], [a, bc, c]]),
        (None, Some(bc), Some(ca)) => out.extend([[bc, c, ca], [b, bc, ca], [b, ca, a]]),
        (Some(ab), None, Some(ca)) => out.extend([[ca, a, ab], [c, ca, ab], [c, ab, b]]),
        (Some(ab), Some(bc), Some(ca)) => out.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]),
    }
}
