//! `cargo xtask package`: what a release hands out. The program writes its own manual pages, completions and plug-ins into
//! `target/package/`; cargo-deb packs them, and `tar` packs them with a static program.

mod build;
mod notices;
mod reproducible;
mod tree;

pub(crate) use reproducible::CHORE as REPRODUCIBLE;

use crate::chore::{Chore, ChoreError, at, path_option, workspace};
use build::Build;
use clap::{Arg, ArgAction, ArgMatches, Command};
use std::fs;
use std::path::{Path, PathBuf};
use std::process;
use tree::Tree;

/// See the module.
pub(crate) const CHORE: Chore = Chore { command, run };

fn command() -> Command {
    Command::new("package")
        .about("Build the program and pack it for Debian with manual pages, completions, icon and plug-ins")
        .arg(path_option("program", "FILE").help("The pathwarp to pack [default: build one]"))
        .arg(
            Arg::new("static").long("static").action(ArgAction::SetTrue).help(
                "Link the program statically and pack an archive (.tar.gz) that runs on any Linux of this processor",
            ),
        )
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let root = workspace().canonicalize().map_err(|e| e.to_string())?;
    let (time, linked_statically) = (build::time(&root)?, arguments.get_flag("static"));
    let build = Build { root: &root, target: &root.join("target"), linked_statically, time: &time };
    let program = match arguments.get_one::<PathBuf>("program") {
        Some(program) => program.canonicalize().map_err(at(program))?,
        None => build.program()?,
    };
    let packed = pack(&build, &program)?;
    Ok(format!("wrote {}", packed.display()))
}

/// Lays the files out in `TARGET/package/` and packs them. Returns the package.
fn pack(build: &Build<'_>, program: &Path) -> Result<PathBuf, ChoreError> {
    let folder = build.target.join("package");
    fs::create_dir_all(&folder).map_err(at(&folder))?;
    let tree = Tree::lay_out(build.root, program, &folder.join("tree"))?;
    if build.linked_statically { archive(build, &tree, &folder) } else { debian(build, &folder) }
}

/// Packs the tree with cargo-deb. Cargo.toml of pathwarp-cli describes the package.
fn debian(build: &Build<'_>, folder: &Path) -> Result<PathBuf, ChoreError> {
    let output = folder.join("pathwarp.deb");
    let mut deb = process::Command::new(env!("CARGO"));
    deb.args(["deb", "--quiet", "--no-build", "--no-strip", "--locked", "--package", "pathwarp-cli", "--output"])
        .arg(&output);
    deb.current_dir(build.root).env("CARGO_TARGET_DIR", build.target).env("SOURCE_DATE_EPOCH", build.time);
    succeed(&mut deb, "install cargo-deb: cargo install --locked cargo-deb")?;
    Ok(output)
}

/// Packs the tree as an archive, with the same order, owner and time of all files in every run.
fn archive(build: &Build<'_>, tree: &Tree, folder: &Path) -> Result<PathBuf, ChoreError> {
    let name = format!("pathwarp-{}-{}-linux", env!("CARGO_PKG_VERSION"), std::env::consts::ARCH);
    let output = folder.join(format!("{name}.tar.gz"));
    let mut tar = process::Command::new("tar");
    tar.args(["--create", "--sort=name", "--owner=0", "--group=0", "--numeric-owner", "--format=gnu"]);
    tar.args(["--use-compress-program=gzip --no-name --best", &format!("--mtime=@{}", build.time)]);
    tar.arg(format!("--transform=s,^\\.,{name},")).arg("--file").arg(&output).arg("--directory").arg(&tree.folder);
    succeed(tar.arg("."), "install GNU tar and gzip")?;
    Ok(output)
}

/// Runs a command to its end.
fn succeed(command: &mut process::Command, advice: &str) -> Result<(), ChoreError> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command.status().map_err(|e| format!("{name}: {e}; {advice}"))?;
    if status.success() { Ok(()) } else { Err(format!("{name} ended with {status}; if it is missing, {advice}")) }
}
