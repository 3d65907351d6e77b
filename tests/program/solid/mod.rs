//! `pathwarp solid`: models and points through the program.

mod files;
mod model;
mod picture;

use crate::support::{pathwarp, pathwarp_in, root, sample, words};
use model::Model;
use pathwarp_solid::deform::Registry3;
use picture::Camera;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Runs `pathwarp solid` in a folder, and returns standard output.
fn ok(folder: &Path, args: &[&str], stdin: &str) -> String {
    let all: Vec<&str> = std::iter::once("solid").chain(args.iter().copied()).collect();
    let out = pathwarp_in(folder, &all, stdin.as_bytes());
    assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
    text(&out.stdout)
}

fn fails(folder: &Path, args: &[&str], stdin: &str, code: i32) -> String {
    let all: Vec<&str> = std::iter::once("solid").chain(args.iter().copied()).collect();
    let out = pathwarp_in(folder, &all, stdin.as_bytes());
    assert_eq!(out.status.code(), Some(code), "{args:?}: {}", text(&out.stderr));
    text(&out.stderr)
}

const TEAPOT: &str = "samples/solid/teapot.obj";

#[test]
fn the_examples_of_help_run() {
    let dir = tempfile::tempdir().unwrap();
    for e in Registry3::builtin().entries() {
        for example in e.about().info.examples {
            let command = example.command.replace("out.", &format!("{}/out.", dir.path().display()));
            let out = pathwarp(&words(&command));
            assert_eq!(out.status.code(), Some(0), "{command}: {}", text(&out.stderr));
            assert_eq!(text(&out.stderr), "", "{command}");
            let after = Model::read(&fs::read_to_string(dir.path().join("out.obj")).unwrap());
            if !command.contains("teapot") {
                assert!(after.faces.len() > 100, "{command}");
                continue;
            }
            let before = Model::read(&fs::read_to_string(sample("solid/teapot.obj")).unwrap());
            assert_eq!(after.faces, before.faces, "{command}");
            assert_ne!(after.vertices, before.vertices, "{command}");
        }
    }
}

#[test]
fn points_chains_inverses_and_jacobians() {
    let dir = tempfile::tempdir().unwrap();
    let numbers = |s: &str| -> Vec<f64> { s.split_whitespace().map(|w| w.parse().unwrap()).collect() };
    let frame = ["--box", "0,0,0,100,100,100"];
    let ffd = ["ffd", "--move", "1,1,1:8,-16,24"];
    let got = ok(dir.path(), &[&["map"], &ffd[..], &frame[..]].concat(), "# middle\n50 50 50\n");
    assert_eq!(numbers(&got), [51.0, 48.0, 53.0]);
    // A chain, and its inverse.
    let twist = ["bend", "--preset", "twist", "--along", "z"];
    let there = ok(
        dir.path(),
        &[&["map"], &ffd[..], &frame[..], &["+"], &twist[..], &["--through", "50,50,50"]].concat(),
        "30 40 60\n80 20 10\n",
    );
    assert_ne!(there, "30 40 60\n80 20 10\n");
    let back = ok(dir.path(), &[&["map"], &ffd[..], &frame[..], &["--inverse"]].concat(), &got);
    assert!(numbers(&back).iter().all(|v| (v - 50.0).abs() < 1e-9), "{back}");
    let jet = ok(dir.path(), &[&["map"], &ffd[..], &frame[..], &["--jacobian"]].concat(), "50 50 50\n");
    assert_eq!(numbers(&jet).len(), 12);
    // Undefined points are nan, with exit code 1: behind a sheet's eye there is no ray.
    let args = ["solid", "map", "anamorph", "--eye", "0,0,10", "--reference", "-5,-5,0;5,5,0", "--push", "1,1,0:2"];
    let out = pathwarp_in(dir.path(), &args, b"0 0 20\n0 0 5\n");
    assert_eq!((out.status.code(), text(&out.stdout).lines().next()), (Some(1), Some("nan nan nan")));
}

