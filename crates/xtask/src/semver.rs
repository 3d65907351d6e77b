//! `cargo xtask semver`: compares the public interfaces of the libraries with those of the last release.

use crate::chore::{Chore, ChoreError, workspace};
use clap::{Arg, ArgMatches, Command};
use std::path::Path;
use std::process;

/// See the module.
pub(crate) const CHORE: Chore = Chore { command, run };

/// Tags of releases.
const TAGS: &str = "v[0-9]*";

fn command() -> Command {
    Command::new("semver")
        .about("Compare the interfaces of the libraries with the last release (needs cargo-semver-checks)")
        .arg(
            Arg::new("since")
                .long("since")
                .value_name("TAG")
                .help("The release to compare with [default: the last tag v…]"),
        )
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let root = workspace();
    let tag = match arguments.get_one::<String>("since") {
        Some(tag) => tag.clone(),
        None => match last_tag(&root) {
            Some(tag) => tag,
            None => return Ok("there is no release to compare with: no tag v…".into()),
        },
    };
    let mut cargo = process::Command::new(env!("CARGO"));
    cargo.args(["semver-checks", "check-release", "--workspace", "--baseline-rev", &tag]).current_dir(root);
    let status = cargo.status().map_err(|e| e.to_string())?;
    if status.success() {
        return Ok(format!("the libraries keep what {tag} promised, or their version says otherwise"));
    }
    Err(format!(
        "a library breaks what {tag} promised: raise its version, or mend it; if cargo-semver-checks is missing, cargo install \
         --locked cargo-semver-checks"
    ))
}

/// The nearest tag of a release below the last commit.
fn last_tag(root: &Path) -> Option<String> {
    let mut git = process::Command::new("git");
    let out = git.args(["describe", "--tags", "--abbrev=0", "--match", TAGS]).current_dir(root).output().ok()?;
    let tag = String::from_utf8(out.stdout).ok()?.trim().to_owned();
    (out.status.success() && !tag.is_empty()).then_some(tag)
}
