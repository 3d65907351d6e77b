//! Recipes, inverses, mapped points, and drawings with an embedded source.

use crate::support::{artwork, expect_code, pathwarp_in, sample};
use serde_json::Value;
use std::fs;

const CAGE: &str = "M 10,90 C 40,110 60,70 95,85 C 85,60 105,40 90,15 C 60,-5 40,35 5,10 C 15,40 0,60 10,90 Z";
const ART: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path id='s' d='M0,0H100V100H0Z'/><circle id='c' cx='50' cy='40' r='20'/></svg>";

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_saved_command_line_runs_to_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let ok = |args: &[&str]| {
        let out = pathwarp_in(dir.path(), args, ART.as_bytes());
        assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
        out.stdout
    };
    fs::write(
        dir.path().join("cage.svg"),
        format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><path d='{CAGE}'/></svg>"),
    )
    .unwrap();
    let line = [
        "projective",
        "--target",
        "0%,100% 100%,95% 80%,10% 15%,0%",
        "--tolerance",
        "0.02",
        "--strokes",
        "keep",
        "--write-recipe",
        "r.toml",
        "+",
        "shaper",
        "--shaper",
        "cage.svg",
        "--base",
        "0%,90% 100%,100%",
        "--base-as-drawn",
    ];
    let first = ok(&line);
    assert_eq!(first, ok(&["run", "r.toml"]));
    // The recipe finds its cage from another working folder.
    let elsewhere = tempfile::tempdir().unwrap();
    let file = dir.path().join("r.toml").display().to_string();
    let out = pathwarp_in(elsewhere.path(), &["run", &file], ART.as_bytes());
    assert_eq!(first, out.stdout, "{}", text(&out.stderr));
    // Options on the command line override the recipe's.
    assert_ne!(first, ok(&["run", "r.toml", "--tolerance", "0.0001"]));
    // A recipe written to another folder refers to the same files.
    let moved = elsewhere.path().join("moved.toml").display().to_string();
    let mut line = line;
    line[8] = &moved;
    ok(&line);
    let out = pathwarp_in(elsewhere.path(), &["run", "moved.toml"], ART.as_bytes());
    assert_eq!(first, out.stdout, "{}", text(&out.stderr));
}

#[test]
fn faulty_recipes_are_input_errors_that_name_the_fault() {
    let dir = tempfile::tempdir().unwrap();
    for (recipe, part) in [
        ("", "pathwarp"),
        ("pathwarp = 2", "version 2"),
        ("pathwarp = 1", "no [[step]]"),
        ("pathwarp = 1\n[[step]]\ndeformation = 'wobble'", "wobble"),
        ("pathwarp = 1\n[[step]]\ndeformation = 'affine'\nrotat = 3", "rotat"),
        ("pathwarp = 1\n[[step]]\ndeformation = 'affine'\nrotate = {}", "rotate"),
        ("pathwarp = 1\n[options]\nloud = true\n[[step]]\ndeformation = 'affine'", "loud"),
        ("pathwarp = 1\nstep = [", "TOML"),
    ] {
        fs::write(dir.path().join("r.toml"), recipe).unwrap();
        let out = pathwarp_in(dir.path(), &["run", "r.toml"], ART.as_bytes());
        let said = text(&out.stderr);
        assert_eq!(out.status.code(), Some(3), "{recipe}: {said}");
        assert!(said.contains("r.toml") && said.contains(part), "{recipe}: {said}");
    }
}

/// X followed by X --inverse restores the drawing within (1 + s) times the tolerance, s being the largest stretch of the inverse.
#[test]
fn inverses_restore_the_drawing() {
    let dir = tempfile::tempdir().unwrap();
    for (args, stretch) in [
        (&["affine", "--rotate", "30", "--scale-x", "0.5", "--about", "10,20"][..], 2.0),
        (&["similitude", "--base", "0,100 100,100", "--target", "20,90 80,60"], 1.6),
        (&["projective", "--base", "0,100 100,100 100,0 0,0", "--target", "0,100 100,90 75,20 15,5"], 6.0),
        (
            &[
                "shaper",
                "--base",
                "0,100 100,100 100,0 0,0",
                "--shaper",
                "0,100 100,90 90,0 5,5",
                "--target",
                "0,100 100,95 90,10 10,0",
            ],
            6.0,
        ),
    ] {
        let there =
            pathwarp_in(dir.path(), &[args, &["--tolerance", "0.001", "--precision", "9"]].concat(), ART.as_bytes());
        assert_eq!(there.status.code(), Some(0), "{}", text(&there.stderr));
        let back = pathwarp_in(
            dir.path(),
            &[args, &["--inverse", "--tolerance", "0.001", "--precision", "9"]].concat(),
            &there.stdout,
        );
        assert_eq!(back.status.code(), Some(0), "{args:?} {}", text(&back.stderr));
        fs::write(dir.path().join("a.svg"), ART).unwrap();
        fs::write(dir.path().join("b.svg"), &back.stdout).unwrap();
        let compared = pathwarp_in(dir.path(), &["compare", "--json", "a.svg", "b.svg"], b"");
        let c: Value = serde_json::from_slice(&compared.stdout).unwrap();
        assert!(c["max_distance"].as_f64().unwrap() <= (1.0 + stretch) * 0.001, "{args:?}: {c}");
    }
}

