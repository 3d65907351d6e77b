//! What is checked of one file.

use super::pictures::{self, Pair};
use super::refined;
use pathwarp::kurbo::{Affine, Point, Vec2};
use pathwarp::map::{Class, Jet, Map};
use pathwarp::refit;
use pathwarp_cli::Bender;
use pathwarp_raster::{Pixmap, compare};
use pathwarp_svg::{Document, Gradients, Images, ReadOptions, Structure, WarpOptions, Warped};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The longest side of a picture, pixels.
pub(super) const SIDE: f64 = 300.0;
/// Pictures are alike if at most this share of their pixels …
const SHARE: f64 = 0.001;
/// … differs by more than this.
pub(super) const LEVELS: u8 = 16;
/// The largest mean difference between a bent drawing and a bent picture of it, in 1/255.
const MEAN: f64 = 1.0;
/// Of a pixel of the picture that is compared: the tolerance.
const TOLERANCE: f64 = 0.01;
/// How long reading and bending one file may take.
const SLOW: Duration = Duration::from_secs(60);

/// The affine map against the original, and against the original with exact arcs.
const AFFINE: &str = "affine map";
const EXACT: &str = "affine map, the original's arcs exact";

/// The check that nothing breaks.
pub(super) const ALIVE: &str = "no panic, no hang";

