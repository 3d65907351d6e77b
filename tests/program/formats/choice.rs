//! The choice of a format: by extension, by `--format`, in batches and streams.

use crate::support::{expect_code, pathwarp_in, sample};
use serde_json::Value;
use std::fs;
use std::path::Path;

const SQUARE: &str =
    "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path id='s' d='M10,10H90V90H10Z'/></svg>";

/// The format of a file's content.
fn kind(bytes: &[u8]) -> &'static str {
    let begins = |magic: &[u8]| bytes.starts_with(magic);
    match () {
        () if begins(b"%PDF-") => "pdf",
        () if begins(b"  0\nSECTION") => "dxf",
        () if begins(b"\x1f\x8b") => "svgz",
        () if begins(b"\x89PNG") => "png",
        () if begins(b"<") => "svg",
        () => "other",
    }
}

#[test]
fn every_command_that_draws_writes_every_format() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    fs::write(folder.join("a.svg"), SQUARE).unwrap();
    let run = |args: &[&str]| {
        let out = pathwarp_in(folder, args, b"");
        assert_eq!(out.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
        out.stdout
    };
    run(&["affine", "a.svg", "--rotate", "9", "-o", "b.svg", "--write-recipe", "r.toml"]);
    let xcf = sample("paper.xcf").display().to_string();
    let commands: [&[&str]; 6] = [
        &["affine", "a.svg", "--rotate", "9"],
        &["affine", &xcf, "--rotate", "9"],
        &["affine", "a.svg", "--rotate", "9", "+", "wave", "--height", "5", "--length", "30"],
        &["run", "r.toml", "a.svg"],
        // A file for viewing has a margin by default, input for another command has none.
        &["text", "Word", "--margin", "0"],
        &["convert", "a.svg"],
    ];
    for command in commands {
        for format in ["svg", "svgz", "pdf", "dxf"] {
            let name = format!("out.{format}");
            run(&[command, &["-o", &name]].concat());
            let file = fs::read(folder.join(&name)).unwrap();
            assert_eq!(kind(&file), format, "{command:?}");
            // Standard output gets the same bytes.
            assert_eq!(run(&[command, &["--format", format]].concat()), file, "{command:?} {format}");
        }
    }
    run(&["gallery", "a.svg", "-o", "sheet.pdf"]);
    assert_eq!(kind(&fs::read(folder.join("sheet.pdf")).unwrap()), "pdf");
    // A single path can be exported, too.
    run(&["convert", &xcf, "--split", "-o", "paths.dxf"]);
    let split = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    assert!(split.filter(|n| n.starts_with("paths-") && n.ends_with(".dxf")).count() > 1);
}

#[test]
fn what_cannot_be_is_an_error_that_says_what_to_do() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    fs::write(folder.join("a.svg"), SQUARE).unwrap();
    let xcf = sample("paper.xcf").display().to_string();
    for (args, part) in [
        (&["affine", "a.svg", "-o", "o.eps"][..], "pdftops -eps"),
        (&["text", "a", "-o", "o.ai"], "write a .pdf"),
        (&["affine", "a.svg", "-o", "o.webp"], "`pathwarp render`"),
        (&["affine", "a.svg", "-o", "o.svg", "--format", "pdf"], "disagree"),
        (&["affine", "a.svg", "--format", "png"], "--format png: a drawing is written as SVG, PDF or DXF"),
        (&["affine", "a.svg", "-o", "o.pdf", "--embed-recipe"], "no place for the source"),
        (&["affine", "a.svg", "--in-place", "--format", "pdf"], "disagree"),
        (&["affine", &xcf, "-o", "o.png"], "GIMP paths are written as"),
        (&["render", "a.svg", "-o", "o.tiff"], "write a .png"),
        (&["render", "a.svg", "--format", "pdf"], "a picture is written as PNG, JPEG or WebP"),
    ] {
        let out = pathwarp_in(folder, args, b"");
        let said = String::from_utf8_lossy(&out.stderr);
        assert_eq!(out.status.code(), Some(2), "{args:?}: {said}");
        assert!(said.contains(part), "{args:?}: {said}");
    }
    assert_eq!(fs::read_dir(folder).unwrap().count(), 1, "nothing was written");
}

