//! `--mesh` and `--curves`: the artwork on a surface in space, as OBJ files.

use crate::failure::Failure;
use pathwarp::kurbo::Point;
use pathwarp::map::Map;
use pathwarp::recipe::BuiltRecipe;
use pathwarp_mesh::Shape;
use pathwarp_svg::{Document, WarpOptions};
use std::path::PathBuf;

/// The files that the recipe's steps ask for, with their text.
pub(crate) fn files(
    doc: &Document,
    built: &BuiltRecipe,
    options: &WarpOptions,
) -> Result<Vec<(PathBuf, String)>, Failure> {
    let mut out = Vec::new();
    for (i, b) in built.steps.iter().enumerate() {
        let Some(space) = &b.space else { continue };
        let before = &built.steps[..i];
        let place = |p: Point| (space.place)(before.iter().fold(p, |q, s| s.map.point(q)));
        let shapes: Vec<_> = doc.selected(&options.selection).collect();
        let as_mesh = |filled: bool| -> Vec<Shape<'_>> {
            let wanted = shapes.iter().filter(|s| s.filled || !filled);
            wanted.map(|s| Shape { name: &s.id, outline: &s.outline, even_odd: s.even_odd }).collect()
        };
        let tolerance = options.refit.tolerance;
        for file in &space.files {
            let made = if file.filled {
                pathwarp_mesh::filled(&as_mesh(true), &place, tolerance)
            } else {
                pathwarp_mesh::outlines(&as_mesh(false), &place, tolerance)
            };
            let text = made.map_err(|e| Failure::Geometry(format!("--{}: {e}", file.param)))?;
            out.push((PathBuf::from(&file.name), text));
        }
    }
    Ok(out)
}
