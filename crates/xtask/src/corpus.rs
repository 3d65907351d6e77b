//! `cargo xtask corpus`: the icon paths that the refit is measured on, one path's data per line.
//!
//! Two icon sets are fetched with `npm pack`; an even selection of each, in the order of the files' names, is scaled to a box
//! of 0..1000 and written to `corpus/icons.txt`. Arcs are written as cubics of at most a quarter turn, so that every program
//! that reads the file measures the same curves.

use pathwarp::Outline;
use pathwarp::kurbo::Affine;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

/// A set of icons on npm: its name, the folder of its SVG files, the side of their square view box, and which file of how many
/// is taken.
struct Set {
    package: &'static str,
    folder: &'static str,
    side: f64,
    every: usize,
}

/// Chosen so that both together give some 23,000 segments.
const SETS: [Set; 2] = [
    Set { package: "simple-icons", folder: "package/icons", side: 24.0, every: 10 },
    Set { package: "bootstrap-icons", folder: "package/icons", side: 16.0, every: 15 },
];

/// The box the icons are scaled to.
const BOX: f64 = 1000.0;

/// Arcs become quarter turns whatever their size.
const ANY: f64 = f64::INFINITY;

/// Fetches the icons and writes `corpus/icons.txt` beside the workspace's `Cargo.toml`.
///
/// # Errors
/// If `npm` or `tar` cannot be run or fail, or a file cannot be read or written.
pub(crate) fn run() -> io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus");
    std::fs::create_dir_all(&folder)?;
    let mut lines = Vec::new();
    for set in &SETS {
        let work = folder.join(set.package);
        std::fs::create_dir_all(&work)?;
        fetch(set.package, &work)?;
        let mut files: Vec<PathBuf> = std::fs::read_dir(work.join(set.folder))?
            .map(|e| e.map(|e| e.path()))
            .collect::<io::Result<Vec<_>>>()?
            .into_iter()
            .filter(|p| p.extension().is_some_and(|e| e == "svg"))
            .collect();
        files.sort();
        for file in files.iter().step_by(set.every) {
            let text = std::fs::read_to_string(file)?;
            lines.extend(path_data(&text).map(|d| normalised(d, BOX / set.side)).filter(|d| !d.is_empty()));
        }
    }
    let mut out = io::BufWriter::new(std::fs::File::create(folder.join("icons.txt"))?);
    for line in &lines {
        writeln!(out, "{line}")?;
    }
    out.flush()
}

/// `npm pack` and `tar` into `work`, unless that was done before.
fn fetch(package: &str, work: &Path) -> io::Result<()> {
    if work.join("package").is_dir() {
        return Ok(());
    }
    let packed = succeeded(Command::new("npm").args(["pack", "--silent", package]).current_dir(work))?;
    let archive = packed.lines().last().unwrap_or_default().trim().to_owned();
    succeeded(Command::new("tar").args(["xzf", &archive]).current_dir(work))?;
    std::fs::remove_file(work.join(archive))
}

/// What the command printed, if it succeeded.
fn succeeded(command: &mut Command) -> io::Result<String> {
    let output = command.output()?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        Err(io::Error::other(format!("{command:?}: {said}")))
    }
}

/// The values of the `d` attributes in an SVG file.
fn path_data(svg: &str) -> impl Iterator<Item = &str> {
    svg.split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next())
}

/// Path data scaled, arcs turned into cubics.
fn normalised(d: &str, scale: f64) -> String {
    Outline::from_svg_lossy(d).transformed(Affine::scale(scale)).to_bez_path(ANY).to_svg()
}
