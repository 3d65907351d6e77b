//! Chores, and the common parts of their command lines.

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use std::path::{Path, PathBuf};

/// An error message for the person at the terminal.
pub(crate) type ChoreError = String;

/// A subcommand of `cargo xtask`.
pub(crate) struct Chore {
    /// Declares the name and the options.
    pub(crate) command: fn() -> Command,
    /// Runs the chore and returns a summary to print.
    pub(crate) run: fn(&ArgMatches) -> Result<String, ChoreError>,
}

/// The root folder of this workspace.
pub(crate) fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// An option `--name VALUE` that takes a path.
pub(crate) fn path_option(name: &'static str, value: &'static str) -> Arg {
    Arg::new(name).long(name).value_name(value).value_parser(value_parser!(PathBuf))
}

/// An option `--name N` that takes a count.
pub(crate) fn count_option(name: &'static str, default: &'static str) -> Arg {
    Arg::new(name).long(name).value_name("N").value_parser(value_parser!(usize)).default_value(default)
}

/// An option `--name` without a value.
pub(crate) fn flag_option(name: &'static str) -> Arg {
    Arg::new(name).long(name).action(ArgAction::SetTrue)
}

/// The option `--program FILE`, which names the pathwarp to run.
pub(crate) fn program_option() -> Arg {
    path_option("program", "FILE").help("The pathwarp to run [default: build one]")
}

/// The values of a path option that may be given several times.
pub(crate) fn paths(arguments: &ArgMatches, name: &str) -> Vec<PathBuf> {
    arguments.get_many(name).unwrap_or_default().cloned().collect()
}

/// Returns a function that turns an error into a message that names `path`.
pub(crate) fn at<E: std::fmt::Display>(path: &Path) -> impl Fn(E) -> ChoreError {
    move |error| format!("{}: {error}", path.display())
}

/// Bytes as hexadecimal digits.
pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
