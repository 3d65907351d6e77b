//! Copies paths from one file into another, as GIMP stores them.

use crate::ending::Status;
use crate::sources::Files;
use crate::terminal;
use pathwarp::kurbo::Affine;
use pathwarp_engine::export;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::format::Format;
use pathwarp_engine::input::{self, GimpFile};
use pathwarp_engine::options::{CommonOptions, Reading};
use pathwarp_engine::output::{self, PendingFile};
use pathwarp_gimp::{GimpPath, Stroke};
use pathwarp_svg::NamedPath;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// Copies the paths of a file into another format, with `split` each to a file. `None` if `format` can show more than paths.
pub(super) fn copy(
    file: &Path,
    target: Option<&Path>,
    format: Format,
    options: &CommonOptions,
    split: bool,
    salvage: bool,
) -> Result<Option<Status>, Failure> {
    let gimp = GimpFile::open(file, salvage, &options.reading.limits)?;
    if gimp.is_none() && !split && matches!(format, Format::Pdf | Format::Dxf) {
        return Ok(None);
    }
    let damage = gimp.as_ref().and_then(|g| g.damage.clone());
    let (size, paths) = match &gimp {
        Some(gimp) => (gimp.canvas(), gimp.paths().cloned().collect()),
        None => drawing(file, &options.reading)?,
    };
    if let Some(damage) = damage.as_ref().filter(|_| !options.quiet) {
        terminal::warning(&format!("{}: {damage}", input::display(file)));
    }
    let bytes = |paths: &[GimpPath]| export::paths(size, paths, format, options, None).map(|exported| exported.bytes);
    match target {
        Some(out) if split => {
            let names = names(out, format, &paths);
            let mut files = Files::default();
            files.add_source(file);
            names.iter().try_for_each(|to| files.add_output(to, ""))?;
            let single = |(to, p): (&PathBuf, &GimpPath)| PendingFile::new(to, &bytes(std::slice::from_ref(p))?);
            let files: Result<Vec<PendingFile>, Failure> = names.iter().zip(&paths).map(single).collect();
            PendingFile::commit_all(files?)?;
        }
        _ => output::write(target, &bytes(&paths)?)?,
    }
    Ok(Some(Status::partial_if(damage.is_some())))
}

/// Returns the size of an SVG's viewBox, and its paths in units of it, as GIMP would store them.
fn drawing(file: &Path, reading: &Reading) -> Result<([f64; 2], Vec<GimpPath>), Failure> {
    let doc = input::document(file, reading)?;
    let page = doc.view_box();
    let to_page = Affine::translate(-page.origin().to_vec2());
    let path = |p: NamedPath| {
        let strokes = p.outline.transformed(to_page).subpaths.iter().map(Stroke::from_subpath).collect();
        GimpPath { name: p.label.or(p.title).unwrap_or(p.id), visible: true, strokes }
    };
    Ok(([page.width(), page.height()], doc.paths().into_iter().map(path).collect()))
}

/// Returns a file name for every path, distinct even on file systems that ignore case.
fn names(out: &Path, format: Format, paths: &[GimpPath]) -> Vec<PathBuf> {
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    let extension = out.extension().map_or_else(|| format.extension().into(), |e| e.to_string_lossy());
    let mut taken = HashSet::new();
    // The next number to try for each name, so that many paths with equal names do not try all numbers.
    let mut next: HashMap<String, usize> = HashMap::new();
    let mut unique = |p: &GimpPath| {
        let name = input::file_name(&p.name);
        let number = next.entry(name.to_lowercase()).or_insert(1);
        loop {
            let numbered = if *number == 1 { name.clone() } else { format!("{name}-{number}") };
            *number += 1;
            if !numbered.is_empty() && taken.insert(numbered.to_lowercase()) {
                return numbered;
            }
        }
    };
    paths.iter().map(|p| out.with_file_name(format!("{stem}-{}.{extension}", unique(p)))).collect()
}
