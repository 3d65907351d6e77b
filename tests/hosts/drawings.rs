//! Drawings before and after, as Chromium shows both (`cargo xtask browser`).

use crate::browser;
use crate::support::{pathwarp_program, program, root, skipped};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Returns the judge's findings for every drawing of a folder with this program, in some ways, and its report; `None` without Chromium.
fn judged(by: &Path, folder: &Path, ways: &[&str]) -> Option<(Vec<Value>, String)> {
    if let Some(what) = browser::missing() {
        skipped(format_args!("drawings are not compared in Chromium without {what}"));
        return None;
    }
    let json = tempfile::NamedTempFile::new().unwrap();
    let mut judge = Command::new(program("xtask"));
    judge.arg("browser").arg(folder).arg("--program").arg(by).arg("--json").arg(json.path()).args(ways);
    let said = String::from_utf8_lossy(&judge.output().unwrap().stderr).into_owned();
    let found = serde_json::from_slice(&fs::read(json.path()).unwrap()).unwrap_or_else(|e| panic!("{e}: {said}"));
    Some((found, said))
}

/// Tries programs that empty a drawing, leave it unchanged, or write no result.
#[cfg(unix)]
#[test]
fn emptied_and_unbent_results_differ_on_pages_of_every_size() {
    use std::os::unix::fs::PermissionsExt as _;
    let dir = tempfile::tempdir().unwrap();
    let art = dir.path().join("art");
    fs::create_dir(&art).unwrap();
    for side in [16, 24, 100, 640, 1200, 1700, 2000] {
        for (color, at) in [("black", 4), ("white", 2)] {
            let (from, part) = (side * at / 8, side / 8);
            let mark = format!("<path fill='{color}' d='M{from} {from}h{part}v{part}z'/>");
            let size = format!("viewBox='0 0 {side} {side}' width='{side}' height='{side}'");
            let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' {size}>{mark}</svg>");
            fs::write(art.join(format!("{color}-{side}.svg")), svg).unwrap();
        }
    }
    fs::write(art.join("broken.svg"), "<svg xmlns='http://www.w3.org/2000/svg'><g></svg>").unwrap();
    // The arguments are: expr FILE … -o RESULT.
    let loop_ = "in=$2; while [ \"$1\" != -o ]; do shift; done\n";
    for (name, body) in
        [("emptied", "sed 's/<path[^>]*>//' \"$in\" >\"$2\""), ("unbent", "cp \"$in\" \"$2\""), ("none", ":")]
    {
        let program = dir.path().join(name);
        fs::write(&program, format!("#!/bin/sh\n{loop_}{body}\n")).unwrap();
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
        let Some((all, _)) = judged(&program, &art, &[]) else { return };
        assert!(all.len() > 40, "{} findings", all.len());
        for finding in all {
            let counts = !finding["file"].as_str().unwrap().ends_with("broken.svg");
            assert_eq!(finding["differs"], counts, "{name}: {finding}");
        }
    }
}

/// `tests/browser` holds a small drawing for each feature that programs read in different ways. None may differ in any of the ways tried,
/// with any installed fonts. To add a drawing, put it there.
#[test]
fn own_drawings_are_what_chromium_shows() {
    none_differs(&[], &[]);
}

#[test]
fn pictures_of_own_drawings_are_what_chromium_shows() {
    none_differs(&["--as", "png"], &NOT_READ);
}

#[test]
fn own_drawings_in_pdf_are_what_chromium_shows() {
    if Command::new("pdftocairo").arg("-v").output().is_err() {
        skipped("PDFs of drawings are not compared with Chromium without pdftocairo");
        return;
    }
    none_differs(&["--as", "pdf"], &NOT_READ);
}

/// Drawings of features that pictures lack and warnings name: rules for `:nth-child(… of …)`, missing pictures, and packed ones.
const NOT_READ: [&str; 3] = ["css-nesting-of-selectors", "pictures-that-are-missing", "pictures-that-are-packed"];

/// Asserts that no drawing differs except those named.
fn none_differs(ways: &[&str], but: &[&str]) {
    let Some((found, said)) = judged(pathwarp_program(), &root().join("tests/browser"), ways) else { return };
    assert!(found.len() > 30 && found.iter().all(|f| f["counts"] == true), "{said}");
    let differs = |f: &&Value| f["differs"] == true;
    let file = |f: &Value| Path::new(f["file"].as_str().unwrap()).file_stem().unwrap().to_string_lossy().into_owned();
    assert!(found.iter().filter(differs).all(|f| but.contains(&&*file(f))), "{said}");
}
