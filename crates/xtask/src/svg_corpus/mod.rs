//! `cargo xtask corpus --svg FOLDER…`: whole drawings through the program's own reader, map and writers, measured against
//! resvg's rendering of the originals.
//!
//! Every file is taken through
//!
//! 1. the identity, written anew and with its structure kept: the pictures must be the same. Once as the affine map it is,
//!    whose control points are moved, and once hidden from the fitter;
//! 2. an affine map, hidden as well: the picture must be what resvg draws of the original under that transform, and of the
//!    original with its arcs written more precisely ([`refined`]);
//! 3. a strong shaper: the picture must be the original's picture, large, bent pixel by pixel;
//! 4. a comparison of its ids, classes, titles and nesting before and after;
//! 5. reading and writing, timed beside usvg's own.
//!
//! A panic, and more than a minute for one map of one file, count as failures of the program.

mod checks;
mod pictures;
mod refined;
mod speed;

use crate::Fault;
use checks::{Findings, Way};
use pathwarp_svg::{GenericFamilies, ReadOptions};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, mpsc};
use std::time::Duration;

/// How long the checks of one file may take altogether, drawing included, before it is given up.
const LIMIT: Duration = Duration::from_secs(300);

/// The checks that can be asked for alone. Names and nesting are looked at in what the affine map gives.
pub(crate) const CHECKS: [&str; 3] = ["identity", "affine", "shaper"];

/// What is asked.
pub(crate) struct Job {
    /// Folders of SVG files.
    pub(crate) folders: Vec<PathBuf>,
    /// A folder of fonts for their text.
    pub(crate) fonts: Option<PathBuf>,
    /// Every how many files one is measured.
    pub(crate) every: usize,
    /// Where pictures of what misses go.
    pub(crate) pictures: Option<PathBuf>,
    /// Which of [`CHECKS`] are made, and no times taken; all if empty.
    pub(crate) only: Vec<String>,
    /// Whether only times are taken.
    pub(crate) times: bool,
}

/// Measures all the folders and says what was found.
pub(crate) fn run(job: &Job) -> Result<String, Fault> {
    let mut out = String::new();
    for folder in &job.folders {
        let mut files = Vec::new();
        collect(folder, &mut files).map_err(|e| format!("{}: {e}", folder.display()))?;
        files.sort();
        let files: Vec<PathBuf> = files.into_iter().step_by(job.every.max(1)).collect();
        let options = ReadOptions {
            // The families that resvg's test suite is drawn with.
            generic_families: GenericFamilies {
                serif: Some("Noto Serif".into()),
                sans_serif: Some("Noto Sans".into()),
                cursive: Some("Yellowtail".into()),
                fantasy: Some("Sedgwick Ave Display".into()),
                monospace: Some("Noto Mono".into()),
            },
            system_fonts: job.fonts.is_none(),
            fonts: job.fonts.iter().cloned().collect(),
            ..ReadOptions::default()
        };
        if !job.times {
            let way = Way { read: options.clone(), pictures: job.pictures.clone(), only: job.only.clone() };
            let found = all(&files, &way);
            report(folder, &files, &found, &mut out);
        }
        if job.only.is_empty() {
            speed::report(&files, &options, &mut out);
        }
    }
    Ok(out)
}

/// The checks of all files, several at a time. The threads are our own: those of the warp's pool must not wait for it.
fn all(files: &[PathBuf], way: &Way) -> Vec<Findings> {
    let next = AtomicUsize::new(0);
    let found: Vec<Mutex<Findings>> = files.iter().map(|_| Mutex::default()).collect();
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some((file, slot)) = files.iter().zip(&found).nth(next.fetch_add(1, Ordering::Relaxed)) {
                    let findings = guarded(file, way);
                    if let Ok(mut slot) = slot.lock() {
                        *slot = findings;
                    }
                }
            });
        }
    });
    found.into_iter().map(|m| m.into_inner().unwrap_or_default()).collect()
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else if path.extension().is_some_and(|e| e == "svg" || e == "svgz") {
            files.push(path);
        }
    }
    Ok(())
}

/// The checks of one file, on a thread that may fail or be left behind.
fn guarded(file: &Path, way: &Way) -> Findings {
    let (send, receive) = mpsc::channel();
    let (path, way) = (file.to_owned(), way.clone());
    /// resvg itself needs a deep stack for some of librsvg's files.
    const STACK: usize = 256 << 20;
    let thread = std::thread::Builder::new().stack_size(STACK).spawn(move || {
        // A receiver that has given up needs no answer.
        let _ = send.send(checks::all(&path, &way));
    });
    let fault = |what: &str| vec![(checks::ALIVE, false, what.to_owned())];
    if thread.is_err() {
        return fault("no thread");
    }
    match receive.recv_timeout(LIMIT) {
        Ok(found) => found,
        Err(mpsc::RecvTimeoutError::Timeout) => fault("given up, drawing included"),
        Err(mpsc::RecvTimeoutError::Disconnected) => fault("panic"),
    }
}

fn report(folder: &Path, files: &[PathBuf], found: &[Findings], out: &mut String) {
    let mut checks: Vec<&'static str> = Vec::new();
    for (check, ..) in found.iter().flatten() {
        if !checks.contains(check) {
            checks.push(check);
        }
    }
    let _ = writeln!(out, "\n{}: {} files", folder.display(), files.len());
    for check in checks {
        let of: Vec<(&PathBuf, bool, &String)> = files
            .iter()
            .zip(found)
            .flat_map(|(f, all)| all.iter().filter(|(c, ..)| *c == check).map(move |(_, ok, word)| (f, *ok, word)))
            .collect();
        let passed = of.iter().filter(|(_, ok, _)| *ok).count();
        let _ = writeln!(out, "{check}: {passed} of {} ({:.2} %)", of.len(), 100.0 * passed as f64 / of.len() as f64);
        for (file, _, word) in of.iter().filter(|(_, ok, _)| !ok) {
            let name = file.strip_prefix(folder).unwrap_or(file).display();
            let _ = writeln!(out, "    {name}: {word}");
        }
    }
}
