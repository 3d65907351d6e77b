//! Text in scripts that its fonts lack, with fonts of this repository alone.
//!
//! The truth is the result of `pathwarp text` for each word in the font for it, which the tests of `pathwarp-text` compare with HarfBuzz.

use crate::support::{pathwarp_in, root};
use pathwarp::kurbo::Rect;
use pathwarp_svg::{Document, ReadOptions};
use std::fs;
use std::path::Path;

const SIZE: f64 = 50.0;

/// Words, and the files of the fonts that have their letters.
const WORDS: [(&str, &str); 10] = [
    ("नमस्ते", "devanagari.ttf"),
    ("হিন্দী", "bengali.ttf"),
    ("สวัสดี", "thai.ttf"),
    ("សួស្តី", "khmer.ttf"),
    ("Բարեւ", "armenian.ttf"),
    ("გამარჯობა", "georgian.ttf"),
    ("שלום", "hebrew.ttf"),
    ("مرحبا", "arabic.ttf"),
    ("日本語", "japanese.otf"),
    ("Hi", ""),
];

fn fonts() -> String {
    root().join("crates/pathwarp-text/tests/scripts").display().to_string()
}

fn svg(content: &str) -> String {
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 2000 2000' font-size='{SIZE}'>{content}</svg>")
}

#[track_caller]
fn run(args: &[&str], stdin: &str) -> (Option<i32>, Vec<u8>, String) {
    let dir = tempfile::tempdir().unwrap();
    let out = pathwarp_in(dir.path(), args, stdin.as_bytes());
    (out.status.code(), out.stdout, String::from_utf8(out.stderr).unwrap())
}

/// The boxes of all subpaths, from left to right.
fn boxes(svg: &[u8]) -> Vec<Rect> {
    let doc = Document::read(svg, "out", &ReadOptions::default().with_system_fonts(false)).unwrap();
    let outlines = doc.shapes().iter().flat_map(|s| &s.outline.subpaths);
    let mut all: Vec<Rect> =
        outlines.filter_map(|s| pathwarp::Outline { subpaths: vec![s.clone()] }.bounding_box()).collect();
    all.sort_by(|a, b| a.x0.total_cmp(&b.x0).then(a.y0.total_cmp(&b.y0)).then(a.x1.total_cmp(&b.x1)));
    all
}

/// A drawing, moved.
#[track_caller]
fn moved(content: &str, options: &[&str]) -> (Option<i32>, Vec<Rect>, String) {
    let fonts = fonts();
    let args = ["affine", "-", "--move-x", "1", "--no-system-fonts", "--fonts-dir", &fonts];
    let (code, out, said) = run(&[&args[..], options].concat(), &svg(content));
    (code, if out.is_empty() { Vec::new() } else { boxes(&out) }, said)
}

/// Returns the boxes of `pathwarp text` for a word in one font.
fn word(text: &str, font: &str) -> Vec<Rect> {
    let (size, file) = (SIZE.to_string(), Path::new(&fonts()).join(font).display().to_string());
    let own = if font.is_empty() { vec![] } else { vec!["--font", &file] };
    let (code, out, said) = run(&[&["text", text, "--size", &size, "--no-system-fonts"][..], &own].concat(), "");
    assert_eq!((code, said.as_str()), (Some(0), ""), "{text}");
    boxes(&out)
}

/// Asserts that boxes are those of a word, wherever it is.
#[track_caller]
fn same(found: &[Rect], expected: &[Rect], within: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}: {found:?} {expected:?}");
    let by = found[0].origin() - expected[0].origin();
    for (a, b) in found.iter().zip(expected) {
        let b = *b + by;
        let off =
            [a.x0 - b.x0, a.y0 - b.y0, a.x1 - b.x1, a.y1 - b.y1].into_iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        assert!(off < within, "{what}: {a:?} {b:?}");
    }
}

