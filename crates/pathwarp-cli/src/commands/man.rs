//! `pathwarp man [NAME]`: the manual page of the program or of one command; `--out-dir` writes all of them.

use crate::advice;
use crate::failure::Failure;
use crate::output::{self, PendingFile};
use crate::status::Status;
use clap::{Arg, ArgMatches, Command, value_parser};
use std::fs;
use std::path::{Path, PathBuf};

pub(super) const NAME: &str = "man";

/// The id of the argument.
const PAGE: &str = "PAGE";

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("Print the manual page of the program, or of one command")
        .arg(Arg::new(PAGE).value_name("NAME").help("A command or deformation [default: the program]"))
        .arg(
            Arg::new("out-dir")
                .long("out-dir")
                .value_name("DIR")
                .value_parser(value_parser!(PathBuf))
                .conflicts_with(PAGE)
                .help("Write the pages of the program and of all commands to this folder: pathwarp.1, pathwarp-NAME.1"),
        )
        .after_help(
            "Examples:\n  pathwarp man | man -l -\n  pathwarp man shaper | man -l -\n  pathwarp man --out-dir ~/.local/share/man/man1",
        )
}

/// Prints the manual page of `whole`, the program's command line, or of a part of it.
pub(super) fn run(whole: Command, m: &ArgMatches) -> Result<Status, Failure> {
    if let Some(folder) = m.get_one::<PathBuf>("out-dir") {
        return write_all(&whole, folder);
    }
    let page = match m.get_one::<String>(PAGE) {
        None => page(whole)?,
        Some(name) => {
            let known = whole.get_subcommands().map(Command::get_name);
            let part = whole.find_subcommand(name);
            page(subcommand(part.ok_or_else(|| Failure::usage(advice::unknown("command", name, known)))?))?
        }
    };
    output::to_stdout(&page)?;
    Ok(Status::Complete)
}

/// Writes every page to a folder, or none.
fn write_all(whole: &Command, folder: &Path) -> Result<Status, Failure> {
    fs::create_dir_all(folder).map_err(|e| Failure::output(folder, format!("cannot be created: {e}")))?;
    let all = std::iter::once(whole.clone()).chain(whole.get_subcommands().map(subcommand));
    let files = all.map(|command| {
        let file = folder.join(command.get_name()).with_extension("1");
        PendingFile::new(&file, &page(command)?)
    });
    PendingFile::commit_all(files.collect::<Result<_, Failure>>()?)?;
    Ok(Status::Complete)
}

/// A part of the program under the name of its page.
fn subcommand(part: &Command) -> Command {
    let name = part.get_name();
    part.clone().name(format!("pathwarp-{name}")).bin_name(format!("pathwarp {name}"))
}

/// The text of a page.
fn page(command: Command) -> Result<Vec<u8>, Failure> {
    let mut out = Vec::new();
    clap_mangen::Man::new(command).render(&mut out).map_err(|e| Failure::stdout(&e))?;
    Ok(out)
}
