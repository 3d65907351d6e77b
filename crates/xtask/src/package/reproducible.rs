//! `cargo xtask reproducible`: builds the program and its packages twice, from copies of the sources in two folders, and compares
//! the bytes.

use super::build::{self, Build};
use super::pack;
use crate::chore::{Chore, ChoreError, at, path_option, workspace};
use clap::{Arg, ArgAction, ArgMatches, Command};
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process;

/// See the module.
pub(crate) const CHORE: Chore = Chore { command, run };

/// The folders of the copies. Their lengths differ, so that a path that is left in the program would move what follows it.
const COPIES: [&str; 2] = ["one", "a-second-folder/with a space"];

fn command() -> Command {
    Command::new("reproducible")
        .about("Build and pack the last commit in two folders and compare the bytes")
        .arg(path_option("in", "DIR").help("The folder for the copies [default: a temporary one]"))
        .arg(
            Arg::new("static")
                .long("static")
                .action(ArgAction::SetTrue)
                .help("Link statically, as package --static does"),
        )
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let root = workspace().canonicalize().map_err(|e| e.to_string())?;
    let temporary = tempfile::tempdir().map_err(|e| e.to_string())?;
    let folder = match arguments.get_one::<PathBuf>("in") {
        Some(folder) => folder.clone(),
        None => temporary.path().to_owned(),
    };
    let time = build::time(&root)?;
    let mut sums = Vec::new();
    for name in COPIES {
        let copy = folder.join(name);
        export(&root, &copy)?;
        let copy = copy.canonicalize().map_err(at(&copy))?;
        let linked_statically = arguments.get_flag("static");
        let build = Build { root: &copy, target: &copy.join("target"), linked_statically, time: &time };
        let program = build.program()?;
        let packed = pack(&build, &program)?;
        sums.push([sum(&program)?, sum(&packed)?]);
    }
    let mut said = String::new();
    for (i, what) in ["program", "package"].into_iter().enumerate() {
        let _ = writeln!(said, "{what}: {}, {}", sums[0][i], sums[1][i]);
    }
    if sums[0] == sums[1] { Ok(said + "the same bytes") } else { Err(said + "the bytes differ") }
}

/// Writes the files of the last commit to a folder.
fn export(root: &Path, to: &Path) -> Result<(), ChoreError> {
    fs::create_dir_all(to).map_err(at(to))?;
    let git = |args: &[&str]| {
        let status = process::Command::new("git").args(args).current_dir(root).status();
        if status.map_err(|e| format!("git: {e}"))?.success() { Ok(()) } else { Err(format!("git {args:?} failed")) }
    };
    let archive = to.join("sources.tar");
    git(&["archive", "--output", &archive.display().to_string(), "HEAD"])?;
    let tar = process::Command::new("tar").arg("--extract").arg("--file").arg(&archive).current_dir(to).status();
    if !tar.map_err(|e| format!("tar: {e}"))?.success() {
        return Err("tar failed".into());
    }
    fs::remove_file(&archive).map_err(at(&archive))
}

fn sum(file: &Path) -> Result<String, ChoreError> {
    let digest = Sha256::digest(fs::read(file).map_err(at(file))?);
    Ok(digest.iter().fold(String::new(), |mut hex, byte| {
        let _ = write!(hex, "{byte:02x}");
        hex
    }))
}
