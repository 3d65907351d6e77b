//! `pathwarp completions SHELL`: a completion script.

use crate::catalogue::Catalogue as _;
use crate::failure::Failure;
use crate::output;
use crate::status::Status;
use clap::{Arg, ArgMatches, Command, value_parser};
use clap_complete::Shell;
use pathwarp::deform::Registry;
use pathwarp::param::Kind;

pub(super) const NAME: &str = "completions";

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("Print completions for a shell")
        .arg(Arg::new("SHELL").required(true).value_parser(value_parser!(Shell)))
}

/// Prints the completions of `whole`, the program's command line, with the values that parameters may have.
pub(super) fn run(registry: &Registry, mut whole: Command, m: &ArgMatches) -> Result<Status, Failure> {
    for info in registry.infos() {
        for p in info.params {
            if let Kind::NameOrFile(names) | Kind::Choice(names) = p.kind {
                whole = whole.mut_subcommand(info.name, |c| c.mut_arg(p.name, |a| a.value_parser(names.to_vec())));
            }
        }
    }
    let mut out = Vec::new();
    if let Some(shell) = m.get_one::<Shell>("SHELL") {
        clap_complete::generate(*shell, &mut whole, "pathwarp", &mut out);
    }
    output::to_stdout(&out)?;
    Ok(Status::Complete)
}
