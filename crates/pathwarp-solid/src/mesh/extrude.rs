//! Flat shapes as solids: a front, a back, and walls along the edges between them.

use super::flat::{FlatShape, sides};
use super::model::{Corner, Mark, Mesh, NONE, PolygonKind};
use glam::DVec3;
use std::collections::HashSet;

/// Appends shapes as objects: flat at z = 0 if `depth` is 0, otherwise closed solids from there to z = `depth` above it. Solids that would
/// touch, also themselves, in an edge or at a corner are drawn apart by a hundred-thousandth of the largest coordinate.
pub fn extrude(mesh: &mut Mesh, shapes: &[FlatShape], depth: f64) {
    let mut all = FlatShape::default();
    let mut ends = Vec::with_capacity(shapes.len());
    for shape in shapes {
        all.append(&shape.turned());
        ends.push(all.triangles.len());
    }
    let all = if depth == 0.0 { all } else { all.unpinched().separated() };
    let count = u32::try_from(all.points.len()).unwrap_or(NONE);
    let back = u32::try_from(mesh.positions.len()).unwrap_or(NONE);
    let front = back.saturating_add(count);
    let layer = |z: f64| all.points.iter().map(move |[x, y]| DVec3::new(*x, *y, z));
    mesh.positions.extend(layer(0.0));
    if depth != 0.0 {
        mesh.positions.extend(layer(depth));
    }
    let corner = |first: u32, i: u32| Corner { vertex: first.saturating_add(i), uv: NONE, normal: NONE };
    let mut from = 0;
    for (shape, to) in shapes.iter().zip(ends) {
        let triangles = &all.triangles[std::mem::replace(&mut from, to)..to];
        mesh.marks.push((u32::try_from(mesh.polygons.len()).unwrap_or(NONE), Mark::Object(shape.name.clone())));
        if depth == 0.0 {
            triangles.iter().for_each(|t| mesh.push(PolygonKind::Face, t.map(|i| corner(back, i))));
            continue;
        }
        for [a, b, c] in triangles {
            mesh.push(PolygonKind::Face, [*a, *b, *c].map(|i| corner(front, i)));
            mesh.push(PolygonKind::Face, [*a, *c, *b].map(|i| corner(back, i)));
        }
        let own: HashSet<(u32, u32)> = sides(triangles).collect();
        // An edge without an opposite one is on the outline, with the shape to its left.
        for (a, b) in sides(triangles).filter(|(a, b)| !own.contains(&(*b, *a))) {
            mesh.push(PolygonKind::Face, [corner(back, a), corner(back, b), corner(front, b), corner(front, a)]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::topology;

    #[test]
    fn a_frame_becomes_a_ring() {
        // A square with a square hole, as eight triangles, given clockwise.
        let p = |r: f64| [[-r, -r], [r, -r], [r, r], [-r, r]];
        let points = [p(2.0), p(1.0)].concat();
        let triangles = (0..4u32)
            .flat_map(|i| {
                let j = (i + 1) % 4;
                [[i, i + 4, j], [j, i + 4, j + 4]]
            })
            .collect();
        let shape = FlatShape { name: "frame".into(), points, triangles };
        let mut mesh = Mesh::default();
        extrude(&mut mesh, std::slice::from_ref(&shape), 0.5);
        let t = topology(&mesh);
        assert!(t.is_closed() && t.euler() == 0 && (t.volume - 6.0).abs() < 1e-12, "{t:?}");
        let mut flat = Mesh::default();
        extrude(&mut flat, &[shape], 0.0);
        let t = topology(&flat);
        assert!((t.open_edges, t.faces) == (8, 8) && (t.area - 12.0).abs() < 1e-12, "{t:?}");
    }
}
