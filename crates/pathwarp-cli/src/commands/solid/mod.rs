//! `pathwarp solid …` deforms models: one subcommand for each deformation of space, and `map`, `run` and `list`.

mod args;
mod bend;
mod model;
mod report;
mod warp;

use crate::arguments::{self, reading_args};
use crate::commands::args::{file_arg, given_file, switch};
use crate::commands::map::{points_args, print_images, read_points};
use crate::ending::{Ending, Status};
use crate::steps;
use args::{SolidOptions, frame_arg, given_frame, model_args, options};
use clap::{ArgMatches, Command};
use pathwarp::GeometryError;
use pathwarp::budget::Budget;
use pathwarp::deform::Info;
use pathwarp::recipe::Recipe;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::options::Given;
use pathwarp_engine::steps::INVERSE;
use pathwarp_engine::{output, recipe_file, references};
use pathwarp_solid::deform::Registry3;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::map::{Creases3, Jet3, Map3};
use pathwarp_solid::{Box3, Frame3, recipe};
use std::ffi::OsString;
use std::fmt::Write as _;
use std::sync::Arc;

const ABOUT: &str = "Deform solids: meshes, curved surfaces and points in space";

const AFTER: &str =
    "Space is x right, y up, z towards the viewer. A unit of a model counts as a millimetre, so 5mm is 5; \
percentages refer to the model's box and count from its left, bottom and back.

Chains: pathwarp solid ffd IN.obj --move … + anamorph --eye … -o OUT.obj
All steps are composed; percentages of a later step refer to the model as it is by then.

Exit codes: as of pathwarp itself (`pathwarp help`).";

pub(super) fn solid_command() -> Command {
    let registry = Registry3::builtin();
    let deformations = registry.entries().iter().map(|e| warp::command(&e.about().info));
    Command::new("solid")
        .about(ABOUT)
        .after_help(AFTER)
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands(deformations)
        .subcommands([map_command(&registry), run_command(), list_command()])
}

/// Runs a subcommand; `further_parts` are those of a chain, after each `+`.
pub(super) fn solid(m: &ArgMatches, further_parts: &[&[OsString]]) -> Result<Status, Ending> {
    let registry = Registry3::builtin();
    let Some((name, m)) = m.subcommand() else { return Err(Failure::usage("a deformation is required").into()) };
    match name {
        "map" => map(&registry, m, further_parts),
        _ if registry.get(name).is_some() => {
            let mut recipe = Recipe { steps: vec![steps::step(&registry, name, m)] };
            let mut given = Given::default();
            for part in steps::parts(&registry, further_parts, &options())? {
                recipe.steps.push(part.step);
                given = given.joined(&part.options)?;
            }
            let given = given.joined(&arguments::given(m))?;
            Ok(warp::run(&registry, &recipe, &given, &SolidOptions::read(m)?, None)?)
        }
        _ if !further_parts.is_empty() => {
            Err(Failure::usage(format!("{name} is not a deformation of space; `+` chains deformations")).into())
        }
        "run" => Ok(run_recipe(&registry, m)?),
        _ => Ok(list(&registry)?),
    }
}

fn list_command() -> Command {
    Command::new("list").about("List the deformations of space")
}

fn list(registry: &Registry3) -> Result<Status, Failure> {
    let width = registry.entries().iter().map(|e| e.about().info.name.len()).max().unwrap_or(0);
    let mut out = String::new();
    for e in registry.entries() {
        let _ = writeln!(out, "{:width$}  {}", e.about().info.name, e.about().info.title);
    }
    out.push_str("\n`pathwarp help solid NAME` describes one; `+` chains several.\n");
    output::to_stdout(out.as_bytes())?;
    Ok(Status::Complete)
}

fn map_command(registry: &Registry3) -> Command {
    let deformation = |info: &Info| {
        let command = Command::new(info.name).about(info.title).args(steps::args(info));
        command.args(points_args()).arg(frame_arg())
    };
    Command::new("map")
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

/// Runs `map`; `further_parts` are those of the chain, after each `+`.
fn map(registry: &Registry3, m: &ArgMatches, further_parts: &[&[OsString]]) -> Result<Status, Ending> {
    let reading = arguments::reading(m)?;
    let Some((name, m)) = m.subcommand() else { return Err(Failure::usage("a deformation is required").into()) };
    let mut recipe = Recipe { steps: vec![steps::step(registry, name, m)] };
    recipe.steps.extend(steps::parts(registry, further_parts, &[])?.into_iter().map(|part| part.step));
    references::resolve_files(registry, &mut recipe, &reading)?;
    let (points, bytes) = read_points(m, "three numbers x y z")?;
    let points: Vec<DVec3> = points.into_iter().map(DVec3::from).collect();
    let bounds = Box3::around(points.iter().copied()).unwrap_or(Box3 { min: DVec3::ZERO, max: DVec3::ZERO });
    let frame = Frame3::new(given_frame(m)?.unwrap_or(bounds));
    let budget = Arc::new(Budget::new(reading.limits.for_input(bytes)));
    let built = recipe::build_within(&recipe, registry, frame, &points, &budget).map_err(Failure::of_recipe)?;
    let map = &built.map;
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    let mut jets = vec![Jet3::default(); points.len()];
    map.jets(&points, &mut jets);
    if let Some(e) = built.exceeded() {
        return Err(Failure::of_recipe(GeometryError::Limit(e).into()).into());
    }
    let image = |(p, jet): (&DVec3, &Jet3)| {
        let is_defined = creases.defined_at(*p) && jet.p.is_finite();
        (is_defined.then_some(jet.p.to_array()), jet.d.to_cols_array())
    };
    Ok(print_images(m, points.iter().zip(&jets).map(image))?)
}

fn run_command() -> Command {
    Command::new("run")
        .about("Run a recipe for solids that --write-recipe saved")
        .arg(file_arg("RECIPE", "A recipe (TOML) with solid = true"))
        .arg(switch(INVERSE, "Apply the inverse of every step, the last first (give --box: the source's box)"))
        .args(model_args())
}

fn run_recipe(registry: &Registry3, m: &ArgMatches) -> Result<Status, Failure> {
    let file = given_file(m, "RECIPE")?;
    let saved = recipe_file::read(registry, file, arguments::reading(m)?.external)?;
    let given = saved.options.overridden_by(&arguments::given(m));
    let recipe = if m.get_flag(INVERSE) { saved.recipe.inverted() } else { saved.recipe };
    warp::run(registry, &recipe, &given, &SolidOptions::read(m)?, Some(file))
}