/// Quads, groups, materials, texture coordinates and polylines survive, and normals stay perpendicular.
#[test]
fn a_model_keeps_everything_but_its_coordinates() {
    let dir = tempfile::tempdir().unwrap();
    let cube = "mtllib paint.mtl\no cube\nv 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nvt 0 0\nvt 1 0\nvn 0 0 1\nusemtl red\n\
                f 1/1/1 2/2/1 3//1 4//1\nl 1 3\n";
    let out = ok(
        dir.path(),
        &[
            "ffd",
            "--degree",
            "1",
            "--move",
            "1,0,0:0,0,10",
            "--move",
            "1,1,0:0,0,10",
            "--region",
            "0,0,-5,10,10,10",
            "--extend",
        ],
        cube,
    );
    for line in ["mtllib paint.mtl", "o cube", "usemtl red", "v 0 0 0", "vt 1 0", "f 1/1/1 2/2/2 3//3 4//4", "l 1 3"] {
        assert!(out.lines().any(|l| l == line), "{line} not in\n{out}");
    }
    let model = Model::read(&out);
    // The front half of the box is cut by the plane z = x/2.
    assert_eq!(model.vertices[1], [10.0, 0.0, 5.0]);
    let n = out.lines().filter(|l| l.starts_with("vn ")).count();
    assert_eq!(n, 4);
    let normal: Vec<f64> =
        out.lines().find(|l| l.starts_with("vn ")).unwrap().split(' ').skip(1).map(|w| w.parse().unwrap()).collect();
    assert!((normal[0] * 10.0 + normal[2] * 5.0).abs() < 1e-6 && normal[2] > 0.0, "{normal:?}");
}

/// The pictures before and after are equal as seen from the eye, and differ from the side.
#[test]
fn the_picture_from_the_eye_is_unchanged() {
    let dir = tempfile::tempdir().unwrap();
    let source = fs::read_to_string(root().join(TEAPOT)).unwrap();
    fs::write(dir.path().join("in.obj"), &source).unwrap();
    let before = Model::read(&source);
    let eye = [10.0, 35.0, 260.0];
    for args in [
        &["--reference", "-60,-10,40;60,-10,40;0,90,40;0,20,-60", "--push", "0,0,0,1:160%"][..],
        &[
            "--reference",
            "-60,-10,60;60,-10,60;0,120,60;0,20,-90",
            "--degree",
            "2",
            "--push",
            "0,0,0,2:150%",
            "--push",
            "1,0,0,1:70%",
        ],
        &[
            "--degree",
            "3x1x1",
            "--push",
            "1,0,0:1.3",
            "--push",
            "1,1,0:1.3",
            "--push",
            "2,0,1:0.8",
            "--push",
            "2,1,1:0.8",
        ],
        &["--reference", "-60,-10,0;60,60,0", "--degree", "2x1x1", "--push", "1,0,0:1.4", "--push", "1,1,0:0.8"],
        &["--local", "--reference", "30.1,-50,-175;30.1,-50,204;30.1,200,0;63.8,30,0", "--point", "48,35,0:125%"],
    ] {
        let line = [&["anamorph", "in.obj", "--eye", "10,35,260", "-o", "out.obj"][..], args].concat();
        ok(dir.path(), &line, "");
        let after = Model::read(&fs::read_to_string(dir.path().join("out.obj")).unwrap());
        let (same, all) = Camera { eye, at: [0.0, 25.0, 0.0] }.differing(&before, &after);
        assert!(same as f64 <= 0.001 * all as f64, "{args:?}: {same} of {all} pixels differ");
        let (other, all) = Camera { eye: [260.0, 35.0, 0.0], at: [0.0, 25.0, 0.0] }.differing(&before, &after);
        assert!(other as f64 > 0.02 * all as f64, "{args:?}: only {other} of {all} pixels differ from the side");
    }
}

