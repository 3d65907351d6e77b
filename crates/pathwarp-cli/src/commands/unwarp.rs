//! `pathwarp unwarp FILE`: restores the source of a drawing that was written with `--embed-recipe`.

use super::file_args;
use crate::failure::Failure;
use crate::options::{self, Given};
use crate::status::Status;
use crate::{input, output};
use clap::{Arg, ArgAction, ArgMatches, Command};
use pathwarp_svg::Origin;

pub(super) const NAME: &str = "unwarp";

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("Restore the source of a drawing written with --embed-recipe, byte for byte")
        .arg(file_args::file("FILE", "The warped drawing; - is standard input"))
        .arg(file_args::out("OUT", "Write the source to this file; - or none writes to standard output"))
        .arg(Arg::new("recipe").long("recipe").action(ArgAction::SetTrue).help("Write the recipe instead of the source"))
        .args(options::reading_args())
        .after_help("Example:\n  pathwarp unwarp warped.svg -o source.svg\n  pathwarp unwarp --recipe warped.svg -o recipe.toml")
}

pub(super) fn run(m: &ArgMatches) -> Result<Status, Failure> {
    let file = file_args::given(m, "FILE")?;
    let target = file_args::target(m, [file])?;
    let name = input::display(file);
    let bytes = input::bytes(file)?;
    let limits = Given::reading(m)?.limits.for_input(bytes.len());
    let origin = Origin::of_file(&bytes, &name, &limits).map_err(|e| Failure::from(e).about(&name))?;
    let lacks =
        |what: &str| Failure::Input(format!("{name}: holds no {what}; only drawings written with --embed-recipe do"));
    let origin = origin.ok_or_else(|| lacks("source"))?;
    if m.get_flag("recipe") && origin.recipe.trim().is_empty() {
        return Err(lacks("recipe"));
    }
    let bytes = if m.get_flag("recipe") { origin.recipe.into_bytes() } else { origin.source };
    output::write(target, &bytes)?;
    Ok(Status::Complete)
}
