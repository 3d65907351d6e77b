//! The plug-in at work in GIMP 3.

use super::installed::{IN_GIMP_3, gimp_3};
use crate::support::expect_code;
use crate::support::gimp::stroke;
use pathwarp_gimp::{GimpPath, Stroke, read, to_json};
use serde_json::Value;
use std::fs;

/// The paths of the image: artwork, a cage, a line, and two straight paths for base and target.
fn image_paths() -> [GimpPath; 5] {
    let art = stroke(
        true,
        &[
            [10.25, 10.],
            [10.25, 10.],
            [10.25, 10.],
            [90., 10.],
            [90., 10.],
            [90., 12.125],
            [90., 90.],
            [90., 90.125],
            [88., 90.],
        ],
    );
    let cage = stroke(
        true,
        &[
            [10., 90.],
            [10., 90.],
            [40., 110.],
            [60., 70.],
            [95., 85.],
            [85., 60.],
            [105., 40.],
            [90., 15.],
            [60., -5.],
            [40., 35.],
            [5., 10.],
            [15., 40.],
        ],
    );
    let line = stroke(false, &[[0., 50.], [0., 50.], [30., 0.], [70., 100.], [100., 50.], [100., 50.]]);
    let path = |name: &str, s: &Stroke| GimpPath { name: name.into(), visible: true, strokes: vec![s.clone()] };
    let straight = |a: [f64; 2], b: [f64; 2]| stroke(false, &[a, a, a, b, b, b]);
    let (foot, place) = (straight([10., 90.], [90., 90.]), straight([300., 200.], [420., 170.]));
    [path("Art", &art), path("Cage", &cage), path("Line", &line), path("Foot", &foot), path("Place", &place)]
}

/// A script that runs procedures of the plug-in on an image with `paths`, and writes the new paths and the errors to `out`.
fn plug_in_script(paths: &str, out: &str) -> String {
    format!(
        r#"{IN_GIMP_3}
image = Gimp.Image.new(640, 400, Gimp.ImageBaseType.RGB)
build(image, "{paths}")
found, said = [], []
for name, values in [
    ("shaper", {{"shaper": "Cage"}}),
    ("shaper", {{"shaper": "Cage", "base": "Foot", "target": "Place"}}),
    ("bend", {{"along": "Line"}}),
    ("warp", {{"style": "flag", "bend": "-30%"}}),
    ("wordart", {{"preset": "triangle"}}),
    ("shaper", {{"shaper": "Nobody"}}),
    ("shaper", {{"shaper": "Line"}}),
]:
    procedure = Gimp.get_pdb().lookup_procedure("plug-in-pathwarp-" + name)
    config = procedure.create_config()
    config.set_property("run-mode", Gimp.RunMode.NONINTERACTIVE)
    config.set_property("image", image)
    config.set_property("path", "Art")
    for key, value in values.items():
        config.set_property(key, value)
    answer = procedure.run(config)
    if answer.index(0) != Gimp.PDBStatusType.SUCCESS:
        said.append(Gimp.get_pdb().get_last_error())
        continue
    new = answer.index(1)
    found.append({{"name": new.get_name(), "visible": bool(new.get_visible()), "strokes": strokes(new)}})
json.dump({{"paths": found, "said": said, "all": [p.get_name() for p in image.get_paths()]}}, open("{out}", "w"))
"#
    )
}

#[test]
fn the_plug_in_works_in_gimp_3() {
    let dir = tempfile::tempdir().unwrap();
    let d = dir.path();
    let at = |name: &str| d.join(name).display().to_string();
    expect_code(0, &["install", "gimp", "--dir", &at("gimp3/plug-ins")]);
    let all = image_paths();
    fs::write(at("in.json"), to_json(Some([640.0, 400.0]), &all)).unwrap();
    let Some(said) = gimp_3(d, &plug_in_script(&at("in.json"), &at("out.json"))) else { return };
    assert!(d.join("out.json").exists(), "{said}");
    let text = fs::read_to_string(at("out.json")).unwrap();
    let answer: Value = serde_json::from_str(&text).unwrap();
    let new = ["Art wordart", "Art warp", "Art bend", "Art shaper #1", "Art shaper"];
    let names: Vec<&str> = new.into_iter().chain(all.iter().map(|p| p.name.as_str())).collect();
    assert_eq!(answer["all"], serde_json::json!(names), "{said}");
    assert!(answer["said"][0].as_str().unwrap().contains("Nobody"), "{answer}");
    // Messages name paths, not the plug-in's temporary file.
    let why = answer["said"][1].as_str().unwrap();
    assert!(why.contains("Line") && !why.contains("paths.json"), "{why}");
    let found = read(text.as_bytes()).unwrap();
    // The command line gives equal points.
    let input = |name: &str| format!("{}#{name}", at("in.json"));
    let commands: [&[&str]; 5] = [
        &["shaper", "--shaper", &input("Cage")],
        &["shaper", "--shaper", &input("Cage"), "--base", &input("Foot"), "--target", &input("Place")],
        &["bend", "--along", &input("Line")],
        &["warp", "--style", "flag", "--bend", "-30%"],
        &["wordart", "--preset", "triangle"],
    ];
    assert_eq!(found.len(), commands.len());
    for (found, command) in found.iter().zip(commands) {
        let words: Vec<&str> = command.to_vec();
        let (art, out) = (input("Art"), at("out-of-the-program.json"));
        expect_code(0, &[words.as_slice(), &[&art, "-o", &out, "-q"]].concat());
        let wanted = &read(&fs::read(out).unwrap()).unwrap()[0];
        assert_eq!(found.strokes, wanted.strokes, "{command:?}");
        assert!(found.visible);
    }
}
