//! `pathwarp paths FILE`: lists the paths of a file.

use super::file_args;
use crate::failure::Failure;
use crate::input::{self, GimpFile};
use crate::options::{Given, reading_args};
use crate::status::Status;
use crate::{output, readable, terminal};
use clap::{Arg, ArgAction, ArgMatches, Command};
use pathwarp::decimal::trimmed;
use serde::Serialize;
use std::fmt::Write as _;

pub(super) const NAME: &str = "paths";

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("List the paths of a file: name, closed, anchors, points")
        .arg(file_args::file(
            "FILE",
            "An SVG file or a GIMP file (XCF, exported SVG, point list, GIMP 1 text); - is standard input",
        ))
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print JSON with every point"))
        .arg(
            Arg::new("salvage")
                .long("salvage")
                .action(ArgAction::SetTrue)
                .help("List the paths before the damage in a damaged GIMP file"),
        )
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

#[derive(Serialize)]
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

pub(super) fn run(m: &ArgMatches) -> Result<Status, Failure> {
    let file = file_args::given(m, "FILE")?;
    let reading = Given::reading(m)?;
    let gimp = GimpFile::open(file, m.get_flag("salvage"), &reading.limits)?;
    let mut paths = match &gimp {
        Some(gimp) => gimp.paths().map(of_gimp).collect(),
        None => of_drawing(&input::document(file, &reading)?),
    };
    let text = if m.get_flag("json") {
        if gimp.is_some() {
            // For GIMP files the JSON holds only stored data.
            paths.iter_mut().for_each(|p| p.bounds = None);
        }
        readable::json(&PathList { paths }).map_err(|e| Failure::file(file, e))? + "\n"
    } else {
        table(&paths)
    };
    output::to_stdout(text.as_bytes())?;
    let Some(damage) = gimp.and_then(|g| g.damage) else { return Ok(Status::Complete) };
    terminal::warning(&format!("{}: {damage}", input::display(file)));
    Ok(Status::Partial)
}

fn of_gimp(p: &pathwarp_gimp::GimpPath) -> ListedPath {
    ListedPath {
        name: p.name.clone(),
        label: None,
        title: None,
        element: None,
        visible: Some(p.visible),
        bounds: p.bounds().map(|[x0, y0, x1, y1]| [x0, y0, x1 - x0, y1 - y0]),
        strokes: p.strokes.iter().map(stroke).collect(),
    }
}

fn of_drawing(doc: &pathwarp_svg::Document) -> Vec<ListedPath> {
    doc.paths()
        .into_iter()
        .map(|p| ListedPath {
            name: p.id,
            label: p.label,
            title: p.title,
            element: Some(p.element),
            visible: None,
            bounds: p.outline.bounding_box().map(|b| [b.x0, b.y0, b.width(), b.height()]),
            strokes: p.outline.subpaths.iter().map(|s| stroke(&pathwarp_gimp::Stroke::from_subpath(s))).collect(),
        })
        .collect()
}

fn stroke(s: &pathwarp_gimp::Stroke) -> ListedStroke {
    ListedStroke { closed: s.closed, anchors: s.anchors(), points: s.points.clone() }
}

fn table(paths: &[ListedPath]) -> String {
    let mut out = String::new();
    let names: Vec<_> = paths.iter().map(|p| readable::name(&p.name)).collect();
    let width = output::column(names.iter().map(AsRef::as_ref));
    let what = if paths.iter().any(|p| p.visible.is_some()) { "visible" } else { "element" };
    let _ = writeln!(out, "{:width$}  {what:8}  {:7}  {:>7}  x y width height", "name", "closed", "anchors");
    for (p, name) in paths.iter().zip(names) {
        let closed: Vec<&str> = p.strokes.iter().map(|s| if s.closed { "closed" } else { "open" }).collect();
        let all_same = closed.windows(2).all(|w| w[0] == w[1]);
        let closed = if closed.is_empty() {
            "empty"
        } else if all_same {
            closed[0]
        } else {
            "mixed"
        };
        let anchors: Vec<String> = p.strokes.iter().map(|s| s.anchors.to_string()).collect();
        let anchors = if anchors.len() > 6 {
            format!("{} in {}", p.strokes.iter().map(|s| s.anchors).sum::<usize>(), anchors.len())
        } else {
            anchors.join("+")
        };
        let bounds = p.bounds.map_or(String::new(), |b| b.map(|v| trimmed(v, 6)).join(" "));
        let what = p.visible.map(|v| if v { "visible" } else { "hidden" }).or(p.element.as_deref()).unwrap_or_default();
        let _ = write!(out, "{name:width$}  {what:8}  {closed:7}  {anchors:>7}  {bounds}");
        if let Some(l) = p.label.as_ref().or(p.title.as_ref()) {
            let _ = write!(out, "  ({})", readable::name(l));
        }
        out.push('\n');
    }
    out
}