/// Each word alone takes the font for its script, whatever its text names.
#[test]
fn a_word_takes_the_font_of_its_script() {
    for (text, font) in WORDS {
        let expected = word(text, font);
        for family in ["sans-serif", "serif", "Noto Sans"] {
            let (code, found, said) = moved(&format!("<text x='20' y='90' font-family='{family}'>{text}</text>"), &[]);
            assert_eq!((code, said.as_str()), (Some(0), ""), "{text}");
            same(&found, &expected, 0.01, text);
        }
    }
}

/// Words of all scripts in one line look as they do alone, in every order and alignment, on a path, and in separate elements.
#[test]
fn words_keep_their_shape_among_others() {
    let alone: Vec<Vec<Rect>> = WORDS.iter().map(|(text, font)| word(text, font)).collect();
    for start in 0..WORDS.len() {
        let order: Vec<usize> = (0..WORDS.len()).map(|i| (start + 3 * i) % WORDS.len()).collect();
        let texts: Vec<&str> = order.iter().map(|i| WORDS[*i].0).collect();
        let line = texts.join(" ");
        let parts: String = texts.iter().map(|t| format!("<tspan fill='red'>{t}</tspan> ")).collect();
        let anchor = ["start", "middle", "end"][start % 3];
        for content in [
            format!("<text x='990' y='90' text-anchor='{anchor}'>{line}</text>"),
            format!("<text x='990' y='90' text-anchor='{anchor}'>{parts}</text>"),
            format!("<defs><path id='p' d='M0 90H2000'/></defs><text><textPath href='#p'>{line}</textPath></text>"),
            format!("<text y='90' xml:space='preserve'>{line}</text>"),
        ] {
            let (code, found, said) = moved(&content, &[]);
            assert!(code == Some(0) && !said.contains("font"), "{said}");
            assert_eq!(found.len(), alone.iter().map(Vec::len).sum::<usize>(), "{content}");
            // Hebrew and Arabic beside each other go from right to left as a whole.
            let mut left: Vec<usize> = order.clone();
            let rtl = |i: usize| matches!(WORDS[i].1, "hebrew.ttf" | "arabic.ttf");
            for i in 1..left.len() {
                if rtl(left[i - 1]) && rtl(left[i]) {
                    left.swap(i - 1, i);
                }
            }
            let mut rest = &found[..];
            for i in left {
                let (own, others) = rest.split_at(alone[i].len());
                // usvg measures paths to a fraction of a unit.
                let within = if content.contains("textPath") { 1.0 } else { 0.01 };
                same(own, &alone[i], within, &format!("{} in {content}", WORDS[i].0));
                rest = others;
            }
        }
    }
}

