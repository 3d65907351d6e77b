//! The checks of one file.

use super::exact_arcs::with_exact_arcs;
use super::facts::facts;
use super::finding::Finding;
use super::maps::{self, HiddenAffine, Identity};
use super::pictures::{self, LEVELS, Pair};
use super::scale::{self, SIDE, Scales};
use pathwarp::kurbo::Affine;
use pathwarp::map::Map;
use pathwarp::refit;
use pathwarp_cli::Bender;
use pathwarp_raster::{Pixmap, compare};
use pathwarp_svg::{
    Document, Gradients, Images, ReadOptions, Structure, Warning, WarpOptions, WarpedDocument, usvg_tree,
};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Largest share of differing pixels in pictures that count as the same.
const SHARE: f64 = 0.001;
/// Largest mean difference between a bent drawing and a bent picture of it, in 1/255.
const MEAN: f64 = 1.0;
/// Tolerance of the warp in pixels of the compared picture.
const TOLERANCE: f64 = 0.01;
/// Longest time for reading or bending one file.
const SLOW: Duration = Duration::from_secs(60);

/// Compares the affine map with the original, and with the original with exact arcs.
const AFFINE: &str = "affine map";
const EXACT: &str = "affine map, exact arcs in the original";

/// The check for panics and hangs.
pub(super) const ALIVE: &str = "no panic, no hang";

/// A variant of the identity check.
struct IdentityCheck {
    name: &'static str,
    /// Name of the check for equal pixels, where one applies.
    exact: Option<&'static str>,
    structure: Structure,
    /// Hide the identity from the fitter.
    hidden: bool,
    /// Warp "a copy in place", which bypasses the shortcut for maps that move nothing.
    copy: bool,
}

const IDENTITY_CHECKS: [IdentityCheck; 5] = [
    IdentityCheck {
        name: "identity, flattened",
        exact: Some("identity, flattened, pixel for pixel"),
        structure: Structure::Flatten,
        hidden: false,
        copy: false,
    },
    IdentityCheck {
        name: "identity, control points moved, flattened",
        exact: Some("identity, control points moved, flattened, pixel for pixel"),
        structure: Structure::Flatten,
        hidden: false,
        copy: true,
    },
    IdentityCheck {
        name: "identity, control points moved, patched",
        exact: Some("identity, control points moved, patched, pixel for pixel"),
        structure: Structure::Auto,
        hidden: false,
        copy: true,
    },
    IdentityCheck {
        name: "identity refitted, flattened",
        exact: None,
        structure: Structure::Flatten,
        hidden: true,
        copy: true,
    },
    IdentityCheck {
        name: "identity refitted, patched",
        exact: None,
        structure: Structure::Auto,
        hidden: true,
        copy: true,
    },
];

/// Options of the checks.
#[derive(Clone)]
pub(super) struct CheckOptions {
    pub(super) read: ReadOptions,
    /// Folder for pictures of failures.
    pub(super) pictures: Option<PathBuf>,
    /// The checks to run; all if empty.
    pub(super) only: Vec<String>,
}

/// The checks of one file.
struct FileCase<'a> {
    file: &'a Path,
    document: &'a Document,
    read: &'a ReadOptions,
    options: &'a CheckOptions,
    out: Vec<Finding>,
    /// The slowest step and its duration.
    slowest: (Duration, &'static str),
}

/// Runs all checks of a file. Files that cannot be opened, or that usvg cannot read either, give no findings.
pub(super) fn check(file: &Path, options: &CheckOptions) -> Vec<Finding> {
    let Ok(bytes) = std::fs::read(file) else { return Vec::new() };
    let read = options.read.clone().with_base_dir(file.parent().map(Path::to_owned));
    let started = Instant::now();
    let document = match Document::read(&bytes, "the file", &read) {
        Ok(d) => d,
        Err(e) => {
            let usvg_reads = catch_unwind(|| usvg::Tree::from_data(&bytes, &usvg::Options::default()).is_ok());
            return if usvg_reads.unwrap_or(false) { vec![Finding::failed("read", e.to_string())] } else { Vec::new() };
        }
    };
    let mut case = FileCase {
        file,
        document: &document,
        read: &read,
        options,
        out: vec![Finding::new("read", true, "")],
        slowest: (started.elapsed(), "reading"),
    };
    let result = catch_unwind(AssertUnwindSafe(|| case.checks()));
    let (took, step) = case.slowest;
    case.out.push(match result {
        Err(_) => Finding::failed(ALIVE, "panic"),
        Ok(()) => Finding::new(ALIVE, took <= SLOW, format!("{step} took {:.0} s", took.as_secs_f64())),
    });
    case.out
}

