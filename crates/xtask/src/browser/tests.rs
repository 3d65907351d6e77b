//! Tests of the comparison, and of the drawings in `tests/browser`.

use super::measure::{Bend, Picture, ToPixels, compare};
use super::{Finding, Judge, MAX_OF_PAGE, WAYS};
use crate::chore::workspace;
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::Map as _;
use pathwarp::param::{Args, Frame};
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

const SIDE: usize = 400;
const SAMPLES: usize = 4;

/// A picture of a disc and a line about one pixel wide, antialiased by averaging samples.
fn painted(color: [u8; 3], bend: impl Fn(f64, f64) -> (f64, f64)) -> Picture {
    let covers = |x: f64, y: f64| (x - 150.0).hypot(y - 220.0) < 60.0 || (x + y / 3.0 - 300.0).abs() < 0.7;
    let mut data = Vec::new();
    for i in 0..SIDE * SIDE {
        let sample = |k: usize, c: usize| c as f64 + (k as f64 + 0.5) / SAMPLES as f64;
        let covered = (0..SAMPLES * SAMPLES)
            .filter(|k| {
                let (x, y) = bend(sample(k % SAMPLES, i % SIDE), sample(k / SAMPLES, i / SIDE));
                covers(x, y)
            })
            .count();
        let part = |c: u8| (f64::from(c) * covered as f64 / (SAMPLES * SAMPLES) as f64) as u8;
        data.extend([part(color[0]), part(color[1]), part(color[2]), part(255)]);
    }
    Picture { width: SIDE, height: SIDE, data }
}

fn differs(original: &Picture, found: &Picture, bend: Bend) -> bool {
    compare(original, found, bend, [SIDE, SIDE]).0.differs(MAX_OF_PAGE)
}

#[test]
fn right_results_pass_and_wrong_ones_do_not() {
    let curve = Bend::curve(SIDE, SIDE);
    let Bend::Curve { amplitude: a, wave: k } = curve else { panic!("a curve") };
    let inverse = |x: f64, y: f64| {
        let from_y = y - a * (k * x).sin();
        (x - a * (k * from_y).sin(), from_y)
    };
    let black = painted([0; 3], |x, y| (x, y));
    for color in [[0; 3], [255; 3], [120, 170, 90]] {
        let original = painted(color, |x, y| (x, y));
        for (bend, right) in [(Bend::Shift(16), painted(color, |x, y| (x - 16.0, y))), (curve, painted(color, inverse))]
        {
            assert!(!differs(&original, &right, bend), "{color:?} {bend:?}");
            assert!(differs(&original, &original, bend), "{color:?} {bend:?} left as it was");
            let nothing = Picture { data: vec![0; 4 * SIDE * SIDE], ..right };
            assert!(differs(&original, &nothing, bend), "{color:?} {bend:?} emptied");
            assert!(color == [0; 3] || differs(&black, &right, bend), "{color:?} {bend:?} in another colour");
        }
    }
}

/// A drawing that vanishes counts however small it is on its page: 20 of 160,000 pixels.
#[test]
fn small_things_count() {
    let mut original = Picture { width: SIDE, height: SIDE, data: vec![0; 4 * SIDE * SIDE] };
    let nothing = Picture { data: original.data.clone(), ..original };
    for i in 0..20 {
        let at = 4 * ((100 + i / 4) * SIDE + 100 + i % 4);
        original.data[at..at + 4].fill(255);
    }
    assert!(differs(&original, &nothing, Bend::Shift(16)) && differs(&original, &nothing, Bend::curve(SIDE, SIDE)));
}

/// The program's map has the inverse that is used for the pictures.
#[test]
fn formulas_are_the_map_of_the_pictures() {
    let to_pixels = ToPixels { scale: [2.5, 4.0], offset: [-30.0, 7.0] };
    let curve = Bend::curve(900, 700);
    let Bend::Curve { amplitude: a, wave: k } = curve else { panic!("a curve") };
    for bend in [Bend::Shift(48), curve] {
        let [x, y] = bend.formulas(to_pixels);
        let args = Args::from_pairs(&[("x", x.as_str()), ("y", y.as_str())]);
        let frame = Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0));
        let map = Registry::builtin().get("expr").unwrap().build_from(&args, &frame).unwrap().map;
        for i in 0..100 {
            let p = Point::new(f64::from(i % 10) * 31.0, f64::from(i / 10) * 17.0);
            let pixel = |p: Point| Point::new(2.5 * p.x - 30.0, 4.0 * p.y + 7.0);
            let (from, to) = (pixel(p), pixel(map.point(p)));
            let back = match bend {
                Bend::Shift(by) => Point::new(to.x - by as f64, to.y),
                Bend::Curve { .. } => {
                    let y = to.y - a * (k * to.x).sin();
                    Point::new(to.x - a * (k * y).sin(), y)
                }
            };
            assert!(from.distance(back) < 1e-6, "{bend:?}: {from:?} {back:?}");
        }
    }
}

