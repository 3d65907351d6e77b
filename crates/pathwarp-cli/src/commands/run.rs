//! `pathwarp run RECIPE [INPUT…]`: runs a saved recipe. The options given override the recipe's.

use super::file_args;
use crate::failure::Failure;
use crate::options::{self, Given};
use crate::status::Status;
use crate::steps::INVERSE;
use crate::{pipeline, recipe_file};
use clap::{Arg, ArgAction, ArgMatches, Command};
use pathwarp::deform::Registry;

pub(super) const NAME: &str = "run";

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("Run a recipe file that --write-recipe saved")
        .arg(file_args::file("RECIPE", "A recipe (TOML)"))
        .arg(
            Arg::new(INVERSE)
                .long(INVERSE)
                .action(ArgAction::SetTrue)
                .help("Apply the inverse of every step, the last first (give --frame: the source's box)"),
        )
        .args(options::args())
        .args_override_self(true)
        .after_help(
            "A recipe:\n  pathwarp = 1\n  [options]\n  tolerance = \"0.01\"\n  [[step]]\n  deformation = \"shaper\"\n  \
             shaper = \"cage.svg#flag\"   # relative to the recipe's own folder\n\nExamples:\n  pathwarp shaper logo.svg \
             --shaper cage.svg -o out.svg --write-recipe flag.toml\n  pathwarp run flag.toml other.svg -o other-out.svg",
        )
}

pub(super) fn run(registry: &Registry, m: &ArgMatches) -> Result<Status, Failure> {
    let file = file_args::given(m, "RECIPE")?;
    let saved = recipe_file::read(registry, file)?;
    let given = saved.options.overridden_by(&Given::inputs_and_options(m));
    // The command line alone has no conflicts, so one that shows up now involves the recipe.
    given.check_conflicts().map_err(|e| Failure::file(file, format!("[options] {e}")))?;
    let recipe = if m.get_flag(INVERSE) { saved.recipe.inverted() } else { saved.recipe };
    pipeline::run(registry, &recipe, &given, Some(file))
}
