//! `pathwarp man [NAME]`: the manual page of the program or of one command.

use crate::advice;
use crate::failure::Failure;
use crate::output;
use crate::status::Status;
use clap::{Arg, ArgMatches, Command};

pub(super) const NAME: &str = "man";

/// The id of the argument.
const PAGE: &str = "PAGE";

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("Print the manual page of the program, or of one command")
        .arg(Arg::new(PAGE).value_name("NAME").help("A command or deformation [default: the program]"))
}

/// Prints the manual page of `whole`, the program's command line, or of a part of it.
pub(super) fn run(mut whole: Command, m: &ArgMatches) -> Result<Status, Failure> {
    let mut out = Vec::new();
    if let Some(name) = m.get_one::<String>(PAGE) {
        let part = whole.find_subcommand(name).cloned();
        let known = whole.get_subcommands().map(Command::get_name);
        let part = part.ok_or_else(|| Failure::usage(advice::unknown("command", name, known)))?;
        whole = part.name(format!("pathwarp-{name}")).bin_name(format!("pathwarp {name}"));
    }
    clap_mangen::Man::new(whole).render(&mut out).map_err(|e| Failure::stdout(&e))?;
    output::to_stdout(&out)?;
    Ok(Status::Complete)
}
