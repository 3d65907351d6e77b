//! Arguments of subcommands: switches, words, and the files that many of them read and write.

use crate::sources::Files;
use clap::{Arg, ArgAction, ArgMatches, value_parser};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::output::is_stdout;
use std::path::{Path, PathBuf};

/// The id of the option for the output file.
const OUT: &str = "out";

/// A switch `--NAME`.
pub(super) fn switch(name: &'static str, help: &'static str) -> Arg {
    Arg::new(name).long(name).action(ArgAction::SetTrue).help(help)
}

/// An option `--NAME` with a value, which `value_name` stands for in help.
pub(super) fn option(name: &'static str, value_name: &'static str, help: &'static str) -> Arg {
    Arg::new(name).long(name).value_name(value_name).help(help)
}

/// An option `--NAME` whose value is one of these words.
pub(super) fn choice(name: &'static str, words: &[&'static str], help: &'static str) -> Arg {
    let arg = Arg::new(name).long(name).value_name(words.join("|")).value_parser(words.to_vec());
    arg.hide_possible_values(true).help(help)
}

/// A required file.
pub(super) fn file_arg(name: &'static str, help: &'static str) -> Arg {
    Arg::new(name).required(true).value_parser(value_parser!(PathBuf)).help(help)
}

/// Returns the file given for the required argument `name`.
pub(super) fn given_file<'a>(m: &'a ArgMatches, name: &str) -> Result<&'a Path, Failure> {
    let file = m.get_one::<PathBuf>(name).map(PathBuf::as_path);
    file.ok_or_else(|| Failure::usage(format!("{name} is required")))
}

/// The option `-o, --out`.
pub(super) fn out_arg(value_name: &'static str, help: &'static str) -> Arg {
    option(OUT, value_name, help).short('o').value_parser(value_parser!(PathBuf))
}

/// Returns the output file; `None` is standard output.
///
/// # Errors
/// [`Failure::Usage`] if the output is one of the files `read`.
pub(super) fn target(
    m: &ArgMatches,
    read: impl IntoIterator<Item = impl AsRef<Path>>,
) -> Result<Option<&Path>, Failure> {
    let target = m.get_one::<PathBuf>(OUT).map(PathBuf::as_path).filter(|o| !is_stdout(o));
    if let Some(to) = target {
        let mut files = Files::default();
        read.into_iter().for_each(|f| files.add_source(f.as_ref()));
        files.add_output(to, "")?;
    }
    Ok(target)
}
