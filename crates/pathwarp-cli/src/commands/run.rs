//! `pathwarp run RECIPE [INPUT…]`: runs a saved recipe. The options given override the recipe's.

use super::file_args;
use crate::failure::Failure;
use crate::options::{self, Given, OPTIONS};
use crate::status::Status;
use crate::steps::INVERSE;
use crate::{pipeline, recipe_file};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command};
use pathwarp::deform::Registry;
use pathwarp::param::Kind;
use pathwarp::recipe::{Recipe, Step};
use std::collections::BTreeMap;
use std::ffi::OsString;

pub(super) const NAME: &str = "run";

pub(super) fn command(registry: &Registry) -> Command {
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
        .args(parameters(registry))
        .args_override_self(true)
        .after_help(
            "A recipe:\n  pathwarp = 1\n  [options]\n  tolerance = \"0.01\"\n  [[step]]\n  deformation = \"shaper\"\n  \
             shaper = \"cage.svg#flag\"   # relative to the recipe's own folder\n  select = [\"#logo\"]           # this step holds for a part only; also exclude\n\nExamples:\n  pathwarp shaper logo.svg \
             --shaper cage.svg -o out.svg --write-recipe flag.toml\n  pathwarp run flag.toml other.svg -o other-out.svg\n  pathwarp run \
             flag.toml other.svg --bottom 2 -o other-out.svg   # overrides the recipe's value",
        )
}

/// The parameters of all deformations, which override the recipe's: hidden, as the recipe decides which of them apply.
fn parameters(registry: &Registry) -> Vec<Arg> {
    let mut known: BTreeMap<&'static str, bool> = BTreeMap::new();
    for p in registry.entries().iter().flat_map(|e| e.info().params) {
        *known.entry(p.name).or_insert(true) &= p.kind == Kind::Flag;
    }
    let taken = |name: &str| name == INVERSE || OPTIONS.iter().any(|o| o.name == name);
    let arg = |(name, is_flag): (&'static str, bool)| {
        let arg = Arg::new(name).long(name).hide(true);
        if is_flag { arg.action(ArgAction::SetTrue) } else { arg.action(ArgAction::Append).allow_hyphen_values(true) }
    };
    known.into_iter().filter(|(name, _)| !taken(name)).map(arg).collect()
}

/// Sets the parameters given on the command line in the only step that has them.
fn override_parameters(registry: &Registry, recipe: &mut Recipe, m: &ArgMatches) -> Result<(), Failure> {
    for id in m.ids() {
        let name = id.as_str();
        if m.value_source(name) != Some(ValueSource::CommandLine) || OPTIONS.iter().any(|o| o.name == name) {
            continue;
        }
        let has = |step: &Step| {
            registry.get(&step.deformation).is_some_and(|e| e.info().params.iter().any(|p| p.name == name))
        };
        if !registry.entries().iter().any(|e| e.info().params.iter().any(|p| p.name == name)) {
            continue;
        }
        let mut steps: Vec<&mut Step> = recipe.steps.iter_mut().filter(|s| has(s)).collect();
        let values = || m.get_raw(name).into_iter().flatten().map(|v| v.to_string_lossy().into_owned()).collect();
        match steps.as_mut_slice() {
            [only] => only.args.set(name, values()),
            [] => return Err(Failure::usage(format!("no step of the recipe has --{name}"))),
            several => {
                let problem = "steps of the recipe have it; change it in the recipe";
                return Err(Failure::usage(format!("--{name}: {} {problem}", several.len())));
            }
        }
    }
    Ok(())
}

pub(super) fn run(registry: &Registry, m: &ArgMatches, words: &[OsString]) -> Result<Status, Failure> {
    let file = file_args::given(m, "RECIPE")?;
    let mut saved = recipe_file::read(registry, file, Given::reading(m)?.external)?;
    override_parameters(registry, &mut saved.recipe, m)?;
    let given = saved.options.overridden_by(&Given::inputs_and_options(m));
    super::deformation::mistaken(words, &given)?;
    // The command line alone has no conflicts, so one that shows up now involves the recipe.
    given.check_conflicts().map_err(|e| Failure::file(file, format!("[options] {e}")))?;
    let recipe = if m.get_flag(INVERSE) { saved.recipe.inverted() } else { saved.recipe };
    pipeline::run(registry, &recipe, &given, Some(file))
}
