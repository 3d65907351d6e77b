//! `cargo xtask package`: makes the packages of a release. The program writes its manual pages, completions and plug-ins to
//! `target/package/`; cargo-deb packs them for Debian, and `tar` packs them with a statically linked program.
//!
//! `cargo xtask reproducible` builds and packs two copies of the sources, in different folders, and compares the bytes.

use crate::chore::{Chore, ChoreError, at, flag_option, hex, path_option, workspace};
use clap::{ArgMatches, Command};
use contents::{Tree, host, licences_text};
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{fs, process};

mod contents;

pub(crate) const CHORE: Chore = Chore { command, run };

fn command() -> Command {
    Command::new("package")
        .about("Build the program and pack it for Debian with manual pages, completions, icon and plug-ins")
        .arg(path_option("program", "FILE").help("The pathwarp to pack [default: build one]"))
        .arg(
            flag_option("static").help(
                "Link the program statically and pack an archive (.tar.gz) that runs on any Linux of this processor",
            ),
        )
        .arg(
            path_option("licences", "FILE")
                .help("Only write the licences of the program and of everything that is linked into it here"),
        )
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let root = workspace().canonicalize().map_err(|e| e.to_string())?;
    if let Some(file) = arguments.get_one::<PathBuf>("licences") {
        fs::write(file, licences_text(&root)?).map_err(at(file))?;
        return Ok(format!("wrote {}", file.display()));
    }
    let (time, linked_statically) = (&time(&root)?, arguments.get_flag("static"));
    let build = Build { root: &root, target: &root.join("target"), linked_statically, time };
    let program = match arguments.get_one::<PathBuf>("program") {
        Some(program) => program.canonicalize().map_err(at(program))?,
        None => build.program()?,
    };
    let packed = pack(&build, &program)?;
    Ok(format!("wrote {}", packed.display()))
}

/// Lays out the files in `TARGET/package/` and packs them. Returns the path of the package.
fn pack(build: &Build<'_>, program: &Path) -> Result<PathBuf, ChoreError> {
    let folder = build.target.join("package");
    fs::create_dir_all(&folder).map_err(at(&folder))?;
    let tree = Tree::lay_out(build.root, program, &folder.join("tree"))?;
    if build.linked_statically { archive(build, &tree, &folder) } else { debian(build, &folder) }
}

/// Packs the tree with cargo-deb, as described in the Cargo.toml of pathwarp-cli.
fn debian(build: &Build<'_>, folder: &Path) -> Result<PathBuf, ChoreError> {
    let output = folder.join("pathwarp.deb");
    let mut deb = process::Command::new(env!("CARGO"));
    deb.args(["deb", "--quiet", "--no-build", "--no-strip", "--locked", "--package", "pathwarp-cli", "--output"])
        .arg(&output);
    deb.current_dir(build.root).env("CARGO_TARGET_DIR", build.target).env("SOURCE_DATE_EPOCH", build.time);
    succeed(&mut deb, "install cargo-deb: cargo install --locked cargo-deb")?;
    Ok(output)
}

/// Packs the tree as an archive in which order, owners and times of files are always the same.
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

/// Runs a command, which must succeed.
fn succeed(command: &mut process::Command, advice: &str) -> Result<(), ChoreError> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command.status().map_err(|e| format!("{name}: {e}; {advice}"))?;
    if status.success() { Ok(()) } else { Err(format!("{name} ended with {status}; if it is missing, {advice}")) }
}

/// Separates flags in `CARGO_ENCODED_RUSTFLAGS`, where they may contain spaces.
const SEPARATOR: &str = "\x1f";

/// A build of the program.
struct Build<'a> {
    /// The workspace.
    root: &'a Path,
    /// The target folder.
    target: &'a Path,
    /// `true` if the program must need no library at run time, not even the C library.
    linked_statically: bool,
    /// The time stamp of packages, in seconds since 1970.
    time: &'a str,
}

