//! Plug-ins in Python, and the examples that are separate programs, give the results of a built-in deformation.

use crate::support::plugins::{Scratch, entry, python, text};
use crate::support::{program, root, sample};
use pathwarp::Outline;
use pathwarp::distance::symmetric;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The example programs that ripple: in Python by lines of text, and in Rust by numbers.
fn ripples() -> Vec<PathBuf> {
    let mut all = vec![program("pathwarp-ripple-program")];
    if python() {
        all.push(root().join("examples/plug-ins/pathwarp-ripple.py"));
    }
    all
}

/// Returns the program with that deformation compiled in.
fn compiled_in() -> PathBuf {
    program("pathwarp-ripple")
}

/// The path data of a drawing, in document order.
fn paths(svg: &str) -> Vec<Outline> {
    let svg = svg.replace('\'', "\"");
    svg.split(" d=\"").skip(1).map(|rest| Outline::from_svg(rest.split('"').next().unwrap()).unwrap()).collect()
}

/// Asserts that both drawings agree within `tolerance`.
fn assert_same(a: &Path, b: &Path, tolerance: f64) {
    let [a, b] = [a, b].map(|f| paths(&fs::read_to_string(f).unwrap()));
    assert!(!a.is_empty() && a.len() == b.len());
    for (p, q) in a.iter().zip(&b) {
        let off = symmetric(p, q).unwrap();
        assert!(off <= tolerance, "{off}");
    }
}

#[test]
fn a_program_gives_what_the_compiled_in_deformation_gives() {
    let scratch = Scratch::new();
    for drawing in ["logo.svg", "lettering.svg", "lineart.svg"] {
        let (drawing, expected) = (sample(drawing), scratch.file("expected.svg"));
        let args =
            ["ripple", drawing.to_str().unwrap(), "--wavelength", "60%", "--height", "2%", "--tolerance", "0.01", "-q"];
        let mut own = Command::new(compiled_in());
        assert!(own.args(args).arg("-o").arg(&expected).status().unwrap().success());
        for program in ripples() {
            let plugin = ["-o", "out.svg", "--plugin", program.to_str().unwrap()];
            scratch.expect(0, &[&args[..], &plugin].concat());
            assert_same(&scratch.file("out.svg"), &expected, 0.02);
            let whole = fs::read(scratch.file("out.svg")).unwrap();
            for jobs in ["1", "3", "8"] {
                scratch.expect(0, &[&args[..], &plugin, &["-j", jobs]].concat());
                assert_eq!(fs::read(scratch.file("out.svg")).unwrap(), whole, "{jobs} threads");
            }
        }
    }
}

/// By numbers, values and derivatives are requested together. A program may answer one request before it reads the next.
#[test]
fn requests_that_come_together_may_be_answered_one_by_one() {
    if !python() {
        return;
    }
    let scratch = Scratch::new();
    let script = r#"#!/usr/bin/env python3
import math, os, struct
entry = 'ENTRY'.replace('"text"', '"binary"').replace('"title"', '"jacobian": true, "title"')
os.write(1, entry.encode() + b"\n")
def read(n):
    got = b""
    while len(got) < n and (more := os.read(0, n - len(got))):
        got += more
    return got
while head := read(4):
    kind, *body = read(struct.unpack("<I", head)[0])
    body, out = bytes(body), b""
    for x, y in struct.iter_unpack("<dd", body) if kind != 1 else []:
        out += struct.pack("<dd", x, y + 5 * math.sin(x / 9))
        if kind == 3:
            out += struct.pack("<dddd", 1, 5 / 9 * math.cos(x / 9), 0, 1)
    with open("requests", "a") as log:
        log.write(str(kind))
    os.write(1, struct.pack("<IB", len(out) + 1, 0) + out)
"#;
    scratch.install("pathwarp-waves", &script.replace("ENTRY", &entry("waves").replace('\n', " ")));
    scratch.expect(0, &["waves", "in.svg", "-o", "out.svg", "-q"]);
    let requests = fs::read_to_string(scratch.file("requests")).unwrap();
    assert!(requests.contains("23"), "{requests}");
    let formula = ["expr", "in.svg", "-o", "expected.svg", "-q", "--x", "x", "--y", "y + 5*sin(x/9)"];
    scratch.expect(0, &formula);
    assert_same(&scratch.file("out.svg"), &scratch.file("expected.svg"), 0.2);
}

#[test]
fn the_examples_and_built_in_deformations_pass_the_check() {
    let scratch = Scratch::new();
    let mut all: Vec<String> = ripples().iter().map(|p| p.display().to_string()).collect();
    all.push(root().join("examples/plug-ins/pathwarp-tilt.sh").display().to_string());
    all.extend(["wave".to_owned(), "shaper".to_owned()]);
    for what in all {
        let (report, _) = scratch.expect(0, &["check", &what]);
        for word in
            ["ok    help", "ok    values", "ok    inverse", "ok    laws", "ok    cases", "ok    speed", "is sound"]
        {
            assert!(report.contains(word), "{what}: `{word}` not in:\n{report}");
        }
    }
}