#[test]
fn reports_recipes_explanations_and_saved_lattices() {
    let dir = tempfile::tempdir().unwrap();
    fs::copy(sample("solid/teapot.obj"), dir.path().join("in.obj")).unwrap();
    let line = [
        "ffd",
        "in.obj",
        "--move",
        "1,2,1:0,60%,0",
        "--write-recipe",
        "r.toml",
        "--report",
        "r.json",
        "--save-lattice",
        "l.json",
        "-o",
        "out.obj",
    ];
    ok(dir.path(), &line, "");
    let read = |name: &str| fs::read_to_string(dir.path().join(name)).unwrap();
    let first = read("out.obj");
    let report: Value = serde_json::from_str(&read("r.json")).unwrap();
    for side in ["before", "after"] {
        // Four closed shells.
        assert_eq!(
            (&report[side]["closed"], &report[side]["euler"]),
            (&Value::Bool(true), &Value::from(8)),
            "{report}"
        );
        assert!(report[side]["volume"].as_f64().unwrap() > 1000.0);
    }
    assert!(report["moved"].as_u64().unwrap() > 500 && report["folded"] == 0 && report["torn"] == 0);
    assert!(read("r.toml").contains("solid = true"));
    ok(dir.path(), &["run", "r.toml", "in.obj", "-o", "again.obj"], "");
    assert_eq!(first, read("again.obj"));
    ok(dir.path(), &["ffd", "in.obj", "--lattice", "l.json", "--extend", "-o", "saved.obj"], "");
    assert_eq!(first, read("saved.obj"));
    // The result does not depend on the number of threads.
    ok(dir.path(), &["run", "r.toml", "in.obj", "--jobs", "1", "-o", "again.obj"], "");
    assert_eq!(first, read("again.obj"));
    // The box of the source comes back.
    let b = &report["before"]["bounds"];
    let n = |i: usize, k: usize| b[i][k].as_f64().unwrap();
    let size: Vec<String> =
        (0..3).map(|k| n(0, k).to_string()).chain((0..3).map(|k| (n(1, k) - n(0, k)).to_string())).collect();
    ok(dir.path(), &["run", "r.toml", "out.obj", "--inverse", "--box", &size.join(","), "-o", "back.obj"], "");
    let (back, source) = (Model::read(&read("back.obj")), Model::read(&read("in.obj")));
    let off = back.vertices.iter().zip(&source.vertices).flat_map(|(a, b)| (0..3).map(move |k| (a[k] - b[k]).abs()));
    assert!(off.fold(0.0, f64::max) < 1e-6);
    // With a second step, whose box is by then that of the deformed model.
    let twist = ["+", "bend", "--preset", "twist", "--along", "y", "--angle", "60", "--through", "40%,0,30%"];
    ok(
        dir.path(),
        &[&["ffd", "in.obj", "--move", "1,2,1:0,30%,0"], &twist[..], &["--write-recipe", "two.toml", "-o", "two.obj"]]
            .concat(),
        "",
    );
    ok(dir.path(), &["run", "two.toml", "two.obj", "--inverse", "--box", &size.join(","), "-o", "back.obj"], "");
    let back = Model::read(&read("back.obj"));
    let off = back.vertices.iter().zip(&source.vertices).flat_map(|(a, b)| (0..3).map(move |k| (a[k] - b[k]).abs()));
    assert!(off.fold(0.0, f64::max) < 1e-6);
    // A recipe for solids is not one for drawings.
    let out = pathwarp_in(dir.path(), &["run", "r.toml", "in.obj"], b"");
    assert!(out.status.code() == Some(3) && text(&out.stderr).contains("pathwarp solid run"), "{}", text(&out.stderr));
    let out = pathwarp_in(dir.path(), &["solid", "ffd", "in.obj", "--explain", "-o", "x.obj"], b"");
    assert!(text(&out.stderr).contains("3 by 3 by 3 control points"), "{}", text(&out.stderr));
}

