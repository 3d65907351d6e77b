//! Triangles that follow a surface: edges are halved until their middles are close to it.

use crate::flatten::chord_distance;
use crate::tessellate::Flat;
use crate::{Error, IntoSpace, Space};
use pathwarp::kurbo::Point;
use std::collections::HashMap;

/// Triangles of one shape at most.
const MOST_TRIANGLES: usize = 2_000_000;
/// Rounds of halving at most: each edge gets at most 2^20 parts.
const MOST_ROUNDS: usize = 20;

/// Triangles in space.
pub(crate) struct Mesh {
    pub(crate) points: Vec<Space>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// An edge, whichever way round.
type Edge = (u32, u32);

fn edge(a: u32, b: u32) -> Edge {
    (a.min(b), a.max(b))
}

pub(crate) fn to_surface(name: &str, flat: Flat, space: &IntoSpace<'_>, tolerance: f64) -> Result<Mesh, Error> {
    let place = |p: Point| space(p).ok_or_else(|| Error::NoPlace { shape: name.to_owned(), at: p });
    let mut plane = flat.points;
    let placed: Result<Vec<Space>, Error> = plane.iter().map(|p| place(*p)).collect();
    let mut points = placed?;
    let mut triangles = flat.triangles;
    // Edges known to be close enough.
    let mut good: HashMap<Edge, ()> = HashMap::new();
    for _ in 0..MOST_ROUNDS {
        let mut middles: HashMap<Edge, u32> = HashMap::new();
        for t in &triangles {
            for e in [edge(t[0], t[1]), edge(t[1], t[2]), edge(t[2], t[0])] {
                if good.contains_key(&e) || middles.contains_key(&e) {
                    continue;
                }
                let (a, b) = (e.0 as usize, e.1 as usize);
                let m = plane[a].midpoint(plane[b]);
                let q = place(m)?;
                if chord_distance(points[a], points[b], q) <= tolerance {
                    good.insert(e, ());
                } else {
                    middles.insert(e, points.len() as u32);
                    plane.push(m);
                    points.push(q);
                }
            }
        }
        if middles.is_empty() {
            return Ok(Mesh { points, triangles });
        }
        let mut finer = Vec::with_capacity(triangles.len() * 2);
        for t in &triangles {
            split(*t, &middles, &mut finer);
        }
        if finer.len() > MOST_TRIANGLES {
            return Err(Error::TooMany { shape: name.to_owned(), most: MOST_TRIANGLES });
        }
        triangles = finer;
    }
    Ok(Mesh { points, triangles })
}

/// The parts of a triangle whose marked edges are halved, orientation kept.
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
