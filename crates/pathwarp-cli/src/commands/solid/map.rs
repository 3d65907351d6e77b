//! `pathwarp solid map DEFORMATION … --points FILE`: maps plain points of space.

use super::args;
use crate::commands::points;
use crate::failure::Failure;
use crate::options::{Given, reading_args};
use crate::status::Status;
use crate::{input, output, references, steps};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use pathwarp::GeometryError;
use pathwarp::budget::Budget;
use pathwarp::recipe::Recipe;
use pathwarp_solid::deform::Registry3;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::map::{Creases3, Jet3, Map3};
use pathwarp_solid::{Box3, Frame3, recipe};
use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Arc;

pub(super) const NAME: &str = "map";

pub(super) fn command(registry: &Registry3) -> Command {
    let points = Arg::new("points")
        .long("points")
        .value_name("FILE")
        .value_parser(value_parser!(PathBuf))
        .default_value("-")
        .help("File of points; - is standard input");
    let jacobian =
        Arg::new("jacobian").long("jacobian").action(ArgAction::SetTrue).help("Print the partial derivatives too");
    let deformation = |info: &pathwarp::deform::Info| {
        Command::new(info.name).about(info.title).args(steps::args(info)).args([
            points.clone(),
            jacobian.clone(),
            args::frame_arg(),
        ])
    };
    Command::new(NAME)
        .about("Map plain points, one x y z per line, by a deformation of space")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .args(reading_args())
        .after_help(
            "Every input line produces one output line: x' y' z', with --jacobian followed by the nine partial derivatives \
             x'x y'x z'x x'y y'y z'y x'z y'z z'z. Where the map is undefined, the line is nan nan nan and the exit code is 1. Empty \
             lines and lines that start with # are skipped.\n\nExample:\n  echo 50 50 50 | pathwarp solid map ffd --move \
             1,1,1:8,0,0 --box 0,0,0,100,100,100",
        )
        .subcommands(registry.entries().iter().map(|e| deformation(&e.about().info)))
}

/// Runs `map`; `later` holds the parts of the chain after each `+`.
pub(super) fn run(registry: &Registry3, m: &ArgMatches, later: &[&[OsString]]) -> Result<Status, Failure> {
    let reading = Given::reading(m)?;
    let Some((name, m)) = m.subcommand() else { return Err(Failure::usage("a deformation is required")) };
    let mut steps = Recipe { steps: vec![steps::step(registry, name, m)] };
    steps.steps.extend(steps::parts(registry, later, &[])?.into_iter().map(|part| part.step));
    references::resolve_files(registry, &mut steps, &reading)?;
    let file = m.get_one::<PathBuf>("points").cloned().unwrap_or_else(|| "-".into());
    let bytes = input::bytes(&file)?;
    let points = points::parse(&String::from_utf8_lossy(&bytes), "three numbers x y z")
        .map_err(|e| Failure::Input(format!("{}:{e}", input::display(&file))))?;
    let points: Vec<DVec3> = points.into_iter().map(DVec3::from).collect();
    let around = Box3::around(points.iter().copied()).unwrap_or(Box3 { min: DVec3::ZERO, max: DVec3::ZERO });
    let frame = Frame3::new(args::frame(m)?.unwrap_or(around));
    let budget = Arc::new(Budget::new(reading.limits.for_input(bytes.len())));
    let built = recipe::build_within(&steps, registry, frame, &points, &budget).map_err(Failure::of_recipe)?;
    let map = &built.map;
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    let mut jets = vec![Jet3::default(); points.len()];
    map.jets(&points, &mut jets);
    if let Some(e) = built.exceeded() {
        return Err(Failure::of_recipe(GeometryError::Limit(e).into()));
    }
    let mut out = String::new();
    let mut status = Status::Complete;
    for (p, j) in points.iter().zip(&jets) {
        if creases.defined_at(*p) && j.p.is_finite() {
            let _ = write!(out, "{} {} {}", j.p.x, j.p.y, j.p.z);
        } else {
            status = Status::Partial;
            out.push_str("nan nan nan");
        }
        if m.get_flag("jacobian") {
            j.d.to_cols_array().iter().for_each(|v| {
                let _ = write!(out, " {v}");
            });
        }
        out.push('\n');
    }
    output::to_stdout(out.as_bytes())?;
    Ok(status)
}
