//! Every sample under every deformation, rendered and compared with the reference pictures in `tests/reference/`.
//!
//! `PATHWARP_STORE=1 cargo test --test program pictures::` stores new ones: look at each before committing it.
//! Only the bundled font is used, so that the pictures are the same on every machine.

use crate::support::{artwork, root, sample};
use pathwarp::Seg;
use pathwarp::deform::{Pairs, Registry};
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Frame};
use pathwarp::refit;
use pathwarp_oracle::{Difference, difference};
use pathwarp_raster::{Color, Pixmap, RenderOptions, Size, decode_png, encode_png};
use pathwarp_svg::{Document, ReadOptions, Selection, WarpOptions, usvg_tree};
use std::f64::consts::FRAC_PI_2;
use std::fs;
use std::path::PathBuf;

/// Width of a reference picture.
const WIDTH: u32 = 240;
/// A pixel differs when a channel is off by more than this: antialiasing on other processors stays far below.
const VISIBLE: u8 = 24;
/// Fraction of the pixels that may differ.
const SHARE: f64 = 5e-4;

/// Values that keep the artwork on its page.
const DEFORMATIONS: [(&str, &str, Pairs); 5] = [
    ("shaper", "shaper", &[("shaper", CAGE), ("target", "5%,92% 95%,92%")]),
    ("shaper-four", "shaper", &[("shaper", CAGE), ("target", "3%,97% 90%,85% 80%,12% 15%,5%")]),
    ("projective", "projective", &[("target", "0%,100% 100%,90% 75%,20% 15%,5%")]),
    ("similitude", "similitude", &[("target", "12%,90% 85%,75%")]),
    ("affine", "affine", &[("rotate", "12"), ("scale-x", "0.7"), ("scale-y", "0.8"), ("skew-x", "-15")]),
];
/// A wide, flat shape, so that wide artwork stays on its page too.
const CAGE: &str = "M 0,30 C 30,42 60,18 100,28 C 97,20 103,10 97,2 C 70,-8 35,14 3,0 C 7,10 -3,20 0,30 Z";

fn draw(svg: &[u8]) -> Pixmap {
    let read = ReadOptions::default().with_system_fonts(false);
    let tree = usvg_tree::parse_tree(svg, "picture", &read).unwrap();
    RenderOptions { size: Size::Width(WIDTH), background: Some(Color::WHITE) }.render(&tree).unwrap()
}

fn warped(name: &str, deformation: &str, args: &[(&str, &str)]) -> Vec<u8> {
    let read = ReadOptions::default().with_system_fonts(false);
    let doc = Document::read(&fs::read(sample(name)).unwrap(), name, &read).unwrap();
    let guides = ["Base", "Target", "Shaper"].map(str::to_owned).to_vec();
    let selection = Selection { guides, ..Selection::default() };
    let artwork = doc.artwork_box(&selection).unwrap();
    let map = Registry::builtin()
        .get(deformation)
        .unwrap()
        .build_from(&Args::from_pairs(args), &Frame::new(artwork))
        .unwrap()
        .map;
    let tolerance = 1e-4 * diagonal(artwork);
    let options = WarpOptions::new(refit::Options::new(tolerance)).with_selection(selection);
    doc.warp(&map, &options).unwrap().svg.into_bytes()
}

fn diagonal(r: Rect) -> f64 {
    r.width().hypot(r.height())
}

fn reference(name: &str, deformation: &str) -> PathBuf {
    root().join("tests/reference").join(format!("{}-{deformation}.png", name.trim_end_matches(".svg")))
}

fn acceptable(d: &Difference) -> bool {
    d.share(VISIBLE) <= SHARE
}

#[test]
fn every_sample_matches_its_reference() {
    let store = std::env::var_os("PATHWARP_STORE").is_some();
    let mut off = Vec::new();
    for name in artwork() {
        for (label, deformation, args) in DEFORMATIONS {
            let picture = draw(&warped(&name, deformation, args));
            let file = reference(&name, label);
            if store {
                fs::create_dir_all(file.parent().unwrap()).unwrap();
                fs::write(&file, encode_png(&picture).unwrap()).unwrap();
                continue;
            }
            let known = decode_png(&fs::read(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()))).unwrap();
            let d = difference(&known, &picture);
            if !acceptable(&d) {
                off.push(format!("{}: {:.3} % of the pixels differ", file.display(), 100.0 * d.share(VISIBLE)));
            }
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
        crate::support::expect_code(0, &[&["gallery"], words, &["-o", &out]].concat());
        let file = root().join("tests/reference").join(format!("gallery-{label}.png"));
        if std::env::var_os("PATHWARP_STORE").is_some() {
            fs::copy(&sheet, &file).unwrap();
            continue;
        }
        let known = fs::read(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        let d = difference(&decode_png(&known).unwrap(), &decode_png(&fs::read(&sheet).unwrap()).unwrap());
        if d.share(VISIBLE) > CELL_SHARE {
            off.push(format!("{}: {:.4} % of the pixels differ", file.display(), 100.0 * d.share(VISIBLE)));
        }
    }
    assert!(off.is_empty(), "{}", off.join("\n"));
}

/// The comparison can fail: on a picture moved by half a pixel and on one with a missing shape.
#[test]
fn the_comparison_can_fail() {
    for name in ["logo.svg", "badge.svg", "lineart.svg", "grid.svg"] {
        let source = fs::read_to_string(sample(name)).unwrap();
        let here = draw(source.as_bytes());
        let start = source.find('>').unwrap();
        let half_pixel = format!("{}><g transform=\"translate(0.7 0)\">{}", &source[..start], &source[start + 1..])
            .replace("</svg>", "</g></svg>");
        // Nested viewports close with the same tag; the last one is the root's.
        let half_pixel = match half_pixel.matches("</g></svg>").count() {
            1 => half_pixel,
            _ => continue,
        };
        assert!(!acceptable(&difference(&here, &draw(half_pixel.as_bytes()))), "{name}");
        assert!(acceptable(&difference(&here, &draw(source.as_bytes()))), "{name}");
    }
    let tiles = fs::read_to_string(sample("tiles.svg")).unwrap();
    let first = tiles.find("<path").unwrap();
    let end = first + tiles[first..].find("/>").unwrap() + 2;
    let without = format!("{}{}", &tiles[..first], &tiles[end..]);
    assert!(!acceptable(&difference(&draw(tiles.as_bytes()), &draw(without.as_bytes()))));
}

/// Criterion: a straight shaper on the bounding box of the artwork keeps the picture, adds no segments, and keeps lines as lines.
#[test]
fn a_straight_shaper_changes_nothing() {
    let same = |source: usize, warped: usize| source == warped;
    straight("0%,0% 100%,0% 100%,100% 0%,100%", 1e-4, 2, same, same);
    // Off by 1e-8, so that the affine case is not recognised: no segment is added. (Pixels say little here: the renderer's circles
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
        let d = difference(&draw(&bytes), &draw(warped.svg.as_bytes()));
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
