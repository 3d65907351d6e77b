//! The report, warnings and notes.

use super::common::{CAGE, SQUARE, text};
use crate::support::{expect_code, pathwarp_in, sample};
use pathwarp::Outline;
use serde_json::Value;
use std::fs;

#[test]
fn artwork_that_extends_past_the_page_causes_one_warning() {
    let dir = tempfile::tempdir().unwrap();
    let run = |options: &[&str]| {
        let mut args = vec!["affine", "--move-x", "30", "--move-y", "-8", "--report", "r.json"];
        args.extend(options);
        let out = pathwarp_in(dir.path(), &args, SQUARE.as_bytes());
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        let report: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
        (text(&out.stderr), report["inputs"][0]["warnings"].as_array().unwrap().clone())
    };
    let (said, warnings) = run(&["--fit", "none"]);
    assert_eq!(said.lines().count(), 1, "{said}");
    for part in ["extends past the page by up to 30 units", "30 %; top, right", "--fit grow", "--fit page"] {
        assert!(said.contains(part) && warnings[0].as_str().unwrap().contains(part), "{part} not in {said}");
    }
    assert_eq!(warnings.len(), 1);
    let (said, warnings) = run(&["--quiet", "--fit", "none"]);
    assert!(said.is_empty() && warnings.len() == 1, "{said} {warnings:?}");
    for fit in ["grow", "page"] {
        let (said, warnings) = run(&["--fit", fit]);
        assert!(said.is_empty() && warnings.is_empty(), "{fit}: {said}");
    }
}

#[test]
fn what_the_page_cuts_off_and_the_map_stretches_causes_a_warning_with_a_frame_that_helps() {
    let dir = tempfile::tempdir().unwrap();
    // The page shows half of the shape.
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path d='M60 40C80 30 120 30 140 40V60H60Z'/></svg>";
    let run = |args: &[&str]| {
        let out = pathwarp_in(dir.path(), &[args, &["-o", "o.svg"]].concat(), svg.as_bytes());
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        let (said, written) = (text(&out.stderr), fs::read_to_string(dir.path().join("o.svg")).unwrap());
        let x = Outline::from_svg(written.split('\'').find(|t| t.starts_with('M')).unwrap()).unwrap();
        (said, x.bounding_box().unwrap())
    };
    let flag = ["warp", "--style", "flag", "--bend", "80%"];
    let (said, stretched) = run(&flag);
    let frame = said.split("--frame ").nth(1).and_then(|s| s.split_whitespace().next()).unwrap();
    assert!(said.contains("the page cuts shapes off") && stretched.height() > 100.0, "{said} {stretched:?}");
    let (said, bent) = run(&[&flag[..], &["--frame", frame]].concat());
    assert!(!said.contains("cuts") && bent.height() < 60.0, "{said} {bent:?}");
    assert!(!run(&["wave"]).0.contains("cuts"));
}

#[test]
fn quiet_commands_say_by_their_exit_code_alone_that_something_is_missing() {
    let dir = tempfile::tempdir().unwrap();
    let unread =
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><image width='9' height='9' href='no.png'/></svg>";
    for command in [&["render", "-"][..], &["convert", "-", "--format", "pdf"]] {
        let run = |more: &[&str]| pathwarp_in(dir.path(), &[command, more].concat(), unread.as_bytes());
        let (aloud, quiet) = (run(&[]), run(&["--quiet"]));
        assert!(text(&aloud.stderr).contains("no.png"), "{command:?}: {}", text(&aloud.stderr));
        assert_eq!(text(&quiet.stderr), "", "{command:?}");
        assert_eq!((quiet.status.code(), &quiet.stdout), (Some(1), &aloud.stdout), "{command:?}");
    }
}

