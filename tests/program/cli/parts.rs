//! `--select` in several parts of a chain: each selection applies to its step.

use super::common::text;
use crate::support::pathwarp_in;
use serde_json::Value;
use std::fs;
use std::path::Path;

const DRAWING: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>\
    <path id='a' class='one' d='M0,0H10V10H0Z'/><path id='b' class='two' d='M40,20H60V30H40Z'/>\
    <path id='ab' class='one two' d='M20,60H30V80H20Z'/><path id='none' d='M80,80H90V90H80Z'/></svg>";

fn run(args: &[&str], input: &str) -> String {
    let out = pathwarp_in(Path::new("."), args, input.as_bytes());
    assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
    text(&out.stdout)
}

/// The path data of an element.
fn data(svg: &str, id: &str) -> String {
    let at = svg.find(&format!("id='{id}'")).unwrap();
    let rest = &svg[at + svg[at..].find(" d='").unwrap() + 4..];
    rest[..rest.find('\'').unwrap()].to_owned()
}

/// The bounding box of an element: x, y, width, height.
fn bounds(svg: &str, id: &str) -> [f64; 4] {
    let list: Value = serde_json::from_str(&run(&["paths", "-", "--json"], svg)).unwrap();
    let path = list["paths"].as_array().unwrap().iter().find(|p| p["name"] == id).unwrap().clone();
    [0, 1, 2, 3].map(|i| (path["bounds"][i].as_f64().unwrap() * 1e6).round() / 1e6)
}

#[test]
fn each_shape_goes_through_the_steps_that_selected_it() {
    let svg = run(
        &["affine", "--move-x", "5", "--select", ".one", "+", "affine", "--move-y", "7", "--select", ".two"],
        DRAWING,
    );
    assert_eq!(bounds(&svg, "a"), [5.0, 0.0, 10.0, 10.0]);
    assert_eq!(bounds(&svg, "b"), [40.0, 27.0, 20.0, 10.0]);
    assert_eq!(bounds(&svg, "ab"), [25.0, 67.0, 10.0, 20.0]);
    assert_eq!(data(&svg, "none"), data(DRAWING, "none"));
    // A single selection applies to the whole chain, from any part.
    for whole in [
        ["affine", "--move-x", "5", "--select", ".one", "+", "affine", "--move-y", "7"],
        ["affine", "--move-x", "5", "+", "affine", "--move-y", "7", "--select", ".one"],
    ] {
        let svg = run(&whole, DRAWING);
        assert_eq!((bounds(&svg, "a"), bounds(&svg, "ab")), ([5.0, 7.0, 10.0, 10.0], [25.0, 67.0, 10.0, 20.0]));
        assert_eq!(data(&svg, "b"), data(DRAWING, "b"));
    }
    // A part without a selection applies to everything; each `--exclude` applies only to its part.
    let three = [
        "affine", "--move-x", "5", "--select", "#a", "+", "affine", "--move-x", "1", "+", "affine", "--move-y", "7",
        "--select", "#b",
    ];
    let svg = run(&three, DRAWING);
    assert_eq!((bounds(&svg, "a")[0], bounds(&svg, "b")[0], bounds(&svg, "none")[0]), (6.0, 41.0, 81.0));
    let svg = run(
        &["affine", "--move-x", "5", "--exclude", "#a", "+", "affine", "--move-y", "7", "--exclude", ".two"],
        DRAWING,
    );
    assert_eq!((bounds(&svg, "a"), bounds(&svg, "b")), ([0.0, 7.0, 10.0, 10.0], [45.0, 20.0, 20.0, 10.0]));
    assert_eq!(bounds(&svg, "none"), [85.0, 87.0, 10.0, 10.0]);
}

