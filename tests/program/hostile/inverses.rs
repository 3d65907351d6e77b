//! Inverses that search in vain: a few control points lie far out, and most points have no source.

use super::bounded::{Folder, svg};
use crate::support::pathwarp_program;
use std::process::Command;

/// Five segments in a page of 100 units.
const PATH: &str = "<path d='M10 10C40 0 60 30 90 10V60C70 90 40 30 10 60Z'/>";

/// A quilt of `n` by `n` patches, the identity except for the control point in row and column `at`.
fn quilt(n: usize, at: usize, to: [f64; 2]) -> String {
    let spacing = 100.0 / (3 * n) as f64;
    let point = |i: usize, j: usize| if (i, j) == (at, at) { to } else { [i as f64 * spacing, j as f64 * spacing] };
    let rows: Vec<Vec<[f64; 2]>> = (0..=3 * n).map(|j| (0..=3 * n).map(|i| point(i, j)).collect()).collect();
    format!("{{\"region\": [0, 0, 100, 100], \"points\": {rows:?}}}")
}

/// Asserts that a command ends by the count of evaluations.
#[track_caller]
fn ends_by_count(folder: &Folder, args: &[&str]) {
    let (code, said) = folder.run(args);
    assert!(code == 4 && said.contains("--limit work"), "{args:?}: {code} {said}");
}

/// Found by fuzzing: this took 20 seconds, until the limit on time ended it.
#[test]
fn undoing_a_quilt_with_a_point_far_out_is_counted() {
    let folder = Folder::with(&[
        ("a.svg", &svg(PATH)),
        ("near.json", quilt(2, 1, [1e6, -1e6]).as_bytes()),
        ("far.json", quilt(2, 3, [1e4, 1e4]).as_bytes()),
    ]);
    ends_by_count(&folder, &["mesh", "a.svg", "--mesh", "near.json", "--inverse", "-o", "o.svg"]);
    ends_by_count(
        &folder,
        &["mesh", "a.svg", "--mesh", "near.json", "--inverse", "--on-error", "skip", "-o", "o.svg", "+", "wave"],
    );
    let far = ["mesh", "a.svg", "--mesh", "far.json", "--region", "artwork", "--inverse", "-o", "o.svg"];
    ends_by_count(&folder, &far);
    let skipping = [&far[..], &["--on-error", "skip", "--strokes", "outline", "--merge", "on"]].concat();
    ends_by_count(&folder, &skipping);
}

/// The message names no amount beyond the limit, since that would depend on threads.
#[test]
fn the_message_is_the_same_on_any_number_of_threads() {
    let paths: String = (0..40).map(|i| PATH.replace("M10", &format!("M{i}"))).collect();
    let folder = Folder::with(&[("a.svg", &svg(&paths)), ("q.json", quilt(2, 1, [1e6, -1e6]).as_bytes())]);
    let mut said = ["1", "2", "8"].map(|n| {
        folder.run(&[
            "mesh",
            "a.svg",
            "--mesh",
            "q.json",
            "--inverse",
            "--jobs",
            n,
            "--on-error",
            "skip",
            "-o",
            "o.svg",
        ])
    });
    said.iter().for_each(|(code, said)| assert_eq!(*code, 4, "{said}"));
    let first = said[0].clone();
    assert!(said.iter_mut().all(|s| *s == first), "{said:#?}");
}