#[test]
fn the_report_has_every_field() {
    let dir = tempfile::tempdir().unwrap();
    let (svg, json) = (dir.path().join("o.svg"), dir.path().join("r.json"));
    let [input, cage] = [sample("monogram.svg"), sample("cages.svg")].map(|p| p.display().to_string());
    let cage = cage + "#flag";
    expect_code(
        0,
        &["shaper", &input, "--shaper", &cage, "-o", svg.to_str().unwrap(), "--report", json.to_str().unwrap()],
    );
    let r: Value = serde_json::from_slice(&fs::read(json).unwrap()).unwrap();
    assert_eq!(r["tool"], "pathwarp");
    assert_eq!(r["steps"][0], "shaper");
    let file = &r["inputs"][0];
    let tolerance = file["tolerance"].as_f64().unwrap();
    let shapes = file["shapes"].as_array().unwrap();
    assert!(!shapes.is_empty());
    let mut sums = [0, 0];
    for s in shapes {
        assert!(s["max_error"].as_f64().unwrap() <= tolerance && s["certified"].is_boolean() && s["folds"] == 0);
        sums[0] += s["segments_in"].as_u64().unwrap();
        sums[1] += s["segments_out"].as_u64().unwrap();
    }
    assert_eq!(r["totals"]["shapes"].as_u64().unwrap() as usize, shapes.len());
    assert_eq!([&r["totals"]["segments_in"], &r["totals"]["segments_out"]].map(|v| v.as_u64().unwrap()), sums);
    assert!(r["totals"]["seconds"].as_f64().unwrap() > 0.0);
    assert_eq!(file["output"], svg.display().to_string());
}

#[test]
fn a_missed_tolerance_is_reported_with_its_place() {
    // Endless waves around a pole.
    let dir = tempfile::tempdir().unwrap();
    let run = |options: &[&str]| {
        let mut args = vec!["expr", "--x", "x", "--y", "y + 5*sin(1/(x-50.3))", "--report", "r.json"];
        args.extend(options);
        let out = pathwarp_in(dir.path(), &args, SQUARE.as_bytes());
        let report: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
        (out, report["inputs"][0].clone())
    };
    for options in [&["--tolerance", "0.001"][..], &["--tolerance", "0.001", "--certify", "--merge", "off"]] {
        let (out, r) = run(options);
        assert_eq!(out.status.code(), Some(1));
        assert!(text(&out.stderr).contains("misses the tolerance near"), "{}", text(&out.stderr));
        let s = &r["shapes"][0];
        assert!(s["max_error"].as_f64().unwrap() > 0.001 && s["assurance"] == "checked" && s["certified"] == false);
        let places = s["unresolved"].as_array().unwrap();
        assert!(!places.is_empty());
        // Only the horizontal sides miss it; the vertical ones stay straight.
        assert!(places.iter().all(|p| p[1] == 0.0 || p[1] == 100.0), "{places:?}");
    }
}

#[test]
fn folds_are_warned_of_and_counted() {
    let dir = tempfile::tempdir().unwrap();
    // The top side of this shaper doubles back.
    let twisted = "M0,100 L100,100 L100,0 C-150,0 250,0 0,0 Z";
    let out = pathwarp_in(dir.path(), &["shaper", "--shaper", twisted, "--report", "r.json"], SQUARE.as_bytes());
    assert_eq!(out.status.code(), Some(0));
    let messages = text(&out.stderr);
    assert!(messages.contains("s folds over near"), "{messages}");
    let r: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
    assert!(r["totals"]["folds"].as_u64().unwrap() > 0);
    assert!(r["inputs"][0]["warnings"][0].as_str().unwrap().contains("s folds over"));
    // A mirroring map does not fold.
    let mirrored = pathwarp_in(dir.path(), &["shaper", "--shaper", CAGE, "--reverse-shaper"], SQUARE.as_bytes());
    assert!(mirrored.stderr.is_empty(), "{}", text(&mirrored.stderr));
}

#[test]
fn explain_prints_the_corners() {
    let (_, said) =
        expect_code(0, &["shaper", "samples/grid.svg", "--shaper", "samples/cages.svg#arch", "--explain", "-o", "-"]);
    for part in ["bottom side of", "corners of", "base:", "target: none"] {
        assert!(said.contains(part), "{part} not in {said}");
    }
}

