//! `pathwarp convert art.xcf -o art.svg`: copies the paths of a file into another format, or a drawing into a PDF or DXF.

use super::file_args;
use crate::advice;
use crate::export::{self, Exported};
use crate::failure::Failure;
use crate::format::{Choice, Format};
use crate::input::{self, GimpFile};
use crate::options::{CommonOptions, Given, Reading, reading_args, some_options};
use crate::output::{self, PendingFile};
use crate::sources::Files;
use crate::status::Status;
use crate::terminal;
use clap::{Arg, ArgAction, ArgMatches, Command};
use pathwarp_gimp::{GimpPath, Stroke, new_xcf, to_json, to_svg};
use pathwarp_svg::ReadOptions;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

pub(super) const NAME: &str = "convert";

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("Copy the paths of a file (GIMP files, SVG) into an SVG, a point list or a new XCF, or a drawing into a PDF or DXF")
        .arg(file_args::file("FILE", "A GIMP file or an SVG; FILE#NAME copies one path of a GIMP file"))
        .arg(file_args::out(
            "OUT",
            "Output file: .svg, .svgz, .json (GIMP point list) or .xcf with the paths; of an SVG also .pdf with the whole \
             drawing, or .dxf with its outlines in mm; - or none writes to standard output",
        ))
        .args(some_options(&["format", "dxf-curves", "tolerance", "union", "quiet"]))
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
        .args(reading_args())
        .after_help(
            "The SVG has its size in px and a matching viewBox, so that GIMP imports it without scaling; path names become ids. \
             Coordinates are written with the precision that GIMP stores.\n\nExamples:\n  pathwarp convert \
             art.xcf -o art.svg\n  pathwarp convert art.xcf#Cage -o cage.json\n  pathwarp convert art.xcf -o paths.svg --split\n  pathwarp convert \
             drawing.svg -o drawing.pdf\n  pathwarp convert drawing.svg -o drawing.dxf --dxf-curves polyline",
        )
}

pub(super) fn run(m: &ArgMatches) -> Result<Status, Failure> {
    let file = file_args::given(m, "FILE")?;
    let split = m.get_flag("split");
    // The files that --split writes are checked below.
    let target = file_args::target(m, (!split).then_some(file))?;
    let options = Given::options(m).read()?;
    let choice = Choice { what: "paths are", among: FORMATS };
    let format = choice.format(target, options.format)?;
    let gimp = GimpFile::open(file, m.get_flag("salvage"), &options.reading.limits)?;
    if gimp.is_none() && !split && matches!(format, Format::Pdf | Format::Dxf) {
        return whole(file, target, format, &options);
    }
    let damage = gimp.as_ref().and_then(|g| g.damage.clone());
    let (size, paths) = match &gimp {
        Some(gimp) => (gimp.canvas(), gimp.paths().cloned().collect()),
        None => drawing(file, &options.reading)?,
    };
    if let Some(d) = damage.as_ref().filter(|_| !options.quiet) {
        terminal::warning(&format!("{}: {d}", input::display(file)));
    }
    match target {
        Some(out) if split => {
            let names = names(out, format, &paths);
            let mut files = Files::default();
            files.read(file);
            names.iter().try_for_each(|to| files.write(to, ""))?;
            let single = |(to, p): (&PathBuf, &GimpPath)| {
                PendingFile::new(to, &bytes(format, size, std::slice::from_ref(p), &options)?)
            };
            let files: Result<Vec<PendingFile>, Failure> = names.iter().zip(&paths).map(single).collect();
            PendingFile::commit_all(files?)?;
        }
        _ => output::write(target, &bytes(format, size, &paths, &options)?)?,
    }
    Ok(Status::partial_if(damage.is_some()))
}

/// The size of an SVG's viewBox and its paths as GIMP would store them, in units of the viewBox.
fn drawing(file: &Path, reading: &Reading) -> Result<([f64; 2], Vec<GimpPath>), Failure> {
    let doc = input::document(file, reading)?;
    let page = doc.view_box();
    let to_page = pathwarp::kurbo::Affine::translate(-page.origin().to_vec2());
    let path = |p: pathwarp_svg::NamedPath| {
        let strokes = p.outline.transformed(to_page).subpaths.iter().map(Stroke::from_subpath).collect();
        GimpPath { name: p.label.or(p.title).unwrap_or(p.id), visible: true, strokes }
    };
    Ok(([page.width(), page.height()], doc.paths().into_iter().map(path).collect()))
}

/// Writes the drawing in an SVG as a PDF or DXF.
fn whole(file: &Path, target: Option<&Path>, format: Format, options: &CommonOptions) -> Result<Status, Failure> {
    let doc = input::document(file, &options.reading)?;
    let Exported { bytes, warnings } =
        export::drawing(doc.text().to_owned(), format, &input::read_options(file, &options.reading), options, None)?;
    let (unread, undrawn) = (doc.unread_images(), doc.undrawn());
    let is_partial = !unread.is_empty() || !undrawn.is_empty();
    let lacking = advice::lacking(doc.missing_fonts(), &unread, &undrawn, &doc.notes()).into_iter();
    let warnings: Vec<String> = lacking.chain(warnings).collect();
    for warning in warnings.iter().filter(|_| !options.quiet) {
        terminal::warning(&format!("{}: {warning}", input::display(file)));
    }
    output::write(target, &bytes)?;
    Ok(Status::partial_if(is_partial))
}

/// The formats that this command writes.
const FORMATS: &[Format] = &[Format::Svg, Format::Svgz, Format::Pdf, Format::Dxf, Format::PointList, Format::Xcf];

/// The bytes of a file with these paths.
fn bytes(format: Format, size: [f64; 2], paths: &[GimpPath], options: &CommonOptions) -> Result<Vec<u8>, Failure> {
    match format {
        Format::PointList => Ok(to_json(Some(size), paths).into_bytes()),
        Format::Xcf => Ok(new_xcf(size.map(|v| v.ceil().clamp(1.0, 524_288.0) as u32), paths)),
        drawing => {
            let svg = to_svg(size, paths, None);
            Ok(export::drawing(svg, drawing, &ReadOptions::default(), options, None)?.bytes)
        }
    }
}

/// A file name for every path, distinct even on file systems that ignore case.
fn names(out: &Path, format: Format, paths: &[GimpPath]) -> Vec<PathBuf> {
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    let extension = out.extension().map_or_else(|| format.extension().into(), |e| e.to_string_lossy());
    let mut taken = HashSet::new();
    // The next number of each name, so that many paths of one name do not try all numbers.
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
