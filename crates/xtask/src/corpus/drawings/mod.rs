//! Warps whole drawings with the program's own reader, maps and writers, and compares them with resvg's rendering of the
//! originals.
//!
//! Every file goes through
//!
//! 1. the identity, with its structure flattened and kept: the pictures must match. Once as a declared affine map, which moves
//!    control points, and once hidden from the fitter;
//! 2. a hidden affine map: the picture must match resvg's drawing of the original under that transform, and of the original with
//!    its arcs written more precisely ([`exact_arcs`]);
//! 3. a strong shaper: the picture must match a large picture of the original bent pixel by pixel;
//! 4. a comparison of ids, classes, titles and nesting before and after;
//! 5. reading and writing, timed against usvg.
//!
//! A panic, or more than a minute for one map of one file, counts as a failure.

mod case;
mod exact_arcs;
mod facts;
mod finding;
mod maps;
mod pictures;
mod scale;
mod timing;

use crate::chore::ChoreError;
use crate::{files, parallel};
use case::CheckOptions;
use finding::Finding;
use pathwarp_svg::{GenericFamilies, ReadOptions};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::Duration;

/// Time limit for all checks of one file, including its pictures.
const TIME_LIMIT: Duration = Duration::from_secs(300);

/// The checks that can be run alone. The one of names and nesting uses the result of the affine map.
pub(super) const CHECKS: [&str; 3] = ["identity", "affine", "shaper"];

/// The options of a run over a corpus.
pub(super) struct CorpusRun {
    /// Folders of SVG files.
    pub(super) folders: Vec<PathBuf>,
    /// A folder of fonts for text, instead of the system's.
    pub(super) fonts: Option<PathBuf>,
    /// Measure every Nth file.
    pub(super) every: usize,
    /// Folder for pictures of failures.
    pub(super) pictures: Option<PathBuf>,
    /// Run these of [`CHECKS`] without timing; if empty, run all with timing.
    pub(super) only: Vec<String>,
    /// Take times only.
    pub(super) times: bool,
}

/// Measures all folders and returns a report.
pub(super) fn measure(run: &CorpusRun) -> Result<String, ChoreError> {
    let mut out = String::new();
    for folder in &run.folders {
        let files = files::below(folder, |path| files::ends_in(path, &["svg", "svgz"]))?;
        let files: Vec<PathBuf> = files.into_iter().step_by(run.every.max(1)).collect();
        // The families that resvg's test suite uses.
        let options = ReadOptions::default()
            .with_generic_families(GenericFamilies {
                serif: Some("Noto Serif".into()),
                sans_serif: Some("Noto Sans".into()),
                cursive: Some("Yellowtail".into()),
                fantasy: Some("Sedgwick Ave Display".into()),
                monospace: Some("Noto Mono".into()),
            })
            .with_system_fonts(run.fonts.is_none())
            .with_fonts(run.fonts.iter().cloned().collect());
        if !run.times {
            let checks = CheckOptions { read: options.clone(), pictures: run.pictures.clone(), only: run.only.clone() };
            let found = parallel::map(&files, |file| check_guarded(file, &checks));
            report(folder, &files, &found, &mut out);
        }
        if run.only.is_empty() {
            timing::report(&files, &options, &mut out);
        }
    }
    Ok(out)
}

/// Checks one file on a thread that may panic or be abandoned.
fn check_guarded(file: &Path, options: &CheckOptions) -> Vec<Finding> {
    let (send, receive) = mpsc::channel();
    let (path, options) = (file.to_owned(), options.clone());
    /// resvg needs a deep stack for some of librsvg's files.
    const STACK: usize = 256 << 20;
    let thread = std::thread::Builder::new().stack_size(STACK).spawn(move || {
        // The receiver may have timed out.
        let _ = send.send(case::check(&path, &options));
    });
    let failed = |remark: &str| vec![Finding::failed(case::ALIVE, remark)];
    if thread.is_err() {
        return failed("no thread");
    }
    match receive.recv_timeout(TIME_LIMIT) {
        Ok(found) => found,
        Err(mpsc::RecvTimeoutError::Timeout) => failed("timed out, pictures included"),
        Err(mpsc::RecvTimeoutError::Disconnected) => failed("panic"),
    }
}

/// Reports the share of files that pass each check, and lists the others.
fn report(folder: &Path, files: &[PathBuf], found: &[Vec<Finding>], out: &mut String) {
    let mut checks: Vec<&'static str> = Vec::new();
    for finding in found.iter().flatten() {
        if !checks.contains(&finding.check) {
            checks.push(finding.check);
        }
    }
    let _ = writeln!(out, "\n{}: {} files", folder.display(), files.len());
    for check in checks {
        let findings: Vec<(&PathBuf, &Finding)> = files
            .iter()
            .zip(found)
            .flat_map(|(file, all)| all.iter().filter(|f| f.check == check).map(move |f| (file, f)))
            .collect();
        let (passed, all) = (findings.iter().filter(|(_, f)| f.passed).count(), findings.len());
        let _ = writeln!(out, "{check}: {passed} of {all} ({:.2} %)", 100.0 * passed as f64 / all as f64);
        for (file, finding) in findings.iter().filter(|(_, f)| !f.passed) {
            let name = file.strip_prefix(folder).unwrap_or(file).display();
            let _ = writeln!(out, "    {name}: {}", finding.remark);
        }
    }
}
