//! Flat shapes as solids: a front, a back, and walls along the edges between them.

use super::flat::FlatShape;
use super::model::{Corner, Mark, Mesh, NONE, PolygonKind};
use glam::DVec3;
use std::collections::HashSet;

/// Appends a shape as an object: flat at z = 0 if `depth` is 0, otherwise a closed solid from there to z = `depth` above it.
pub fn extrude(mesh: &mut Mesh, shape: &FlatShape, depth: f64) {
    let turned = shape.turned();
    let shape = if depth == 0.0 { turned } else { turned.unpinched().separated() };
    let count = u32::try_from(shape.points.len()).unwrap_or(NONE);
    let back = u32::try_from(mesh.positions.len()).unwrap_or(NONE);
    mesh.marks.push((u32::try_from(mesh.polygons.len()).unwrap_or(NONE), Mark::Object(shape.name.clone())));
    let layer = |z: f64| shape.points.iter().map(move |[x, y]| DVec3::new(*x, *y, z));
    mesh.positions.extend(layer(0.0));
    let corner = |first: u32, i: u32| Corner { vertex: first.saturating_add(i), uv: NONE, normal: NONE };
    if depth == 0.0 {
        for t in &shape.triangles {
            mesh.push(PolygonKind::Face, t.map(|i| corner(back, i)));
        }
        return;
    }
    mesh.positions.extend(layer(depth));
    let front = back.saturating_add(count);
    for [a, b, c] in &shape.triangles {
        mesh.push(PolygonKind::Face, [*a, *b, *c].map(|i| corner(front, i)));
        mesh.push(PolygonKind::Face, [*a, *c, *b].map(|i| corner(back, i)));
    }
    let all: HashSet<(u32, u32)> = shape.sides().collect();
    // An edge without an opposite one is on the outline, with the shape to its left.
    for (a, b) in shape.sides().filter(|(a, b)| !all.contains(&(*b, *a))) {
        mesh.push(PolygonKind::Face, [corner(back, a), corner(back, b), corner(front, b), corner(front, a)]);
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
        extrude(&mut mesh, &shape, 0.5);
        let t = topology(&mesh);
        assert!(t.is_closed() && t.euler() == 0 && (t.volume - 6.0).abs() < 1e-12, "{t:?}");
        let mut flat = Mesh::default();
        extrude(&mut flat, &shape, 0.0);
        let t = topology(&flat);
        assert!((t.open_edges, t.faces) == (8, 8) && (t.area - 12.0).abs() < 1e-12, "{t:?}");
    }
}
