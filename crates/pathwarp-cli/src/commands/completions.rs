//! `pathwarp completions SHELL`: a completion script.

use crate::failure::Failure;
use crate::output;
use crate::status::Status;
use clap::{Arg, ArgMatches, Command, value_parser};
use clap_complete::Shell;

pub(super) const NAME: &str = "completions";

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("Print completions for a shell")
        .arg(Arg::new("SHELL").required(true).value_parser(value_parser!(Shell)))
}

/// Prints the completions of `whole`, the program's command line.
pub(super) fn run(mut whole: Command, m: &ArgMatches) -> Result<Status, Failure> {
    let mut out = Vec::new();
    if let Some(shell) = m.get_one::<Shell>("SHELL") {
        clap_complete::generate(*shell, &mut whole, "pathwarp", &mut out);
    }
    output::to_stdout(&out)?;
    Ok(Status::Complete)
}
