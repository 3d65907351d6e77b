//! The command line of pathwarp, for any registry of deformations.
//!
//! A program with deformations of its own is this short:
//!
//! ```no_run
//! # use pathwarp::deform::Registry;
//! fn main() -> std::process::ExitCode {
//!     pathwarp_cli::main_with(Registry::builtin() /* .with(MyDeformation) */)
//! }
//! ```
//!
//! Exit codes: 0 all done; 1 done, but something was left as it was (the report says what); 2 wrong usage; 3 input unreadable;
//! 4 the geometry forbids it. On 2, 3 and 4 no output file is touched.

mod command;
mod common;
mod compare;
mod convert;
mod data_file;
mod deform;
mod failure;
mod flags;
mod gallery;
mod gimp;
mod install;
mod output;
mod paths;
mod picture;
mod preview;
mod query;
mod recipe_file;
mod reference;
mod render;
mod report;
mod schema;
mod space;
mod terminal;
mod text;
mod unwarp;

pub use picture::Bender;

use clap::ArgMatches;
use failure::Failure;
use pathwarp::deform::Registry;
use std::ffi::OsString;
use std::process::ExitCode;

/// What a run came to when it did not fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// All done.
    Done,
    /// Done, but something was left as it was.
    Partly,
}

/// Runs the program on the process's arguments.
#[must_use]
#[expect(clippy::needless_pass_by_value, reason = "a program gives its registry away here, once")]
pub fn main_with(registry: Registry) -> ExitCode {
    run(&registry, std::env::args_os())
}

/// The whole command line of `registry` as clap knows it: for man pages and completions.
#[must_use]
pub fn command(registry: &Registry) -> clap::Command {
    command::build(registry)
}

/// Runs the program on `args`, the first of which is the program's name.
#[must_use]
pub fn run(registry: &Registry, args: impl IntoIterator<Item = OsString>) -> ExitCode {
    flags::know(registry);
    match dispatch(registry, &args.into_iter().collect::<Vec<_>>()) {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Partly) => ExitCode::from(1),
        Err(failure) => {
            failure.show();
            ExitCode::from(failure.code())
        }
    }
}

fn dispatch(registry: &Registry, args: &[OsString]) -> Result<Outcome, Failure> {
    // `A … + B …`: every part after a lone + is a command line of its own, all but the first without inputs.
    let mut parts = args.split(|a| a == "+").map(<[OsString]>::to_vec);
    let mut first = parts.next().unwrap_or_default();
    let rest: Vec<_> = parts.collect();
    let mut matches = command::build(registry).try_get_matches_from(&first)?;
    let is_deformation = |m: &ArgMatches| m.subcommand_name().is_some_and(|name| registry.get(name).is_some());
    let mut steps = Vec::new();
    if is_deformation(&matches) {
        let words;
        (steps, words) = command::chain(registry, &rest)?;
        if !words.is_empty() {
            // Behind the deformation's name: what follows a lone -- are inputs.
            let at = first.len().min(2);
            first.splice(at..at, words);
            matches = command::build(registry).try_get_matches_from(&first)?;
        }
    }
    let Some((name, sub)) = matches.subcommand() else {
        return Err(Failure::usage("no command is given; `pathwarp list` shows the deformations"));
    };
    if !is_deformation(&matches) && name != "map" && !rest.is_empty() {
        return Err(Failure::usage(format!("`+` chains deformations; {name} is none")));
    }
    match name {
        "list" => command::list(registry),
        "completions" => command::completions(registry, sub),
        "man" => command::man(registry),
        "paths" => paths::run(sub),
        "convert" => convert::run(sub),
        "install" => install::run(sub),
        "render" => render::run(sub),
        "gallery" => gallery::run(registry, sub),
        "text" => text::run(sub),
        "schema" => schema::run(registry),
        "unwarp" => unwarp::run(sub),
        "run" => {
            let (recipe, merged) = command::run_recipe(registry, &first, sub)?;
            deform::run(registry, &recipe, &merged)
        }
        "map" => query::run(registry, sub, &rest),
        "compare" => compare::run(sub),
        _ => deform::run(registry, &command::recipe(registry, name, sub, steps), sub),
    }
}