/// What was found of one file, by check: whether it passed, and a word on it.
pub(super) type Findings = Vec<(&'static str, bool, String)>;

/// How files are examined.
#[derive(Clone)]
pub(super) struct Way {
    pub(super) read: ReadOptions,
    /// Where pictures of what misses go.
    pub(super) pictures: Option<PathBuf>,
    /// The checks that are made; all if empty.
    pub(super) only: Vec<String>,
}

/// An affine map that does not say so.
struct Plain(Affine);

impl Map for Plain {
    fn jet(&self, p: Point) -> Jet {
        let [a, b, c, d, ..] = self.0.as_coeffs();
        Jet { p: self.0 * p, dx: Vec2::new(a, b), dy: Vec2::new(c, d) }
    }
}

/// The identity, which says so.
pub(super) struct Still;

impl Map for Still {
    fn jet(&self, p: Point) -> Jet {
        Jet { p, dx: Vec2::new(1.0, 0.0), dy: Vec2::new(0.0, 1.0) }
    }

    fn class(&self) -> Class {
        Class::Affine(Affine::IDENTITY)
    }
}

/// One file under examination.
struct Case<'a> {
    file: &'a Path,
    document: &'a Document,
    read: &'a ReadOptions,
    way: &'a Way,
    out: Findings,
    slowest: (Duration, &'static str),
}

pub(super) fn all(file: &Path, way: &Way) -> Findings {
    let Ok(bytes) = std::fs::read(file) else { return Findings::new() };
    let options = ReadOptions { base_dir: file.parent().map(Path::to_owned), ..way.read.clone() };
    let started = Instant::now();
    let document = match Document::read(&bytes, "the file", &options) {
        Ok(d) => d,
        Err(e) => {
            // What usvg refuses, or fails on, is not ours to draw.
            let theirs = catch_unwind(|| usvg::Tree::from_data(&bytes, &usvg::Options::default()).is_ok());
            return match theirs {
                Ok(true) => vec![("read", false, e.to_string())],
                _ => Findings::new(),
            };
        }
    };
    let mut case = Case {
        file,
        document: &document,
        read: &options,
        way,
        out: vec![("read", true, String::new())],
        slowest: (started.elapsed(), "reading"),
    };
    let whole = catch_unwind(AssertUnwindSafe(|| case.checks()));
    let (took, what) = case.slowest;
    let (ok, word) = match whole {
        Err(_) => (false, "panic".to_owned()),
        Ok(()) => (took <= SLOW, format!("{what} took {:.0} s", took.as_secs_f64())),
    };
    case.out.push((ALIVE, ok, word));
    case.out
}

impl Case<'_> {
    fn checks(&mut self) {
        let document = self.document;
        let size = document.size_px();
        let scale = SIDE / size.width.max(size.height);
        let options = self.options(scale);
        let Some(original) = pictures::whole(document.tree(), scale) else { return };
        if self.asked("identity") {
            self.identity(&original, scale, &options);
        }
        if self.asked("affine") {
            self.affine(scale);
        }
        if self.asked("shaper") {
            self.bent(scale);
        }
    }

    fn asked(&self, check: &str) -> bool {
        self.way.only.is_empty() || self.way.only.iter().any(|o| o == check)
    }

    /// The affine map, hidden from the fitter.
    fn affine(&mut self, scale: f64) {
        let document = self.document;
        // Turned, sheared and squeezed about the middle.
        let middle = document.view_box().center().to_vec2();
        let turn =
            Affine::translate(middle) * Affine::new([0.8, 0.15, -0.22, 0.62, 0.0, 0.0]) * Affine::translate(-middle);
        let fine = pictures::fine(document, scale);
        let map: Arc<dyn Map> = Arc::new(Plain(turn));
        let options = bending(&map, self.options(fine.needed * f64::from(fine.n)));
        let (warped, after) = match self.warped(AFFINE, &*map, &options) {
            Err(e) => return [AFFINE, EXACT].into_iter().for_each(|check| self.out.push((check, false, e.clone()))),
            Ok(w) => w,
        };
        self.structure(&warped);
        let moved = document.user_to_px() * turn * document.user_to_px().inverse();
        let exact = refined::refined(&String::from_utf8_lossy(document.source()));
        let exact = exact.and_then(|text| Document::read(text.as_bytes(), "the refined file", self.read).ok());
        let mut last = None;
        for (check, original) in [(AFFINE, Some(document)), (EXACT, exact.as_ref())] {
            if let Some(original) = original {
                let pair = Pair { a: original.tree(), moved, b: after.tree() };
                let (share, word) = pair.share(&fine);
                if share > SHARE {
                    self.keep(&check.replace([' ', ','], "-"), pair.pictures(&fine));
                }
                last = Some((share <= SHARE, word + &remarks(&warped)));
            }
            // Where there is nothing to refine, one picture is as good as the other.
            self.out.extend(last.clone().map(|(ok, word)| (check, ok, word)));
        }
    }

    /// Bends and draws as fine as asked for: pixels per px.
    fn options(&self, scale: f64) -> WarpOptions {
        WarpOptions::new(refit::Options::new(
            TOLERANCE / (scale * self.document.user_to_px().determinant().abs().sqrt()),
        ))
    }

    fn identity(&mut self, original: &Pixmap, scale: f64, options: &WarpOptions) {
        let mut options = options.clone();
        match self.document.warp(&Still, &options) {
            Ok(w) => {
                let same =
                    w.svg.as_bytes() == self.document.source() || self.document.source().starts_with(&[0x1f, 0x8b]);
                self.out.push(("identity: the file itself", same, String::new()));
            }
            Err(e) => self.out.push(("identity: the file itself", false, e.to_string())),
        }
        // "A copy where it stands" leads past the short cut for maps that move nothing.
        let (alone, moved) = (Vec::new(), vec![Affine::IDENTITY]);
        let hidden = Plain(Affine::IDENTITY);
        for (check, exactly, structure, map, copies) in [
            (
                "identity, written anew",
                "identity, written anew, pixel for pixel",
                Structure::Flatten,
                &Still as &dyn Map,
                &alone,
            ),
            (
                "identity, control points moved, written anew",
                "identity, control points moved, written anew, pixel for pixel",
                Structure::Flatten,
                &Still,
                &moved,
            ),
            (
                "identity, control points moved, patched",
                "identity, control points moved, patched, pixel for pixel",
                Structure::Auto,
                &Still,
                &moved,
            ),
            ("identity refitted, written anew", "", Structure::Flatten, &hidden, &moved),
            ("identity refitted, patched", "", Structure::Auto, &hidden, &moved),
        ] {
            options.structure = structure;
            options.copies.clone_from(copies);
            let found = self.warped(check, map, &options).and_then(|(w, d)| {
                let picture = pictures::whole(d.tree(), scale).ok_or("no picture")?;
                let difference = compare(original, &picture).map_err(|e| e.to_string())?;
                Ok((difference, picture, remarks(&w)))
            });
            match found {
                Err(e) => self.out.push((check, false, e)),
                Ok((d, picture, remarks)) => {
                    let share = d.share_over(LEVELS);
                    let ok = share <= SHARE;
                    if !ok {
                        self.keep(&check.replace([' ', ','], "-"), Some((original.clone(), picture)));
                    }
                    self.out.push((check, ok, format!("{:.2} % of pixels{remarks}", 100.0 * share)));
                    if !exactly.is_empty() {
                        let word = format!("{} pixels, by up to {}", d.pixels_over(0), d.max_channel);
                        self.out.push((exactly, d.is_same(), word));
                    }
                }
            }
        }
    }

    fn warped(
        &mut self,
        check: &'static str,
        map: &dyn Map,
        options: &WarpOptions,
    ) -> Result<(Warped, Document), String> {
        let started = Instant::now();
        let warped = self.document.warp(map, options).map_err(|e| e.to_string())?;
        if started.elapsed() > self.slowest.0 {
            self.slowest = (started.elapsed(), check);
        }
        let after = Document::read(warped.svg.as_bytes(), "the result", self.read).map_err(|e| e.to_string())?;
        Ok((warped, after))
    }

    /// The strong shaper.
    fn bent(&mut self, scale: f64) {
        const CHECK: &str = "strong shaper";
        let Some(map) = pictures::shaper(self.document.view_box()) else {
            return self.out.push((CHECK, false, "no shaper".into()));
        };
        let options = bending(&map, self.options(scale * f64::from(pictures::finer(self.document))));
        let (warped, after) = match self.warped(CHECK, &*map, &options) {
            Err(e) => return self.out.push((CHECK, false, e)),
            Ok(w) => w,
        };
        let Some((ours, expected, inside)) = pictures::bent(self.document, after.tree(), &map, scale) else { return };
        let Some(mean) = pictures::mean_inside(&ours, &expected, &inside) else { return };
        let ok = mean <= MEAN;
        if !ok {
            self.keep("shaper", Some((ours, expected)));
        }
        self.out.push((CHECK, ok, format!("{mean:.2}/255{}", remarks(&warped))));
    }

    /// Ids, classes, titles and what lies in what, and whether the file had to be written anew.
    fn structure(&mut self, warped: &Warped) {
        let anew = warped.warnings.iter().find(|w| w.contains("written anew"));
        self.out.push(("complete in place", anew.is_none(), anew.cloned().unwrap_or_default()));
        let text = String::from_utf8_lossy(self.document.source()).into_owned();
        let (Some(a), Some(b)) = (facts(&text), facts(&warped.svg)) else { return };
        // Copies of what was drawn several times may carry the same class more often.
        let lost: Vec<&String> = a.iter().filter(|(f, n)| b.get(*f).is_none_or(|m| m < n)).map(|(f, _)| f).collect();
        let word = lost.iter().take(3).map(|f| f.as_str()).collect::<Vec<_>>().join("; ");
        self.out.push(("ids, classes, titles, nesting", lost.is_empty(), word));
    }

    /// Keeps a pair of pictures for looking at, side by side with their difference.
    fn keep(&self, check: &str, pair: Option<(Pixmap, Pixmap)>) {
        let (Some(folder), Some((a, b))) = (&self.way.pictures, pair) else { return };
        let mut name: Vec<&str> = self.file.iter().rev().take(3).filter_map(|p| p.to_str()).collect();
        name.reverse();
        pictures::side_by_side(&a, &b, &folder.join(format!("{check}--{}.png", name.join("--"))));
    }
}

