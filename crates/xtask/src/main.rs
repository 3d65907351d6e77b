//! Chores of the workspace, run as `cargo xtask NAME`.

mod docs;
mod new_deformation;

use clap::{Arg, Command, value_parser};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What went wrong, for people.
type Fault = String;

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let matches = Command::new("cargo xtask")
        .about("Chores of the workspace")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand(
            Command::new("new-deformation")
                .about("Write a deformation's file, its lines in the registry and its test")
                .arg(Arg::new("NAME").required(true).help("kebab-case, e.g. swirl or square-wave"))
                .arg(
                    Arg::new("root")
                        .long("root")
                        .value_name("DIR")
                        .value_parser(value_parser!(PathBuf))
                        .help("The workspace to write to [default: this one]"),
                ),
        )
        .subcommand(Command::new("docs").about("Write a page and a picture for every deformation"))
        .get_matches();
    let done = match matches.subcommand() {
        Some(("new-deformation", m)) => {
            let name = m.get_one::<String>("NAME").map_or("", String::as_str);
            new_deformation::run(m.get_one::<PathBuf>("root").unwrap_or(&root), name)
        }
        Some(("docs", _)) => docs::run(&root),
        _ => Err("no such chore".into()),
    };
    match done {
        Ok(said) => {
            say(&said);
            ExitCode::SUCCESS
        }
        Err(fault) => {
            say(&format!("error: {fault}"));
            ExitCode::FAILURE
        }
    }
}

#[expect(clippy::print_stderr, reason = "a program's messages")]
fn say(text: &str) {
    eprintln!("{text}");
}