/// A line is as long as its words and the spaces between them, which the first font has.
#[test]
fn pieces_follow_one_another() {
    let space = {
        let [a, b] = [word("Hi Hi", ""), word("HiHi", "")].map(|w| w.iter().map(|b| b.x1).fold(0.0, f64::max));
        a - b
    };
    let advance = |text: &str, font: &str| {
        // The page of a word without a margin is as wide as its advance, or its ink.
        let file = Path::new(&fonts()).join(font).display().to_string();
        let (_, out, _) =
            run(&["text", text, "--size", "50", "--font", &file, "--no-system-fonts", "--margin", "0"], "");
        let text = String::from_utf8(out).unwrap();
        let line = text.split("data-baseline=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
        let ends: Vec<f64> = line.split(' ').map(|v| v.parse().unwrap()).collect();
        ends[2] - ends[0]
    };
    let (thai, khmer) = (advance("สวัสดี", "thai.ttf"), advance("សួស្តី", "khmer.ttf"));
    // The position at which the first or last word of a drawing begins.
    let (thai_parts, khmer_parts) = (word("สวัสดี", "thai.ttf").len(), word("សួស្តី", "khmer.ttf").len());
    let first = |content: &str| moved(content, &[]).1[0].x0;
    let last = |content: &str, parts: usize| moved(content, &[]).1.iter().rev().nth(parts - 1).unwrap().x0;
    let alone = first("<text x='100' y='90'>สวัสดี</text>");
    let near = |a: f64, b: f64| assert!((a - b).abs() < 0.02, "{a} {b}");
    near(last("<text x='100' y='90'>สวัสดี សួស្តី สวัสดี</text>", thai_parts), alone + thai + khmer + 2.0 * space);
    near(
        first("<text x='900' y='90' text-anchor='end'>สวัสดี <tspan>សួស្តី</tspan></text>"),
        alone + 800.0 - thai - khmer - space,
    );
    let khmer_alone = first("<text x='100' y='90'>សួស្តី</text>");
    // Four clusters of Thai and a space.
    near(
        last("<text x='100' y='90' letter-spacing='7'>สวัสดี សួស្តី</text>", khmer_parts),
        khmer_alone + thai + space + 35.0,
    );
    // Seven clusters, and so six gaps, share what the line lacks.
    let gap = (500.0 - thai - space - khmer) / 6.0;
    near(
        last("<text x='100' y='90' textLength='500'>สวัสดี សួស្តី</text>", khmer_parts),
        khmer_alone + thai + space + 5.0 * gap,
    );
    near(
        last("<text x='100' y='90' dx='9'>สวัสดี<tspan dx='5'> សួស្តី</tspan></text>", khmer_parts),
        khmer_alone + thai + space + 14.0,
    );
}

/// Letters that no font has are named with their text, and `--on-error stop` refuses them.
#[test]
fn letters_without_a_font_are_named() {
    let text = "<text y='90'>Hi ᚠᛇ सुनो</text>";
    let (code, found, said) = moved(text, &[]);
    assert_eq!(code, Some(0));
    assert!(!found.is_empty());
    assert!(said.contains("“ᚠᛇ") && said.contains("“Hi ᚠᛇ सुनो”"), "{said}");
    let (code, found, said) = moved(text, &["--on-error", "stop"]);
    assert!(code != Some(0) && found.is_empty() && said.contains("ᚠᛇ"), "{code:?} {said}");
    let fonts = fonts();
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("a.svg"), svg(text)).unwrap();
    for out in ["a.png", "a.pdf"] {
        let command = if out.ends_with("png") { "render" } else { "convert" };
        let args = [command, "a.svg", "-o", out, "--no-system-fonts", "--fonts-dir", &fonts];
        let out = pathwarp_in(dir.path(), &args, b"");
        let said = String::from_utf8(out.stderr).unwrap();
        assert!(out.status.code() == Some(1) && said.contains("ᚠᛇ"), "{said}");
    }
}

/// Lettering takes letters that its fonts lack from the given fonts, as drawings do.
#[test]
fn lettering_takes_other_fonts() {
    let fonts = fonts();
    let all: Vec<&str> = WORDS.iter().map(|w| w.0).collect();
    let args = ["text", "-", "--size", "50", "--no-system-fonts", "--fonts-dir", &fonts];
    let (code, out, said) = run(&args, &all.join("\n"));
    assert_eq!((code, said.as_str()), (Some(0), ""));
    let count: usize = WORDS.iter().map(|(text, font)| word(text, font).len()).sum();
    assert_eq!(boxes(&out).len(), count);
    let (code, _, said) = run(&args, "Hi ᚠ");
    assert!(code == Some(1) && said.contains("ᚠ (U+16A0)"), "{said}");
}

/// Emoji with layers (COLR 0) and gradients (COLR 1) become outlines in their colours, and stay in the middle of a line.
#[test]
fn colour_emoji_become_outlines() {
    let fonts = fonts();
    let args = ["affine", "-", "--move-x", "1", "--no-system-fonts", "--fonts-dir", &fonts];
    let (code, out, said) = run(&args, &svg("<text y='90' fill='green'>Hi 😀😁!</text>"));
    assert_eq!((code, said.as_str()), (Some(0), ""));
    let text = String::from_utf8(out).unwrap();
    assert!(text.contains("#ffcc33") && text.contains("#331a00") && text.contains("radialGradient"), "{text}");
    assert!(text.contains("linearGradient") && !text.contains("<image"), "{text}");
}
