//! Commands that extract the contents of a file: `convert` copies paths into another format, or a drawing into a PDF or DXF; `paths` lists
//! them; `unwarp` restores the source of a drawing that was written with `--embed-recipe`.

use crate::arguments::{self, OUTPUT_OPTIONS, reading_args, some_options};
use crate::commands::args::{file_arg, given_file, out_arg, switch, target};
use crate::commands::gimp_paths;
use crate::ending::Status;
use crate::terminal;
use clap::{ArgMatches, Command};
use pathwarp::engine::decimal::trimmed;
use pathwarp::kurbo::Point;
use pathwarp_engine::export::{self, Exported, KerfReport};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::format::{Choice, Format};
use pathwarp_engine::input::{self, GimpFile};
use pathwarp_engine::links::Destination;
use pathwarp_engine::options::CommonOptions;
use pathwarp_engine::{advice, output, readable};
use pathwarp_gimp::GimpPath;
use pathwarp_svg::{Document, NamedPath, Origin};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::Path;
use std::string::FromUtf8Error;

pub(super) fn convert_command() -> Command {
    Command::new("convert")
        .about("Copy the paths of a file (GIMP files, SVG) into an SVG, a point list or a new XCF, or a drawing into a PDF or DXF")
        .arg(file_arg("FILE", "A GIMP file or an SVG; FILE#NAME copies one path of a GIMP file"))
        .arg(out_arg(
            "OUT",
            "Output file: .svg, .svgz, .json (GIMP point list) or .xcf with the paths; of an SVG also .pdf with the whole \
             drawing, or .dxf with its outlines in mm; - or none writes to standard output",
        ))
        .args(some_options(&[&OUTPUT_OPTIONS[..], &["union", "quiet"]].concat()))
        .arg(switch("split", "Write every path to its own file, named after OUT and the path: out-NAME.svg").requires("out"))
        .arg(switch("salvage", "Copy the paths before the damage in a damaged file"))
        .args(reading_args())
        .after_help(
            "The SVG has its size in px and a matching viewBox, so that GIMP imports it without scaling; path names become ids. \
             Coordinates are written with the precision that GIMP stores.\n\nExamples:\n  pathwarp convert \
             art.xcf -o art.svg\n  pathwarp convert art.xcf#Cage -o cage.json\n  pathwarp convert art.xcf -o paths.svg --split\n  pathwarp convert art.xcf -o large.xcf --page-width 1200\n  pathwarp convert \
             drawing.svg -o drawing.pdf\n  pathwarp convert drawing.svg -o drawing.dxf --dxf-curves polyline",
        )
}

pub(super) fn convert(m: &ArgMatches) -> Result<Status, Failure> {
    let file = given_file(m, "FILE")?;
    let split = m.get_flag("split");
    // The files that --split writes are checked below.
    let target = target(m, (!split).then_some(file))?;
    convert_file(file, target, &arguments::given(m).read()?, split, m.get_flag("salvage"))
}

/// Copies the paths of a file into another format, or each to a file, or a drawing into a PDF or DXF; without a target, to standard output.
pub(crate) fn convert_file(
    file: &Path,
    target: Option<&Path>,
    options: &CommonOptions,
    split: bool,
    salvage: bool,
) -> Result<Status, Failure> {
    let choice = Choice { what: "paths are", among: FORMATS };
    let format = choice.format(target, options.format)?;
    match gimp_paths::copy(file, target, format, options, split, salvage)? {
        Some(status) => Ok(status),
        None => convert_drawing(file, target, format, options),
    }
}

