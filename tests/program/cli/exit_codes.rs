//! Exit codes 1 to 4, and the messages that go with them.

use super::common::{CAGE, SQUARE, text};
use crate::support::{pathwarp_in, sample};
use serde_json::Value;
use std::fs;

#[test]
fn wrong_usage_is_2_and_names_the_fault() {
    for (args, part) in [
        (&["wobble"][..], "wobble"),
        (&["shaper"], "--shaper"),
        (&["shaper", "--shaper", CAGE, "--tolerance", "-1"], "--tolerance"),
        (&["shaper", "--shaper", CAGE, "--tolerance", "nan"], "--tolerance"),
        (&["shaper", "--shaper", CAGE, "--bottom", "7"], "--bottom"),
        (&["shaper", "--shaper", CAGE, "--frame", "1,2,3"], "--frame"),
        (&["shaper", "--shaper", CAGE, "--strokes", "wide"], "--strokes"),
        (&["shaper", "--shaper", "--explain"], "--shaper"),
        (&["shaper", "--shaper", CAGE, "+", "list"], "list"),
        (&["list", "+", "affine"], "chains deformations"),
        (&["shaper", "--shaper", CAGE, "+", "affine", "--out", "b.svg"], "multiple times"),
        (&["shaper", "--shaper", CAGE, "+", "affine", "--into", "b.xcf"], "cannot be used with"),
        (&["shaper", "--shaper", CAGE, "+", "affine", "in.svg"], "in.svg"),
        (&["affine", "--matrix", "1,0,0,1,0"], "5 numbers instead of 6"),
        (&["affine", "--rotate", "30 parsecs"], "parsecs"),
    ] {
        let dir = tempfile::tempdir().unwrap();
        let mut all = args.to_vec();
        if args[0] != "list" && args[0] != "wobble" {
            all.splice(1..1, ["-o", "out.svg"]);
        }
        let out = pathwarp_in(dir.path(), &all, SQUARE.as_bytes());
        assert_eq!(out.status.code(), Some(2), "{args:?}: {}", text(&out.stderr));
        assert!(text(&out.stderr).contains(part), "{args:?}: {}", text(&out.stderr));
        assert!(!dir.path().join("out.svg").exists());
    }
}

#[test]
fn unreadable_input_is_3_and_names_the_place() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("latin1.svg"), b"<svg xmlns='http://www.w3.org/2000/svg'>\xe4</svg>").unwrap();
    fs::write(dir.path().join("broken.svg"), "<svg xmlns='http://www.w3.org/2000/svg'>\n<path").unwrap();
    fs::write(dir.path().join("empty.svg"), "").unwrap();
    fs::write(dir.path().join("ok.svg"), SQUARE).unwrap();
    fs::write(dir.path().join("points.json"), "[[1,2],[3]]").unwrap();
    for (input, shaper, part) in [
        ("missing.svg", CAGE, "missing.svg"),
        ("latin1.svg", CAGE, "UTF-8"),
        ("broken.svg", CAGE, "broken.svg"),
        ("empty.svg", CAGE, "empty.svg"),
        ("ok.svg", "no-such-file.svg#a", "no-such-file.svg"),
        ("ok.svg", "#nothing", "#nothing"),
        ("ok.svg", "points.json", "points.json"),
    ] {
        let out = pathwarp_in(dir.path(), &["shaper", input, "--shaper", shaper, "-o", "out.svg"], b"");
        assert_eq!(out.status.code(), Some(3), "{input} {shaper}: {}", text(&out.stderr));
        assert!(text(&out.stderr).contains(part), "{input} {shaper}: {}", text(&out.stderr));
        assert!(!dir.path().join("out.svg").exists());
    }
    // An error in a side file names that file and not the artwork.
    fs::write(dir.path().join("style.toml"), "name = 7").unwrap();
    fs::write(dir.path().join("cage.svg"), "<svg").unwrap();
    for args in [
        ["warp", "--style", "missing.toml"],
        ["warp", "--style", "style.toml"],
        ["wordart", "--preset", "missing.json"],
        ["shaper", "--shaper", "missing.svg#a"],
        ["shaper", "--shaper", "cage.svg#a"],
    ] {
        let out = pathwarp_in(dir.path(), &[&args[..], &["ok.svg", "-o", "out.svg"]].concat(), b"");
        let (said, file) = (text(&out.stderr), args[2].split('#').next().unwrap());
        assert_eq!(out.status.code(), Some(3), "{args:?}: {said}");
        assert!(said.starts_with(&format!("error: {file}")) && !said.contains("ok.svg"), "{args:?}: {said}");
    }
}