/// With bitmaps and gradients bent, as the program does it.
fn bending(map: &Arc<dyn Map>, mut options: WarpOptions) -> WarpOptions {
    let bender = Arc::new(Bender::new(Arc::clone(map), None));
    options.gradients = Gradients::Exact(bender.clone());
    options.images = Images::Warp(bender);
    options
}

/// What the program said of its own accord, for telling causes.
fn remarks(w: &Warped) -> String {
    let skipped = w.skipped.iter().map(|s| format!("{}: {}", s.id, s.why));
    let all: Vec<String> = w.warnings.iter().cloned().chain(skipped).take(3).collect();
    if all.is_empty() { String::new() } else { format!(" ({})", all.join("; ")) }
}

/// How often everything stands in a file that must not get lost.
fn facts(text: &str) -> Option<BTreeMap<String, usize>> {
    let options = usvg::roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let d = usvg::roxmltree::Document::parse_with_options(text, options).ok()?;
    let mut facts = BTreeMap::new();
    let mut add = |fact: String| *facts.entry(fact).or_insert(0_usize) += 1;
    for e in d.descendants().filter(usvg::roxmltree::Node::is_element) {
        let outer = e.ancestors().skip(1).find_map(|o| o.attribute("id")).unwrap_or("");
        if let Some(id) = e.attribute("id") {
            add(format!("#{id} in #{outer}"));
        }
        for class in e.attribute("class").unwrap_or("").split_whitespace() {
            add(format!(".{class} in #{outer}"));
        }
        if e.tag_name().name() == "title" {
            add(format!("title {} in #{outer}", e.text().unwrap_or("").trim()));
        }
    }
    Some(facts)
}
