//! `pathwarp unwarp FILE`: the source of a drawing that was written with `--embed-recipe`.

use crate::failure::Failure;
use crate::output::Pending;
use crate::{Outcome, deform, output};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use pathwarp_svg::Origin;
use std::path::PathBuf;

pub(crate) fn command() -> Command {
    Command::new("unwarp")
        .about("Give back the source of a drawing written with --embed-recipe, byte for byte")
        .arg(Arg::new("FILE").required(true).value_parser(value_parser!(PathBuf)).help("The warped drawing; - is standard input"))
        .arg(
            Arg::new("out")
                .short('o')
                .long("out")
                .value_name("OUT")
                .value_parser(value_parser!(PathBuf))
                .help("Where to write it; - or none writes to standard output"),
        )
        .arg(Arg::new("recipe").long("recipe").action(ArgAction::SetTrue).help("The recipe instead of the source"))
        .after_help("Example:\n  pathwarp unwarp warped.svg -o source.svg\n  pathwarp unwarp --recipe warped.svg -o recipe.toml")
}

pub(crate) fn run(m: &ArgMatches) -> Result<Outcome, Failure> {
    let Some(file) = m.get_one::<PathBuf>("FILE") else { return Err(Failure::usage("FILE is needed")) };
    let name = deform::display(file);
    let text = String::from_utf8(deform::read(file)?).map_err(|_| Failure::file(file, "is not UTF-8 text"))?;
    let origin = Origin::read(&text).map_err(|e| Failure::from(e).about(&name))?;
    let origin =
        origin.ok_or_else(|| Failure::file(file, "holds no source; it was not written with --embed-recipe"))?;
    let bytes = if m.get_flag("recipe") { origin.recipe.into_bytes() } else { origin.source };
    match m.get_one::<PathBuf>("out").filter(|o| o.as_os_str() != "-") {
        Some(out) => Pending::commit_all(vec![Pending::new(out, &bytes)?])?,
        None => output::to_stdout(&bytes)?,
    }
    Ok(Outcome::Done)
}