/// Writes the drawing in an SVG as a PDF or DXF.
fn convert_drawing(
    file: &Path,
    target: Option<&Path>,
    format: Format,
    options: &CommonOptions,
) -> Result<Status, Failure> {
    let doc = input::document(file, &options.reading)?;
    let read = input::read_options(file, &options.reading);
    let Exported { bytes, warnings, kerf } =
        export::drawing(doc.decoded().into_owned(), (format, &Destination::Back), &read, options, None)?;
    let (unread, undrawn) = (doc.unread_images(), doc.undrawn());
    let is_undecided = kerf.as_ref().is_some_and(KerfReport::is_partial);
    let is_partial = is_undecided || !unread.is_empty() || !undrawn.is_empty();
    let lacking = advice::lacking(doc.missing_fonts(), &unread, &undrawn, &doc.notes()).into_iter();
    let warnings: Vec<String> = lacking.chain(warnings).collect();
    for warning in warnings.iter().filter(|_| !options.quiet) {
        terminal::warning(&format!("{}: {warning}", input::display(file)));
    }
    kerf.iter().filter(|_| !options.quiet).for_each(|k| terminal::note(&k.note()));
    output::write(target, &bytes)?;
    Ok(Status::partial_if(is_partial))
}

/// The formats that this command writes.
const FORMATS: &[Format] = &[Format::Svg, Format::Svgz, Format::Pdf, Format::Dxf, Format::PointList, Format::Xcf];

pub(super) fn paths_command() -> Command {
    Command::new("paths")
        .about("List the paths of a file: name, closed, anchors, points")
        .arg(file_arg(
            "FILE",
            "An SVG file or a GIMP file (XCF, exported SVG, point list, GIMP 1 text); - is standard input",
        ))
        .arg(switch("json", "Print JSON with every point"))
        .arg(switch("salvage", "List the paths before the damage in a damaged GIMP file"))
        .args(reading_args())
        .after_help(
            "Every anchor is listed as drawing programs store it: incoming handle, anchor, outgoing handle. Arcs are listed as \
             cubics. Numbers of GIMP files are listed exactly as stored.\n\nExamples:\n  pathwarp paths samples/cages.svg\n  pathwarp paths --json samples/cages.svg\n  pathwarp paths art.xcf",
        )
}

#[derive(Serialize)]
struct PathList {
    paths: Vec<ListedPath>,
}

#[derive(Default, Serialize)]
struct ListedPath {
    name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    label: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    title: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    element: Option<String>,
    /// GIMP's visibility switch.
    #[serde(skip_serializing_if = "Option::is_none")]
    visible: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bounds: Option<[f64; 4]>,
    strokes: Vec<ListedStroke>,
}

#[derive(Serialize)]
struct ListedStroke {
    closed: bool,
    anchors: usize,
    points: Vec<[f64; 2]>,
}

pub(super) fn list_paths(m: &ArgMatches) -> Result<Status, Failure> {
    let file = given_file(m, "FILE")?;
    let reading = arguments::reading(m)?;
    let is_json = m.get_flag("json");
    if let Some(gimp) = GimpFile::open(file, m.get_flag("salvage"), &reading.limits)? {
        // For GIMP files, the JSON contains only stored data.
        let path = |p| if is_json { ListedPath { bounds: None, ..of_gimp(p) } } else { of_gimp(p) };
        print(file, gimp.paths().map(path).collect(), is_json)?;
        let Some(damage) = gimp.damage else { return Ok(Status::Complete) };
        terminal::warning(&format!("{}: {damage}", input::display(file)));
        return Ok(Status::Partial);
    }
    print(file, of_drawing(&input::document(file, &reading)?), is_json)?;
    Ok(Status::Complete)
}

fn print(file: &Path, paths: Vec<ListedPath>, is_json: bool) -> Result<(), Failure> {
    let text = if is_json {
        readable::json(&PathList { paths }).map_err(|e| Failure::file(file, e))? + "\n"
    } else {
        table(&paths)
    };
    output::to_stdout(text.as_bytes())
}

fn of_gimp(p: &GimpPath) -> ListedPath {
    ListedPath {
        name: p.name.clone(),
        visible: Some(p.visible),
        bounds: p.bounds().map(|[x0, y0, x1, y1]| [x0, y0, x1 - x0, y1 - y0]),
        strokes: p.strokes.iter().map(|s| stroke(s.closed, s.triples())).collect(),
        ..ListedPath::default()
    }
}

