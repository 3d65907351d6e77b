//! The topology of a mesh: whether its surface is closed and consistently oriented, its Euler number and volume.

use super::model::Mesh;
use glam::DVec3;
use std::collections::HashMap;

/// The topology and the measures of a mesh's faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Topology {
    /// Vertices that belong to a face. Vertices at the same place count as one.
    pub vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Faces.
    pub faces: usize,
    /// Edges of a single face.
    pub open_edges: usize,
    /// Edges of more than two faces, or of two that run along it in the same direction.
    pub bad_edges: usize,
    /// Volume inside a closed, consistently oriented surface, positive if faces are counter-clockwise seen from outside.
    pub volume: f64,
    /// Area of the surface.
    pub area: f64,
}

impl Topology {
    /// Returns `true` if the surface has no boundary and every edge joins two faces of one orientation.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.faces > 0 && self.open_edges == 0 && self.bad_edges == 0
    }

    /// V − E + F: 2 for every ball, 0 for every ring.
    #[must_use]
    pub fn euler(&self) -> i64 {
        let signed = |n: usize| i64::try_from(n).unwrap_or(i64::MAX);
        signed(self.vertices) - signed(self.edges) + signed(self.faces)
    }
}

/// Examines a mesh. Vertices at the same place are taken for one: many files repeat them along seams.
#[must_use]
pub fn topology(mesh: &Mesh) -> Topology {
    // Adding 0 makes −0 and 0 the same place.
    let key = |p: &DVec3| (*p + 0.0).to_array().map(f64::to_bits);
    let mut places: HashMap<[u64; 3], u32> = HashMap::with_capacity(mesh.positions.len());
    let place: Vec<u32> = mesh
        .positions
        .iter()
        .map(|p| {
            let next = u32::try_from(places.len()).unwrap_or(u32::MAX);
            *places.entry(key(p)).or_insert(next)
        })
        .collect();
    let mut used = vec![false; places.len()];
    // How often each edge is run along forwards and backwards.
    let mut edges: HashMap<(u32, u32), [u32; 2]> = HashMap::new();
    let (mut faces, mut volume, mut area) = (0, 0.0, 0.0);
    let origin = mesh.bounds().map_or(DVec3::ZERO, |b| b.center());
    for face in mesh.faces() {
        faces += 1;
        for (i, c) in face.iter().enumerate() {
            let next = face[(i + 1) % face.len()];
            let (a, b) = (place[c.vertex as usize], place[next.vertex as usize]);
            used[a as usize] = true;
            if a != b {
                edges.entry((a.min(b), a.max(b))).or_default()[usize::from(a > b)] += 1;
            }
        }
    }
    for t in mesh.triangles() {
        let [a, b, c] = t.map(|c| mesh.positions[c.vertex as usize] - origin);
        volume += a.dot(b.cross(c)) / 6.0;
        area += 0.5 * (b - a).cross(c - a).length();
    }
    Topology {
        vertices: used.iter().filter(|u| **u).count(),
        edges: edges.len(),
        faces,
        open_edges: edges.values().filter(|n| n[0] + n[1] == 1).count(),
        bad_edges: edges.values().filter(|n| n[0] + n[1] > 1 && **n != [1, 1]).count(),
        volume,
        area,
    }
}