/// The curves equal those of these steps on the shape alone: composed, and fitted once.
#[test]
fn the_steps_of_a_shape_are_fitted_once() {
    let fine = ["--tolerance", "0.01", "--precision", "6"];
    let (first, second) = (["expr", "--x", "x + 4*sin(y/16)"], ["expr", "--y", "y + 3*sin(x/9)"]);
    let parts = [&first[..], &["--select", ".one"], &fine, &["+"], &second, &["--select", ".two"]].concat();
    let svg = run(&parts, DRAWING);
    let alone = |id: &str, args: &[&[&str]]| {
        data(&run(&[&args.concat()[..], &fine, &["--select", id]].concat(), DRAWING), &id[1..])
    };
    assert_eq!(data(&svg, "a"), alone("#a", &[&first]));
    assert_eq!(data(&svg, "b"), alone("#b", &[&second]));
    assert_eq!(data(&svg, "ab"), alone("#ab", &[&first, &["+"], &second]));
    assert_ne!(data(&svg, "ab"), alone("#ab", &[&second, &["+"], &first]));
    // A point of the exact image, by the formula.
    let exact = (20.0_f64 + 4.0 * (60.0_f64 / 16.0).sin(), 60.0_f64);
    let exact = (exact.0, exact.1 + 3.0 * (exact.0 / 9.0).sin());
    let start: Vec<f64> =
        data(&svg, "ab")[1..].split([',', ' ', 'C', 'L', 'c', 'l']).take(2).map(|n| n.parse().unwrap()).collect();
    assert!((start[0] - exact.0).hypot(start[1] - exact.1) < 0.01, "{start:?} {exact:?}");
}

#[test]
fn percentages_refer_to_what_a_step_holds_for() {
    let moved = |args: &[&str]| {
        let svg = run(args, DRAWING);
        ["a", "b", "ab"].map(|id| bounds(&svg, id)[0])
    };
    // Widths: a alone 10, b alone 20.
    assert_eq!(
        moved(&["affine", "--move-x", "100%", "--select", "#a", "+", "affine", "--move-x", "100%", "--select", "#b"]),
        [10.0, 60.0, 20.0]
    );
    // The second step finds a at 50 to 60 and b at 40 to 60: 20 wide. Had a not been moved, it would be 60.
    assert_eq!(
        moved(&[
            "affine", "--move-x", "50", "--select", "#a", "+", "affine", "--move-x", "100%", "--select", "#a",
            "--select", "#b"
        ]),
        [70.0, 60.0, 20.0]
    );
    // A given frame applies to every step that comes first for its part.
    assert_eq!(
        moved(&[
            "affine", "--move-x", "10%", "--select", "#a", "--frame", "viewbox", "+", "affine", "--move-x", "10%",
            "--select", "#b"
        ]),
        [10.0, 50.0, 20.0]
    );
}