fn of_drawing(doc: &Document) -> Vec<ListedPath> {
    let listed = |p: NamedPath| ListedPath {
        name: p.id,
        label: p.label,
        title: p.title,
        element: Some(p.element),
        visible: None,
        bounds: p.outline.bounding_box().map(|b| [b.x0, b.y0, b.width(), b.height()]),
        strokes: p.outline.subpaths.iter().map(|s| stroke(s.closed, s.with_handles().into_iter())).collect(),
    };
    doc.paths().into_iter().map(listed).collect()
}

fn stroke(closed: bool, with_handles: impl Iterator<Item = [Point; 3]>) -> ListedStroke {
    let points: Vec<[f64; 2]> = with_handles.flatten().map(|p| [p.x, p.y]).collect();
    ListedStroke { closed, anchors: points.len() / 3, points }
}

fn table(paths: &[ListedPath]) -> String {
    let mut out = String::new();
    let names: Vec<_> = paths.iter().map(|p| readable::safe_name(&p.name)).collect();
    let width = terminal::column(names.iter().map(AsRef::as_ref));
    let kind = if paths.iter().any(|p| p.visible.is_some()) { "visible" } else { "element" };
    let _ = writeln!(out, "{:width$}  {kind:8}  {:7}  {:>7}  x y width height", "name", "closed", "anchors");
    for (p, name) in paths.iter().zip(names) {
        let has = |closed: bool| p.strokes.iter().any(|s| s.closed == closed);
        let closed = match (has(true), has(false)) {
            (true, true) => "mixed",
            (true, false) => "closed",
            (false, true) => "open",
            (false, false) => "empty",
        };
        let anchors: Vec<String> = p.strokes.iter().map(|s| s.anchors.to_string()).collect();
        let anchors = if anchors.len() > 6 {
            format!("{} in {}", p.strokes.iter().map(|s| s.anchors).sum::<usize>(), anchors.len())
        } else {
            anchors.join("+")
        };
        let bounds = p.bounds.map_or(String::new(), |b| b.map(|v| trimmed(v, 6)).join(" "));
        let kind = p.visible.map(|v| if v { "visible" } else { "hidden" }).or(p.element.as_deref()).unwrap_or_default();
        let _ = write!(out, "{name:width$}  {kind:8}  {closed:7}  {anchors:>7}  {bounds}");
        if let Some(l) = p.label.as_ref().or(p.title.as_ref()) {
            let _ = write!(out, "  ({})", readable::safe_name(l));
        }
        out.push('\n');
    }
    out
}

pub(super) fn unwarp_command() -> Command {
    Command::new("unwarp")
        .about("Restore the source of a drawing written with --embed-recipe, byte for byte")
        .arg(file_arg("FILE", "The warped drawing; - is standard input"))
        .arg(out_arg("OUT", "Write the source to this file; - or none writes to standard output"))
        .arg(switch("recipe", "Write the recipe instead of the source"))
        .args(reading_args())
        .after_help("Example:\n  pathwarp unwarp warped.svg -o source.svg\n  pathwarp unwarp --recipe warped.svg -o recipe.toml")
}

pub(super) fn unwarp(m: &ArgMatches) -> Result<Status, Failure> {
    let file = given_file(m, "FILE")?;
    let target = target(m, [file])?;
    let name = input::display(file);
    let bytes = input::bytes(file)?;
    let reading = arguments::reading(m)?;
    let limits = reading.limits.for_input(bytes.len());
    let origin = Origin::of_file(&bytes, &name, &limits).map_err(|e| Failure::from(e).about(&name))?;
    let lacks =
        |what: &str| Failure::Input(format!("{name}: holds no {what}; only drawings written with --embed-recipe do"));
    let origin = origin.ok_or_else(|| lacks("source"))?;
    if m.get_flag("recipe") && origin.recipe.trim().is_empty() {
        return Err(lacks("recipe"));
    }
    let bytes = match (String::from_utf8(origin.source), Destination::of(target)) {
        _ if m.get_flag("recipe") => origin.recipe.into_bytes(),
        (Ok(text), to @ Destination::File(_)) => to.linked(text, &input::read_options(file, &reading))?.into_bytes(),
        (text, _) => text.map_or_else(FromUtf8Error::into_bytes, String::into_bytes),
    };
    output::write(target, &bytes)?;
    Ok(Status::Complete)
}
