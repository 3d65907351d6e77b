//! Path references: `FILE#NAME`, `FILE`, `#NAME`.

use crate::failure::Failure;
use crate::{data_file, gimp};
use pathwarp::deform::Registry;
use pathwarp::kurbo::Point;
use pathwarp::recipe::Recipe;
use pathwarp::{Error, Outline};
use pathwarp_svg::{Document, ReadOptions};
use std::path::{Path, PathBuf};

/// What an input calls its paths.
#[derive(Clone, Copy)]
pub(crate) enum Names<'a> {
    Svg(&'a Document),
    Gimp(&'a gimp::Input),
}

/// Looks references up, in the input document and in files.
pub(crate) struct References<'a> {
    input: Option<Names<'a>>,
    /// Names in the input document that were used: guides, not artwork.
    pub(crate) guides: Vec<String>,
}

impl<'a> References<'a> {
    pub(crate) fn new(input: Option<Names<'a>>) -> Self {
        Self { input, guides: Vec::new() }
    }

    /// Everything in a recipe that lies in files: paths and texts.
    pub(crate) fn resolve(&mut self, registry: &Registry, recipe: &mut Recipe) -> Result<(), Failure> {
        for step in &mut recipe.steps {
            if let Some(e) = registry.get(&step.deformation) {
                let paths = step.args.resolve_paths(e.info().params, |r| self.look_up(r));
                let all = paths.and_then(|()| step.args.resolve_files(e.info().params, data_file::read));
                all.map_err(Failure::of_recipe)?;
            }
        }
        Ok(())
    }

    fn look_up(&mut self, reference: &str) -> Result<Outline, Error> {
        if let Some(name) = reference.strip_prefix('#') {
            let nowhere = || Error::input(reference, "there is no input document here to find a path in");
            let outline = match self.input.ok_or_else(nowhere)? {
                Names::Svg(doc) => doc.path(name)?.outline,
                Names::Gimp(file) => file.named(name)?.outline(),
            };
            self.guides.push(name.to_owned());
            return Ok(outline);
        }
        let (file, name) = split(reference);
        if let Some(gimp) = gimp::Input::at(&file, false)? {
            return Ok(match name {
                Some(name) => gimp.named(name)?.outline(),
                None => gimp.only()?.outline(),
            });
        }
        let bytes = std::fs::read(&file).map_err(|e| {
            Error::input(
                file.display().to_string(),
                format!("cannot be read: {e}; a path reference is FILE#NAME, #NAME, path data or points"),
            )
        })?;
        if file.extension().is_some_and(|e| e.eq_ignore_ascii_case("json")) {
            return points(&bytes).map_err(|e| Error::input(reference, e));
        }
        let doc = Document::read(&bytes, &file.display().to_string(), &ReadOptions::default())?;
        match name {
            Some(name) => Ok(doc.path(name)?.outline),
            None => {
                let mut all = doc.paths();
                match (all.pop(), all.is_empty()) {
                    (Some(only), true) => Ok(only.outline),
                    (None, _) => Err(Error::input(reference, "holds no path")),
                    (Some(last), false) => Err(Error::input(
                        reference,
                        format!(
                            "holds {} paths; say which: {}#NAME (`pathwarp paths {}` lists them; one is {})",
                            all.len() + 1,
                            file.display(),
                            file.display(),
                            last.id
                        ),
                    )),
                }
            }
        }
    }
}

/// Splits `FILE#NAME`. Either may hold a `#`: the first one behind which the front is a file decides.
pub(crate) fn split(reference: &str) -> (PathBuf, Option<&str>) {
    if Path::new(reference).is_file() {
        return (reference.into(), None);
    }
    let cuts: Vec<usize> = reference.match_indices('#').map(|(i, _)| i).collect();
    let cut = cuts.iter().find(|&&i| Path::new(&reference[..i]).is_file()).or(cuts.last());
    match cut {
        Some(&i) => (reference[..i].into(), Some(&reference[i + 1..])),
        None => (reference.into(), None),
    }
}

/// A JSON file of points: `[[x,y],…]`, or rows of them; each row is a polyline.
fn points(bytes: &[u8]) -> Result<Outline, String> {
    #[derive(serde::Deserialize)]
    #[serde(untagged)]
    enum Shape {
        Points(Vec<[f64; 2]>),
        Rows(Vec<Vec<[f64; 2]>>),
    }
    let shape: Shape = serde_json::from_slice(bytes)
        .map_err(|e| format!("is no JSON list of points [[x,y],…] or of rows of points: {e}"))?;
    let rows = match shape {
        Shape::Points(p) => vec![p],
        Shape::Rows(r) => r,
    };
    let subpaths = rows.iter().flat_map(|r| {
        let points: Vec<Point> = r.iter().map(|[x, y]| Point::new(*x, *y)).collect();
        Outline::from_points(&points, false).subpaths
    });
    Ok(Outline { subpaths: subpaths.collect() })
}
