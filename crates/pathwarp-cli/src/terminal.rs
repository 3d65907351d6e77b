//! Messages on standard error, coloured on a terminal.

use anstyle::{AnsiColor, Style};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::output::is_stdout;
use pathwarp_engine::readable;
use std::io::{self, IsTerminal as _};
use std::path::Path;

const ERROR: Style = AnsiColor::Red.on_default().bold();
const WARNING: Style = AnsiColor::Yellow.on_default().bold();
const NOTE: Style = AnsiColor::Cyan.on_default().bold();

fn print(style: Style, label: &str, message: &str) {
    anstream::eprintln!("{style}{label}{style:#}: {}", readable::safe_message(message));
}

pub(crate) fn error(message: &str) {
    print(ERROR, "error", message);
}

pub(crate) fn warning(message: &str) {
    print(WARNING, "warning", message);
}

pub(crate) fn note(message: &str) {
    print(NOTE, "note", message);
}

/// Refuses to write binary data to a terminal.
pub(crate) fn refuse_terminal(target: Option<&Path>, what: &str, extension: &str) -> Result<(), Failure> {
    let names_terminal = target.is_none_or(is_stdout) && io::stdout().is_terminal();
    if !names_terminal {
        return Ok(());
    }
    Err(Failure::usage(format!(
        "{what} would be written to the terminal; name a file with -o OUT.{extension}, or redirect it: > OUT.{extension}"
    )))
}

/// Returns the width of the column of names in a table.
pub(crate) fn column<'a>(names: impl Iterator<Item = &'a str>) -> usize {
    /// The width of the heading.
    const LEAST: usize = 4;
    /// Longer names exceed the column, since padding all lines to the longest would waste space.
    const MOST: usize = 60;
    names.map(|n| n.chars().count()).max().unwrap_or(LEAST).clamp(LEAST, MOST)
}
