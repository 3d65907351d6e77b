//! `cargo xtask speed`: times the program as people run it, and prints a table for `docs/benchmarks.md`.
//!
//! The yardstick is `usvg IN OUT` on the same file, which reads, resolves and writes a drawing without bending it. Both run as whole
//! processes, in turn. Unless a row says otherwise, it compares CPU times and gives the median of paired runs.

pub(crate) mod generated;
mod process;
mod rows;

use crate::chore::{Chore, ChoreError, at, count_option, path_option, paths, program_option, workspace};
use crate::shell;
use clap::{Arg, ArgAction, ArgMatches, Command};
use process::Job;
use rows::Bench;
use std::fs;
use std::path::{Path, PathBuf};

/// See the module.
pub(crate) const CHORE: Chore = Chore { command, run };

fn command() -> Command {
    Command::new("speed")
        .about("Time whole runs against usvg, and print a table")
        .arg(
            path_option("drawings", "FOLDER")
                .action(ArgAction::Append)
                .required(true)
                .help("Drawings to warp; may be given several times"),
        )
        .arg(path_option("usvg", "FILE").default_value("usvg").help("The usvg program"))
        .arg(count_option("count", "200").help("Number of drawings, spread evenly over all"))
        .arg(count_option("rounds", "5").help("Paired runs; their median counts"))
        .arg(count_option("largest", "1000000").help("Segments of the largest generated drawing"))
        .arg(Arg::new("font").long("font").value_name("FAMILY").default_value("DejaVu Sans").help("An installed font"))
        .arg(
            Arg::new("only")
                .long("only")
                .value_name("PART")
                .action(ArgAction::Append)
                .value_parser(rows::PARTS.map(|p| p.0))
                .help("Measure this part only; may be given several times"),
        )
        .arg(program_option())
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let number = |name: &str| arguments.get_one(name).copied().unwrap_or(1);
    let mut files = Vec::new();
    for folder in paths(arguments, "drawings") {
        files.extend(svg_files(&folder)?);
    }
    let count = number("count").clamp(1, files.len().max(1));
    let drawings = (0..count).filter_map(|i| files.get(i * files.len() / count).cloned()).collect();
    let usvg = arguments.get_one::<PathBuf>("usvg").cloned().unwrap_or_default();
    check(&usvg)?;
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let bench = Bench {
        program: shell::program(&workspace(), arguments)?,
        usvg,
        drawings,
        rounds: number("rounds").max(1),
        largest: number("largest"),
        font: arguments.get_one("font").cloned().unwrap_or_default(),
        folder: folder.path().to_owned(),
    };
    let only: Vec<&String> = arguments.get_many("only").unwrap_or_default().collect();
    let mut table = String::from("| what | measured |\n|---|---|\n");
    for (_, part) in rows::PARTS.iter().filter(|(name, _)| only.is_empty() || only.iter().any(|o| o == name)) {
        part(&bench, &mut table)?;
    }
    Ok(table)
}

/// Refuses a usvg that does not run.
fn check(usvg: &Path) -> Result<(), ChoreError> {
    match Job::new(usvg, ["--version"]).run() {
        Ok(Some(_)) => Ok(()),
        _ => Err(format!(
            "{} does not run; install it with `cargo install usvg --version 0.49.0`, or name it with --usvg FILE",
            usvg.display()
        )),
    }
}

/// Every SVG file below a folder, sorted.
fn svg_files(folder: &Path) -> Result<Vec<PathBuf>, ChoreError> {
    let mut out = Vec::new();
    for entry in fs::read_dir(folder).map_err(at(folder))? {
        let path = entry.map_err(at(folder))?.path();
        if path.is_dir() {
            out.extend(svg_files(&path)?);
        } else if path.extension().is_some_and(|e| e == "svg") {
            out.push(path);
        }
    }
    out.sort();
    Ok(out)
}
