//! Fonts given on the command line, and styles synthesised from them.

use super::common::text;
use crate::support::{pathwarp_in, root};
use pathwarp::kurbo::Rect;
use pathwarp_svg::{Document, ReadOptions};
use std::fs;
use std::path::Path;

const FAMILY: &str = "Pathwarp Test Cff";

fn fonts() -> String {
    root().join("crates/pathwarp-text/tests/fonts").display().to_string()
}

fn drawing(family: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 300 100'>\
         <text x='10' y='80' font-size='60' font-family='{family}'>Halo</text></svg>"
    )
}

#[track_caller]
fn run(folder: &Path, args: &[&str], stdin: &str) -> (Option<i32>, Vec<u8>, String) {
    let out = pathwarp_in(folder, args, stdin.as_bytes());
    (out.status.code(), out.stdout, text(&out.stderr))
}

fn bounds(svg: &[u8]) -> Rect {
    let doc = Document::read(svg, "out", &ReadOptions::default().with_system_fonts(false)).unwrap();
    doc.shapes().iter().filter_map(|s| s.outline.bounding_box()).reduce(|a, b| a.union(b)).unwrap()
}

/// A drawing's text has the outlines that `pathwarp text` makes of the same font, however the font is given.
#[test]
fn text_in_drawings_has_the_fonts_given() {
    let dir = tempfile::tempdir().unwrap();
    let (file, folder) = (fonts() + "/cff.otf", fonts());
    let (_, word, _) = run(dir.path(), &["text", "Halo", "--font", &file, "--size", "60"], "");
    let expected = bounds(&word);
    let named = drawing(FAMILY);
    let warp = |options: &[&str], svg: &str| {
        let mut args = vec!["affine", "-", "--move-x", "5"];
        args.extend(options);
        run(dir.path(), &args, svg)
    };
    let (_, _, said) = warp(&["--no-system-fonts"], &named);
    assert!(said.contains(FAMILY), "{said}");
    let mut results = Vec::new();
    for options in
        [&["--font-file", &file][..], &["--fonts-dir", &folder], &["--no-system-fonts", "--font-file", &file]]
    {
        let (code, svg, said) = warp(options, &named);
        assert_eq!((code, said.as_str()), (Some(0), ""), "{options:?}");
        let b = bounds(&svg);
        assert!(
            (b.width() - expected.width()).abs() < 0.01 && (b.height() - expected.height()).abs() < 0.01,
            "{b:?} {expected:?}"
        );
        results.push(svg);
    }
    assert!(results.windows(2).all(|w| w[0] == w[1]));
    for generic in ["serif", "sans-serif", "cursive", "fantasy", "monospace"] {
        let option = format!("--{generic}-family");
        let (code, svg, said) = warp(&["--font-file", &file, &option, FAMILY], &drawing(generic));
        assert_eq!((code, said.as_str()), (Some(0), ""), "{generic}");
        assert_eq!(bounds(&svg), bounds(&results[0]), "{generic}");
        let (_, _, said) = warp(&["--no-system-fonts", &option, "No Such Family"], &drawing(generic));
        assert!(said.contains("No Such Family"), "{generic}: {said}");
    }
}

/// Commands that only read drawings have these options, too.
#[test]
fn every_command_that_reads_text_takes_fonts() {
    let dir = tempfile::tempdir().unwrap();
    let file = fonts() + "/cff.otf";
    fs::write(dir.path().join("named.svg"), drawing(FAMILY)).unwrap();
    fs::write(dir.path().join("generic.svg"), drawing("fantasy")).unwrap();
    let own = ["--no-system-fonts", "--font-file", &file, "--fantasy-family", FAMILY];
    let both = |args: &[&str], own: &[&str]| {
        ["named.svg", "generic.svg"].map(|name| {
            let args: Vec<&str> =
                args.iter().map(|a| if *a == "IN" { name } else { a }).chain(own.iter().copied()).collect();
            let (code, out, said) = run(dir.path(), &args, "");
            assert_eq!(code, Some(0), "{args:?}: {said}");
            out
        })
    };
    let [a, b] = both(&["render", "IN"], &own);
    assert!(a == b && a != both(&["render", "IN"], &["--no-system-fonts"])[0]);
    let alike = ["compare", "named.svg", "generic.svg", "--max-pixels", "0"];
    let with: Vec<&str> = alike.iter().chain(&own).copied().collect();
    assert_eq!(run(dir.path(), &with, "").0, Some(0));
    for args in [&["convert", "IN"][..], &["paths", "IN"], &["gallery", "IN", "--cell", "60x60"]] {
        both(args, &own);
    }
    // A recipe keeps the families, but not the files.
    let (code, _, said) = run(
        dir.path(),
        &[
            "affine",
            "generic.svg",
            "-o",
            "a.svg",
            "--write-recipe",
            "r.toml",
            "--font-file",
            &file,
            "--fantasy-family",
            FAMILY,
        ],
        "",
    );
    assert_eq!(code, Some(0), "{said}");
    let recipe = fs::read_to_string(dir.path().join("r.toml")).unwrap();
    assert!(recipe.contains(FAMILY) && !recipe.contains("cff.otf"), "{recipe}");
    // Words are set in a family of the given folder.
    let (code, word, said) = run(dir.path(), &["text", "Halo", "--font", FAMILY, "--fonts-dir", &fonts()], "");
    assert_eq!((code, said.as_str()), (Some(0), ""));
    assert_eq!(word, run(dir.path(), &["text", "Halo", "--font", &file], "").1);
}

