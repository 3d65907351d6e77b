//! Plug-ins that work: each is a deformation wherever deformations can be named.

use crate::support::plugins::{Scratch, entry, script, text};
use pathwarp::Outline;
use std::fs;
use std::process::Stdio;

/// The path data of a drawing, in document order.
fn paths(svg: &str) -> Vec<Outline> {
    let svg = svg.replace('\'', "\"");
    svg.split(" d=\"").skip(1).map(|rest| Outline::from_svg(rest.split('"').next().unwrap()).unwrap()).collect()
}

#[test]
fn the_check_names_the_law_that_fails_and_where() {
    let scratch = Scratch::new();
    let laws = r#""laws": [{"identity": {}}, {"area": [{}, 1]}], "cases": [{"at": [1, 2], "to": [1, 2], "tolerance": 0.1}], "title""#;
    let moves = script("bad", "echo 7 7");
    scratch.install("pathwarp-bad", &moves.replace("\"title\"", laws));
    let (report, _) = scratch.expect(1, &["check", "bad"]);
    for word in [
        "FAIL  help",
        "fewer than two examples",
        "FAIL  laws",
        "should be the identity",
        "FAIL  cases",
        "{} takes 1,2 to 7,7",
        "fails",
    ] {
        assert!(report.contains(word), "`{word}` not in:\n{report}");
    }
    scratch.install("pathwarp-bad", &script("bad", "echo nan nan"));
    let (report, _) = scratch.expect(1, &["check", "bad"]);
    assert!(report.contains("FAIL  values") && report.contains("NaN or infinity for the point"), "{report}");
    let (_, stderr) = scratch.expect(2, &["check", "wobble"]);
    assert!(stderr.contains("there is no deformation `wobble`"), "{stderr}");
}

/// A plug-in that moves everything by `x`, and writes a line to the file `starts` whenever it is started.
fn shift(scratch: &Scratch) -> String {
    let params =
        r#""parameters": [{"name": "x", "kind": "length", "axis": "x", "default": "10%", "help": "Shift."}], "title""#;
    let entry = entry("shift").replace("\"title\"", params);
    let starts = scratch.file("starts");
    format!(
        r#"#!/bin/sh
echo started >> {starts}
echo '{entry}'
lines() {{ i=0; while [ $i -lt $1 ]; do read -r line; echo "$line"; i=$((i+1)); done; }}
while read -r command count; do
    case $command in
        build) x=$(lines $count | awk '$1 == "x" {{ print $2 }}'); echo ok;;
        points) lines $count | awk -v x="$x" '{{ printf "%.17g %.17g\n", $1 + x, $2 }}';;
    esac
done
"#,
        starts = starts.display()
    )
}

#[test]
fn a_plug_in_is_a_deformation_everywhere() {
    let scratch = Scratch::new();
    scratch.install("pathwarp-shift.sh", &shift(&scratch));
    let starts = || fs::read_to_string(scratch.file("starts")).unwrap_or_default().lines().count();
    let (list, _) = scratch.expect(0, &["list"]);
    assert!(list.contains("Plug-ins\n  shift") && starts() == 1, "{list}");
    // The entry is remembered from now on.
    for args in [
        &["list", "--json"][..],
        &["help", "shift"],
        &["shift", "--help"],
        &["schema"],
        &["--help"],
        &["completions", "bash"],
    ] {
        let (out, _) = scratch.expect(0, args);
        assert!(out.contains("shift"), "{args:?}: {out}");
    }
    assert_eq!(starts(), 1);
    let (help, _) = scratch.expect(0, &["shift", "--help"]);
    assert!(help.contains("--x <LENGTH>") && help.contains("[default: 10%]"), "{help}");
    let (_, stderr) = scratch.expect(2, &["shift", "in.svg", "--x", "a mile"]);
    assert!(stderr.contains("--x"), "{stderr}");

    // Units are resolved; a chain, an inverse, and a recipe name the plug-in.
    let x = |file: &str| paths(&fs::read_to_string(scratch.file(file)).unwrap())[0].bounding_box().unwrap().x0;
    scratch.expect(0, &["shift", "in.svg", "-o", "out.svg", "--x", "10mm", "--write-recipe", "r.toml", "-q"]);
    assert!((x("out.svg") - (10.0 + 96.0 / 2.54)).abs() < 0.02, "{}", x("out.svg"));
    scratch.expect(0, &["affine", "in.svg", "--move-x", "1", "+", "shift", "--x", "5", "-o", "out.svg", "-q"]);
    assert!((x("out.svg") - 16.0).abs() < 0.02);
    scratch.expect(0, &["shift", "in.svg", "--x", "5", "--inverse", "-o", "out.svg", "-q"]);
    assert!((x("out.svg") - 5.0).abs() < 0.02);
    scratch.expect(0, &["run", "r.toml", "in.svg", "--x", "3", "-o", "out.svg", "-q"]);
    assert!((x("out.svg") - 13.0).abs() < 0.02);
    let mut map = scratch
        .command(&["map", "shift", "--x", "2", "--jacobian"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    std::io::Write::write_all(&mut map.stdin.take().unwrap(), b"1 1\n5 7\n").unwrap();
    let mapped = text(&map.wait_with_output().unwrap().stdout);
    let numbers: Vec<f64> = mapped.split_whitespace().map(|n| n.parse().unwrap()).collect();
    let expected = [3.0, 1.0, 1.0, 0.0, 0.0, 1.0, 7.0, 7.0, 1.0, 0.0, 0.0, 1.0];
    assert!(numbers.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{mapped}");
}

#[test]
fn a_recipe_starts_no_program_by_its_path() {
    let scratch = Scratch::new();
    let elsewhere = Scratch::new();
    let file = elsewhere.install("pathwarp-shift", &shift(&elsewhere)).display().to_string();
    for step in [format!("deformation = \"{file}\""), format!("deformation = \"shift\"\nplugin = \"{file}\"")] {
        fs::write(scratch.file("r.toml"), format!("pathwarp = 1\n[[step]]\n{step}\n")).unwrap();
        scratch.expect(3, &["run", "r.toml", "in.svg", "-o", "out.svg"]);
    }
    fs::write(
        scratch.file("r.toml"),
        format!("pathwarp = 1\n[options]\nplugin = \"{file}\"\n[[step]]\ndeformation = \"shift\"\n"),
    )
    .unwrap();
    scratch.expect(3, &["run", "r.toml", "in.svg", "-o", "out.svg"]);
    assert!(!elsewhere.file("starts").exists());
    // The user may name it beside the recipe.
    fs::write(scratch.file("r.toml"), "pathwarp = 1\n[[step]]\ndeformation = \"shift\"\n").unwrap();
    scratch.expect(0, &["run", "r.toml", "in.svg", "-o", "out.svg", "--plugin", &file, "-q"]);
    assert!(elsewhere.file("starts").exists());
}