/// Whether node, playwright and Chromium are installed. If not, says so directly on standard error, which tests do not capture, because the
/// gate lists such lines.
fn can_show() -> bool {
    let node = Command::new("node").arg("--version").output().is_ok_and(|o| o.status.success());
    let playwright = workspace().join("crates/pathwarp-editor/web/node_modules/playwright-core").is_dir();
    let browser = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"];
    let can = node && playwright && browser.iter().any(|b| Path::new("/usr/bin").join(b).exists());
    if !can {
        let why = b"skipped: drawings are not compared in Chromium without node, playwright-core and Chromium\n";
        let _ = std::io::stderr().write_all(why);
    }
    can
}

fn judged(program: PathBuf, folder: &Path) -> Vec<Finding> {
    Judge::new(program, WAYS.to_vec(), None).unwrap().all(&[folder.to_owned()]).unwrap()
}

/// Tries programs that empty a drawing, leave it as it is, or write no result.
#[cfg(unix)]
#[test]
fn emptied_and_unbent_results_differ_on_pages_of_every_size() {
    use std::os::unix::fs::PermissionsExt as _;
    if !can_show() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let art = dir.path().join("art");
    fs::create_dir(&art).unwrap();
    for side in [16, 24, 100, 640, 1200, 1700, 2000] {
        for (color, at) in [("black", 4), ("white", 2)] {
            let (from, part) = (side * at / 8, side / 8);
            let mark = format!("<path fill='{color}' d='M{from} {from}h{part}v{part}z'/>");
            let size = format!("viewBox='0 0 {side} {side}' width='{side}' height='{side}'");
            let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' {size}>{mark}</svg>");
            fs::write(art.join(format!("{color}-{side}.svg")), svg).unwrap();
        }
    }
    fs::write(art.join("broken.svg"), "<svg xmlns='http://www.w3.org/2000/svg'><g></svg>").unwrap();
    // The arguments are: expr FILE … -o RESULT --limit ….
    let loop_ = "in=$2; while [ \"$1\" != -o ]; do shift; done\n";
    for (name, body) in
        [("emptied", "sed 's/<path[^>]*>//' \"$in\" >\"$2\""), ("unbent", "cp \"$in\" \"$2\""), ("none", ":")]
    {
        let program = dir.path().join(name);
        fs::write(&program, format!("#!/bin/sh\n{loop_}{body}\n")).unwrap();
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
        for finding in judged(program, &art) {
            let counts = !finding.file.ends_with("broken.svg");
            assert_eq!(finding.differs(), counts, "{name}: {}", finding.line());
        }
    }
}

/// `tests/browser` holds a small drawing for each kind of thing that programs read in different ways. None may differ in any of the ways
/// tried, whatever fonts a machine has. To add a drawing, put it there.
#[test]
fn own_drawings_are_what_chromium_shows() {
    if !can_show() {
        return;
    }
    let profile = std::env::current_exe().unwrap().parent().unwrap().parent().unwrap().to_owned();
    let mut build = Command::new(env!("CARGO"));
    // Building with the features of the whole workspace reuses what is already built.
    build.args(["build", "--quiet", "--workspace", "--bin", "pathwarp", "--target-dir"]).arg(profile.parent().unwrap());
    if profile.ends_with("release") {
        build.arg("--release");
    }
    assert!(build.current_dir(workspace()).status().unwrap().success());
    let program = profile.join("pathwarp").with_extension(std::env::consts::EXE_EXTENSION);
    let found = judged(program, &workspace().join("tests/browser"));
    assert!(found.len() > 30 && found.iter().all(|f| f.gap.is_some()), "{}", super::report(&found));
    assert!(!found.iter().any(Finding::differs), "{}", super::report(&found));
}
