//! Path references, `FILE#NAME`, `FILE` and `#NAME`: looked up in files and in the input document.

use crate::advice;
use crate::catalogue::Catalogue;
use crate::failure::Failure;
use crate::input::{described, gimp_outline, read_data_file, split_reference, unreadable};
use crate::options::Reading;
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Affine, Point};
use pathwarp::param::{Kind, is_inline, is_shape, shape_names};
use pathwarp::recipe::Recipe;
use pathwarp::{Error, Outline};
use pathwarp_svg::Document;
use std::path::{Path, PathBuf};

/// Looks up every file that a recipe refers to; paths keep their user units. References to the input document, `#NAME`, stay open.
pub fn resolve_files(catalogue: &dyn Catalogue, recipe: &mut Recipe, reading: &Reading) -> Result<(), Failure> {
    let in_file =
        |reference: &str| names_file(reference, HERE.as_ref()).then(|| Ok(look_up(reference, reading)?.0)).transpose();
    for step in &mut recipe.steps {
        let Some(info) = catalogue.info(&step.deformation) else { continue };
        let paths = step.args.resolve_paths(info.params, in_file);
        let all = paths.and_then(|()| step.args.resolve_files(info.params, read_data_file));
        all.map_err(Failure::of_recipe)?;
    }
    Ok(())
}

/// Looks up the references that [`resolve_files`] leaves open: `in_input` finds a path of the input document, before a shape of that name.
/// Returns the names of these paths, which are guides, not artwork.
pub(crate) fn resolve_names(
    registry: &Registry,
    recipe: &mut Recipe,
    in_input: impl Fn(&str) -> Result<Outline, Error>,
) -> Result<Vec<String>, Error> {
    let mut guides = Vec::new();
    for step in &mut recipe.steps {
        let Some(deformation) = registry.get(&step.deformation) else { continue };
        step.args.resolve_paths(deformation.info().params, |reference| {
            let name = reference.strip_prefix('#').unwrap_or(reference);
            let outline = match in_input(name) {
                Err(_) if is_shape(reference) => return Ok(None),
                found => found?,
            };
            guides.push(name.to_owned());
            Ok(Some(outline))
        })?;
    }
    Ok(guides)
}

/// Returns the files that a recipe reads.
pub fn files_read(catalogue: &dyn Catalogue, recipe: &Recipe) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for step in &recipe.steps {
        for p in catalogue.info(&step.deformation).map_or(&[][..], |i| i.params) {
            for value in step.args.get(p.name) {
                match p.kind {
                    Kind::Path if names_file(value, HERE.as_ref()) => files.push(split_reference(value).0),
                    _ if p.reads_file(value) => files.push(value.into()),
                    _ => {}
                }
            }
        }
    }
    files
}

/// Returns the files that a recipe's parameters ask to be written.
pub fn files_written<'a>(
    catalogue: &'a dyn Catalogue,
    recipe: &'a Recipe,
) -> impl Iterator<Item = (&'static str, &'a Path)> {
    recipe.steps.iter().flat_map(|step| {
        let params = catalogue.info(&step.deformation).map_or(&[][..], |i| i.params);
        let saves = params.iter().filter(|p| p.kind == Kind::Save);
        saves.flat_map(|p| step.args.get(p.name).iter().map(|file| (p.name, Path::new(file))))
    })
}

/// Returns `true` if a path reference, read in `folder`, names a file rather than a shape, a path of the input or path data.
pub fn names_file(reference: &str, folder: &Path) -> bool {
    let is_name = reference.starts_with('#') || is_inline(reference);
    !is_name && (!is_shape(reference) || folder.join(split_reference(reference).0).is_file())
}

/// The current folder, as a path.
pub const HERE: &str = "";

/// Looks up the path that `FILE#NAME` or `FILE` names, and scales it to px.
pub fn in_px(reference: &str, reading: &Reading) -> Result<Outline, Error> {
    let (outline, to_px) = look_up(reference, reading)?;
    Ok(outline.transformed(to_px))
}

/// Returns the outline that a reference to a file names, and the map from its user units to px.
fn look_up(reference: &str, reading: &Reading) -> Result<(Outline, Affine), Error> {
    let (file, name) = split_reference(reference);
    if let Some(outline) = gimp_outline(&file, name, &reading.limits)? {
        return Ok((outline, Affine::IDENTITY));
    }
    let shown = file.display();
    let bytes = std::fs::read(&file).map_err(|e| {
        let word = reference.split(',').next().unwrap_or_default();
        let meant = advice::likely(&word.to_lowercase(), shape_names().iter().copied());
        let problem = match meant.filter(|_| !word.contains(['#', '.', ':', '/', '\\'])) {
            Some(meant) => format!("there is neither a file nor a shape of this name; did you mean {meant}?"),
            None => format!(
                "{}; a path reference is FILE#NAME, #NAME, path data, points, a shape such as heart, circle:r=R, \
                 arc:r=R,from=A,to=B or spiral:turns=N,inner=R,outer=R",
                unreadable(&file, &e)
            ),
        };
        Error::input(shown.to_string(), problem)
    })?;
    if file.extension().is_some_and(|e| e.eq_ignore_ascii_case("json")) {
        let outline = polylines(&bytes).map_err(|e| Error::input(reference, e))?;
        return Ok((outline, Affine::IDENTITY));
    }
    let doc = Document::read(&bytes, &shown.to_string(), &reading.read_options());
    let doc = doc.map_err(|e| described(&bytes, &file).map_or(e, |what| Error::input(shown.to_string(), what)))?;
    let to_px = doc.user_to_px();
    if let Some(name) = name {
        return Ok((doc.path(name)?.outline, to_px));
    }
    let mut all = doc.paths();
    let count = all.len();
    match all.pop() {
        Some(only) if count == 1 => Ok((only.outline, to_px)),
        None => Err(Error::input(reference, "holds no path")),
        Some(last) => {
            let problem = format!(
                "holds {count} paths; name one of them: {shown}#NAME (`pathwarp paths {shown}` lists them; one is {})",
                last.id
            );
            Err(Error::input(reference, problem))
        }
    }
}

/// Parses a JSON file of points: `[[x,y],…]`, or rows of them. Each row is a polyline.
fn polylines(bytes: &[u8]) -> Result<Outline, String> {
    #[derive(serde::Deserialize)]
    #[serde(untagged)]
    enum PointList {
        Points(Vec<(f64, f64)>),
        Rows(Vec<Vec<(f64, f64)>>),
    }
    let list: PointList = serde_json::from_slice(bytes)
        .map_err(|e| format!("is not a JSON list of points [[x,y],…] or of rows of points: {e}"))?;
    let rows = match list {
        PointList::Points(p) => vec![p],
        PointList::Rows(r) => r,
    };
    let subpaths = rows.into_iter().flat_map(|row| {
        let points: Vec<Point> = row.into_iter().map(Point::from).collect();
        Outline::from_points(&points, false).subpaths
    });
    Ok(Outline { subpaths: subpaths.collect() })
}