#[test]
fn what_is_not_a_font_is_named() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("a.svg"), drawing("serif")).unwrap();
    fs::create_dir(dir.path().join("empty")).unwrap();
    for (options, part) in [
        (["--font-file", "none.ttf"], "none.ttf"),
        (["--font-file", "a.svg"], "is not a font"),
        (["--fonts-dir", "empty"], "holds no font"),
    ] {
        for command in [&["render", "a.svg"][..], &["affine", "a.svg"]] {
            let args: Vec<&str> = command.iter().chain(&options).copied().collect();
            let (code, _, said) = run(dir.path(), &args, "");
            assert!(code == Some(3) && said.contains(part), "{args:?}: {said}");
        }
    }
    let (code, _, said) = run(dir.path(), &["affine", "a.svg", "--serif-family", " "], "");
    assert!(code == Some(2) && said.contains("--serif-family"), "{said}");
}

/// A synthesised bold is thicker by em/24 for the 300 steps from regular, an italic slants by 14°.
#[test]
fn styles_are_synthesised_on_request() {
    let dir = tempfile::tempdir().unwrap();
    let word = |options: &[&str]| {
        let mut args = vec!["text", "l", "--size", "96"];
        args.extend(options);
        let (code, svg, said) = run(dir.path(), &args, "");
        assert_eq!((code, said.as_str()), (Some(0), ""), "{options:?}");
        let glyph = String::from_utf8(svg.clone()).unwrap();
        let advance = glyph.split("data-glyph=\"").nth(1).unwrap().split('"').next().unwrap();
        (bounds(&svg), advance.split(' ').nth(2).unwrap().parse::<f64>().unwrap())
    };
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-3, "{a} {b}");
    let (plain, advance) = word(&[]);
    let (bold, wider) = word(&["--weight", "bold", "--synthesize"]);
    near(bold.width() - plain.width(), 4.0);
    near(bold.height() - plain.height(), 4.0);
    near(wider - advance, 4.0);
    let (italic, same) = word(&["--italic", "--synthesize"]);
    near(italic.width() - plain.width(), plain.height() * 14.0_f64.to_radians().tan());
    near(same, advance);
    // A font that has the style is used unchanged; a lighter one cannot be made.
    let variable = fonts() + "/variable.ttf";
    let of = |options: &[&str]| {
        run(dir.path(), &[&["text", "n", "--font", &variable, "--weight", "bold"], options].concat(), "")
    };
    assert_eq!(of(&["--synthesize"]), of(&[]));
    for (options, part) in [
        (&["--weight", "bold"][..], "only 400; name a font that has it with --font, or make it with --synthesize"),
        (&["--italic"], "--synthesize"),
        (&["--weight", "thin", "--synthesize"], "only bolder weights"),
    ] {
        let (code, _, said) = run(dir.path(), &[&["text", "l"], options].concat(), "");
        assert!(code == Some(2) && said.contains(part), "{said}");
    }
}

/// Content missing from a picture or a PDF is reported, once.
#[test]
fn what_is_not_drawn_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let cases = [
        ("<text x='9' y='50' font-family='Nope'>a</text>", 0, "text uses another font, as Nope is missing"),
        (
            "<text x='9' y='50' font-family='Noto Sans' style='text-shadow:1px 1px red'>a</text>",
            1,
            "text-shadow: 1px 1px red",
        ),
        ("<foreignObject width='9' height='9'/><rect width='9' height='9'/>", 1, "foreignObject at 1:63 is not drawn"),
        ("<style>@import 'a.css';</style><rect width='9' height='9'/>", 1, "@import"),
        ("<image width='9' height='9' href='nope.png'/>", 1, "the image nope.png cannot be read"),
        ("<defs><foreignObject width='9' height='9'/></defs><rect width='9' height='9'/>", 0, ""),
    ];
    for (body, expected, why) in cases {
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>");
        for args in
            [&["render", "-", "--no-system-fonts"][..], &["convert", "-", "--format", "pdf", "--no-system-fonts"]]
        {
            let (code, out, said) = run(dir.path(), args, &svg);
            assert_eq!(
                (code, said.lines().count()),
                (Some(expected), usize::from(!why.is_empty())),
                "{args:?} {body}: {said}"
            );
            assert!(said.contains(why) && !out.is_empty(), "{said}");
        }
    }
}