impl Build<'_> {
    /// Builds the program and returns its path.
    fn program(&self) -> Result<PathBuf, ChoreError> {
        let host = host()?;
        let mut cargo = process::Command::new(env!("CARGO"));
        cargo.args(["build", "--profile", "dist", "--locked", "--package", "pathwarp-cli", "--target", &host]);
        cargo.arg("--target-dir").arg(self.target).current_dir(self.root);
        cargo.env("CARGO_ENCODED_RUSTFLAGS", self.flags()?.join(SEPARATOR));
        if !cargo.status().map_err(|e| e.to_string())?.success() {
            return Err("the program does not build".into());
        }
        let folder = self.target.join(host).join("dist");
        Ok(folder.join("pathwarp").with_extension(std::env::consts::EXE_EXTENSION))
    }

    /// Compiler flags. They replace paths of this machine, since panic messages contain paths of source files.
    fn flags(&self) -> Result<Vec<String>, ChoreError> {
        let crates = cargo_home()?.join("registry/src");
        let renamed = |from: &Path, to: &str| format!("--remap-path-prefix={}={to}", from.display());
        let mut flags =
            vec![renamed(&crates, "/crates"), renamed(self.root, "/pathwarp"), renamed(self.target, "/target")];
        if self.linked_statically {
            flags.push("-Ctarget-feature=+crt-static".into());
        }
        Ok(flags)
    }
}

/// Cargo's home folder, which holds the sources of the crates.
fn cargo_home() -> Result<PathBuf, ChoreError> {
    let given = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    given.or_else(|| Some(std::env::home_dir()?.join(".cargo"))).ok_or_else(|| "set CARGO_HOME".into())
}

/// The time stamp of packages: `SOURCE_DATE_EPOCH`, or else the time of the last commit.
fn time(root: &Path) -> Result<String, ChoreError> {
    if let Ok(time) = std::env::var("SOURCE_DATE_EPOCH") {
        return Ok(time);
    }
    let git = process::Command::new("git").args(["log", "-1", "--format=%ct"]).current_dir(root).output();
    let time = git.ok().and_then(|out| String::from_utf8(out.stdout).ok()).unwrap_or_default().trim().to_owned();
    if time.is_empty() { Err("this is no git repository: set SOURCE_DATE_EPOCH".into()) } else { Ok(time) }
}

pub(crate) const REPRODUCIBLE: Chore = Chore { command: reproducible_command, run: reproducible };

/// The folders of the copies. Their names differ in length, so that a path left in the program would shift the bytes after it.
const COPIES: [&str; 2] = ["one", "a-second-folder/with a space"];

fn reproducible_command() -> Command {
    Command::new("reproducible")
        .about("Build and pack the last commit in two folders and compare the bytes")
        .arg(path_option("in", "DIR").help("The folder for the copies [default: a temporary one]"))
        .arg(flag_option("static").help("Link statically, as package --static does"))
}

fn reproducible(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let root = workspace().canonicalize().map_err(|e| e.to_string())?;
    let temporary = tempfile::tempdir().map_err(|e| e.to_string())?;
    let folder = arguments.get_one::<PathBuf>("in").map_or(temporary.path(), PathBuf::as_path);
    let time = &time(&root)?;
    let mut sums = Vec::new();
    for name in COPIES {
        let copy = folder.join(name);
        export(&root, &copy)?;
        let copy = copy.canonicalize().map_err(at(&copy))?;
        let linked_statically = arguments.get_flag("static");
        let build = Build { root: &copy, target: &copy.join("target"), linked_statically, time };
        let program = build.program()?;
        let packed = pack(&build, &program)?;
        sums.push([sum(&program)?, sum(&packed)?]);
    }
    let mut report = String::new();
    for (i, what) in ["program", "package"].into_iter().enumerate() {
        let _ = writeln!(report, "{what}: {}, {}", sums[0][i], sums[1][i]);
    }
    if sums[0] == sums[1] { Ok(report + "the same bytes") } else { Err(report + "the bytes differ") }
}

/// Exports the files of the last commit to a folder.
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
    Ok(hex(&Sha256::digest(fs::read(file).map_err(at(file))?)))
}
