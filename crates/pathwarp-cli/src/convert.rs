//! `pathwarp convert art.xcf -o art.svg`: paths from one kind of file into another, as they are.

use crate::failure::Failure;
use crate::gimp::{self, Input};
use crate::output::{self, Pending};
use crate::{Outcome, deform, terminal};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use pathwarp_gimp::{GimpPath, Stroke, new_xcf, to_json, to_svg};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

pub(crate) fn command() -> Command {
    Command::new("convert")
        .about("Take the paths of a file (XCF and other files of GIMP's, SVG) into an SVG, a point list, or a new XCF")
        .arg(
            Arg::new("FILE")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("A file of GIMP's or an SVG; FILE#NAME takes one path of GIMP's"),
        )
        .arg(
            Arg::new("out")
                .short('o')
                .long("out")
                .value_name("OUT")
                .value_parser(value_parser!(PathBuf))
                .help("Where to write: .svg, .json (GIMP's point lists) or .xcf (paths alone); none writes SVG to standard output"),
        )
        .arg(
            Arg::new("split")
                .long("split")
                .action(ArgAction::SetTrue)
                .requires("out")
                .help("A file for every path, its name behind OUT's: out-NAME.svg"),
        )
        .arg(
            Arg::new("salvage")
                .long("salvage")
                .action(ArgAction::SetTrue)
                .help("Of a damaged file, take the paths before the damage"),
        )
        .after_help(
            "The SVG has its size in px and a viewBox of the same numbers, so that GIMP imports it without scaling; paths keep \
             their names as ids. Coordinates are written to the precision in which GIMP keeps them.\n\nExamples:\n  pathwarp convert \
             art.xcf -o art.svg\n  pathwarp convert art.xcf#Cage -o cage.json\n  pathwarp convert art.xcf -o paths.svg --split",
        )
}

pub(crate) fn run(m: &ArgMatches) -> Result<Outcome, Failure> {
    let Some(file) = m.get_one::<PathBuf>("FILE") else { return Err(Failure::usage("FILE is needed")) };
    let gimps = Input::open(file, m.get_flag("salvage"))?;
    let damage = gimps.as_ref().and_then(|i| i.damage.clone());
    let (size, paths) = match &gimps {
        Some(input) => (input.canvas(), input.meant().cloned().collect()),
        None => drawing(file)?,
    };
    if let Some(d) = &damage {
        terminal::warning(&format!("{}: {d}", deform::display(file)));
    }
    match m.get_one::<PathBuf>("out").filter(|o| o.as_os_str() != "-") {
        None => output::to_stdout(to_svg(size, &paths, None).as_bytes())?,
        Some(out) if m.get_flag("split") => {
            let names = names(out, &paths);
            let one = |(to, p): (&PathBuf, &GimpPath)| Pending::new(to, &bytes(to, size, std::slice::from_ref(p))?);
            let files: Result<Vec<Pending>, Failure> = names.iter().zip(&paths).map(one).collect();
            Pending::commit_all(files?)?;
        }
        Some(out) => Pending::commit_all(vec![Pending::new(out, &bytes(out, size, &paths)?)?])?,
    }
    Ok(if damage.is_some() { Outcome::Partly } else { Outcome::Done })
}

/// An SVG's paths as GIMP would keep them, in the pixels of its viewBox.
fn drawing(file: &Path) -> Result<([f64; 2], Vec<GimpPath>), Failure> {
    let doc = deform::document(file)?;
    let page = doc.view_box();
    let to_page = pathwarp::kurbo::Affine::translate(-page.origin().to_vec2());
    let path = |p: pathwarp_svg::NamedPath| {
        let strokes = p.outline.transformed(to_page).subpaths.iter().map(Stroke::from_subpath).collect();
        GimpPath { name: p.label.or(p.title).unwrap_or(p.id), visible: true, strokes }
    };
    Ok(([page.width(), page.height()], doc.paths().into_iter().map(path).collect()))
}

fn bytes(to: &Path, size: [f64; 2], paths: &[GimpPath]) -> Result<Vec<u8>, Failure> {
    let extension = to.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    match extension.as_str() {
        "svg" => Ok(to_svg(size, paths, None).into_bytes()),
        "json" => Ok(to_json(Some(size), paths).into_bytes()),
        "xcf" => Ok(new_xcf(size.map(|v| v.ceil().clamp(1.0, 524_288.0) as u32), paths)),
        _ => Err(Failure::usage(format!("{}: paths are written as .svg, .json or .xcf", to.display()))),
    }
}

/// A file's name for every path; no two are the same, also where file names have no capitals.
fn names(out: &Path, paths: &[GimpPath]) -> Vec<PathBuf> {
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    let extension = out.extension().unwrap_or_default().to_string_lossy();
    let mut taken = HashSet::new();
    let mut unique = |p: &GimpPath| {
        let name = gimp::file_name(&p.name);
        let numbered = (2..).map(|n| format!("{name}-{n}"));
        let mut tries = std::iter::once(name.clone()).chain(numbered).filter(|n| !n.is_empty());
        tries.find(|n| taken.insert(n.to_lowercase())).unwrap_or(name)
    };
    paths.iter().map(|p| out.with_file_name(format!("{stem}-{}.{extension}", unique(p)))).collect()
}