#[test]
fn a_recipe_runs_backwards() {
    let dir = tempfile::tempdir().unwrap();
    let recipe = "pathwarp = 1\n[[step]]\ndeformation = 'affine'\nrotate = 30\nabout = '10,20'\n[[step]]\ndeformation = 'projective'\nbase = '0,100 100,100 100,0 0,0'\ntarget = '0,100 100,90 75,20 15,5'\n";
    fs::write(dir.path().join("r.toml"), recipe).unwrap();
    let fine = ["--tolerance", "1e-5", "--precision", "10", "-q"];
    let art = ART
        .replace("r='20'", "r='9'")
        .replace("<path id='s' d='M0,0H100V100H0Z'/>", "<path id='s' d='M30,30h20v20z'/>");
    let there = pathwarp_in(dir.path(), &[&["run", "r.toml"][..], &fine].concat(), art.as_bytes());
    let back = pathwarp_in(dir.path(), &[&["run", "r.toml", "--inverse"][..], &fine].concat(), &there.stdout);
    assert_eq!(back.status.code(), Some(0), "{}", text(&back.stderr));
    fs::write(dir.path().join("a.svg"), art).unwrap();
    fs::write(dir.path().join("b.svg"), &back.stdout).unwrap();
    let out = pathwarp_in(dir.path(), &["compare", "a.svg", "b.svg", "--max-distance", "1e-4"], b"");
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stdout));
}

#[test]
fn an_embedded_source_is_restored_byte_for_byte() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out.svg").display().to_string();
    for name in artwork() {
        let source = fs::read(sample(&name)).unwrap();
        let input = sample(&name).display().to_string();
        expect_code(0, &["shaper", &input, "--shaper", CAGE, "--embed-recipe", "-q", "-o", &out]);
        let back = pathwarp_in(dir.path(), &["unwarp", "out.svg"], b"");
        assert_eq!(back.stdout, source, "{name}");
        // The embedded recipe runs.
        let recipe = pathwarp_in(dir.path(), &["unwarp", "--recipe", "out.svg", "-o", "r.toml"], b"");
        assert_eq!(recipe.status.code(), Some(0));
        let again = pathwarp_in(dir.path(), &["run", "r.toml", "-", "--embed-recipe", "-q"], &source);
        assert_eq!(again.stdout, fs::read(&out).unwrap(), "{name}");
    }
    let none = pathwarp_in(dir.path(), &["unwarp", "-"], ART.as_bytes());
    assert_eq!(none.status.code(), Some(3));
    assert!(text(&none.stderr).contains("--embed-recipe"));
}

#[test]
fn points_are_mapped_line_by_line() {
    let dir = tempfile::tempdir().unwrap();
    let run = |args: &[&str], points: &str| pathwarp_in(dir.path(), &[&["map"], args].concat(), points.as_bytes());
    let out = run(&["affine", "--matrix", "1,2,3,4,5,6"], "10 100\n\n# a comment\n0,0\n");
    assert_eq!(text(&out.stdout), "315 426\n5 6\n");
    let out = run(&["affine", "--matrix", "1,2,3,4,5,6", "--jacobian"], "10 100");
    assert_eq!(text(&out.stdout), "315 426 1 2 3 4\n");
    let out = run(&["affine", "--matrix", "1,2,3,4,5,6", "--inverse"], "315 426");
    assert_eq!(text(&out.stdout), "10 100\n");
    // A chain, with percentages that refer to the frame.
    let out = run(
        &["affine", "--matrix", "2,0,0,2,0,0", "--frame", "0,0,10,10", "+", "affine", "--matrix", "1,0,0,1,1,0"],
        "3 4",
    );
    assert_eq!(text(&out.stdout), "7 8\n");
    // The map is not defined beyond the horizon.
    let out = run(&["projective", "--frame", "0,0,100,100", "--target", "0,100 100,100 75,0 25,0"], "50 50\n50 300\n");
    assert_eq!(out.status.code(), Some(1), "{}", text(&out.stderr));
    assert!(text(&out.stdout).ends_with("nan nan\n"), "{}", text(&out.stdout));
    let bad = run(&["affine"], "1 2\n3 four\n");
    assert_eq!(bad.status.code(), Some(3));
    assert!(text(&bad.stderr).contains(":2: `3 four`"), "{}", text(&bad.stderr));
}