/// Warns of folds, tears, and omitted content.
#[test]
fn warnings_and_exit_codes() {
    let dir = tempfile::tempdir().unwrap();
    fs::copy(sample("solid/teapot.obj"), dir.path().join("in.obj")).unwrap();
    let warning = |args: &[&str], code: i32| fails(dir.path(), args, "", code);
    let fold = warning(&["ffd", "in.obj", "--move", "0,1,1:300%,0,0", "-o", "o.obj"], 0);
    assert!(fold.contains("inside out"), "{fold}");
    let tear = warning(&["ffd", "in.obj", "--region", "0,0,-60,120,60,120", "--move", "0,1,1:5,0,0", "-o", "o.obj"], 0);
    assert!(tear.contains("torn apart along"), "{tear}");
    let kept = [
        "ffd",
        "in.obj",
        "--region",
        "0,0,-60,120,60,120",
        "--degree",
        "3",
        "--freeze",
        "left:1,right:1,top:1,bottom:1,back:1,front:1",
        "--move",
        "1,1,1:5,0,0",
        "-o",
        "o.obj",
    ];
    assert_eq!(warning(&kept, 0), "");
    let infinite = warning(
        &[
            "anamorph",
            "in.obj",
            "--eye",
            "0,30,-200",
            "--reference",
            "-9,0,0;9,0,0;0,9,0;0,0,9",
            "--push",
            "0,0,0,1:3",
            "-o",
            "o.obj",
        ],
        4,
    );
    assert!(infinite.contains("has no image") && infinite.contains("vertex"), "{infinite}");
    assert!(
        warning(&["ffd", "in.obj", "--move", "9,9,9:1,1,1", "-o", "o.obj"], 2)
            .contains("--move: `9,9,9` is not a control point")
    );
    assert!(warning(&["anamorph", "in.obj"], 2).contains("--eye is needed"));
    assert!(warning(&["ffd", "in.obj", "-o", "in.obj"], 2).contains("overwritten"));
    assert!(warning(&["ffd", "missing.obj"], 3).contains("missing.obj: there is no such file"));
    for (file, part) in [("v 0 0 0\nf 1 2 3\n", "line 2: an index"), ("v 0 0 nan\n", "line 1"), ("", "no vertices")] {
        let said = fails(dir.path(), &["ffd"], file, 3);
        assert!(said.contains(part), "{said}");
    }
    let surface = "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\nsurf 0 1 0 1 1 2 3 4\n";
    assert!(fails(dir.path(), &["ffd"], surface, 1).contains("left out: 1 lines of `surf`"));
}

/// A plate of 50 × 20 mm with a round hole, in a drawing whose units are not millimetres.
const PLATE: &str = "<svg xmlns='http://www.w3.org/2000/svg' width='60mm' height='30mm' viewBox='0 0 600 300'>\
                     <path id='plate' fill-rule='evenodd' d='M50,50 H550 V250 H50 Z M350,150 A50,50 0 1 0 250,150 A50,50 0 1 0 350,150 Z'/></svg>";

fn report(folder: &Path, args: &[&str]) -> Value {
    ok(folder, &[args, &["--report", "r.json"]].concat(), "");
    serde_json::from_str(&fs::read_to_string(folder.join("r.json")).unwrap()).unwrap()
}

/// Checks lengths in millimetres, closedness, the single handle, and the volume of the plate, which grows with the radius when wrapped.
#[test]
fn a_drawing_is_extruded_and_wrapped_true_to_size() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("plate.svg"), PLATE).unwrap();
    let area = 50.0 * 20.0 - std::f64::consts::PI * 25.0;
    let flat = report(dir.path(), &["bend", "plate.svg", "--preset", "twist", "--angle", "0", "-o", "flat.stl"]);
    assert!((flat["after"]["area"].as_f64().unwrap() - area).abs() < 0.5, "{flat}");
    assert!(!flat["after"]["closed"].as_bool().unwrap());
    let args = ["wrap", "plate.svg", "--extrude", "3mm", "--radius", "41mm", "--refine", "0.01mm", "-o", "mug.stl"];
    let mug = report(dir.path(), &args);
    let after = &mug["after"];
    assert!(after["closed"] == true && after["euler"] == 0 && mug["before"]["euler"] == 0, "{mug}");
    let close = |a: &Value, b: f64, within: f64| assert!((a.as_f64().unwrap() - b).abs() < within, "{a} {b}");
    close(&mug["before"]["volume"], 3.0 * area, 1.0);
    // Guldin: the middle of the wall is at 42.5 instead of 41.
    close(&after["volume"], 3.0 * area * 42.5 / 41.0, 2.0);
    // The page is 60 mm wide, so that its middle is 30 from the left.
    let half = 44.0 * (25.0f64 / 41.0).sin();
    close(&after["bounds"][0][0], 30.0 - half, 1e-4);
    close(&after["bounds"][1][0], 30.0 + half, 1e-4);
    close(&after["bounds"][0][1], 5.0, 1e-4);
    close(&after["bounds"][1][2], 3.0, 0.011);
    // An STL is a model like any other; unwrapped, it becomes the plate again.
    let back = report(
        dir.path(),
        &[
            "wrap",
            "mug.stl",
            "--radius",
            "41mm",
            "--surface",
            "0",
            "--inverse",
            "--box",
            "5,5,0,50,20,3",
            "-o",
            "back.stl",
        ],
    );
    assert_eq!(back["after"]["closed"], true);
    close(&back["after"]["bounds"][0][0], 5.0, 1e-4);
    close(&back["after"]["bounds"][1][2], 3.0, 1e-4);
    assert!(fails(dir.path(), &["ffd", "plate.svg", "-o", "x.fbx"], "", 2).contains("not as .fbx"));
    assert!(fails(dir.path(), &["ffd", "back.stl", "--extrude", "3"], "", 2).contains("model already"));
    fs::write(dir.path().join("cut.stl"), &fs::read(dir.path().join("back.stl")).unwrap()[..500]).unwrap();
    assert!(fails(dir.path(), &["ffd", "cut.stl", "-o", "x.stl"], "", 3).contains("wrong length"));
}