/// A map that folds gives two points of the source one image; undoing it cannot recover both.
#[test]
fn undoing_a_fold_is_warned_of_with_the_place() {
    let dir = tempfile::tempdir().unwrap();
    let back = |map: &[&str]| {
        let forth = pathwarp_in(dir.path(), &[map, &["-q"]].concat(), SQUARE.as_bytes());
        assert_eq!(forth.status.code(), Some(0), "{}", text(&forth.stderr));
        let undo = [map, &["--inverse", "--frame", "0,0,100,100", "-o", "back.svg"]].concat();
        let out = pathwarp_in(dir.path(), &undo, &forth.stdout);
        (out.status.code(), text(&out.stderr))
    };
    // A hairpin, narrower than the artwork is high. Both points of the message have the image that it names.
    let hairpin = ["bend", "--along", "M0,0 C60,-100 40,-100 100,0"];
    let (_, said) = back(&hairpin);
    assert!(said.contains("undoing it is ambiguous") && said.contains("have the same image"), "{said}");
    let is_coordinate = |w: &&str| w.parse::<f64>().is_ok() && w.contains('.');
    let line = said.lines().find(|l| l.contains("undoing")).unwrap();
    let places: Vec<&str> = line.split([' ', ',']).filter(is_coordinate).take(6).collect();
    let points = format!("{} {}\n{} {}\n", places[0], places[1], places[2], places[3]);
    let map = [&["map"], &hairpin[..], &["--frame", "0,0,100,100", "--points", "-"]].concat();
    let images = text(&pathwarp_in(dir.path(), &map, points.as_bytes()).stdout);
    assert_eq!(images.lines().count(), 2);
    for image in images.lines() {
        for (found, shown) in image.split(' ').zip(&places[4..]) {
            assert!((found.parse::<f64>().unwrap() - shown.parse::<f64>().unwrap()).abs() < 1e-3, "{images} {said}");
        }
    }
    for map in [&["warp", "--style", "flag"][..], &["swirl"], &["polar"], &["wordart", "--preset", "arch-up"]] {
        let (code, said) = back(map);
        assert!(code == Some(0) && !said.contains("ambiguous"), "{map:?}: {said}");
    }
    // This map cannot be undone on all of the square: an error or a warning is due.
    let (code, said) = back(&["wordart", "--preset", "button", "--box", "artwork"]);
    assert!(code == Some(4) || said.contains("ambiguous"), "{code:?}: {said}");
}

/// The report of strokes that stay strokes has their error; those that become outlines are counted.
#[test]
fn strokes_are_reported_and_explained() {
    let dir = tempfile::tempdir().unwrap();
    let drawing = "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='100mm' viewBox='0 0 100 100' fill='none' \
                   stroke='red'><path id='cut' d='M10 10H90V90L20 40Z' stroke-width='.1'/><path id='thick' d='M20 20L80 30' \
                   stroke-width='9'/></svg>";
    let run = |options: &[&str]| {
        let args =
            [&["warp", "--style", "flag", "--bend", "60%", "--report", "r.json", "--explain", "-o", "o.svg"], options];
        let out = pathwarp_in(dir.path(), &args.concat(), drawing.as_bytes());
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        let r: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
        let svg = fs::read_to_string(dir.path().join("o.svg")).unwrap();
        (text(&out.stderr), r["inputs"][0]["shapes"].clone(), svg)
    };
    let (said, shapes, svg) = run(&[]);
    let [cut, thick] = [&shapes[0], &shapes[1]];
    assert!(cut["id"] == "cut" && cut["outlined_strokes"].is_null(), "{shapes}");
    let error = cut["stroke_error"].as_f64().unwrap();
    // A miter reaches four half widths from the corner, and the map stretches it.
    assert!(error > 0.0 && error < 3.0 * 4.0 * 0.05, "{shapes}");
    assert!(thick["outlined_strokes"] == 1 && thick["stroke_error"].is_null(), "{shapes}");
    assert!(said.contains("strokes: 1 stayed strokes") && said.contains("1 became outlines"), "{said}");
    // The cut line is one contour.
    let line = svg.split("<path").find(|p| p.contains("id='cut'")).unwrap();
    assert_eq!(line.matches('M').count(), 1, "{svg}");
    let (said, shapes, _) = run(&["--strokes", "keep"]);
    assert!(shapes[1]["stroke_error"].is_null() && !said.contains("strokes:"), "{said} {shapes}");
}