#[test]
fn forbidden_geometry_is_4_and_leaves_the_old_file_alone() {
    let anchors = sample("anchors.svg").display().to_string();
    let horizon = "0,0 100,0 40,40 0,100";
    let dir = tempfile::tempdir().unwrap();
    let old = dir.path().join("out.svg");
    fs::write(&old, "precious").unwrap();
    for (args, parts) in [
        (vec!["--shaper", "M0,0 L10,0 L10,10 L0,10 L1,1"], vec!["not closed", "--shaper"]),
        (vec!["--shaper", "M0,0 L10,0 L10,10 Z"], vec!["3 anchors"]),
        (
            vec!["--shaper", CAGE, "--target", &(anchors.clone() + "#target4-collinear")],
            vec!["one line", "target4-collinear"],
        ),
        (vec!["--shaper", CAGE, "--base", "5,5 5,5"], vec!["coincide", "--base"]),
        (vec!["--shaper", CAGE, "--base", "10,40 20,40 17,35 13,35"], vec!["s hits infinity at"]),
        (vec!["--shaper", CAGE, "--target", horizon], vec!["infinity"]),
    ] {
        let mut all = vec!["shaper", "-", "-o", "out.svg"];
        all.extend(args.iter().copied());
        let out = pathwarp_in(dir.path(), &all, SQUARE.as_bytes());
        let said = text(&out.stderr);
        assert_eq!(out.status.code(), Some(4), "{args:?}: {said}");
        assert!(parts.iter().all(|p| said.contains(p)), "{args:?}: {said}");
        assert_eq!(fs::read_to_string(&old).unwrap(), "precious");
    }
}

#[test]
fn artwork_as_flat_as_a_line_needs_a_base() {
    let dir = tempfile::tempdir().unwrap();
    let line = SQUARE.replace("M0,0H100V100H0Z", "M0,50H100");
    for args in [&["shaper", "--shaper", CAGE][..], &["projective", "--target", "0,0 10,0 10,10 0,10"]] {
        let out = pathwarp_in(dir.path(), args, line.as_bytes());
        assert_eq!(out.status.code(), Some(4));
        assert!(text(&out.stderr).contains("100 wide and 0 high"), "{}", text(&out.stderr));
        let with = pathwarp_in(dir.path(), &[args, &["--frame", "0,0,100,100"]].concat(), line.as_bytes());
        assert_eq!(with.status.code(), Some(0), "{}", text(&with.stderr));
    }
}

#[test]
fn a_shape_beyond_the_horizon_can_be_skipped() {
    let dir = tempfile::tempdir().unwrap();
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path id='near' d='M12,36 l4,0 0,3 z'/><path id='far' d='M0,0H100V100H0Z'/></svg>";
    let args = [
        "shaper",
        "-",
        "--shaper",
        CAGE,
        "--base",
        "10,40 20,40 17,35 13,35",
        "--on-error",
        "skip",
        "-o",
        "out.svg",
        "--report",
        "r.json",
    ];
    let out = pathwarp_in(dir.path(), &args, svg.as_bytes());
    assert_eq!(out.status.code(), Some(1), "{}", text(&out.stderr));
    let warped = fs::read_to_string(dir.path().join("out.svg")).unwrap();
    assert!(warped.contains("M0,0H100V100H0Z") && !warped.contains("M12,36"), "{warped}");
    let report: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
    assert_eq!(report["inputs"][0]["skipped"][0]["id"], "far");
    assert_eq!(report["inputs"][0]["shapes"][0]["id"], "near");
}

/// Too few decimals to keep the tolerance give a warning and exit code 1, and its advice helps.
#[test]
fn too_few_decimals_are_1_and_said() {
    let run = |more: &[&str]| {
        let args = [&["swirl", "--tolerance", "0.01", "-o", "-"][..], more].concat();
        let out = pathwarp_in(tempfile::tempdir().unwrap().path(), &args, SQUARE.as_bytes());
        (out.status.code(), text(&out.stderr))
    };
    let (code, said) = run(&["--precision", "0"]);
    assert!(code == Some(1) && said.contains("--precision 0") && said.contains("more decimals"), "{said}");
    assert_eq!(run(&["--precision", "4"]).0, Some(0));
    assert_eq!(run(&[]).0, Some(0));
}
