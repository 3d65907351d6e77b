//! The artwork on a surface in space, as OBJ files: a mesh of the filled shapes, or curves.

use crate::advice;
use crate::failure::Failure;
use pathwarp::deform::Built;
use pathwarp::kurbo::Point;
use pathwarp::map::Map;
use pathwarp::recipe::{BuiltParts, BuiltRecipe};
use pathwarp_mesh::NamedShape;
use pathwarp_svg::{Document, WarpOptions};
use std::path::PathBuf;

/// Refuses steps that write such a file for artwork which other steps have bent in several ways.
pub(super) fn check(built: &BuiltParts) -> Result<(), Failure> {
    let asks = |(i, step): (usize, &Built)| {
        let file = step.space.as_ref()?.files.first()?;
        let parts = built.parts.iter().filter(|p| p.indices.contains(&i)).count();
        (parts > 1).then_some((file.param, i))
    };
    match built.whole.steps.iter().enumerate().find_map(asks) {
        Some((param, i)) => Err(Failure::usage(format!(
            "--{param} writes one surface, but step {} holds for parts that other steps bend in different ways; run it by itself",
            i + 1
        ))),
        None => Ok(()),
    }
}

/// The first parameter that asks for such a file.
pub(super) fn requested(built: &BuiltRecipe) -> Option<&'static str> {
    built.steps.iter().filter_map(|s| s.space.as_ref()).find_map(|s| s.files.first()).map(|f| f.param)
}

/// The files that the recipe's steps ask for, with their text.
pub(super) fn files(
    doc: &Document,
    built: &BuiltRecipe,
    options: &WarpOptions,
) -> Result<Vec<(PathBuf, String)>, Failure> {
    let mut out = Vec::new();
    for (i, step) in built.steps.iter().enumerate() {
        let Some(space) = &step.space else { continue };
        let before = &built.steps[..i];
        let place = |p: Point| (space.place)(before.iter().fold(p, |q, s| s.map.point(q)));
        let shapes: Vec<_> = doc.selected(&options.selection).collect();
        for file in &space.files {
            let wanted = shapes.iter().filter(|s| s.filled || !file.filled);
            let wanted: Vec<NamedShape<'_>> =
                wanted.map(|s| NamedShape { name: &s.id, outline: &s.outline, even_odd: s.even_odd }).collect();
            let made = if file.filled {
                pathwarp_mesh::filled(&wanted, &place, options.refit.tolerance, doc.budget())
            } else {
                pathwarp_mesh::outlines(&wanted, &place, options.refit.tolerance, doc.budget())
            };
            let text = made.map_err(|e| Failure::Geometry(format!("--{}: {}", file.param, advice::surface(&e))))?;
            out.push((PathBuf::from(&file.name), text));
        }
    }
    Ok(out)
}
