//! `cargo xtask outputs`: a fingerprint of everything the program writes, to show that a restructuring changes no output.
//!
//! `--store FILE` runs every command of the cookbook, of the guides and of the help pages that needs only samples, and one over
//! each drawing of the given folders, and writes one line per command: a hash of all its output, and the command. `--check FILE` runs the same
//! commands again and lists those whose hash differs.
//!
//! Wording is not compared: standard error is ignored, messages and times are removed from reports, and descriptions from the
//! schema.

mod commands;
mod hashes;

use crate::chore::{Chore, ChoreError, at, count_option, path_option, paths, program_option, workspace};
use crate::shell;
use clap::{ArgAction, ArgMatches, Command};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// See the module.
pub(crate) const CHORE: Chore = Chore { command, run };

fn command() -> Command {
    Command::new("outputs")
        .about("Store a hash of everything the program writes, or compare with stored hashes")
        .arg(
            path_option("store", "FILE")
                .conflicts_with("check")
                .required_unless_present("check")
                .help("Run every example and write the hashes to FILE"),
        )
        .arg(path_option("check", "FILE").help("Run the commands of FILE again and list those with other output"))
        .arg(
            path_option("drawings", "FOLDER")
                .action(ArgAction::Append)
                .help("Also warp drawings from this folder; may be given several times"),
        )
        .arg(count_option("count", "300").help("Take at most N drawings from each folder"))
        .arg(count_option("every", "1").help("Check every Nth command only"))
        .arg(program_option())
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let root = &workspace();
    let program = &shell::program(root, arguments)?;
    let number = |name: &str| arguments.get_one(name).copied().unwrap_or(1);
    match (arguments.get_one::<PathBuf>("store"), arguments.get_one::<PathBuf>("check")) {
        (Some(file), _) => store(root, program, file, &paths(arguments, "drawings"), number("count")),
        (None, Some(file)) => check(root, program, file, number("every")),
        (None, None) => Err("neither --store nor --check is given".into()),
    }
}

/// Writes the hash and the text of every command to `file`.
fn store(root: &Path, program: &Path, file: &Path, drawings: &[PathBuf], count: usize) -> Result<String, ChoreError> {
    let lines = commands::all(root, program, drawings, count)?;
    let hashes = hashes::of_all(root, program, &lines)?;
    let text: String = hashes.iter().zip(&lines).map(|(h, l)| format!("{h} {l}\n")).collect();
    fs::write(file, text).map_err(at(file))?;
    Ok(format!("stored the hashes of {} commands", lines.len()))
}

/// Runs every `every`th command of `file` and compares.
fn check(root: &Path, program: &Path, file: &Path, every: usize) -> Result<String, ChoreError> {
    let text = fs::read_to_string(file).map_err(at(file))?;
    let stored: Vec<(&str, &str)> = text.lines().filter_map(|l| l.split_once(' ')).step_by(every.max(1)).collect();
    let lines: Vec<String> = stored.iter().map(|(_, line)| (*line).to_owned()).collect();
    let found = hashes::of_all(root, program, &lines)?;
    let mut differing = String::new();
    for ((hash, line), new) in stored.iter().zip(&found) {
        if hash != new {
            let _ = write!(differing, "\n  pathwarp {line}");
        }
    }
    if differing.is_empty() {
        Ok(format!("{} commands wrote the same bytes", lines.len()))
    } else {
        Err(format!("of {} commands, these wrote other bytes:{differing}", lines.len()))
    }
}
