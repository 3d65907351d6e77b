//! `pathwarp map DEFORMATION … --points FILE`: maps plain points, for scripts and for checks.

use crate::arguments::{self, reading_args};
use crate::commands::args::{option, switch};
use crate::commands::exact::{self, Curves};
use crate::ending::{Ending, Status};
use crate::steps;
use clap::{Arg, ArgMatches, Command, value_parser};
use pathwarp::GeometryError;
use pathwarp::budget::Budget;
use pathwarp::deform::{Built, Registry};
use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::{Creases, Jet, Map as _, preimages};
use pathwarp::outline::Outline;
use pathwarp::param::Frame;
use pathwarp::recipe::Recipe;
use pathwarp_engine::catalogue::Catalogue as _;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::input::{self, PlainArtwork, hatching};
use pathwarp_engine::options::{CommonOptions, Given, rect};
use pathwarp_engine::session::Session;
use pathwarp_engine::steps::INVERSE;
use pathwarp_engine::{output, references};
use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Arc;

/// The work for a point, relative to an evaluation of the map with the work of a fit around it, the unit of budgets.
const WORK_FOR_POINT: f64 = 0.25;
/// The work for all preimages of a point, in the same unit.
const WORK_FOR_PREIMAGES: f64 = 5000.0;

pub(super) fn map_command(registry: &Registry) -> Command {
    let mut c = Command::new("map")
        .about("Map plain points, one x y per line, by a deformation")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .args(reading_args())
        .after_help(
            "Every input line produces one output line: x' y', with --jacobian followed by the four partial derivatives \
             x'x y'x x'y y'y. Where the map is undefined, the line is nan nan and the exit code is 1. Empty lines and \
             lines that start with # are skipped.\n\nWith --inverse --all a line holds every point that the map takes there, \
             x y x y …, from left to right. For affine, projective, bilinear, birational, ffd, mesh, shaper and triangle, whose \
             coordinates are quotients of polynomials, and for flat anamorphoses, they are all points at which the map is defined, \
             inside and outside the frame, up to a million times its size away; for other maps, those that Newton's method finds \
             over the frame and half its size around it.\n\nWith --exact every control point of the exact image is a line x y weight, \
             and an empty line ends each curve. -o FILE.dxf writes them in millimetres (a px is 25.4/96 mm, y up), a spline with weights for \
             each contour, of degree 9 at most; -o FILE.json as `pathwarp solid` reads them, in the numbers given. A curve of degree p \
             keeps it under projective maps and has degree p n under others of degree n, p (m + n) under lattices of degree m x n.\n\nExample:\n  echo 50 50 | pathwarp map shaper --shaper cage.svg --frame \
             0,0,100,100 --points -",
        );
    let help = "Box that percentages and defaults refer to [default: the bounding box of the points]";
    let frame = option("frame", "X,Y,W,H", help).allow_hyphen_values(true);
    let all = switch("all", "Print all points that the maps of steps with --inverse lead back to").requires(INVERSE);
    let frame_and_all = [frame, all.conflicts_with("jacobian")];
    for info in registry.infos() {
        let command = Command::new(info.name).aliases(steps::alias(info.name)).about(info.title);
        let command = command.args(steps::args(info)).args(points_args()).args(frame_and_all.clone());
        c = c.subcommand(command.args(exact::args()));
    }
    c
}

/// The arguments for the file of points, and for derivatives.
pub(super) fn points_args() -> [Arg; 2] {
    let points = option("points", "FILE", "File of points; - is standard input");
    let points = points.value_parser(value_parser!(PathBuf)).default_value("-");
    [points, switch("jacobian", "Print the partial derivatives too")]
}

/// Reads the file of points named on the command line. Also returns its size in bytes.
pub(super) fn read_points<const N: usize>(m: &ArgMatches, wanted: &str) -> Result<(Vec<[f64; N]>, usize), Failure> {
    let file = m.get_one::<PathBuf>("points").cloned().unwrap_or_else(|| "-".into());
    let bytes = input::bytes(&file)?;
    let points = parse_points(&String::from_utf8_lossy(&bytes), wanted);
    Ok((points.map_err(|e| Failure::Input(format!("{}:{e}", input::display(&file))))?, bytes.len()))
}

/// Prints images, with their derivatives if requested; `None` where the map is undefined.
pub(super) fn print_images<const N: usize, const M: usize>(
    m: &ArgMatches,
    images: impl Iterator<Item = (Option<[f64; N]>, [f64; M])>,
) -> Result<Status, Failure> {
    let (mut out, mut is_partial) = (String::new(), false);
    for (image, derivatives) in images {
        is_partial |= image.is_none();
        let image = image.unwrap_or([f64::NAN; N]);
        let derivatives = derivatives.iter().filter(|_| m.get_flag("jacobian"));
        for (i, v) in image.iter().chain(derivatives).enumerate() {
            let space = if i > 0 { " " } else { "" };
            let _ = if i < N && v.is_nan() { write!(out, "{space}nan") } else { write!(out, "{space}{v}") };
        }
        out.push('\n');
    }
    output::to_stdout(out.as_bytes())?;
    Ok(Status::partial_if(is_partial))
}

