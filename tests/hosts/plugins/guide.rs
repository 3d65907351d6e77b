//! `docs/writing-deformations.md`, followed word for word: its commands are run, and its changes and files made, in an empty folder.

use crate::support::plugins::{Scratch, python, text};
use crate::support::{pathwarp_program, root, sample};
use pathwarp::kurbo::Point;
use std::f64::consts::PI;
use std::fs;
use std::process::Command;

/// The guide's crate, as a module whose test runs with the tests here.
#[path = "swell.rs"]
#[allow(dead_code, reason = "nobody calls its `main` here")]
mod swell;

/// Returns the formula of all of the guide's ways, in the box 0,0,80,40 and with an amount of 80 %.
fn swollen(p: Point) -> Point {
    Point::new(p.x, 20.0 + (p.y - 20.0) * (1.0 + 0.8 * (PI * p.x / 80.0).sin().powi(2)))
}

/// A code block: its language, the paragraph before it, and its text.
struct Block {
    language: String,
    before: String,
    text: String,
}

/// The code blocks of the section `heading`.
fn blocks(heading: &str) -> Vec<Block> {
    let page = fs::read_to_string(root().join("docs/writing-deformations.md")).unwrap();
    let (_, section) = page.split_once(&format!("\n## {heading}\n")).unwrap();
    // Headings in code blocks are comments of shells.
    let section = section.split("\n## ").next().unwrap();
    let (mut out, mut before) = (Vec::new(), String::new());
    for (i, part) in section.split("```").enumerate() {
        if i % 2 == 0 {
            before = part.trim().to_owned();
        } else {
            let (language, text) = part.split_once('\n').unwrap();
            out.push(Block { language: language.to_owned(), before: before.clone(), text: text.to_owned() });
        }
    }
    out
}

/// Follows a section in `scratch`.
fn follow(scratch: &Scratch, heading: &str) {
    for block in blocks(heading) {
        match block.language.as_str() {
            "diff" => change(scratch, &block.text),
            "sh" => match block.before.rsplit_once("Save this as `") {
                Some((_, rest)) => fs::write(scratch.file(rest.split('`').next().unwrap()), &block.text).unwrap(),
                None => shell(scratch, &block.text),
            },
            other => panic!("{heading} has a block in `{other}`"),
        }
    }
}

/// Runs commands in a shell that finds the program.
fn shell(scratch: &Scratch, commands: &str) {
    let folder = pathwarp_program().parent().unwrap().display();
    let mut shell = Command::new("sh");
    shell.arg("-ec").arg(format!("PATH={folder}:$PATH\n{commands}")).current_dir(scratch.dir.path());
    for (name, value) in scratch.command(&[]).get_envs() {
        shell.env(name, value.unwrap());
    }
    // Cargo finds its settings in the home folder.
    shell.env("HOME", std::env::var_os("HOME").unwrap_or_default()).env_remove("CARGO_TARGET_DIR");
    let out = shell.env("PATHWARP_PLUGIN_SECONDS", "60").output().unwrap();
    assert!(out.status.success(), "{commands}\n{}\n{}", text(&out.stdout), text(&out.stderr));
}

/// Makes a change: lines that begin with a space or a minus become those that begin with a space or a plus.
fn change(scratch: &Scratch, diff: &str) {
    let (head, body) = diff.split_once('\n').unwrap();
    let file = scratch.file(head.strip_prefix("--- ").unwrap());
    let lines = |marks: [char; 2]| -> String {
        let kept = body.lines().filter(|l| l.starts_with(marks) || l.is_empty());
        kept.map(|l| format!("{}\n", l.get(1..).unwrap_or_default())).collect()
    };
    let (old, new) = (lines([' ', '-']), lines([' ', '+']));
    let source = fs::read_to_string(&file).unwrap();
    assert_eq!(source.matches(&old).count(), 1, "{} does not have once:\n{old}", file.display());
    fs::write(&file, source.replace(&old, &new)).unwrap();
}

fn with_logo() -> Scratch {
    let scratch = Scratch::new();
    fs::copy(sample("logo.svg"), scratch.file("logo.svg")).unwrap();
    scratch
}