#[test]
fn batches_have_formats() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    fs::create_dir_all(folder.join("in/sub")).unwrap();
    for name in ["in/a.svg", "in/b.svgz", "in/sub/c.svg"] {
        fs::write(folder.join(name), SQUARE).unwrap();
    }
    fs::write(folder.join("in/bad.svg"), "<svg").unwrap();
    let run = |code, args: &[&str]| {
        let out = pathwarp_in(folder, args, b"");
        assert_eq!(out.status.code(), Some(code), "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
        String::from_utf8(out.stdout).unwrap()
    };
    let listed = run(0, &["affine", "-r", "in", "--out-dir", "out", "--format", "pdf", "--dry-run"]);
    assert!(listed.contains(&format!("-> {}", Path::new("out").join("sub").join("c.pdf").display())), "{listed}");
    assert!(!folder.join("out").exists());
    run(1, &["affine", "-r", "in", "--out-dir", "out", "--format", "pdf"]);
    run(1, &["affine", "-r", "in", "--out-dir", "cut/{stem}-cut.dxf"]);
    for (name, format) in [
        ("out/a.pdf", "pdf"),
        ("out/b.pdf", "pdf"),
        ("out/sub/c.pdf", "pdf"),
        ("cut/a-cut.dxf", "dxf"),
        ("cut/sub/c-cut.dxf", "dxf"),
    ] {
        assert_eq!(kind(&fs::read(folder.join(name)).unwrap()), format, "{name}");
    }
    assert!(!folder.join("out/bad.pdf").exists());
    // The results of a run are not its inputs; two inputs of one name would give one file.
    fs::write(folder.join("in/a.svgz"), SQUARE).unwrap();
    let out = pathwarp_in(folder, &["affine", "in/a.svg", "in/a.svgz", "--out-dir", "out", "--format", "pdf"], b"");
    assert_eq!(out.status.code(), Some(2));
}

/// `-` means standard output for every kind of output.
#[test]
fn a_dash_is_standard_output() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    fs::write(folder.join("a.svg"), SQUARE).unwrap();
    let run = |code, args: &[&str]| {
        let out = pathwarp_in(folder, args, b"");
        assert_eq!(out.status.code(), Some(code), "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
        (out.stdout, String::from_utf8(out.stderr).unwrap())
    };
    let warp = |more: &[&str]| run(0, &[&["affine", "a.svg", "-o", "o.pdf"], more].concat()).0;
    let report: Value = serde_json::from_slice(&warp(&["--report", "-"])).unwrap();
    assert_eq!(report["inputs"][0]["output"], "o.pdf");
    assert_eq!(kind(&warp(&["--preview", "-"])), "png");
    let recipe = String::from_utf8(warp(&["--write-recipe", "-"])).unwrap();
    assert!(recipe.contains("deformation = \"affine\""), "{recipe}");
    for command in [
        &["render", "a.svg", "-o", "-"][..],
        &["gallery", "a.svg", "-o", "-"],
        &["convert", "a.svg", "-o", "-"],
        &["text", "a", "-o", "-"],
    ] {
        assert!(!run(0, command).0.is_empty(), "{command:?}");
    }
    // One stream takes one output.
    for more in [&["--report", "-"][..], &["--preview", "-"], &["--write-recipe", "-"]] {
        let (out, said) = run(2, &[&["affine", "a.svg"], more].concat());
        assert!(out.is_empty() && said.contains("standard output"), "{more:?}: {said}");
    }
    assert!(!folder.join("-").exists());
    expect_code(0, &["list"]);
}