#[test]
fn recipes_reports_and_lists_say_it_alike() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("in.svg"), DRAWING).unwrap();
    let ok = |args: &[&str]| {
        let out = pathwarp_in(dir.path(), args, b"");
        assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
        text(&out.stdout)
    };
    let read = |name: &str| fs::read_to_string(dir.path().join(name)).unwrap();
    let line = [
        "warp",
        "in.svg",
        "--style",
        "flag",
        "--select",
        ".one",
        "--exclude",
        "#none",
        "-o",
        "out.svg",
        "+",
        "swirl",
        "--select",
        ".two",
    ];
    ok(&[&line[..], &["--write-recipe", "r.toml", "--report", "r.json"]].concat());
    let recipe = read("r.toml");
    assert!(
        recipe.contains("select = [\".one\"]")
            && recipe.contains("select = [\".two\"]")
            && recipe.contains("exclude = \"#none\""),
        "{recipe}"
    );
    ok(&["run", "r.toml", "in.svg", "-o", "again.svg"]);
    assert_eq!(read("again.svg"), read("out.svg"));
    // A selection for the run restricts every step.
    ok(&["run", "r.toml", "in.svg", "--select", "#a", "-o", "part.svg"]);
    assert_ne!(data(&read("part.svg"), "a"), data(DRAWING, "a"));
    assert_eq!(data(&read("part.svg"), "b"), data(DRAWING, "b"));

    let report: Value = serde_json::from_str(&read("r.json")).unwrap();
    let input = &report["inputs"][0];
    let steps = |id: &str| input["shapes"].as_array().unwrap().iter().find(|s| s["id"] == id).unwrap()["steps"].clone();
    assert_eq!([steps("a"), steps("b"), steps("ab")].map(|s| s.to_string()), ["[1]", "[2]", "[1,2]"]);
    assert_eq!(input["selections"][1]["select"][0], ".two");
    assert_eq!(input["selections"][0]["frame"], serde_json::json!([0.0, 0.0, 30.0, 80.0]));
    let listed = ok(&[&line[..], &["--dry-run"]].concat());
    assert!(
        listed.contains("step 1, warp: .one")
            && listed.contains("step 2, swirl: .two")
            && listed.contains("in.svg -> out.svg"),
        "{listed}"
    );
    let explained = pathwarp_in(dir.path(), &[&line[..], &["--explain"]].concat(), b"");
    assert!(
        text(&explained.stderr).contains("step 1, warp for .one: frame: 30.0000 × 80.0000"),
        "{}",
        text(&explained.stderr)
    );

    ok(&[&line[..], &["--embed-recipe"]].concat());
    assert_eq!(ok(&["unwarp", "out.svg"]), DRAWING);
    assert!(ok(&["unwarp", "--recipe", "out.svg"]).contains("select = [\".two\"]"));

    // Steps with different frames can be undone if the frame is given.
    let frame = ["--frame", "0,0,100,100"];
    ok(&[&line[..8], &["-o", "bent.svg", "--tolerance", "1e-5", "--write-recipe", "f.toml"], &frame, &line[10..]]
        .concat());
    ok(&[&["run", "--inverse", "f.toml", "bent.svg", "-o", "back.svg", "--tolerance", "1e-5"][..], &frame].concat());
    let apart: Value = serde_json::from_str(&ok(&["compare", "--json", "in.svg", "back.svg"])).unwrap();
    assert!(apart["max_distance"].as_f64().unwrap() < 1e-3, "{apart}");
}

#[test]
fn what_shapes_share_follows_each_of_them() {
    let drawing = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><clipPath id='c'><path d='M0,0H30V30H0Z'/></clipPath>\
        <path id='a' clip-path='url(#c)' d='M0,0H40V40H0Z'/><path id='b' clip-path='url(#c)' d='M0,0H40V40H0Z'/>\
        <path id='k' clip-path='url(#c)' d='M0,0H40V40H0Z'/></svg>";
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("in.svg"), drawing).unwrap();
    let ok = |args: &[&str]| {
        let out = pathwarp_in(dir.path(), args, b"");
        assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
        text(&out.stdout)
    };
    let (first, second) =
        (["affine", "in.svg", "--move-x", "30", "--select", "#a"], ["affine", "--move-y", "40", "--select", "#b"]);
    ok(&[&first[..], &["-o", "parts.svg", "+"], &second].concat());
    // The truth is the picture with the moved clips, by transforms.
    let moved = drawing
        .replace("id='a' ", "id='a' transform='translate(30 0)' ")
        .replace("id='b' ", "id='b' transform='translate(0 40)' ");
    fs::write(dir.path().join("moved.svg"), &moved).unwrap();
    for (file, name) in [("parts.svg", "a.png"), ("moved.svg", "b.png")] {
        ok(&["render", file, "-o", name, "--width", "100"]);
    }
    assert_eq!(
        fs::read(dir.path().join("a.png")).unwrap(),
        fs::read(dir.path().join("b.png")).unwrap(),
        "{}",
        fs::read_to_string(dir.path().join("parts.svg")).unwrap()
    );
    // A single selection, too, leaves the clip path of the others unmoved.
    ok(&[&first[..], &["-o", "one.svg"]].concat());
    fs::write(dir.path().join("moved.svg"), moved.replace(" transform='translate(0 40)'", "")).unwrap();
    for (file, name) in [("one.svg", "a.png"), ("moved.svg", "b.png")] {
        ok(&["render", file, "-o", name, "--width", "100"]);
    }
    assert_eq!(fs::read(dir.path().join("a.png")).unwrap(), fs::read(dir.path().join("b.png")).unwrap());
}

