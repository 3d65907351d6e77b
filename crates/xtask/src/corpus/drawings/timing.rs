//! Times reading and writing against usvg.

use super::maps::Identity;
use pathwarp::kurbo::Affine;
use pathwarp::refit;
use pathwarp_svg::{Document, ReadOptions, Structure, WarpOptions};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Timed rounds per file; the fastest counts.
const ROUNDS: usize = 15;

/// Times all files and reports totals and the distribution of ratios.
pub(super) fn report(files: &[PathBuf], options: &ReadOptions, out: &mut String) {
    let mut warp = WarpOptions::new(refit::Options::new(0.01));
    let modes = [
        ("default structure", Structure::Auto, Vec::new()),
        ("flattened", Structure::Flatten, Vec::new()),
        // A copy in place bypasses the shortcut for maps that move nothing.
        ("patched, every control point moved", Structure::Auto, vec![Affine::IDENTITY]),
    ];
    for (mode, structure, copies) in modes {
        warp.structure = structure;
        warp.copies = copies;
        let times: Vec<(f64, f64)> = files.iter().filter_map(|f| timed(f, options, &warp)).collect();
        let (ours, theirs) = times.iter().fold((0.0, 0.0), |s, t| (s.0 + t.0, s.1 + t.1));
        let mut ratios: Vec<f64> = times.iter().map(|t| t.0 / t.1).collect();
        ratios.sort_by(f64::total_cmp);
        let at = |share: f64| ratios.get((share * ratios.len() as f64) as usize).copied().unwrap_or(f64::NAN);
        let _ = writeln!(
            out,
            "reading and writing, {mode}, {} files: {:.1} ms, usvg {:.1} ms, ratio {:.3}; ratio by file: 10 % below {:.2}, \
             50 % below {:.2}, 90 % below {:.2}",
            times.len(),
            ours * 1e3,
            theirs * 1e3,
            ours / theirs,
            at(0.1),
            at(0.5),
            at(0.9)
        );
    }
}

/// Best times of pathwarp and of usvg for one file, in seconds; `None` if the file is not suited.
fn timed(file: &Path, options: &ReadOptions, warp: &WarpOptions) -> Option<(f64, f64)> {
    let text = String::from_utf8(std::fs::read(file).ok()?).ok()?;
    // Loading fonts would dominate both times. Nested drawings may hold text.
    if text.contains("<text") || text.contains("data:image/svg") {
        return None;
    }
    let options = options
        .clone()
        .with_base_dir(file.parent().map(Path::to_owned))
        .with_system_fonts(false)
        .with_fonts(Vec::new());
    let theirs = usvg::Options { resources_dir: options.base_dir.clone(), ..usvg::Options::default() };
    let mut best = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        let started = Instant::now();
        let written = Document::read(text.as_bytes(), "the file", &options).ok()?.warp(&Identity, warp).ok()?;
        best.0 = best.0.min(started.elapsed().as_secs_f64());
        let started = Instant::now();
        let again = usvg::Tree::from_str(&text, &theirs).ok()?.to_string(&usvg::WriteOptions::default());
        best.1 = best.1.min(started.elapsed().as_secs_f64());
        if written.svg.is_empty() || again.is_empty() {
            return None;
        }
    }
    Some(best)
}
