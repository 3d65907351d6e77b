//! `pathwarp solid …`: deforms meshes. One subcommand per deformation of space, and `map`, `run` and `list`.

mod args;
mod drawing;
mod format;
mod list;
mod map;
mod model;
mod polygons;
mod preview;
mod report;
mod run;
mod surfaces;
mod warp;
mod work;

use crate::failure::Failure;
use crate::options::Given;
use crate::status::Status;
use crate::steps;
use clap::{ArgMatches, Command};
use pathwarp::recipe::Recipe;
use pathwarp_solid::deform::Registry3;
use std::ffi::OsString;

pub(super) const NAME: &str = "solid";

const ABOUT: &str = "Deform solids: meshes, curved surfaces and points in space";

const AFTER: &str =
    "Space is x right, y up, z towards the viewer. A unit of a model counts as a millimetre, so 5mm is 5; \
percentages refer to the model's box and count from its left, bottom and back.

Chains: pathwarp solid ffd IN.obj --move … + anamorph --eye … -o OUT.obj
All steps are composed; percentages of a later step refer to the model as it is by then.

Exit codes: as of pathwarp itself (`pathwarp help`).";

pub(super) fn command() -> Command {
    let registry = Registry3::builtin();
    let deformations = registry.entries().iter().map(|e| warp::command(&e.about().info));
    Command::new(NAME)
        .about(ABOUT)
        .after_help(AFTER)
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands(deformations)
        .subcommands([map::command(&registry), run::command(), list::command()])
}

/// Runs a subcommand; `later` holds the parts of a chain after each `+`.
pub(super) fn run(m: &ArgMatches, later: &[&[OsString]]) -> Result<Status, Failure> {
    let registry = Registry3::builtin();
    let Some((name, m)) = m.subcommand() else { return Err(Failure::usage("a deformation is required")) };
    match name {
        map::NAME => map::run(&registry, m, later),
        _ if registry.get(name).is_some() => {
            let mut recipe = Recipe { steps: vec![steps::step(&registry, name, m)] };
            let mut given = Given::default();
            for part in steps::parts(&registry, later, &args::options())? {
                recipe.steps.push(part.step);
                given = given.joined(&part.options)?;
            }
            let given = given.joined(&Given::inputs_and_options(m))?;
            warp::run(&registry, &recipe, &given, &args::Own::read(m)?, None)
        }
        _ if !later.is_empty() => {
            Err(Failure::usage(format!("{name} is not a deformation of space; `+` chains deformations")))
        }
        run::NAME => run::run(&registry, m),
        _ => list::run(&registry),
    }
}