/// Runs `map`; `later` holds the parts of the chain after each `+`.
pub(super) fn map(registry: &Registry, m: &ArgMatches, later: &[&[OsString]]) -> Result<Status, Ending> {
    let reading = arguments::reading(m)?;
    let Some((name, m)) = m.subcommand() else { return Err(Failure::usage("a deformation is required").into()) };
    let mut recipe = Recipe { steps: vec![steps::step(registry, name, m)] };
    recipe.steps.extend(steps::parts(registry, later, &[])?.into_iter().map(|part| part.step));
    references::resolve_files(registry, &mut recipe, &reading)?;
    let exact = Curves::read(m, &reading)?;
    let (points, bytes) = if exact.is_some() { (Vec::new(), 0) } else { read_points(m, "two numbers x y")? };
    let points: Vec<Point> = points.into_iter().map(|[x, y]| Point::new(x, y)).collect();
    let frame = match (m.get_one::<String>("frame"), &exact) {
        (Some(t), _) => rect(t).map_err(|e| Failure::usage(format!("--frame: {e}")))?.rect([1.0; 2]),
        (None, Some(curves)) => curves.bounds(),
        (None, None) => Outline::from_points(&points, false).bounding_box().unwrap_or(Rect::ZERO),
    };
    // Stands for artwork, which later steps and inverses examine.
    let hatching = hatching(frame);
    let budget = Arc::new(Budget::new(reading.limits.for_input(bytes)));
    let options = CommonOptions { reading, ..CommonOptions::default() };
    let session = Session { registry, recipe: &recipe, options: &options, given: &Given::default() };
    let outlines = vec![&hatching];
    let artwork = &mut PlainArtwork { outlines, frame: Frame::new(frame), budget: Arc::clone(&budget) };
    let built = session.ready(artwork, None)?.built.whole;
    let map = &built.map;
    let work = if m.get_flag("all") { WORK_FOR_PREIMAGES } else { WORK_FOR_POINT };
    let spent = budget.spend(work * map.cost().work * points.len() as f64);
    spent.map_err(|e| Failure::of_recipe(GeometryError::Limit(e).into()))?;
    if let Some(curves) = exact {
        return Ok(curves.write_images(map, m)?);
    }
    if m.get_flag("all") {
        return Ok(print_preimages(&points, &recipe, &built.steps, frame)?);
    }
    let mut creases = Creases::default();
    map.creases(&mut creases);
    let mut jets = vec![Jet::default(); points.len()];
    map.jets(&points, &mut jets);
    if let Some(e) = built.failure() {
        return Err(Failure::of_recipe(e).into());
    }
    let image = |(p, jet): (&Point, &Jet)| {
        let is_defined = creases.defined_at(*p) && jet.p.is_finite();
        (is_defined.then_some([jet.p.x, jet.p.y]), [jet.dx.x, jet.dx.y, jet.dy.x, jet.dy.y])
    };
    Ok(print_images(m, points.iter().zip(&jets).map(image))?)
}

/// Prints the image of each point under all steps, with every preimage for inverse steps.
fn print_preimages(points: &[Point], recipe: &Recipe, steps: &[Built], frame: Rect) -> Result<Status, Failure> {
    let mut all: Vec<Vec<Point>> = points.iter().map(|p| vec![*p]).collect();
    for (step, built) in recipe.steps.iter().zip(steps) {
        let forward = if step.inverse { built.map.inverse() } else { None };
        for set in &mut all {
            *set = match &forward {
                Some(map) => preimages(map, set, frame).concat(),
                None => set.iter().map(|p| built.map.point(*p)).filter(|p| p.is_finite()).collect(),
            };
        }
    }
    let mut out = String::new();
    for set in &all {
        let line: Vec<String> = set.iter().map(|p| format!("{} {}", p.x, p.y)).collect();
        let _ = writeln!(out, "{}", if set.is_empty() { "nan nan".into() } else { line.join(" ") });
    }
    output::to_stdout(out.as_bytes())?;
    Ok(Status::partial_if(all.iter().any(Vec::is_empty)))
}

/// Most characters of a wrong line in a message.
const SHOWN: usize = 60;

/// Parses points of N coordinates, separated by spaces, commas or tabs. Empty lines and lines that begin with `#` are skipped. The error
/// states the line's number, and that the line is not `wanted`.
fn parse_points<const N: usize>(text: &str, wanted: &str) -> Result<Vec<[f64; N]>, String> {
    let mut out = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let numbers = line.split([' ', ',', '\t']).filter(|w| !w.is_empty()).map(str::parse::<f64>);
        match numbers.collect::<Result<Vec<f64>, _>>().map(<[f64; N]>::try_from) {
            Ok(Ok(point)) if point.iter().all(|c| c.is_finite()) => out.push(point),
            _ => {
                let shown: String = line.chars().take(SHOWN).collect();
                return Err(format!("{}: `{shown}` is not {wanted}", i + 1));
            }
        }
    }
    Ok(out)
}