/// A ring drawn by a stroke, a filled square with a stroke, and dashes: every fill and every stroke is a closed solid.
#[test]
fn strokes_are_solids() {
    let dir = tempfile::tempdir().unwrap();
    let write = |shapes: &str| {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='60mm' height='60mm' viewBox='0 0 120 120'>{shapes}</svg>"
        );
        fs::write(dir.path().join("s.svg"), svg).unwrap();
        report(dir.path(), &["bend", "s.svg", "--extrude", "5mm", "--preset", "twist", "--angle", "0", "-o", "s.obj"])["after"].clone()
    };
    // A unit is half a millimetre. The stroke of the circle is 2 mm wide, with its middle at a radius of 20 mm.
    let ring = write("<circle cx='60' cy='60' r='40' fill='none' stroke='black' stroke-width='4'/>");
    let truth = 5.0 * std::f64::consts::PI * (21.0 * 21.0 - 19.0 * 19.0);
    assert!(ring["closed"] == true && ring["euler"] == 0, "{ring}");
    assert!((ring["volume"].as_f64().unwrap() / truth - 1.0).abs() < 1e-3, "{ring}, not {truth}");
    // 10 × 10 mm, and a frame from 12 × 12 to 8 × 8 that overlaps it.
    let framed = write("<rect id='r' x='20' y='20' width='20' height='20' stroke='red' stroke-width='4'/>");
    assert!(framed["closed"] == true && framed["euler"] == 2, "{framed}");
    assert!((framed["volume"].as_f64().unwrap() - 5.0 * (100.0 + 144.0 - 64.0)).abs() < 1e-3, "{framed}");
    let names: Vec<String> = fs::read_to_string(dir.path().join("s.obj"))
        .unwrap()
        .lines()
        .filter(|l| l.starts_with("o "))
        .map(str::to_owned)
        .collect();
    assert_eq!(names, ["o r", "o r stroke"]);
    // A stroke whose width and dashes are in px at any scale: nine dashes of 8 px and the start of a tenth.
    let dashes = write(
        "<g transform='scale(2)'><path d='M0,20 H39' stroke='red' stroke-width='2' stroke-dasharray='8' \
         vector-effect='non-scaling-stroke'/></g>",
    );
    let px = 25.4 / 96.0;
    let ink = 39.0 / px - 9.0 * 8.0;
    assert!(dashes["closed"] == true && dashes["euler"] == 20, "{dashes}");
    assert!((dashes["volume"].as_f64().unwrap() / (5.0 * ink * px * 2.0 * px) - 1.0).abs() < 1e-4, "{dashes}");
}

