//! `cargo xtask corpus --svg FOLDER…`: whole drawings through the program's own reader, map and writers, measured against
//! resvg's rendering of the originals.
//!
//! Every file is taken through
//!
//! 1. the identity, bent as if it were no affine map, flattened and with its structure kept: the pictures must be the same;
//! 2. an affine map, also as if it were none: the picture must be what resvg draws of the original under that transform;
//! 3. a strong shaper: the picture must be the original's picture, large, bent pixel by pixel;
//! 4. a comparison of its ids, classes, titles and nesting before and after;
//! 5. reading and writing, timed beside usvg's own.
//!
//! A panic, and more than a minute for one file, count as failures of the program.

use crate::Fault;
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::map::{Class, Jet, Map, NewtonInverse};
use pathwarp::param::{Args, Frame};
use pathwarp::refit;
use pathwarp_raster::{Difference, ImageWarp, Pixmap, Size, compare, render, shown, warp_image};
use pathwarp_svg::{Document, GenericFamilies, ReadOptions, Structure, WarpOptions, Warped};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::time::{Duration, Instant};

/// The longest side of a picture, pixels.
const SIDE: f64 = 300.0;
/// That of pictures in which thin strokes count: large enough that the thinnest is wider than a pixel, within this.
const LARGE: f64 = 1600.0;
/// Pictures are alike if at most this share of their pixels …
const SHARE: f64 = 0.001;
/// … differs by more than this.
const LEVELS: u8 = 16;
/// The largest mean difference between a bent drawing and a bent picture of it, in 1/255.
const MEAN: f64 = 1.0;
/// How much larger that picture is.
const FINER: f64 = 4.0;
/// How long one file may take.
const LIMIT: Duration = Duration::from_secs(60);
/// Timed rounds per file; the best one counts.
const ROUNDS: usize = 5;

/// What is asked.
pub(crate) struct Job {
    /// Folders of SVG files.
    pub(crate) folders: Vec<PathBuf>,
    /// A folder of fonts for their text.
    pub(crate) fonts: Option<PathBuf>,
    /// Every how many files one is measured.
    pub(crate) every: usize,
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
struct Still;

impl Map for Still {
    fn jet(&self, p: Point) -> Jet {
        Jet { p, dx: Vec2::new(1.0, 0.0), dy: Vec2::new(0.0, 1.0) }
    }

    fn class(&self) -> Class {
        Class::Affine(Affine::IDENTITY)
    }
}

/// What was found of one file, by check: whether it passed, and a word on it.
type Findings = Vec<(&'static str, bool, String)>;

/// Seconds for reading and writing: ours, usvg's.
type Times = (f64, f64);

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
        let found = all(&files, &options);
        report(folder, &files, &found, &mut out);
        let times: Vec<Times> = files.iter().filter_map(|f| timed(f, &options)).collect();
        let (ours, theirs) = times.iter().fold((0.0, 0.0), |s, t| (s.0 + t.0, s.1 + t.1));
        let mut ratios: Vec<f64> = times.iter().map(|t| t.0 / t.1).collect();
        ratios.sort_by(f64::total_cmp);
        let median = ratios.get(ratios.len() / 2).copied().unwrap_or(f64::NAN);
        let _ = writeln!(
            out,
            "reading and writing: {ours:.3} s, usvg's own {theirs:.3} s: {:.2} of it, median {median:.2}",
            ours / theirs
        );
    }
    Ok(out)
}

