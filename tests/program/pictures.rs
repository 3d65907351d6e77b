//! Every deformation in two examples of its page, each on three samples, compared with the reference pictures in `tests/reference/`.
//!
//! `PATHWARP_STORE=1 cargo test --test program pictures::` stores new ones: look at each before committing it.
//! Only the bundled font is used, so that the pictures are equal on every machine.

use crate::support::{artwork, expect_code, root, sample, words_into};
use pathwarp::Seg;
use pathwarp::deform::{Info, Registry};
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Frame};
use pathwarp::refit;
use pathwarp_oracle::{Difference, difference};
use pathwarp_raster::{Pixmap, decode_png, encode_png};
use pathwarp_svg::{Document, ReadOptions, Selection, WarpOptions, usvg_tree};
use resvg::tiny_skia::{Color, IntRect, PixmapPaint, Transform};
use std::f64::consts::FRAC_PI_2;
use std::fs;
use std::path::{Path, PathBuf};

/// A drawing of areas, one of text, and one of strokes.
const SAMPLES: [&str; 3] = ["badge.svg", "headline.svg", "lineart.svg"];
/// Pixels of the longer side of a picture. The pictures of a deformation share a sheet: a row for each example.
const SIDE: u32 = 200;
/// Difference of a channel beyond which a pixel differs. Antialiasing on other processors stays far below.
const VISIBLE: u8 = 24;
/// Fraction of the pixels that may differ.
const SHARE: f64 = 5e-4;

/// The first two examples that run on any drawing: they name neither a path nor a photograph.
fn examples(info: &Info) -> [&'static str; 2] {
    let of_any = |command: &&str| !command.contains("'#") && !command.contains(".jpg");
    let mut all = info.examples.iter().map(|e| e.command).filter(of_any);
    [(); 2].map(|()| all.next().unwrap_or_else(|| panic!("{} has no two examples for any drawing", info.name)))
}

/// The result of an example on another sample.
fn bent(folder: &Path, example: &str, sample: &str) -> Vec<u8> {
    let mut words = words_into(folder, example);
    words[1] = format!("samples/{sample}");
    words.push("--no-system-fonts".into());
    expect_code(0, &words);
    fs::read(folder.join("out.svg")).unwrap()
}

/// Draws a page in a corner of a white square, moved by this many pixels.
fn draw(svg: &[u8], [x, y]: [f32; 2]) -> Pixmap {
    let read = ReadOptions::default().with_system_fonts(false);
    let tree = usvg_tree::parse_tree(svg, "picture", &read).unwrap();
    let scale = SIDE as f32 / tree.size().width().max(tree.size().height());
    let mut out = Pixmap::new(SIDE, SIDE).unwrap();
    out.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(scale, scale).post_translate(x, y), &mut out.as_mut());
    out
}

fn acceptable(d: &Difference) -> bool {
    d.share(VISIBLE) <= SHARE
}

fn stores() -> bool {
    std::env::var_os("PATHWARP_STORE").is_some()
}

fn reference(name: &str) -> PathBuf {
    root().join("tests/reference").join(name).with_extension("png")
}

fn known(name: &str) -> Pixmap {
    let file = reference(name);
    decode_png(&fs::read(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()))).unwrap()
}

