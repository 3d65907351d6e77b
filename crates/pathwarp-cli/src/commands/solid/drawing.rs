//! Drawings as models: the filled shapes of an SVG, flat or extruded, true to size in millimetres.

use crate::advice;
use crate::failure::Failure;
use crate::input;
use crate::options::Reading;
use crate::units::MM_PER_PX;
use pathwarp::kurbo::{Affine, Point};
use pathwarp_mesh::NamedShape;
use pathwarp_solid::mesh::{FlatShape, Mesh, extrude};
use pathwarp_svg::Selection;
use std::path::Path;

/// Distance in millimetres within which outlines are followed: finer than printers and cutters work.
const TOLERANCE: f64 = 0.01;

/// Reads a drawing: x from the left edge of the page, y from its bottom edge.
pub(super) fn read(file: &Path, reading: &Reading, depth: f64) -> Result<Mesh, Failure> {
    let doc = input::document(file, reading)?;
    let page = doc.user_to_px().transform_rect_bbox(doc.view_box());
    let to_mm =
        Affine::scale_non_uniform(MM_PER_PX, -MM_PER_PX) * Affine::translate((-page.x0, -page.y1)) * doc.user_to_px();
    let unit = to_mm.determinant().abs().sqrt();
    let mut mesh = Mesh::default();
    let mut unfilled = 0;
    for shape in doc.selected(&Selection::default()) {
        if !shape.filled {
            unfilled += 1;
            continue;
        }
        let named = NamedShape { name: &shape.id, outline: &shape.outline, even_odd: shape.even_odd };
        let flat = pathwarp_mesh::flat(&named, TOLERANCE / unit, doc.budget())
            .map_err(|e| Failure::Geometry(format!("{}: {}", input::display(file), advice::surface(&e))))?;
        let points = flat.points.iter().map(|p| {
            let p: Point = to_mm * *p;
            [p.x, p.y]
        });
        let flat = FlatShape { name: shape.id.clone(), points: points.collect(), triangles: flat.triangles };
        extrude(&mut mesh, &flat, depth);
    }
    if unfilled > 0 {
        mesh.left_out.push(format!("{unfilled} shapes that are not filled (convert their strokes to paths first)"));
    }
    if mesh.positions.is_empty() {
        return Err(Failure::file(file, "the drawing has no filled shapes"));
    }
    Ok(mesh)
}
