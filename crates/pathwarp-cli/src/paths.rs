//! `pathwarp paths FILE`: what paths a file holds.

use crate::failure::Failure;
use crate::{Outcome, deform, output};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use pathwarp::kurbo::{CubicBez, Point};
use pathwarp::outline::{Seg, Subpath};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::PathBuf;

pub(crate) fn command() -> Command {
    Command::new("paths")
        .about("List the paths of a file: name, closed, anchors, points")
        .arg(Arg::new("FILE").required(true).value_parser(value_parser!(PathBuf)).help("An SVG file; - is standard input"))
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("As JSON, with every point"))
        .after_help(
            "Points are listed as drawing programs keep them: for every anchor its incoming handle, itself, its outgoing \
             handle. Arcs are listed as cubics.\n\nExamples:\n  pathwarp paths samples/cages.svg\n  pathwarp paths --json samples/cages.svg",
        )
}

#[derive(Serialize)]
struct List {
    paths: Vec<Path>,
}

#[derive(Serialize)]
struct Path {
    name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    label: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    title: Option<String>,
    element: String,
    bounds: Option<[f64; 4]>,
    strokes: Vec<Stroke>,
}

#[derive(Serialize)]
struct Stroke {
    closed: bool,
    anchors: usize,
    points: Vec<[f64; 2]>,
}

pub(crate) fn run(m: &ArgMatches) -> Result<Outcome, Failure> {
    let Some(file) = m.get_one::<PathBuf>("FILE") else { return Err(Failure::usage("FILE is needed")) };
    let doc = deform::document(file)?;
    let paths: Vec<Path> = doc
        .paths()
        .into_iter()
        .map(|p| Path {
            name: p.id,
            label: p.label,
            title: p.title,
            element: p.element,
            bounds: p.outline.bounding_box().map(|b| [b.x0, b.y0, b.width(), b.height()]),
            strokes: p.outline.subpaths.iter().map(stroke).collect(),
        })
        .collect();
    let text = if m.get_flag("json") {
        serde_json::to_string_pretty(&List { paths }).map_err(|e| Failure::file(file, e))? + "\n"
    } else {
        table(&paths)
    };
    output::to_stdout(text.as_bytes())?;
    Ok(Outcome::Done)
}

/// Anchors with their two handles; a line's handles lie on its anchors.
fn stroke(s: &Subpath) -> Stroke {
    let cubics: Vec<CubicBez> = s
        .segs
        .iter()
        .flat_map(|g| match g {
            Seg::Line(l) => vec![CubicBez::new(l.p0, l.p0, l.p1, l.p1)],
            Seg::Arc(a) => a.to_cubics(a.a.hypot().max(a.b.hypot()) * 1e-3).collect(),
            other => vec![other.to_cubic()],
        })
        .collect();
    let mut points: Vec<Point> = Vec::with_capacity(3 * cubics.len() + 3);
    for (i, c) in cubics.iter().enumerate() {
        let incoming = match i.checked_sub(1) {
            Some(before) => cubics[before].p2,
            None if s.closed => cubics.last().map_or(c.p0, |l| l.p2),
            None => c.p0,
        };
        points.extend([incoming, c.p0, c.p1]);
    }
    match cubics.last() {
        None => points.extend([s.start; 3]),
        Some(l) if !s.closed => points.extend([l.p2, l.p3, l.p3]),
        Some(_) => {}
    }
    Stroke { closed: s.closed, anchors: points.len() / 3, points: points.iter().map(|p| [p.x, p.y]).collect() }
}

fn table(paths: &[Path]) -> String {
    let mut out = String::new();
    let width = paths.iter().map(|p| p.name.chars().count()).max().unwrap_or(0).max(4);
    let _ = writeln!(out, "{:width$}  {:8}  {:7}  {:>7}  x y width height", "name", "element", "closed", "anchors");
    for p in paths {
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
        let bounds = p.bounds.map_or(String::new(), |b| {
            b.map(|v| format!("{v:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()).join(" ")
        });
        let _ = write!(out, "{:width$}  {:8}  {closed:7}  {anchors:>7}  {bounds}", p.name, p.element);
        if let Some(l) = p.label.as_ref().or(p.title.as_ref()) {
            let _ = write!(out, "  ({l})");
        }
        out.push('\n');
    }
    out
}