/// Returns a drawing of `n` curves in one path.
fn logo(n: usize) -> String {
    let mut d = "M0,0".to_owned();
    for i in 0..n {
        let (x, y) = ((i % 25) as f64 * 36.0, (i / 25) as f64 * 40.0);
        d += &if i % 25 == 24 {
            format!(" M0,{}", y + 40.0)
        } else {
            format!(" C{},{} {},{} {},{}", x + 9.0, y + 20.0, x + 27.0, y - 20.0, x + 36.0, y)
        };
    }
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 900 800'><path d='{d}'/></svg>")
}

/// By lines of text, a Python plug-in warps 500 segments in about a second of processor time, including Python's start. Ten seconds are
/// allowed, since machines differ and have other load.
#[test]
fn five_hundred_segments_in_python_take_about_a_second() {
    if !python() {
        return;
    }
    let scratch = Scratch::new();
    fs::write(scratch.file("logo.svg"), logo(520)).unwrap();
    let plugin = root().join("examples/plug-ins/pathwarp-ripple.py").display().to_string();
    let args =
        ["ripple", "logo.svg", "-o", "out.svg", "--wavelength", "60%", "--height", "2%", "-q", "--plugin", &plugin];
    let mut child = scratch.command(&args).spawn().unwrap();
    let used = wait4::Wait4::wait4(&mut child).unwrap();
    assert!(used.status.success());
    let seconds = (used.rusage.utime + used.rusage.stime).as_secs_f64();
    eprintln!("{seconds:.2} s");
    assert!(seconds < 10.0, "{seconds} s");
}

/// A map with a kink at x = 50 that gives derivatives: the kink is a node of the result, and both sides are exact.
#[test]
fn declared_creases_are_nodes() {
    if !python() {
        return;
    }
    let scratch = Scratch::new();
    let script = r#"#!/usr/bin/env python3
import sys
print('ENTRY', flush=True)
for line in sys.stdin:
    command, n = line.split()
    lines = [sys.stdin.readline() for _ in range(int(n))]
    if command == "build":
        print("crease line 1 0 -50\nnote a kink\nok")
    for p in lines if command != "build" else []:
        x, y = map(float, p.split())
        v, slope = (y, 0) if x < 50 else (y + (x - 50) / 2, 0.5)
        print(x, v, *((1, slope, 0, 1) if command == "jets" else ()))
    sys.stdout.flush()
"#;
    let entry = entry("fold").replace("\"title\"", "\"jacobian\": true, \"title\"");
    scratch.install("pathwarp-fold", &script.replace("ENTRY", &entry));
    fs::write(
        scratch.file("line.svg"),
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path d='M0,10 H100' stroke='red'/></svg>",
    )
    .unwrap();
    let (_, notes) = scratch.expect(0, &["fold", "line.svg", "-o", "out.svg", "--explain", "--strokes", "keep"]);
    assert!(notes.contains("a kink"), "{notes}");
    let svg = fs::read_to_string(scratch.file("out.svg")).unwrap();
    let segs: Vec<_> = paths(&svg)[0].segs().map(|s| (s.start(), s.end())).collect();
    let expected = [((0.0, 10.0), (50.0, 10.0)), ((50.0, 10.0), (100.0, 35.0))];
    assert_eq!(segs.len(), 2, "{svg}");
    for ((a, b), (p, q)) in segs.iter().zip(expected) {
        assert!(a.distance(p.into()) < 0.01 && b.distance(q.into()) < 0.01, "{svg}");
    }
}

#[test]
fn two_maps_of_one_program_take_turns_over_many_points() {
    let scratch = Scratch::new();
    let curves: String = (0..12_000).map(|i| format!("Q{i},30 {},{}", i + 1, 10 + i % 7)).collect();
    let drawing =
        format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 12000 40'><path d='M0,10{curves}'/></svg>");
    fs::write(scratch.file("many.svg"), drawing).unwrap();
    let ripple = ["--wavelength", "300", "--height", "2"];
    let chain = [&["ripple", "many.svg"], &ripple[..], &["+", "ripple"], &ripple[..]].concat();
    let expected = scratch.file("expected.svg");
    let mut own = Command::new(compiled_in());
    own.args(&chain).arg("-q").arg("-o").arg(&expected).current_dir(scratch.dir.path());
    assert!(own.status().unwrap().success());
    let program = program("pathwarp-ripple-program");
    let plugin = ["-q", "-o", "out.svg", "--plugin", program.to_str().unwrap(), "-j", "1"];
    scratch.expect(0, &[&chain[..], &plugin].concat());
    assert_same(&scratch.file("out.svg"), &expected, 4.0);
}

#[test]
fn a_crate_of_one_file_adds_its_deformation() {
    let dir = tempfile::tempdir().unwrap();
    let run = |args: &[&str]| Command::new(compiled_in()).args(args).current_dir(root()).output().unwrap();
    assert!(text(&run(&["list"]).stdout).contains("rings on water"));
    let out = dir.path().join("o.svg");
    let done = run(&["ripple", "samples/grid.svg", "-o", out.to_str().unwrap()]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert!(fs::read_to_string(out).unwrap().contains('C'), "straight lines have become curves");
    assert!(run(&["shaper", "samples/grid.svg", "--shaper", "samples/cages.svg#flag", "-o", "-"]).status.success());
}
