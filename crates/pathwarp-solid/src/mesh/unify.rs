//! One index for each corner, as PLY has it: a vertex with its texture coordinates and normal.

use super::model::{Corner, Mesh, NONE};
use std::collections::HashMap;

/// The different corners of a mesh, and the number of each corner's.
pub(super) struct Unified {
    pub(super) corners: Vec<Corner>,
    pub(super) index: Vec<u32>,
}

/// Numbers the different corners. If every vertex has one, they are numbered like the vertices, also those without a polygon.
pub(super) fn unify(mesh: &Mesh) -> Unified {
    let bare = |v: usize| Corner { vertex: u32::try_from(v).unwrap_or(NONE), uv: NONE, normal: NONE };
    let mut corners: Vec<Corner> = (0..mesh.positions.len()).map(bare).collect();
    let mut taken = vec![false; corners.len()];
    let mut others: HashMap<Corner, u32> = HashMap::new();
    let mut index = Vec::with_capacity(mesh.corners.len());
    for c in &mesh.corners {
        let v = c.vertex as usize;
        if !taken[v] && *c != bare(v) {
            (taken[v], corners[v]) = (true, *c);
        }
        // A corner of a line has neither, and takes what its vertex has.
        let is_bare = *c == bare(v);
        index.push(if is_bare || corners[v] == *c {
            c.vertex
        } else {
            *others.entry(*c).or_insert_with(|| {
                corners.push(*c);
                u32::try_from(corners.len() - 1).unwrap_or(NONE)
            })
        });
    }
    Unified { corners, index }
}