/// Asserts that the plug-in of a file maps points by the formula.
fn assert_swells(scratch: &Scratch, name: &str, file: &str) {
    let points: Vec<Point> = (0..40).map(|i| Point::new(2.0 * f64::from(i), 35.0 - f64::from(i))).collect();
    let list: String = points.iter().map(|p| format!("{} {}\n", p.x, p.y)).collect();
    fs::write(scratch.file("points.txt"), list).unwrap();
    let args = ["map", name, "--amount", "80%", "--frame", "0,0,80,40", "--points", "points.txt", "--plugin", file];
    let (mapped, _) = scratch.expect(0, &args);
    assert_eq!(mapped.lines().count(), points.len());
    for (p, line) in points.iter().zip(mapped.lines()) {
        let (x, y) = line.split_once(' ').unwrap();
        let q = Point::new(x.parse().unwrap(), y.parse().unwrap());
        assert!(q.distance(swollen(*p)) < 1e-11, "{name}: {p} to {q}");
    }
}

#[test]
fn the_road_in_python() {
    if !python() {
        return;
    }
    let scratch = with_logo();
    follow(&scratch, "A program in Python");
    assert_swells(&scratch, "swell", "./pathwarp-swell.py");
    let [waist, again] = ["waist.svg", "waist-again.svg"].map(|f| fs::read(scratch.file(f)).unwrap());
    assert_eq!(waist, again);
    assert!(scratch.file("waves.svg").exists() && scratch.file("swollen.svg").exists());
}

#[test]
fn the_road_in_rust() {
    let scratch = with_logo();
    follow(&scratch, "A program in Rust");
    let file = "pathwarp-swell-fast/target/release/pathwarp-swell-fast";
    assert_swells(&scratch, "swell-fast", file);
    assert!(scratch.file("swollen-fast.svg").exists());
    // The check finds a wrong derivative.
    let source = scratch.file("pathwarp-swell-fast/src/main.rs");
    let wrong =
        fs::read_to_string(&source).unwrap().replace("(y - self.middle) * slope, 0.0, growth]", "0.0, 0.0, growth]");
    fs::write(&source, wrong).unwrap();
    shell(&scratch, "cargo build -q --release --manifest-path pathwarp-swell-fast/Cargo.toml");
    let (report, _) = scratch.expect(1, &["check", file]);
    assert!(report.contains("FAIL  values") && report.contains("differences give"), "{report}");
}

#[test]
fn the_road_in_shell() {
    let scratch = with_logo();
    follow(&scratch, "A program in shell");
    assert_swells(&scratch, "swell-sh", "./pathwarp-swell-sh.sh");
}

/// The guide's way by a crate has the module above as its program, which is compiled and tested here. Its other commands are commands of
/// the workspace, whose tests run them.
#[test]
fn the_road_by_a_crate() {
    let blocks = blocks("A crate");
    assert_eq!(blocks.iter().find(|b| b.language == "rust").unwrap().text, include_str!("swell.rs"));
    let own = &blocks.iter().find(|b| b.language == "toml").unwrap().text;
    for path in own.split("path = \"../pathwarp/").skip(1) {
        assert!(root().join(path.split('"').next().unwrap()).join("Cargo.toml").exists(), "{path}");
    }
    let commands = &blocks.iter().find(|b| b.language.is_empty()).unwrap().text;
    let manifest = fs::read_to_string(root().join("examples/plugin-crate/Cargo.toml")).unwrap();
    assert!(commands.contains("-p pathwarp-ripple") && manifest.contains("name = \"pathwarp-ripple\""));
}

/// `new-plugin` overwrites no file, and refuses names that no deformation can have.
#[test]
fn new_plug_ins_replace_nothing() {
    let scratch = Scratch::new();
    scratch.expect(0, &["new-plugin", "python", "swell"]);
    fs::write(scratch.file("pathwarp-swell.py"), "mine").unwrap();
    let (_, stderr) = scratch.expect(5, &["new-plugin", "python", "swell"]);
    assert!(stderr.contains("exists already"), "{stderr}");
    assert_eq!(fs::read_to_string(scratch.file("pathwarp-swell.py")).unwrap(), "mine");
    for name in ["Swell", "../swell", "a b", "", "-x"] {
        scratch.expect(2, &["new-plugin", "rust", name]);
    }
    for name in ["shaper", "list", "help"] {
        let (_, stderr) = scratch.expect(2, &["new-plugin", "python", name]);
        assert!(stderr.contains("is a command already"), "{stderr}");
    }
    scratch.expect(2, &["new-plugin", "cobol", "swell"]);
}
