//! `pathwarp solid` with PLY, glTF, curved surfaces and several models at once.

use super::{fails, ok, report, text};
use crate::support::{pathwarp_in, sample};
use serde_json::Value;
use std::fs;

const PUSH: [&str; 6] = ["--degree", "1", "--move", "1,1,1:4,2,-3", "--weight", "0,1,0:2"];

fn args<'a>(first: &[&'a str], last: &[&'a str]) -> Vec<&'a str> {
    [first, &PUSH, last].concat()
}

/// Every format of meshes gives an equal surface of a model, up to the precision of the format.
#[test]
fn formats_agree() {
    let dir = tempfile::tempdir().unwrap();
    fs::copy(sample("solid/room.obj"), dir.path().join("in.obj")).unwrap();
    let straight = report(dir.path(), &args(&["ffd", "in.obj"], &["-o", "out.obj"]));
    for format in ["ply", "glb", "gltf"] {
        let copy = format!("copy.{format}");
        // Nothing moves, so this is a conversion. PLY has no names, of which pathwarp warns.
        let out = pathwarp_in(dir.path(), &["solid", "ffd", "in.obj", "-o", &copy], b"");
        assert_eq!(out.status.code(), Some(0), "{format}: {}", text(&out.stderr));
        assert_eq!(text(&out.stderr).contains("no room for names"), format == "ply", "{format}: {}", text(&out.stderr));
        let again = report(dir.path(), &args(&["ffd", &copy], &["-o", &format!("out.{format}")]));
        for key in ["area", "vertices"] {
            let [a, b] = [&straight, &again].map(|r| r["after"][key].as_f64().unwrap());
            let same = if key == "area" {
                1e-6 * a
            } else if format == "ply" {
                0.0
            } else {
                f64::INFINITY
            };
            assert!((a - b).abs() <= same, "{format} {key}: {a} {b}");
        }
        let [a, b] = [&straight, &again].map(|r| r["after"]["faces"].as_u64().unwrap());
        assert_eq!(if format == "ply" { a } else { b.min(2 * a) }, b, "{format}");
        assert_eq!(straight["after"]["closed"], again["after"]["closed"], "{format}");
    }
}

/// A patch file through a perspective map keeps its degree and becomes rational; through a lattice its degree rises; a twist is refitted.
#[test]
fn curved_surfaces() {
    let dir = tempfile::tempdir().unwrap();
    fs::copy(sample("solid/newell.bpt"), dir.path().join("in.bpt")).unwrap();
    let anamorph = [
        "anamorph",
        "in.bpt",
        "--eye",
        "0,2,20",
        "--reference",
        "-5,-1,3;5,-1,3;0,8,3;0,1,-6",
        "--push",
        "0,0,0,1:150%",
    ];
    let projected = report(dir.path(), &[&anamorph[..], &["-o", "p.json"]].concat());
    assert!(projected["exact"] == 32 && projected["after"]["degree"] == serde_json::json!([3, 3]), "{projected}");
    assert_eq!(projected["after"]["rational"], 32);
    let said = fails(dir.path(), &[&anamorph[..], &["-o", "p.bpt"]].concat(), "", 2);
    assert!(said.contains("has weights") && said.contains("write .json"), "{said}");
    let lattice = report(dir.path(), &["ffd", "in.bpt", "--degree", "1", "--move", "1,1,1:1,0.5,0", "-o", "l.bpt"]);
    assert!(lattice["exact"] == 32 && lattice["after"]["degree"] == serde_json::json!([9, 9]), "{lattice}");
    let twist = ["bend", "in.bpt", "--preset", "twist", "--along", "y", "--angle", "90", "--refine", "0.001"];
    let twisted = report(dir.path(), &[&twist[..], &["-o", "t.json"]].concat());
    assert!(twisted["refitted"] == 32 && twisted["distance"].as_f64().unwrap() <= 0.001, "{twisted}");
    // As polygons, and there and back, the surface of a JSON file does not change.
    for (from, to) in [("t.json", "t.obj"), ("in.bpt", "plain.obj")] {
        ok(dir.path(), &["ffd", from, "-o", to], "");
    }
    let area = |name: &str| report(dir.path(), &["ffd", name, "-o", "again.stl"])["after"]["area"].as_f64().unwrap();
    // A turn that changes with the height shears: the area grows.
    assert!(area("t.obj") > 1.02 * area("plain.obj"));
    ok(dir.path(), &["ffd", "in.bpt", "-o", "same.bpt"], "");
    let numbers = |name: &str| -> Vec<f64> {
        let all = fs::read_to_string(dir.path().join(name)).unwrap();
        all.lines()
            .map(|l| l.split('#').next().unwrap())
            .flat_map(str::split_whitespace)
            .map(|w| w.parse().unwrap())
            .collect()
    };
    assert_eq!(numbers("in.bpt"), numbers("same.bpt"));
    assert!(fails(dir.path(), &["ffd", "t.obj", "-o", "x.bpt"], "", 2).contains("not curved surfaces"));
    fs::write(dir.path().join("bad.json"), "{\"surfaces\":[{\"degree\":[1,1],\"points\":[[0,0,0]]}]}").unwrap();
    assert!(fails(dir.path(), &["ffd", "bad.json", "-o", "x.json"], "", 3).contains("surface 1 has 1 control points"));
}

#[test]
fn several_models_each_on_its_own() {
    let dir = tempfile::tempdir().unwrap();
    for name in ["a.obj", "b.obj"] {
        fs::copy(sample("solid/room.obj"), dir.path().join(name)).unwrap();
    }
    fs::write(dir.path().join("bad.obj"), "v 0 0\n").unwrap();
    let all = args(
        &["solid", "ffd", "a.obj", "bad.obj", "b.obj"],
        &["--out-dir", "out", "--report", "r.json", "--preview", "{stem}.png"],
    );
    let out = pathwarp_in(dir.path(), &all, b"");
    assert_eq!(out.status.code(), Some(1), "{}", text(&out.stderr));
    assert!(text(&out.stderr).contains("bad.obj: line 1") && text(&out.stderr).contains("1 of 3 models failed"));
    let read = |name: &str| fs::read(dir.path().join(name)).unwrap();
    assert_eq!(read("out/a.obj"), read("out/b.obj"));
    assert!(read("a.png").len() > 1000 && read("b.png").len() > 1000 && !dir.path().join("out/bad.obj").exists());
    let report: Value = serde_json::from_slice(&read("r.json")).unwrap();
    assert!(report[0]["file"] == "a.obj" && report[1]["error"].as_str().unwrap().contains("line 1"), "{report}");
    assert_eq!(report[2]["moved"], report[0]["moved"]);
    let said = |more: &[&str]| fails(dir.path(), &args(&["ffd", "a.obj", "b.obj"], more), "", 2);
    assert!(said(&["-o", "c.obj"]).contains("--out-dir"));
    assert!(said(&["--out-dir", "out", "--preview", "p.png"]).contains("{stem}"));
    assert!(said(&["--out-dir", "."]).contains("overwritten"));
    assert!(said(&["-o", "{stem}.fbx"]).contains("not as .fbx"));
    ok(dir.path(), &args(&["ffd", "a.obj", "b.obj"], &["-o", "new/{stem}-bent.ply", "--quiet"]), "");
    assert_eq!(read("new/a-bent.ply"), read("new/b-bent.ply"));
}

/// Damage and endless work end with an error in bounded time, and leave nothing behind.
#[test]
fn damage_and_endless_work() {
    let dir = tempfile::tempdir().unwrap();
    fs::copy(sample("solid/teapot.obj"), dir.path().join("in.obj")).unwrap();
    fs::copy(sample("solid/newell.bpt"), dir.path().join("in.bpt")).unwrap();
    fs::write(dir.path().join("many.ply"), "ply\nformat ascii 1.0\nelement vertex 1000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n").unwrap();
    fs::write(dir.path().join("many.bpt"), "1000000000\n3 3\n").unwrap();
    fs::write(
        dir.path().join("out.gltf"),
        r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[]}],"buffers":[{"uri":"/etc/passwd","byteLength":9}]}"#,
    )
    .unwrap();
    let refused_by = |code: i32, input: &str, more: &[&str], part: &str| {
        let twist = ["bend", input, "--preset", "twist", "--along", "y", "--angle", "90", "-o", "o.obj"];
        let said = fails(dir.path(), &[&twist[..], more].concat(), "", code);
        assert!(said.contains(part), "{input}: {said}");
        assert!(!dir.path().join("o.obj").exists());
    };
    let refused = |input: &str, more: &[&str], part: &str| refused_by(3, input, more, part);
    refused("many.ply", &[], "announces 1000000000 elements");
    refused("many.bpt", &[], "ends");
    refused("out.gltf", &[], "outside the file");
    refused("in.obj", &["--refine", "1e-12", "--limit", "work=1000000"], "allow a larger --refine");
    refused_by(4, "in.bpt", &["--refine", "1e-13", "--limit", "work=100000"], "the limit `work`");
}

/// Warns of an inverted map that folds, under which a point has several sources.
#[test]
fn folds_of_an_inverse_are_said() {
    let dir = tempfile::tempdir().unwrap();
    fs::copy(sample("solid/room.obj"), dir.path().join("in.obj")).unwrap();
    let fold = |by: &str| -> String {
        let moved = format!("1,1,1:{by},0,0");
        let args = ["solid", "ffd", "in.obj", "--degree", "2", "--move", &moved, "--inverse", "-o", "o.obj"];
        text(&pathwarp_in(dir.path(), &args, b"").stderr)
    };
    assert!(fold("400%").contains("folds space over itself"), "{}", fold("400%"));
    assert_eq!(fold("20%"), "");
}
