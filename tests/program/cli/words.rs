//! Messages for mistakes that new users make.

use super::common::{SQUARE, text};
use crate::support::pathwarp_in;
use serde_json::Value;
use std::fs;

#[test]
fn likely_mistakes_get_an_answer() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("a.svg"), SQUARE).unwrap();
    assert!(pathwarp_in(dir.path(), &["convert", "a.svg", "-o", "p.xcf"], b"").status.success());
    for (args, code, part) in [
        (&["warp", "a.svg", "--bend", "50"][..], 2, "write 50%"),
        (&["warp", "a.svg", "--style", "falg"], 2, "did you mean flag?"),
        (&["wordart", "a.svg", "--preset", "Buton"], 2, "did you mean button?"),
        (&["help", "shapr"], 2, "did you mean `shaper`?"),
        (&["compare", "p.xcf", "a.svg"], 3, "`pathwarp paths`"),
        (&["gallery", "p.xcf"], 3, "an XCF holds paths"),
        (&["expr", "a.svg", "--x", "sqrt(x-300)"], 4, "at 0.0000,0.0000 sqrt(-300) has no finite value"),
        (&["affine", "a.svg", "+", "expr", "--x", "1/(x-50)", "--y", "ln(y-100)"], 4, "has no finite value"),
        (&["bend", "a.svg", "--along", "circel:r=3"], 3, "circle:r=R"),
        (&["shaper", "a.svg", "--base"], 2, "quote it: '#NAME'"),
        (&["anamorph", "a.svg", "--distance", "50cm"], 2, "--onto is needed"),
    ] {
        let out = pathwarp_in(dir.path(), args, b"");
        let said = text(&out.stderr);
        assert_eq!(out.status.code(), Some(code), "{args:?}: {said}");
        assert!(said.contains(part), "{args:?}: {said}");
    }
}

#[test]
fn names_are_read_in_any_case() {
    let dir = tempfile::tempdir().unwrap();
    let run = |style: &str, strokes: &str, axis: &str| {
        let args = ["warp", "--style", style, "--strokes", strokes, "--axis", axis, "-q"];
        let out = pathwarp_in(dir.path(), &args, SQUARE.as_bytes());
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        out.stdout
    };
    assert_eq!(run("FLAG", "Outline", "Vertical"), run("flag", "outline", "vertical"));
}

#[test]
fn a_fold_of_lettering_names_the_letter() {
    let dir = tempfile::tempdir().unwrap();
    let word = pathwarp_in(dir.path(), &["text", "Qy"], b"").stdout;
    let out = pathwarp_in(dir.path(), &["expr", "--x", "x*(60-x)"], &word);
    let said = text(&out.stderr);
    assert!(said.contains("“Q”") && said.contains("folds over"), "{said}");
}

/// A map may turn most of a word over, except its corners.
#[test]
fn all_letters_that_fold_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let word = pathwarp_in(dir.path(), &["text", "STAR", "--no-system-fonts"], b"").stdout;
    let out = pathwarp_in(dir.path(), &["warp", "-", "--style", "bulge", "--bend", "-80%"], &word);
    let said = text(&out.stderr);
    for letter in ["S", "T", "A", "R"] {
        assert!(said.contains(&format!("“{letter}”")) || said.contains(&format!("{letter} folds")), "{letter}: {said}");
    }
    // The whole word upside down does not fold.
    let out = pathwarp_in(dir.path(), &["affine", "-", "--scale-y", "-1"], &word);
    assert!(out.stderr.is_empty(), "{}", text(&out.stderr));
}

#[test]
fn a_page_fitted_to_the_artwork_keeps_its_margin() {
    let dir = tempfile::tempdir().unwrap();
    // 5 from the left, 20 from the top, 35 from the right, 40 from the bottom.
    let drawing =
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path id='s' d='M5,20H65V60H5Z'/></svg>";
    let out =
        pathwarp_in(dir.path(), &["affine", "--scale-x", "2", "--scale-y", "2", "--fit", "page"], drawing.as_bytes());
    let svg = text(&out.stdout);
    let list = pathwarp_in(dir.path(), &["paths", "-", "--json"], svg.as_bytes());
    let list: Value = serde_json::from_slice(&list.stdout).unwrap();
    let [x, y, w, h] = [0, 1, 2, 3].map(|i| list["paths"][0]["bounds"][i].as_f64().unwrap());
    let view = format!("viewBox='{} {} {} {}'", x - 5.0, y - 5.0, w + 10.0, h + 10.0);
    assert!(svg.contains(&view) && (w, h) == (120.0, 80.0), "{view} {svg}");
    // Artwork that bleeds off its page has no margin, and parts that the page cut off stay off.
    let bleeding = drawing.replace("M5,20", "M-5,20").replace("H5Z", "H-5Z");
    let out = pathwarp_in(dir.path(), &["affine", "--fit", "page", "--move-x", "1"], bleeding.as_bytes());
    assert!(text(&out.stdout).contains("viewBox='1 20 65 40'"), "{}", text(&out.stdout));
}

/// Letters of text elements are named like those of outlined words.
#[test]
fn a_fold_of_text_names_the_letters() {
    let dir = tempfile::tempdir().unwrap();
    let drawing = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 200 100'>\
                   <text id='hello' x='10' y='60' font-size='40'>Q<tspan fill='red'>y</tspan></text></svg>";
    for (along, letters) in [("x*(60-x)", "hello: the letter “Q” folds over"), ("x*(46-x)", "hello: the letter “Q”")]
    {
        let out = pathwarp_in(dir.path(), &["expr", "--x", along, "--no-system-fonts"], drawing.as_bytes());
        let said = text(&out.stderr);
        assert!(said.contains(letters), "{said}");
    }
    // Both letters are upside down, so neither folds against the other. One in the middle does.
    let out = pathwarp_in(dir.path(), &["expr", "--x", "-x", "--no-system-fonts"], drawing.as_bytes());
    assert!(!text(&out.stderr).contains("folds"), "{}", text(&out.stderr));
}
