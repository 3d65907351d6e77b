//! `pathwarp solid run RECIPE [MODEL]`: runs a saved recipe on a model.

use super::{args, warp};
use crate::commands::file_args;
use crate::failure::Failure;
use crate::options::Given;
use crate::recipe_file;
use crate::status::Status;
use crate::steps::INVERSE;
use clap::{Arg, ArgAction, ArgMatches, Command};
use pathwarp_solid::deform::Registry3;

pub(super) const NAME: &str = "run";

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("Run a recipe for solids that --write-recipe saved")
        .arg(file_args::file("RECIPE", "A recipe (TOML) with solid = true"))
        .arg(
            Arg::new(INVERSE)
                .long(INVERSE)
                .action(ArgAction::SetTrue)
                .help("Apply the inverse of every step, the last first (give --box: the source's box)"),
        )
        .args(args::all())
}

pub(super) fn run(registry: &Registry3, m: &ArgMatches) -> Result<Status, Failure> {
    let file = file_args::given(m, "RECIPE")?;
    let saved = recipe_file::read(registry, file, Given::reading(m)?.external)?;
    let given = saved.options.overridden_by(&Given::inputs_and_options(m));
    let recipe = if m.get_flag(INVERSE) { saved.recipe.inverted() } else { saved.recipe };
    warp::run(registry, &recipe, &given, &args::Own::read(m)?, Some(file))
}
