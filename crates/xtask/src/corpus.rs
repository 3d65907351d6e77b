//! `cargo xtask corpus`: makes the file of icon paths, one per line, on which refitting is measured.
//!
//! Fetches two icon sets with `npm pack`, takes every Nth file of each in alphabetical order, scales the paths to a box of 0..1000, and writes
//! them to `corpus/icons.txt`. Arcs become cubics of at most a quarter turn, so that every program that reads the file measures the same
//! curves.

use crate::chore::{Chore, workspace};
use crate::shell::{ends_in, files_below};
use clap::Command as ChoreCommand;
use pathwarp::Outline;
use pathwarp::kurbo::Affine;
use std::io::{self, Write};
use std::path::Path;
use std::process::Command;

pub(crate) const CHORE: Chore = Chore {
    command: || ChoreCommand::new("corpus").about("Fetch the icons that refitting is measured on (needs npm)"),
    run: |_| fetch_all().map_err(|e| e.to_string()),
};

/// A package of icons on npm.
struct IconSet {
    package: &'static str,
    /// The folder of its SVG files.
    folder: &'static str,
    /// The side of their square view boxes.
    side: f64,
    /// One file of this many is taken.
    every: usize,
}

/// The icon sets: some 23,000 segments in total.
const SETS: [IconSet; 2] = [
    IconSet { package: "simple-icons", folder: "package/icons", side: 24.0, every: 10 },
    IconSet { package: "bootstrap-icons", folder: "package/icons", side: 16.0, every: 15 },
];

/// Side of the box that icons are scaled to.
const BOX: f64 = 1000.0;

/// Tolerance for arcs that become cubics: any error is allowed, which gives one cubic per quarter turn.
const ARC_TOLERANCE: f64 = f64::INFINITY;

/// Fetches the icons, writes `corpus/icons.txt` beside the workspace's `Cargo.toml`, and returns a summary.
fn fetch_all() -> io::Result<String> {
    let folder = workspace().join("corpus");
    std::fs::create_dir_all(&folder)?;
    let mut lines = Vec::new();
    for set in &SETS {
        let work = folder.join(set.package);
        fetch(set.package, &work)?;
        let files = files_below(&work.join(set.folder), |f| ends_in(f, &["svg"])).map_err(io::Error::other)?;
        for file in files.iter().step_by(set.every) {
            let text = std::fs::read_to_string(file)?;
            let scale = Affine::scale(BOX / set.side);
            let data = text.split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next());
            let icons = data.map(|d| Outline::from_svg_lossy(d).transformed(scale).to_bez_path(ARC_TOLERANCE).to_svg());
            lines.extend(icons.filter(|d| !d.is_empty()));
        }
    }
    let mut out = io::BufWriter::new(std::fs::File::create(folder.join("icons.txt"))?);
    for line in &lines {
        writeln!(out, "{line}")?;
    }
    out.flush()?;
    Ok("wrote corpus/icons.txt".to_owned())
}

/// Downloads a package and unpacks it into `work`, unless it is there already.
fn fetch(package: &str, work: &Path) -> io::Result<()> {
    if work.join("package").is_dir() {
        return Ok(());
    }
    std::fs::create_dir_all(work)?;
    let packed = output_of(Command::new("npm").args(["pack", "--silent", package]).current_dir(work))?;
    let archive = packed.lines().last().unwrap_or_default().trim().to_owned();
    output_of(Command::new("tar").args(["xzf", &archive]).current_dir(work))?;
    std::fs::remove_file(work.join(archive))
}

/// Runs a command and returns its standard output.
fn output_of(command: &mut Command) -> io::Result<String> {
    let output = command.output()?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        Err(io::Error::other(format!("{command:?}: {message}")))
    }
}
