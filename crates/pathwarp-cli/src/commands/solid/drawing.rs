//! Drawings as models: fills and strokes of an SVG, flat or extruded, true to size in millimetres.

use crate::advice;
use crate::failure::Failure;
use crate::input;
use crate::options::Reading;
use crate::units::MM_PER_PX;
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Point};
use pathwarp_mesh::NamedShape;
use pathwarp_solid::mesh::{FlatShape, Mesh, extrude};
use pathwarp_svg::Selection;
use std::path::Path;

/// Distance in millimetres within which outlines are followed: finer than printers and cutters work.
const TOLERANCE: f64 = 0.01;

/// Reads a drawing: x from the left edge of the page, y from its bottom edge.
pub(super) fn read(bytes: &[u8], file: &Path, reading: &Reading, depth: f64) -> Result<Mesh, Failure> {
    let doc = input::document_of(bytes, file, reading)?;
    let page = doc.user_to_px().transform_rect_bbox(doc.view_box());
    let to_mm =
        Affine::scale_non_uniform(MM_PER_PX, -MM_PER_PX) * Affine::translate((-page.x0, -page.y1)) * doc.user_to_px();
    let unit = to_mm.determinant().abs().sqrt();
    let mut shapes = Vec::new();
    let mut add = |name: &str, outline: &Outline, even_odd: bool| -> Result<(), Failure> {
        let named = NamedShape { name, outline, even_odd };
        let flat = pathwarp_mesh::flat(&named, TOLERANCE / unit, doc.budget())
            .map_err(|e| Failure::Geometry(format!("{}: {}", input::display(file), advice::surface(&e))))?;
        let points = flat.points.iter().map(|p| {
            let p: Point = to_mm * *p;
            [p.x, p.y]
        });
        let flat = FlatShape { name: name.to_owned(), points: points.collect(), triangles: flat.triangles };
        if !flat.triangles.is_empty() {
            shapes.push(flat);
        }
        Ok(())
    };
    let all = Selection::default();
    let strokes = doc.strokes(&all, TOLERANCE / unit);
    let strokes = strokes.map_err(|e| {
        Failure::Input(format!("{}: the strokes take {e}; {}", input::display(file), advice::raise(&e)))
    })?;
    for (shape, stroke) in doc.selected(&all).zip(strokes) {
        if shape.filled {
            add(&shape.id, &shape.outline, shape.even_odd)?;
        }
        if let Some(stroke) = stroke {
            let name = if shape.filled { format!("{} stroke", shape.id) } else { shape.id.clone() };
            add(&name, &stroke, false)?;
        }
    }
    if shapes.is_empty() {
        return Err(Failure::file(file, "the drawing has no shapes with an area"));
    }
    let mut mesh = Mesh::default();
    extrude(&mut mesh, &shapes, depth);
    Ok(mesh)
}
