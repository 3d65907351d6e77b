//! `pathwarp DEFORMATION …`: warps files by one deformation or a chain.

use crate::advice::mistakes;
use crate::failure::Failure;
use crate::options::{self, Given};
use crate::pipeline;
use crate::status::Status;
use crate::steps::{self, ChainPart};
use clap::{ArgMatches, Command};
use pathwarp::deform::{Info, Registry};
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
        .aliases(steps::aliases(info.name))
        .about(info.title)
        .long_about(format!("{} — {}\n\n{}", info.name, info.title, info.about))
        .after_help(examples)
        .args(steps::args(info))
}

/// Runs the deformation `name`, chained with those in `later`.
pub(super) fn run(
    registry: &Registry,
    name: &str,
    m: &ArgMatches,
    words: &[OsString],
    later: &[&[OsString]],
) -> Result<Status, Failure> {
    let first = ChainPart { step: steps::step(registry, name, m), options: Given::inputs_and_options(m) };
    let mut parts = vec![first];
    parts.extend(steps::parts(registry, later, &options::options_without_inputs().collect::<Vec<_>>())?);
    let (recipe, given) = steps::chained(parts)?;
    mistaken(words, &given)?;
    pipeline::run(registry, &recipe, &given, None)
}

/// Refuses inputs that are parts of something else.
pub(super) fn mistaken(words: &[OsString], given: &Given) -> Result<(), Failure> {
    mistakes::inputs(words, given.inputs(), given.gives("out") || given.gives("out-dir"))
        .map_or(Ok(()), |said| Err(Failure::Usage(said)))
}