/// The checks of all files, several at a time. The threads are our own: those of the warp's pool must not wait for it.
fn all(files: &[PathBuf], options: &ReadOptions) -> Vec<Findings> {
    let next = AtomicUsize::new(0);
    let found: Vec<Mutex<Findings>> = files.iter().map(|_| Mutex::default()).collect();
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some((file, slot)) = files.iter().zip(&found).nth(next.fetch_add(1, Ordering::Relaxed)) {
                    let findings = guarded(file, options);
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
fn guarded(file: &Path, options: &ReadOptions) -> Findings {
    let (send, receive) = mpsc::channel();
    let (path, options) = (file.to_owned(), options.clone());
    let thread = std::thread::Builder::new().stack_size(64 << 20).spawn(move || {
        // A receiver that has given up needs no answer.
        let _ = send.send(checks(&path, &options));
    });
    let fault = |what: &str| vec![("no panic, no hang", false, what.to_owned())];
    if thread.is_err() {
        return fault("no thread");
    }
    match receive.recv_timeout(LIMIT) {
        Ok(mut found) => {
            found.push(("no panic, no hang", true, String::new()));
            found
        }
        Err(mpsc::RecvTimeoutError::Timeout) => fault("more than a minute"),
        Err(mpsc::RecvTimeoutError::Disconnected) => fault("panic"),
    }
}

fn checks(file: &Path, options: &ReadOptions) -> Findings {
    let mut out = Findings::new();
    let Ok(bytes) = std::fs::read(file) else { return out };
    let options = ReadOptions { base_dir: file.parent().map(Path::to_owned), ..options.clone() };
    // What usvg refuses is not ours to draw.
    let Ok(document) = Document::read(&bytes, "the file", &options) else { return out };
    let size = document.size_px();
    let longest = size.width.max(size.height);
    let scale = SIDE / longest;
    let tolerance = 0.01 / (scale * document.user_to_px().determinant().abs().sqrt());
    let mut plain = WarpOptions::new(refit::Options::new(tolerance));
    let Some(original) = picture(&document, scale) else { return out };

    for (check, exact, structure) in [
        ("identity, flattened", "", Structure::Flatten),
        ("identity, structure kept", "identity, pixel for pixel", Structure::Auto),
    ] {
        plain.structure = structure;
        let after = warped(&document, &Plain(Affine::IDENTITY), &plain, &options);
        let difference = after
            .and_then(|(_, d)| picture(&d, scale).ok_or("no picture".into()))
            .and_then(|p| compare(&original, &p).map_err(|e| e.to_string()));
        push(&mut out, check, &difference);
        if !exact.is_empty() {
            let same = difference.as_ref().is_ok_and(Difference::is_same);
            out.push((exact, same, difference.map_or_else(|e| e, |d| format!("up to {}", d.max_channel))));
        }
    }

    // Turned, sheared and squeezed about the middle.
    let middle = document.view_box().center().to_vec2();
    let turn = Affine::translate(middle) * Affine::new([0.8, 0.15, -0.22, 0.62, 0.0, 0.0]) * Affine::translate(-middle);
    let thinnest = thinnest(document.tree().root()).unwrap_or(f64::INFINITY);
    /// The smallest stretch of the map, a little less.
    const SQUEEZE: f64 = 0.6;
    let fine = (1.1 / (SQUEEZE * thinnest)).clamp(scale, LARGE / longest);
    let after = warped(&document, &Plain(turn), &plain, &options);
    if let Ok((warped, _)) = &after {
        structure(&document, &warped.svg, &mut out);
        let anew = warped.warnings.iter().find(|w| w.contains("written anew"));
        out.push(("complete in place", anew.is_none(), anew.cloned().unwrap_or_default()));
    }
    let difference = after.and_then(|(_, d)| {
        let expected = drawn(&document, fine, document.user_to_px() * turn * document.user_to_px().inverse());
        let (a, b) = expected.zip(picture(&d, fine)).ok_or("no picture")?;
        compare(&a, &b).map_err(|e| e.to_string())
    });
    push(&mut out, "affine map", &difference);
    if let Some(found) = bent(&document, &plain, &options, scale) {
        out.push((
            "strong shaper",
            found.as_ref().is_ok_and(|m| *m <= MEAN),
            found.map_or_else(|e| e, |m| format!("{m:.2}/255")),
        ));
    }
    out
}

fn push(out: &mut Findings, check: &'static str, found: &Result<Difference, String>) {
    match found {
        Ok(d) => {
            let share = d.share_over(LEVELS);
            out.push((check, share <= SHARE, format!("{:.2} % of pixels", 100.0 * share)));
        }
        Err(e) => out.push((check, false, e.clone())),
    }
}

fn warped(
    document: &Document,
    map: &dyn Map,
    options: &WarpOptions,
    read: &ReadOptions,
) -> Result<(Warped, Document), String> {
    let warped = document.warp(map, options).map_err(|e| e.to_string())?;
    let after = Document::read(warped.svg.as_bytes(), "the result", read).map_err(|e| e.to_string())?;
    Ok((warped, after))
}

#[expect(clippy::cast_possible_truncation, reason = "the renderer's own precision")]
fn picture(document: &Document, scale: f64) -> Option<Pixmap> {
    render(document.tree(), Size::Scale(scale as f32)).ok()
}

/// What resvg draws of a document with everything moved by an affine map of its pixels.
#[expect(clippy::cast_possible_truncation, reason = "the renderer's own precision")]
fn drawn(document: &Document, scale: f64, moved: Affine) -> Option<Pixmap> {
    let blank = picture(document, scale)?;
    let mut out = Pixmap::new(blank.width(), blank.height())?;
    let [a, b, c, d, e, f] = (Affine::scale(scale) * moved).as_coeffs().map(|v| v as f32);
    resvg::render(document.tree(), resvg::tiny_skia::Transform::from_row(a, b, c, d, e, f), &mut out.as_mut());
    Some(out)
}

/// The width of the thinnest stroke, pixels.
fn thinnest(group: &usvg::Group) -> Option<f64> {
    let of = |node: &usvg::Node| match node {
        usvg::Node::Group(g) => thinnest(g),
        usvg::Node::Text(t) => thinnest(t.flattened()),
        usvg::Node::Path(p) => p.stroke().map(|s| {
            let (x, y) = p.abs_transform().get_scale();
            f64::from(s.width().get() * x.min(y))
        }),
        usvg::Node::Image(_) => None,
    };
    group.children().iter().filter_map(of).filter(|w| *w > 0.0).min_by(f64::total_cmp)
}

/// The mean difference, within what the page's picture covers, between the bent drawing's picture and the bent picture.
fn bent(document: &Document, options: &WarpOptions, read: &ReadOptions, scale: f64) -> Option<Result<f64, String>> {
    const NET: &str =
        "M4%,92% C30%,70% 60%,112% 95%,84% C112%,60% 82%,36% 96%,10% C70%,-4% 34%,26% 6%,8% C-8%,36% 20%,66% 4%,92% Z";
    let frame = Frame::new(document.view_box());
    let args = Args::from_pairs(&[("shaper", NET)]);
    let built = Registry::builtin().get("shaper")?.build_from(&args, &frame).ok()?;
    let area = document.view_box();
    /// How far beyond the page answers count: its pixels' edges.
    const REACH: f64 = 0.02;
    let inverse = NewtonInverse::over(Arc::clone(&built.map), area, REACH);
    let after = match warped(document, &*built.map, options, read) {
        Ok((_, d)) => d,
        Err(e) => return Some(Err(e)),
    };
    let ours = picture(&after, scale)?;
    let large = picture(document, FINER * scale)?;
    let mut solid = Pixmap::new(large.width(), large.height())?;
    solid.fill(resvg::tiny_skia::Color::BLACK);
    let to_user = document.user_to_px().inverse();
    let bend = |source: &Pixmap| {
        let warp = ImageWarp {
            source,
            placed: to_user * Affine::scale(1.0 / (FINER * scale)),
            map: &*built.map,
            inverse: &inverse,
            shown: to_user
                * Affine::scale(1.0 / scale)
                * shown(
                    Rect::new(0.0, 0.0, f64::from(ours.width()), f64::from(ours.height())),
                    (ours.width(), ours.height()),
                ),
            size: (ours.width(), ours.height()),
        };
        warp_image(&warp).ok()
    };
    let (expected, inside) = (bend(&large)?, bend(&solid)?);
    let (mut sum, mut count) = (0.0, 0.0);
    for ((a, b), inside) in ours.pixels().iter().zip(expected.pixels()).zip(inside.pixels()) {
        if inside.alpha() == 255 && (a.alpha() > 0 || b.alpha() > 0) {
            let off = |a: u8, b: u8| f64::from(a.abs_diff(b));
            sum +=
                off(a.red(), b.red()) + off(a.green(), b.green()) + off(a.blue(), b.blue()) + off(a.alpha(), b.alpha());
            count += 4.0;
        }
    }
    (count > 0.0).then(|| Ok(sum / count))
}

/// Ids, classes, titles and what lies in what.
fn structure(document: &Document, after: &str, out: &mut Findings) {
    let text = String::from_utf8_lossy(document.source()).into_owned();
    let parse = |text| {
        let options = usvg::roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
        usvg::roxmltree::Document::parse_with_options(text, options)
    };
    let (Ok(a), Ok(b)) = (parse(&text), parse(after)) else {
        return;
    };
    let facts = |d: &usvg::roxmltree::Document<'_>| {
        let mut facts = BTreeMap::new();
        let mut add = |fact: String| *facts.entry(fact).or_insert(0_usize) += 1;
        for e in d.descendants().filter(usvg::roxmltree::Node::is_element) {
            let id = e.attribute("id");
            let outer = e.ancestors().skip(1).find_map(|o| o.attribute("id")).unwrap_or("");
            if let Some(id) = id {
                add(format!("#{id} in #{outer}"));
            }
            for class in e.attribute("class").unwrap_or("").split_whitespace() {
                add(format!(".{class}"));
            }
            if e.has_tag_name("title") || e.tag_name().name() == "title" {
                add(format!("title {}", e.text().unwrap_or("").trim()));
            }
        }
        facts
    };
    let (a, b) = (facts(&a), facts(&b));
    // Copies of what was drawn several times may carry the same class more often.
    let lost = a.iter().find(|(fact, n)| b.get(*fact).is_none_or(|m| m < n));
    out.push(("ids, classes, titles, nesting", lost.is_none(), lost.map_or_else(String::new, |l| l.0.clone())));
}

/// Times reading and writing, one program after the other.
fn timed(file: &Path, options: &ReadOptions) -> Option<Times> {
    let bytes = std::fs::read(file).ok()?;
    let text = String::from_utf8(bytes).ok()?;
    // Reading fonts is the same work for both, and larger than all the rest.
    if text.contains("<text") || text.contains("image/svg") {
        return None;
    }
    let options = ReadOptions { base_dir: file.parent().map(Path::to_owned), ..options.clone() };
    let mut warp = WarpOptions::new(refit::Options::new(0.01));
    warp.structure = Structure::Flatten;
    let theirs = usvg::Options { resources_dir: options.base_dir.clone(), ..usvg::Options::default() };
    let mut best = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        let started = Instant::now();
        let written = Document::read(text.as_bytes(), "the file", &options).ok()?.warp(&Still, &warp).ok()?;
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