#[test]
fn a_part_that_is_mirrored_is_no_fold() {
    let args = ["affine", "--scale-x", "-1", "--select", "#a", "+", "affine", "--move-x", "3", "--select", "#b"];
    let out = pathwarp_in(Path::new("."), &args, DRAWING.as_bytes());
    assert!(!text(&out.stderr).contains("folds"), "{}", text(&out.stderr));
}

#[test]
fn letters_are_placed_for_each_part() {
    let word = |text: &str| run(&["text", text, "--no-system-fonts"], "");
    let inner = |svg: &str| svg[svg.find("<g").unwrap()..svg.rfind("</svg>").unwrap()].to_owned();
    let drawing = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 400'><g id='up'>{}</g><g id='down'>{}</g></svg>",
        inner(&word("Top")),
        inner(&word("Low"))
    );
    let bend = |along: &'static str, id: &'static str| ["bend", "--along", along, "--glyphs", "rotate", "--select", id];
    let (first, second) = (bend("M0,200 A200,200 0 0 1 400,200", "#up"), bend("M0,300 Q200,400 400,300", "#down"));
    let fine = ["--tolerance", "0.01", "--precision", "4"];
    let both = run(&[&first[..], &fine, &["+"], &second].concat(), &drawing);
    let apart = run(&[&second[..], &fine].concat(), &run(&[&first[..], &fine].concat(), &drawing));
    let letters = |svg: &str| svg.matches(" d=\"").map(|_| ()).count() + svg.matches(" d='").count();
    assert!(letters(&both) >= 6);
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("a.svg"), &both).unwrap();
    fs::write(dir.path().join("b.svg"), &apart).unwrap();
    let out = pathwarp_in(dir.path(), &["compare", "--json", "a.svg", "b.svg"], b"");
    let apart: Value = serde_json::from_slice(&out.stdout).unwrap();
    assert!(apart["max_distance"].as_f64().unwrap() < 0.05, "{apart}");
}

#[test]
fn paths_of_a_gimp_file_and_pictures() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("in.svg"), DRAWING).unwrap();
    let run = |args: &[&str]| pathwarp_in(dir.path(), args, b"");
    assert!(run(&["convert", "in.svg", "-o", "in.xcf"]).status.success());
    let line = [
        "affine", "in.xcf", "--move-x", "5", "--select", "a", "-o", "out.svg", "+", "affine", "--move-y", "7",
        "--select", "b", "--select", "a",
    ];
    let out = run(&line);
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    let svg = fs::read_to_string(dir.path().join("out.svg")).unwrap();
    assert_eq!((bounds(&svg, "a"), bounds(&svg, "b")), ([5.0, 7.0, 10.0, 10.0], [40.0, 27.0, 20.0, 10.0]));
    assert!(run(&["render", "in.svg", "-o", "in.png"]).status.success());
    let out = run(&["affine", "in.png", "--select", "a", "-o", "out.png", "+", "affine", "--select", "b"]);
    assert_eq!(out.status.code(), Some(2));
    assert!(text(&out.stderr).contains("a picture has no parts"), "{}", text(&out.stderr));
    let out = run(&["affine", "in.svg", "--select", "#a", "-o", "out.svg", "+", "affine", "--select", "#bb"]);
    assert!(text(&out.stderr).contains("nothing matches `#bb`"), "{}", text(&out.stderr));
}