impl FileCase<'_> {
    fn checks(&mut self) {
        let document = self.document;
        let size = document.size_px();
        let scale = SIDE / size.width.max(size.height);
        let options = self.warp_options(scale);
        let Some(original) = pictures::whole(usvg_tree::tree(document), scale) else { return };
        if self.runs("identity") {
            self.identity(&original, scale, &options);
        }
        if self.runs("affine") {
            self.affine(scale);
        }
        if self.runs("shaper") {
            self.bent(scale);
        }
    }

    fn runs(&self, check: &str) -> bool {
        self.options.only.is_empty() || self.options.only.iter().any(|o| o == check)
    }

    /// Warps by an affine map that is hidden from the fitter.
    fn affine(&mut self, scale: f64) {
        let document = self.document;
        // Rotate, shear and squeeze about the centre of the page.
        let middle = document.view_box().center().to_vec2();
        let affine =
            Affine::translate(middle) * Affine::new([0.8, 0.15, -0.22, 0.62, 0.0, 0.0]) * Affine::translate(-middle);
        let scales = Scales::new(document, scale);
        let map: Arc<dyn Map> = Arc::new(HiddenAffine(affine));
        let options = bending(&map, self.warp_options(scales.needed * f64::from(scales.oversampling)));
        let (warped, after) = match self.warped(AFFINE, &*map, &options) {
            Err(e) => return self.out.extend([AFFINE, EXACT].map(|check| Finding::failed(check, e.clone()))),
            Ok(w) => w,
        };
        self.structure(&warped);
        let moved = document.user_to_px() * affine * document.user_to_px().inverse();
        let exact = with_exact_arcs(&String::from_utf8_lossy(document.source()));
        let exact = exact.and_then(|text| Document::read(text.as_bytes(), "the file with exact arcs", self.read).ok());
        let mut last = None;
        for (check, original) in [(AFFINE, Some(document)), (EXACT, exact.as_ref())] {
            if let Some(original) = original {
                let pair = Pair { a: usvg_tree::tree(original), moved, b: usvg_tree::tree(&after) };
                let (share, remark) = pair.share(&scales);
                if share > SHARE {
                    self.save(check, pair.pictures(&scales));
                }
                last = Some((share <= SHARE, remark + &remarks(&warped)));
            }
            // Without arcs, the first comparison counts for both.
            self.out.extend(last.clone().map(|(passed, remark)| Finding::new(check, passed, remark)));
        }
    }

    /// Options with a tolerance for pictures at `scale` pixels per px.
    fn warp_options(&self, scale: f64) -> WarpOptions {
        WarpOptions::new(refit::Options::new(
            TOLERANCE / (scale * self.document.user_to_px().determinant().abs().sqrt()),
        ))
    }

    fn identity(&mut self, original: &Pixmap, scale: f64, options: &WarpOptions) {
        const UNCHANGED: &str = "identity: the file unchanged";
        self.out.push(match self.document.warp(&Identity, options) {
            Ok(w) => {
                let same =
                    w.svg.as_bytes() == self.document.source() || self.document.source().starts_with(&[0x1f, 0x8b]);
                Finding::new(UNCHANGED, same, "")
            }
            Err(e) => Finding::failed(UNCHANGED, e.to_string()),
        });
        let hidden = HiddenAffine(Affine::IDENTITY);
        for check in IDENTITY_CHECKS {
            let mut options = options.clone();
            options.structure = check.structure;
            options.copies = if check.copy { vec![Affine::IDENTITY] } else { Vec::new() };
            let map: &dyn Map = if check.hidden { &hidden } else { &Identity };
            let found = self.warped(check.name, map, &options).and_then(|(w, d)| {
                let picture = pictures::whole(usvg_tree::tree(&d), scale).ok_or("no picture")?;
                let difference = compare(original, &picture).map_err(|e| e.to_string())?;
                Ok((difference, picture, remarks(&w)))
            });
            match found {
                Err(e) => self.out.push(Finding::failed(check.name, e)),
                Ok((d, picture, remarks)) => {
                    let share = d.share_over(LEVELS);
                    let passed = share <= SHARE;
                    if !passed {
                        self.save(check.name, Some((original.clone(), picture)));
                    }
                    let remark = format!("{:.2} % of pixels{remarks}", 100.0 * share);
                    self.out.push(Finding::new(check.name, passed, remark));
                    if let Some(exact) = check.exact {
                        let remark = format!("{} pixels, by up to {}", d.pixels_over(0), d.max_channel);
                        self.out.push(Finding::new(exact, d.is_same(), remark));
                    }
                }
            }
        }
    }

    /// Warps the drawing and reads the result.
    fn warped(
        &mut self,
        check: &'static str,
        map: &dyn Map,
        options: &WarpOptions,
    ) -> Result<(WarpedDocument, Document), String> {
        let started = Instant::now();
        let warped = self.document.warp(map, options).map_err(|e| e.to_string())?;
        if started.elapsed() > self.slowest.0 {
            self.slowest = (started.elapsed(), check);
        }
        let after = Document::read(warped.svg.as_bytes(), "the result", self.read).map_err(|e| e.to_string())?;
        Ok((warped, after))
    }

    /// Warps by the strong shaper.
    fn bent(&mut self, scale: f64) {
        const CHECK: &str = "strong shaper";
        let Some(map) = maps::shaper(self.document.view_box()) else {
            return self.out.push(Finding::failed(CHECK, "no shaper"));
        };
        let options = bending(&map, self.warp_options(scale * f64::from(scale::oversampling(self.document))));
        let (warped, after) = match self.warped(CHECK, &*map, &options) {
            Err(e) => return self.out.push(Finding::failed(CHECK, e)),
            Ok(w) => w,
        };
        let Some((ours, expected, inside)) = pictures::bent(self.document, usvg_tree::tree(&after), &map, scale) else {
            return;
        };
        let Some(mean) = pictures::mean_inside(&ours, &expected, &inside) else { return };
        let passed = mean <= MEAN;
        if !passed {
            self.save("shaper", Some((ours, expected)));
        }
        self.out.push(Finding::new(CHECK, passed, format!("{mean:.2}/255{}", remarks(&warped))));
    }

    /// Checks that the file was patched in place and that ids, classes, titles and nesting are preserved.
    fn structure(&mut self, warped: &WarpedDocument) {
        let flattened = warped.warnings.iter().find(|w| matches!(w, Warning::Flattened(_)));
        self.out.push(Finding::new(
            "patched in place",
            flattened.is_none(),
            flattened.map(ToString::to_string).unwrap_or_default(),
        ));
        let text = String::from_utf8_lossy(self.document.source()).into_owned();
        let (Some(a), Some(b)) = (facts(&text), facts(&warped.svg)) else { return };
        // Instances of `use` repeat classes, so a count may grow.
        let lost: Vec<&String> = a.iter().filter(|(f, n)| b.get(*f).is_none_or(|m| m < n)).map(|(f, _)| f).collect();
        let remark = lost.iter().take(3).map(|f| f.as_str()).collect::<Vec<_>>().join("; ");
        self.out.push(Finding::new("ids, classes, titles, nesting", lost.is_empty(), remark));
    }

    /// Saves a pair of pictures side by side with their difference.
    fn save(&self, check: &str, pair: Option<(Pixmap, Pixmap)>) {
        let (Some(folder), Some((a, b))) = (&self.options.pictures, pair) else { return };
        let mut name: Vec<&str> = self.file.iter().rev().take(3).filter_map(|p| p.to_str()).collect();
        name.reverse();
        pictures::side_by_side(
            &a,
            &b,
            &folder.join(format!("{}--{}.png", check.replace([' ', ','], "-"), name.join("--"))),
        );
    }
}

/// Adds bent bitmaps and gradients, as the program does.
fn bending(map: &Arc<dyn Map>, mut options: WarpOptions) -> WarpOptions {
    let bender = Arc::new(Bender::new(Arc::clone(map), None));
    options.gradients = Gradients::Exact(bender.clone());
    options.images = Images::Warp(bender);
    options
}

/// The first warnings and skipped elements, as a hint at the cause.
fn remarks(w: &WarpedDocument) -> String {
    let skipped = w.skipped.iter().map(|s| format!("{}: {}", s.id, s.why));
    let all: Vec<String> = w.warnings.iter().map(ToString::to_string).chain(skipped).take(3).collect();
    if all.is_empty() { String::new() } else { format!(" ({})", all.join("; ")) }
}