#[test]
fn the_schema_names_every_parameter() {
    let (schema, _) = expect_code(0, &["schema"]);
    let schema: Value = serde_json::from_str(&schema).unwrap();
    let steps = schema["properties"]["step"]["items"]["oneOf"].as_array().unwrap();
    for e in pathwarp::deform::Registry::builtin().entries() {
        let step = steps.iter().find(|s| s["properties"]["deformation"]["const"] == e.info().name).unwrap();
        for p in e.info().params {
            assert!(step["properties"][p.name]["description"].is_string());
        }
    }
}

/// A square is repeated three times along a line of three times its width, and a whole number of times along a circle.
#[test]
fn artwork_is_repeated_along_a_skeleton() {
    const SQUARE: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 400'><defs><clipPath id='k'><rect width='10' \
                          height='10'/></clipPath></defs><rect id='s' width='10' height='10' clip-path='url(#k)' stroke='red'/></svg>";
    let dir = tempfile::tempdir().unwrap();
    let bend = |along: &str| {
        let args =
            ["bend", "--along", along, "--stretch", "repeat", "--strokes", "keep", "--baseline", "0", "-o", "o.svg"];
        let args: Vec<&str> = args.into_iter().chain(["--report", "r.json"]).collect();
        let out = pathwarp_in(dir.path(), &args, SQUARE.as_bytes());
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        let report: Value = serde_json::from_str(&fs::read_to_string(dir.path().join("r.json")).unwrap()).unwrap();
        let svg = fs::read(dir.path().join("o.svg")).unwrap();
        let doc = pathwarp_svg::Document::read(&svg, "o.svg", &pathwarp_svg::ReadOptions::default()).unwrap();
        (report, doc.shapes().iter().map(|s| s.outline.clone()).collect::<Vec<_>>())
    };
    let (report, shapes) = bend("20,50 50,50");
    assert_eq!(report["inputs"][0]["shapes"][0]["copies"], 3, "{report}");
    // The square and its clip path are both repeated.
    assert_eq!(shapes.len(), 2);
    for outline in shapes {
        assert_eq!(outline.subpaths.len(), 3);
        for (i, s) in outline.subpaths.iter().enumerate() {
            let b = pathwarp::Outline { subpaths: vec![s.clone()] }.bounding_box().unwrap();
            let x = 20.0 + 10.0 * i as f64;
            assert!(
                (b.x0 - x).abs() + (b.x1 - x - 10.0).abs() + (b.y0 - 40.0).abs() + (b.y1 - 50.0).abs() < 1e-2,
                "{b:?}"
            );
        }
    }
    let (report, shapes) = bend("M100,200 A100,100 0 1 1 300,200 A100,100 0 1 1 100,200 Z");
    assert_eq!(report["inputs"][0]["shapes"][0]["copies"], 62, "{report}");
    assert!(shapes.iter().all(|s| s.subpaths.len() == 62));

    // Copies are made before the first map, and cannot be undone.
    for (args, part) in [
        (&["affine", "--rotate", "5", "+", "bend", "--along", "0,0 50,0", "--stretch", "repeat"][..], "first step"),
        (&["bend", "--along", "0,0 50,0", "--stretch", "repeat", "--inverse"], "no inverse"),
    ] {
        let out = pathwarp_in(dir.path(), args, SQUARE.as_bytes());
        assert!(text(&out.stderr).contains(part) && out.status.code() == Some(3), "{out:?}");
    }
    let args = ["bend", "--along", "0,0 50,0", "--stretch", "repeat", "+", "affine", "--move-x", "100%"];
    let out = pathwarp_in(dir.path(), &args, SQUARE.as_bytes());
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    // At the second step the artwork is the whole row.
    let doc = pathwarp_svg::Document::read(&out.stdout, "out", &pathwarp_svg::ReadOptions::default()).unwrap();
    let b = doc.shapes()[0].outline.bounding_box().unwrap();
    assert!((b.x0 - 50.0).abs() + (b.x1 - 100.0).abs() < 1e-2, "{b:?}");
}

/// On the samples, X followed by X --inverse restores every path within (1 + s) times the tolerance, s being the largest stretch of
/// the inverse along the artwork (the reciprocal of the map's smaller singular value).
#[test]
fn inverses_restore_the_samples() {
    const TOLERANCE: f64 = 0.01;
    let bent = "M 0,30 C 10,38 20,22 33,30 C 37,20 28,10 33,0 C 20,-6 10,8 0,0 C 4,10 -3,20 0,30 Z";
    let deformations: [(&str, &[(&str, &str)]); 6] = [
        ("shaper", &[("shaper", bent), ("target", "5%,90% 95%,90%")]),
        ("birational", &[("top", "0%,10% 50%,-15% 100%,5%"), ("bottom", "0%,100% 40%,110% 100%,95%")]),
        ("swirl", &[]),
        ("bulge", &[]),
        ("wave", &[]),
        ("projective", &[("target", "0%,100% 100%,90% 75%,20% 15%,5%")]),
    ];
    let dir = tempfile::tempdir().unwrap();
    for name in ["icon.svg", "lettering.svg", "monogram.svg", "tiles.svg", "lineart.svg"] {
        let source = fs::read(sample(name)).unwrap();
        let doc = pathwarp_svg::Document::read(&source, name, &pathwarp_svg::ReadOptions::default()).unwrap();
        let page = doc.view_box();
        let frame = format!("{},{},{},{}", page.x0, page.y0, page.width(), page.height());
        for (deformation, pairs) in deformations {
            let mut line = vec![
                deformation,
                "--frame",
                &frame,
                "--strokes",
                "keep",
                "--tolerance",
                "0.01",
                "--precision",
                "8",
                "-q",
            ];
            let named: Vec<String> = pairs.iter().map(|(k, _)| format!("--{k}")).collect();
            for (k, (_, v)) in named.iter().zip(pairs) {
                line.extend([k.as_str(), *v]);
            }
            let there = pathwarp_in(dir.path(), &line, &source);
            assert_eq!(there.status.code(), Some(0), "{name} {deformation}: {}", text(&there.stderr));
            line.push("--inverse");
            let back = pathwarp_in(dir.path(), &line, &there.stdout);
            assert_eq!(back.status.code(), Some(0), "{name} {deformation}: {}", text(&back.stderr));

            let args = pathwarp::param::Args::from_pairs(pairs);
            let registry = pathwarp::deform::Registry::builtin();
            let map =
                registry.get(deformation).unwrap().build_from(&args, &pathwarp::param::Frame::new(page)).unwrap().map;
            let stretch = doc
                .shapes()
                .iter()
                .flat_map(|s| s.outline.segs())
                .flat_map(|g| (0..=20).map(|i| map.jet(g.eval(f64::from(i) / 20.0))))
                .map(|j| {
                    let (a, b, c, d) = (j.dx.x, j.dy.x, j.dx.y, j.dy.y);
                    let (p, q) = ((a + d).hypot(c - b), (a - d).hypot(c + b));
                    2.0 / (p - q).abs()
                })
                .fold(0.0, f64::max);
            fs::write(dir.path().join("a.svg"), &source).unwrap();
            fs::write(dir.path().join("b.svg"), &back.stdout).unwrap();
            let compared = pathwarp_in(dir.path(), &["compare", "--json", "--width", "50", "a.svg", "b.svg"], b"");
            let c: Value = serde_json::from_slice(&compared.stdout).unwrap();
            let ids = |c: &Value| {
                c["paths"]
                    .as_array()
                    .unwrap()
                    .iter()
                    .filter(|p| !p["id"].as_str().unwrap().contains(' '))
                    .cloned()
                    .collect::<Vec<_>>()
            };
            for p in ids(&c) {
                let d = p["distance"].as_f64().unwrap_or(0.0);
                assert!(d <= (1.0 + stretch) * TOLERANCE, "{name} {deformation} {}: {d}, stretch {stretch}", p["id"]);
            }
            assert!(!ids(&c).is_empty());
        }
    }
}
