//! Chains of deformations and guides in the document.

use super::common::{CAGE, SQUARE, text};
use crate::support::{expect_code, pathwarp_in, sample};
use serde_json::Value;
use std::fs;

#[test]
fn chains_equal_their_parts_one_after_another() {
    let dir = tempfile::tempdir().unwrap();
    let run = |args: &[&str], input: &[u8]| {
        let out = pathwarp_in(dir.path(), args, input);
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        out.stdout
    };
    let fine = ["--tolerance", "1e-4", "--precision", "8"];
    let perspective = ["projective", "--target", "0,100 100,95 80,10 15,0"];
    let bend = ["shaper", "--shaper", CAGE];
    let first = run(&[&perspective[..], &fine].concat(), SQUARE.as_bytes());
    let both = run(&[&bend[..], &fine].concat(), &first);
    let chained = run(&[&perspective[..], &fine, &["+"], &bend].concat(), SQUARE.as_bytes());
    // The common options may be in any part.
    let last = run(&[&perspective[..], &["+"], &bend, &fine].concat(), SQUARE.as_bytes());
    assert!(last == chained);
    let apart =
        run(&[&perspective[..], &fine[..2], &["+"], &bend, &fine[2..], &["-o", "-"]].concat(), SQUARE.as_bytes());
    assert!(apart == chained);
    fs::write(dir.path().join("-in.svg"), SQUARE).unwrap();
    let named = [&perspective[..], &["--", "-in.svg", "+"], &bend, &fine, &["-o", "named.svg"]].concat();
    assert!(run(&named, b"").is_empty());
    assert!(fs::read(dir.path().join("named.svg")).unwrap() == chained);
    fs::write(dir.path().join("a.svg"), both).unwrap();
    fs::write(dir.path().join("b.svg"), chained).unwrap();
    let out = run(&["compare", "--json", "a.svg", "b.svg"], b"");
    let c: Value = serde_json::from_slice(&out).unwrap();
    assert!(c["max_distance"].as_f64().unwrap() < 3e-4, "{c}");
}

#[test]
fn guides_in_the_document_stay_and_are_not_warped() {
    let (svg, _) = expect_code(
        0,
        &["shaper", "samples/paper-two-anchors.svg", "--base", "#Base", "--target", "#Target", "--shaper", "#Shaper"],
    );
    let source = fs::read_to_string(sample("paper-two-anchors.svg")).unwrap();
    for id in ["Base", "Target", "Shaper"] {
        let line = |s: &str| s.lines().find(|l| l.contains(&format!("id=\"{id}\""))).unwrap().to_owned();
        assert_eq!(line(&svg), line(&source));
    }
    assert_ne!(svg, source);
}
