//! Text in many scripts, and words as other programs write them, as Chromium shows them with equal fonts.
//!
//! Skipped where the browser is not installed.

use crate::browser;
use crate::support::{pathwarp_in, root, skipped};
use pathwarp_raster::{Pixmap, decode_png};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

const SIZE: [usize; 2] = [800, 120];

/// Texts, and their attributes. Their fonts are in this repository.
const TEXTS: [(&str, &str); 21] = [
    ("", "नमस्ते Hi"),
    ("", "Hi नमस्ते שלום שָׁלוֹם สวัสดี"),
    ("font-family='Noto Sans'", "(שלום) Hello مرحبا بالعالم ١٢٣ নমস্কার"),
    ("x='400' text-anchor='middle'", "សួស្តី Բարեւ გამარჯობა 日本語、かな"),
    ("x='790' text-anchor='end'", "Hi <tspan fill='blue'>สวัสดี</tspan> น้ำ <tspan font-size='20'>শ্রী हिन्दी</tspan>"),
    ("direction='rtl' x='790'", "שלום (abc) नमस्ते سلام"),
    ("textLength='600'", "Hi नमस्ते สวัสดี"),
    ("textLength='600' lengthAdjust='spacingAndGlyphs'", "Hi नमस्ते สวัสดี"),
    ("letter-spacing='5' word-spacing='10'", "Hi नमस्ते สวัสดี שלום abc"),
    ("dx='0 5 5' rotate='0 10 20'", "Hi สวัสดี"),
    ("", "Hi <tspan dy='-10' font-size='20'>नमस्ते</tspan><tspan dy='10'> down</tspan>"),
    ("dominant-baseline='middle'", "Hi नमस्ते"),
    ("fill='green'", "Hi 😀 😁!"),
    ("", "क्षत्रिय कर्म <tspan>हिन्दी</tspan>। 日本 Հայաստան"),
    // Words as Illustrator, Figma and Inkscape write them.
    ("font-variant='small-caps'", "Small Caps 12 été"),
    ("style='font-variant-caps:all-small-caps'", "Smallest"),
    ("", "<tspan>Hello</tspan><tspan> World</tspan> and<tspan> more</tspan>"),
    ("", "one\n  two<tspan>\n three</tspan>\n<tspan>four</tspan>\n"),
    ("xml:space='preserve' style='white-space: pre;letter-spacing:0.1em'", "<tspan x='20' y='60'>Two  words</tspan>"),
    ("xml:space='preserve' dx='0 3 -2 0 5' dy='0 2 4 -6' rotate='0 0 20 0'", "<tspan>Kerned by hand</tspan>"),
    (
        "letter-spacing='-0.02em'",
        "<tspan letter-spacing='-1'>W</tspan><tspan x='52' y='60'>e A</tspan><tspan x='130' y='60'>V</tspan>",
    ),
];

fn folder(name: &str) -> String {
    root().join(name).display().to_string()
}

/// Writes a configuration of fontconfig that knows only the fonts of this repository.
fn fontconfig(into: &Path) -> String {
    let mut text = "<?xml version='1.0'?><!DOCTYPE fontconfig SYSTEM 'fonts.dtd'><fontconfig>".to_owned();
    for name in ["crates/pathwarp-text/tests/scripts", "crates/pathwarp-svg/fonts"] {
        let _ = write!(text, "<dir>{}</dir>", folder(name));
    }
    let _ = write!(text, "<cachedir>{}</cachedir></fontconfig>", into.join("cache").display());
    let file = into.join("fonts.conf");
    fs::write(&file, text).unwrap();
    file.display().to_string()
}

/// Counts the dark pixels of a picture that are more than two pixels from any of another one.
fn strays(a: &Pixmap, b: &Pixmap) -> usize {
    let dark = |p: &Pixmap, x: i64, y: i64, most: u8| {
        let inside = x >= 0 && y >= 0 && x < i64::from(p.width()) && y < i64::from(p.height());
        inside && p.pixel(x as u32, y as u32).is_some_and(|c| c.alpha() > 128 && c.red().min(c.blue()) < most)
    };
    let all = (0..i64::from(a.height())).flat_map(|y| (0..i64::from(a.width())).map(move |x| (x, y)));
    let near = |(x, y): (i64, i64)| (-1..=1).any(|i| (-1..=1).any(|j| dark(b, x + i, y + j, 200)));
    all.filter(|&(x, y)| dark(a, x, y, 100) && !near((x, y))).count()
}

#[test]
fn texts_are_as_in_chromium() {
    if let Some(why) = browser::missing() {
        return skipped(format!("texts in Chromium: {why} is not installed"));
    }
    let dir = tempfile::tempdir().unwrap();
    let config = fontconfig(dir.path());
    let mut wrong = Vec::new();
    for (attributes, content) in TEXTS {
        let place = if attributes.contains(" x='") || attributes.starts_with("x='") { "" } else { "x='20'" };
        let [width, height] = SIZE;
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' viewBox='0 0 {width} {height}'>\
             <rect width='100%' height='100%' fill='white'/>\
             <g font-family='sans-serif' text-rendering='geometricPrecision'><text {place} y='60' font-size='36' {attributes}>{content}</text></g></svg>"
        );
        let file = dir.path().join("a.svg");
        fs::write(&file, text).unwrap();
        let shown = browser::shown_with(&file, SIZE, &[("FONTCONFIG_FILE", &config)]);
        let fonts = folder("crates/pathwarp-text/tests/scripts");
        let args = ["render", "a.svg", "-o", "a.png", "--no-system-fonts", "--fonts-dir", &fonts];
        let out = pathwarp_in(dir.path(), &args, b"");
        assert!(out.status.success(), "{content}: {}", String::from_utf8_lossy(&out.stderr));
        let own = decode_png(&fs::read(dir.path().join("a.png")).unwrap()).unwrap();
        let off = (strays(&shown, &own), strays(&own, &shown));
        if off.0 + off.1 > 12 {
            wrong.push(format!("{content} ({attributes}): {off:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
