//! `pathwarp DEFORMATION …`: warps files by one deformation or a chain.

use crate::failure::Failure;
use crate::options::{self, Given};
use crate::status::Status;
use crate::{pipeline, steps};
use clap::{ArgMatches, Command};
use pathwarp::deform::{Info, Registry};
use pathwarp::recipe::Recipe;
use std::ffi::OsString;
use std::fmt::Write as _;

pub(super) fn command(info: &Info) -> Command {
    described(info).args(options::args())
}

/// The subcommand of a deformation, of the plane or of space, with its help and its own parameters.
pub(super) fn described(info: &Info) -> Command {
    let mut examples = String::from("Examples:");
    for e in info.examples {
        let _ = write!(examples, "\n  {}:\n    pathwarp {}", e.what, e.command);
    }
    let _ = write!(examples, "\n\nSource: {}", info.source);
    Command::new(info.name)
        .about(info.title)
        .long_about(format!("{} — {}\n\n{}", info.name, info.title, info.about))
        .after_help(examples)
        .args(steps::args(info))
}

/// Runs the deformation `name`, chained with those in `later`.
pub(super) fn run(registry: &Registry, name: &str, m: &ArgMatches, later: &[&[OsString]]) -> Result<Status, Failure> {
    let mut steps = vec![steps::step(registry, name, m)];
    let mut given = Given::default();
    for part in steps::parts(registry, later, &options::options_without_inputs().collect::<Vec<_>>())? {
        steps.push(part.step);
        given = given.joined(&part.options)?;
    }
    let given = given.joined(&Given::inputs_and_options(m))?;
    pipeline::run(registry, &Recipe { steps }, &given, None)
}
