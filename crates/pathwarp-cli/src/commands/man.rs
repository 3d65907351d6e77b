//! `pathwarp man`: the manual page.

use crate::failure::Failure;
use crate::output;
use crate::status::Status;
use clap::Command;

pub(super) const NAME: &str = "man";

pub(super) fn command() -> Command {
    Command::new(NAME).about("Print the manual page")
}

/// Prints the manual page of `whole`, the program's command line.
pub(super) fn run(whole: Command) -> Result<Status, Failure> {
    let mut out = Vec::new();
    clap_mangen::Man::new(whole).render(&mut out).map_err(|e| Failure::stdout(&e))?;
    output::to_stdout(&out)?;
    Ok(Status::Complete)
}