/// No reference would match if the picture were moved by half a pixel.
#[test]
fn every_deformation_matches_its_reference() {
    let folder = tempfile::tempdir().unwrap();
    let mut off = Vec::new();
    for entry in Registry::builtin().entries() {
        let name = entry.info().name;
        let mut sheet = Pixmap::new(SIDE * SAMPLES.len() as u32, SIDE * 2).unwrap();
        let known = (!stores()).then(|| known(name));
        for (row, example) in (0..).zip(examples(entry.info())) {
            for (column, sample) in (0..).zip(SAMPLES) {
                let svg = bent(folder.path(), example, sample);
                let picture = draw(&svg, [0.0; 2]);
                let [x, y] = [column, row].map(|n| n * SIDE as i32);
                let off_by = |moved: [f32; 2]| {
                    let known = known.as_ref()?.clone_rect(IntRect::from_xywh(x, y, SIDE, SIDE).unwrap()).unwrap();
                    Some(difference(&known, &draw(&svg, moved)))
                };
                sheet.draw_pixmap(x, y, picture.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
                if let Some(d) = off_by([0.0; 2]).filter(|d| !acceptable(d)) {
                    off.push(format!("{example}, on {sample}: {:.3} % of the pixels differ", 100.0 * d.share(VISIBLE)));
                }
                for moved in [[0.5, 0.0], [0.0, 0.5]] {
                    let found = off_by(moved);
                    assert!(
                        !found.is_some_and(|d| acceptable(&d)),
                        "{example}, on {sample}: moved by {moved:?}, it is not seen"
                    );
                }
            }
        }
        if stores() {
            fs::write(reference(name), encode_png(&sheet).unwrap()).unwrap();
        }
    }
    assert!(off.is_empty(), "{}", off.join("\n"));
}

/// Fraction of a sheet's pixels that may differ: the cells share the pixels, so a fault in one of them counts for less.
const CELL_SHARE: f64 = SHARE / 16.0;

/// Every warp style and every text shape, as `pathwarp gallery` draws them.
#[test]
fn every_style_matches_its_reference() {
    let folder = tempfile::tempdir().unwrap();
    let mut off = Vec::new();
    for (label, words) in [
        ("styles", &["samples/lettering.svg", "--cell", "150x100"][..]),
        ("styles-vertical", &["samples/lettering.svg", "--cell", "150x100", "--bend", "-60%", "--axis", "vertical"]),
        ("wordart", &["samples/logo.svg", "--cell", "110x90", "--columns", "8", "--set", "wordart"]),
    ] {
        let sheet = folder.path().join(label).with_extension("png");
        let out = sheet.display().to_string();
        expect_code(0, &[&["gallery"], words, &["-o", &out]].concat());
        let name = format!("gallery-{label}");
        if stores() {
            fs::copy(&sheet, reference(&name)).unwrap();
            continue;
        }
        let d = difference(&known(&name), &decode_png(&fs::read(&sheet).unwrap()).unwrap());
        if d.share(VISIBLE) > CELL_SHARE {
            off.push(format!("{name}: {:.4} % of the pixels differ", 100.0 * d.share(VISIBLE)));
        }
    }
    assert!(off.is_empty(), "{}", off.join("\n"));
}

/// The comparison sees a missing shape.
#[test]
fn a_missing_shape_differs() {
    let tiles = fs::read_to_string(sample("tiles.svg")).unwrap();
    let first = tiles.find("<path").unwrap();
    let end = first + tiles[first..].find("/>").unwrap() + 2;
    let without = format!("{}{}", &tiles[..first], &tiles[end..]);
    let [whole, without] = [&tiles, &without].map(|svg| draw(svg.as_bytes(), [0.0; 2]));
    assert!(!acceptable(&difference(&whole, &without)) && acceptable(&difference(&whole, &whole)));
}

fn diagonal(r: Rect) -> f64 {
    r.width().hypot(r.height())
}

/// A straight shaper on the bounding box of the artwork keeps the picture, adds no segments, and keeps lines as lines.
#[test]
fn a_straight_shaper_changes_nothing() {
    let same = |source: usize, warped: usize| source == warped;
    straight("0%,0% 100%,0% 100%,100% 0%,100%", 1e-4, 2, same, same);
    // Off by 1e-8, so that the affine case is not recognised: no segment is added. (Pixels prove little here: the renderer's circles
    // are polynomials too, and dashes along them move with the error in length.)
    let no_more = |source: usize, warped: usize| warped <= source;
    let any = |_: usize, _: usize| true;
    straight("0%,0% 100%,0% 100%,100.000001% 0%,100%", 1e-4, 255, any, no_more);
}

fn straight(
    shaper: &str,
    tolerance: f64,
    channel: usize,
    lines: fn(usize, usize) -> bool,
    all: fn(usize, usize) -> bool,
) {
    let read = ReadOptions::default().with_system_fonts(false);
    for name in artwork() {
        let bytes = fs::read(sample(&name)).unwrap();
        let doc = Document::read(&bytes, &name, &read).unwrap();
        let frame = doc.artwork_box(&Selection::default()).unwrap();
        let args = Args::from_pairs(&[("shaper", shaper)]);
        let map = Registry::builtin().get("shaper").unwrap().build_from(&args, &Frame::new(frame)).unwrap().map;
        let warped = doc.warp(&map, &WarpOptions::new(refit::Options::new(tolerance * diagonal(frame)))).unwrap();
        let d = difference(&draw(&bytes, [0.0; 2]), &draw(warped.svg.as_bytes(), [0.0; 2]));
        assert!(d.most() <= channel, "{name}, {shaper}: off by {}", d.most());
        let after = Document::read(warped.svg.as_bytes(), &name, &read).unwrap();
        // One cubic represents a quarter of an ellipse.
        let cubics = |s: &Seg| match s {
            Seg::Arc(a) => (a.sweep.abs() / FRAC_PI_2 - 1e-9).ceil() as usize,
            _ => 1,
        };
        let segs = |d: &Document, lines: bool| -> usize {
            let painted = d.selected(&Selection::default()).flat_map(|s| s.outline.segs());
            painted.filter(|s| !lines || matches!(s, Seg::Line(_))).map(cubics).sum()
        };
        assert!(lines(segs(&doc, true), segs(&after, true)), "{name}, {shaper}: lines");
        assert!(all(segs(&doc, false), segs(&after, false)), "{name}, {shaper}: segments");
    }
}