#[test]
fn undoing_other_extremes_ends_by_count_or_succeeds() {
    let pairs: Vec<String> =
        (0..40_i32).map(|i| format!("{},{}:{},{}", i * 37 % 100, i * 71 % 100, i * 53 % 100, i * 29 % 100)).collect();
    let mut mls = vec!["mls", "a.svg"];
    pairs.iter().for_each(|p| mls.extend(["--pair", p.as_str()]));
    let sines: String = (1..150).map(|i| format!("+sin(x*{i})")).collect();
    let expr = format!("x{sines}");
    let folder = Folder::with(&[("a.svg", &svg(PATH))]);
    let bend = "M10,120 C60,20 90,20 120,120 S180,220 230,120";
    let cases: [&[&str]; 10] = [
        &mls,
        &["expr", "a.svg", "--x", &expr],
        &["warp", "a.svg", "--style", "twist", "--bend", "1000%"],
        &["swirl", "a.svg", "--angle", "36000"],
        &["wave", "a.svg", "--length", "0.01", "--height", "1"],
        &["ffd", "a.svg", "--degree", "10x10", "--move", "5,5:100000,3000", "--extend"],
        &["triangle", "a.svg", "--degree", "8", "--move", "3,3,2:3000,4000"],
        &["bend", "a.svg", "--along", bend, "--by", "parameter", "--stretch", "fit", "--width", "4000%"],
        &["wordart", "a.svg", "--preset", "button-pour"],
        &["shaper", "a.svg", "--shaper", "M0,120 Q60,-300 120,120 L110,0 Q60,600 10,0 Z"],
    ];
    for case in cases {
        let (code, said) = folder.run(&[case, &["--inverse", "--on-error", "skip", "-o", "o.svg"]].concat());
        assert!([0, 1].contains(&code) || said.contains("--limit work"), "{case:?}: {code} {said}");
    }
    let twist = ["--style", "twist", "--bend", "300%", "--inverse"];
    let chain =
        [&["warp", "a.svg"], &twist[..], &["-o", "o.svg", "+", "warp"], &twist, &["+", "warp"], &twist].concat();
    let (code, said) = folder.run(&chain);
    assert!([0, 1].contains(&code) || said.contains("--limit work"), "{code} {said}");
}

#[test]
fn undoing_points_is_counted() {
    let points: String = (0..100_000).map(|i| format!("{} {}\n", i % 317, i % 211)).collect();
    let folder = Folder::with(&[("p.txt", points.as_bytes()), ("q.json", quilt(2, 1, [1e6, -1e6]).as_bytes())]);
    // `map` takes its limits before the deformation.
    let args = ["map", "--limit", "work=3e7", "mesh", "--mesh", "q.json", "--inverse", "--frame", "0,0,100,100"];
    let mut command = Command::new(pathwarp_program());
    let done = command.args(args).args(["--points", "p.txt"]).current_dir(folder.path()).output().unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.code() == Some(4) && said.contains("--limit work"), "{said}");
}

/// A B-spline box of control points in mixed-up positions, and 10,000 triangles in it.
#[test]
fn undoing_a_box_in_space_is_counted() {
    const CELLS: usize = 8;
    let n = CELLS + 2;
    let mixed = |k: usize| [k * 7919 % 997, k * 104_729 % 991, k * 1_299_709 % 983].map(|v| v as f64 * 20.0 - 1e4);
    let layer = |k: usize| -> Vec<Vec<[f64; 3]>> {
        (0..n).map(|j| (0..n).map(|i| mixed((k * n + j) * n + i)).collect()).collect()
    };
    let points: Vec<Vec<Vec<[f64; 3]>>> = (0..n).map(layer).collect();
    let lattice = format!(
        "{{\"degree\": [2, 2, 2], \"cells\": [{CELLS}, {CELLS}, {CELLS}], \"region\": [0, 0, 0, 100, 100, 100], \
         \"points\": {points:?}}}"
    );
    let vertex = |k: usize| format!("v {} {} {}\n", k * 31 % 101, k * 17 % 101, k * 7 % 101);
    let face = |k: usize| format!("f {} {} {}\n", 3 * k + 1, 3 * k + 2, 3 * k + 3);
    let model: String = (0..30_000).map(vertex).chain((0..10_000).map(face)).collect();
    let folder = Folder::with(&[("a.obj", model.as_bytes()), ("l.json", lattice.as_bytes())]);
    ends_by_count(&folder, &["solid", "ffd", "a.obj", "--lattice", "l.json", "--inverse", "-o", "o.obj"]);
}
