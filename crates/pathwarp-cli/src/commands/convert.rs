//! `pathwarp convert art.xcf -o art.svg`: copies the paths of a file into another format.

use super::file_args;
use crate::failure::Failure;
use crate::input::{self, GimpFile};
use crate::options::{self, Access, Given};
use crate::output::{self, PendingFile};
use crate::sources::Files;
use crate::status::Status;
use crate::terminal;
use clap::{Arg, ArgAction, ArgMatches, Command};
use pathwarp_gimp::{GimpPath, Stroke, new_xcf, to_json, to_svg};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

pub(super) const NAME: &str = "convert";

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("Copy the paths of a file (GIMP files, SVG) into an SVG, a point list, or a new XCF")
        .arg(file_args::file("FILE", "A GIMP file or an SVG; FILE#NAME copies one path of a GIMP file"))
        .arg(file_args::out(
            "OUT",
            "Output file: .svg, .json (GIMP point list) or .xcf (paths only); none writes SVG to standard output",
        ))
        .arg(
            Arg::new("split")
                .long("split")
                .action(ArgAction::SetTrue)
                .requires("out")
                .help("Write every path to its own file, named after OUT and the path: out-NAME.svg"),
        )
        .arg(
            Arg::new("salvage")
                .long("salvage")
                .action(ArgAction::SetTrue)
                .help("Copy the paths before the damage in a damaged file"),
        )
        .args(options::access_args())
        .after_help(
            "The SVG has its size in px and a matching viewBox, so that GIMP imports it without scaling; path names become ids. \
             Coordinates are written with the precision that GIMP stores.\n\nExamples:\n  pathwarp convert \
             art.xcf -o art.svg\n  pathwarp convert art.xcf#Cage -o cage.json\n  pathwarp convert art.xcf -o paths.svg --split",
        )
}

pub(super) fn run(m: &ArgMatches) -> Result<Status, Failure> {
    let file = file_args::given(m, "FILE")?;
    let split = m.get_flag("split");
    // The files that --split writes are checked below.
    let target = file_args::target(m, (!split).then_some(file))?;
    let gimp = GimpFile::open(file, m.get_flag("salvage"))?;
    let damage = gimp.as_ref().and_then(|g| g.damage.clone());
    let (size, paths) = match &gimp {
        Some(gimp) => (gimp.canvas(), gimp.paths().cloned().collect()),
        None => drawing(file, &Given::access(m)?)?,
    };
    if let Some(d) = &damage {
        terminal::warning(&format!("{}: {d}", input::display(file)));
    }
    match target {
        None => output::to_stdout(to_svg(size, &paths, None).as_bytes())?,
        Some(out) if split => {
            let names = names(out, &paths);
            let mut files = Files::default();
            files.read(file);
            names.iter().try_for_each(|to| files.write(to, ""))?;
            let single =
                |(to, p): (&PathBuf, &GimpPath)| PendingFile::new(to, &bytes(to, size, std::slice::from_ref(p))?);
            let files: Result<Vec<PendingFile>, Failure> = names.iter().zip(&paths).map(single).collect();
            PendingFile::commit_all(files?)?;
        }
        Some(out) => output::write(Some(out), &bytes(out, size, &paths)?)?,
    }
    Ok(Status::partial_if(damage.is_some()))
}

/// The size of an SVG's viewBox and its paths as GIMP would store them, in units of the viewBox.
fn drawing(file: &Path, access: &Access) -> Result<([f64; 2], Vec<GimpPath>), Failure> {
    let doc = input::document(file, access)?;
    let page = doc.view_box();
    let to_page = pathwarp::kurbo::Affine::translate(-page.origin().to_vec2());
    let path = |p: pathwarp_svg::NamedPath| {
        let strokes = p.outline.transformed(to_page).subpaths.iter().map(Stroke::from_subpath).collect();
        GimpPath { name: p.label.or(p.title).unwrap_or(p.id), visible: true, strokes }
    };
    Ok(([page.width(), page.height()], doc.paths().into_iter().map(path).collect()))
}

/// The bytes of a file with these paths, in the format of its extension.
fn bytes(to: &Path, size: [f64; 2], paths: &[GimpPath]) -> Result<Vec<u8>, Failure> {
    let extension = to.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    match extension.as_str() {
        "svg" => Ok(to_svg(size, paths, None).into_bytes()),
        "json" => Ok(to_json(Some(size), paths).into_bytes()),
        "xcf" => Ok(new_xcf(size.map(|v| v.ceil().clamp(1.0, 524_288.0) as u32), paths)),
        _ => Err(Failure::usage(format!("{}: paths are written as .svg, .json or .xcf", to.display()))),
    }
}

/// A file name for every path, distinct even on file systems that ignore case.
fn names(out: &Path, paths: &[GimpPath]) -> Vec<PathBuf> {
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    let extension = out.extension().unwrap_or_default().to_string_lossy();
    let mut taken = HashSet::new();
    let mut unique = |p: &GimpPath| {
        let name = input::file_name(&p.name);
        let numbered = (2..).map(|n| format!("{name}-{n}"));
        let mut tries = std::iter::once(name.clone()).chain(numbered).filter(|n| !n.is_empty());
        tries.find(|n| taken.insert(n.to_lowercase())).unwrap_or(name)
    };
    paths.iter().map(|p| out.with_file_name(format!("{stem}-{}.{extension}", unique(p)))).collect()
}
