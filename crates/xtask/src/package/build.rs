//! Builds the program for a release: the same bytes wherever the sources lie.

use crate::chore::{ChoreError, at};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Separates flags in `CARGO_ENCODED_RUSTFLAGS`, so that they may contain spaces.
const SEPARATOR: &str = "\x1f";

/// A build of the program.
pub(super) struct Build<'a> {
    /// The workspace.
    pub(super) root: &'a Path,
    /// The target folder.
    pub(super) target: &'a Path,
    /// The program needs no library at run time, not even the system's C library.
    pub(super) linked_statically: bool,
    /// The time that packages bear, in seconds since 1970.
    pub(super) time: &'a str,
}

impl Build<'_> {
    /// Builds the program and returns its path.
    pub(super) fn program(&self) -> Result<PathBuf, ChoreError> {
        let host = host()?;
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["build", "--release", "--locked", "--package", "pathwarp-cli", "--target", &host]);
        cargo.arg("--target-dir").arg(self.target).current_dir(self.root);
        cargo.env("CARGO_ENCODED_RUSTFLAGS", self.flags()?.join(SEPARATOR));
        // The names of functions take a third of the program.
        cargo.env("CARGO_PROFILE_RELEASE_STRIP", "symbols");
        if !cargo.status().map_err(|e| e.to_string())?.success() {
            return Err("the program does not build".into());
        }
        let folder = self.target.join(host).join("release");
        Ok(folder.join("pathwarp").with_extension(std::env::consts::EXE_EXTENSION))
    }

    /// Compiler flags. Messages of panics contain the paths of source files: paths of this machine are replaced.
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

/// The target triple of this machine.
pub(super) fn host() -> Result<String, ChoreError> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let out = Command::new(&rustc).arg("-vV").output().map_err(at(Path::new(&rustc)))?;
    let text = String::from_utf8_lossy(&out.stdout).into_owned();
    let host = text.lines().find_map(|l| l.strip_prefix("host: ")).ok_or("rustc -vV names no host")?;
    Ok(host.to_owned())
}

/// Cargo's folder, which has the sources of the crates.
fn cargo_home() -> Result<PathBuf, ChoreError> {
    let own = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    own.or_else(|| Some(std::env::home_dir()?.join(".cargo"))).ok_or_else(|| "set CARGO_HOME".into())
}

/// The time that packages bear: `SOURCE_DATE_EPOCH`, or else that of the last commit.
pub(super) fn time(root: &Path) -> Result<String, ChoreError> {
    if let Ok(time) = std::env::var("SOURCE_DATE_EPOCH") {
        return Ok(time);
    }
    let git = Command::new("git").args(["log", "-1", "--format=%ct"]).current_dir(root).output();
    let time = git.ok().and_then(|out| String::from_utf8(out.stdout).ok()).unwrap_or_default().trim().to_owned();
    if time.is_empty() { Err("this is no git repository: set SOURCE_DATE_EPOCH".into()) } else { Ok(time) }
}
