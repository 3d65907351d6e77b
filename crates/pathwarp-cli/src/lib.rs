//! The command line of pathwarp, for any registry of deformations.
//!
//! A program with additional deformations is this short:
//!
//! ```no_run
//! # use pathwarp::deform::Registry;
//! fn main() -> std::process::ExitCode {
//!     pathwarp_cli::main_with(Registry::builtin() /* .with(MyDeformation) */)
//! }
//! ```
//!
//! Exit codes: 0 success; 1 done, but something was left unchanged or, of several inputs, left out, or nothing is on the page of the result
//! (messages and the report give reasons); 2 wrong usage; 3 unreadable input, or input that exceeds a limit on work; 4 geometry without a
//! valid result; 5 unwritable output; 130 interrupted. On 2 to 5 no output file is touched. An interrupted run leaves finished results.

mod arguments;
mod commands;
mod data;
mod ending;
mod inkscape;
mod interruption;
mod mistakes;
mod pipeline;
mod plugins;
mod report_file;
mod sources;
mod steps;
mod terminal;
mod watch;

use ending::{Ending, Status};
use pathwarp::deform::Registry;
use pathwarp_engine::advice::Flags;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::temporaries;
use std::ffi::OsString;
use std::panic::{self, AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

/// Runs the program on the process's arguments.
#[must_use]
#[expect(clippy::needless_pass_by_value, reason = "a program hands over its registry here, once")]
pub fn main_with(registry: Registry) -> ExitCode {
    keep_sweeps_quiet();
    watch::allow();
    run(&registry, std::env::args_os())
}

/// Returns the whole command line of `registry` as a clap command, for man pages and completions.
#[must_use]
pub fn command(registry: &Registry) -> clap::Command {
    commands::build(registry)
}

/// Silences panics of linesweeper 0.5, which fails on the edges of some areas. The fitter catches them and sweeps in another direction
/// (`TURNS` in `bezierfit`); it reports an error if none succeeds.
fn keep_sweeps_quiet() {
    let print = panic::take_hook();
    panic::set_hook(Box::new(move |panic| {
        if !panic.location().is_some_and(|location| location.file().contains("linesweeper")) {
            print(panic);
        }
    }));
}

/// Runs the program on `args`, the first of which is the program's name.
#[must_use]
pub fn run(registry: &Registry, args: impl IntoIterator<Item = OsString>) -> ExitCode {
    temporaries::protect_by(interruption::handle);
    let args: Vec<OsString> = args.into_iter().collect();
    let dispatch = || {
        if inkscape::is_call(&args) {
            Ok(inkscape::run(registry, &args, commands::convert_file)?)
        } else {
            commands::dispatch(registry, &args)
        }
    };
    // A panic of a library is reported as an error of the file that caused it. Temporary files are removed.
    let outcome = catch_unwind(AssertUnwindSafe(dispatch)).unwrap_or_else(|_| {
        Err(Ending::from(Failure::Input("the program failed (see the message above); please report it".into())))
    });
    match outcome {
        Ok(Status::Complete) => ExitCode::SUCCESS,
        Ok(Status::Partial) => ExitCode::from(1),
        Err(ending) => {
            let flags = Flags::of(registry).with(Flags::of(&pathwarp_solid::deform::Registry3::builtin()));
            ending.show(&flags);
            ExitCode::from(ending.code())
        }
    }
}