/// Logos with strokes, shapes that touch, and outlines that touch themselves become closed solids, even after reading in single precision.
#[test]
fn logos_for_a_printer() {
    let dir = tempfile::tempdir().unwrap();
    for name in ["logo", "badge", "icon", "tiles", "lineart"] {
        fs::copy(sample(&format!("{name}.svg")), dir.path().join("in.svg")).unwrap();
        let args = [
            "wrap",
            "in.svg",
            "--extrude",
            "5mm",
            "--radius",
            "41mm",
            "--refine",
            "0.05mm",
            "-o",
            "mug.stl",
            "--quiet",
        ];
        let mug = report(dir.path(), &args);
        let again = report(dir.path(), &["ffd", "mug.stl", "-o", "again.stl"]);
        assert!(mug["after"]["closed"] == true && again["before"]["closed"] == true, "{name}: {mug} {again}");
        assert_eq!(mug["after"]["euler"], again["before"]["euler"], "{name}");
    }
}

#[test]
fn a_preview_shows_both_sides_of_both() {
    let dir = tempfile::tempdir().unwrap();
    fs::copy(sample("solid/teapot.obj"), dir.path().join("in.obj")).unwrap();
    ok(dir.path(), &["bend", "in.obj", "--preset", "twist", "--along", "y", "--preview", "p.png", "-o", "o.obj"], "");
    let picture = pathwarp_raster::decode_png(&fs::read(dir.path().join("p.png")).unwrap()).unwrap();
    assert_eq!((picture.width(), picture.height()), (968, 968));
    // Every panel has a model in its middle, and white corners.
    for (x, y) in [(240, 240), (728, 240), (240, 728), (728, 728)] {
        assert!(picture.pixel(x, y).unwrap().red() < 250, "{x} {y}");
    }
    assert_eq!(picture.pixel(2, 2).unwrap().red(), 255);
}

/// The rod of a sighting hole surrounds the ray from the eye through the middle of the model, before and behind all of the result.
#[test]
fn a_sighting_hole_lies_on_the_ray_of_the_eye() {
    let dir = tempfile::tempdir().unwrap();
    let cube = "v 0 0 0\nv 60 0 0\nv 60 60 30\nv 0 60 30\nf 1 2 3 4\n";
    let line = ["anamorph", "--eye", "10,20,300", "--degree", "1", "--push", "1,1,1:1.5", "--sight-hole", "rod.obj"];
    let result = Model::read(&ok(dir.path(), &line, cube));
    let text = fs::read_to_string(dir.path().join("rod.obj")).unwrap();
    let rod = Model::read(&text);
    // From (10, 20, 300) to the middle (30, 30, 15) of the box.
    let (eye, way) = ([10.0, 20.0, 300.0], [20.0, 10.0, -285.0]);
    let length = f64::sqrt(way.iter().map(|v| v * v).sum());
    let along = |p: &[f64; 3]| (0..3).map(|i| (p[i] - eye[i]) * way[i]).sum::<f64>() / length;
    let radius = 0.01 * f64::sqrt(60.0 * 60.0 * 2.0 + 30.0 * 30.0);
    for p in &rod.vertices {
        let square: f64 = (0..3).map(|i| (p[i] - eye[i]).powi(2)).sum();
        assert!(((square - along(p).powi(2)).sqrt() - radius).abs() < 1e-9, "{p:?}");
    }
    let depths: Vec<f64> = rod.vertices.iter().map(along).collect();
    let (near, far) =
        (depths.iter().copied().fold(f64::INFINITY, f64::min), depths.iter().copied().fold(0.0, f64::max));
    assert!(result.vertices.iter().map(along).all(|d| d > near && d < far));
    // Its faces look outwards: six times its volume by tetrahedra is that of a prism with 24 sides.
    let faces: Vec<Vec<usize>> = text
        .lines()
        .filter_map(|l| l.strip_prefix("f "))
        .map(|l| l.split(' ').map(|w| w.parse::<usize>().unwrap() - 1).collect())
        .collect();
    let det = |[a, b, c]: [[f64; 3]; 3]| -> f64 {
        (0..3).map(|i| a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3])).sum()
    };
    let corner = |k: usize| rod.vertices[k];
    let six: f64 =
        faces.iter().flat_map(|f| (1..f.len() - 1).map(|k| det([corner(f[0]), corner(f[k]), corner(f[k + 1])]))).sum();
    let area = 12.0 * radius * radius * (std::f64::consts::TAU / 24.0).sin();
    assert!((six / 6.0 / (area * (far - near)) - 1.0).abs() < 1e-9, "{six}");
}
