//! Runs an installed GIMP without a screen, and reads its output about paths.

use pathwarp_gimp::{GimpPath, Stroke};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// Runs GIMP without a screen: the program that the environment variable `variable` names, or the one with the usual name. Returns
/// `None` if there is no such program.
fn gimp(variable: &str, usual: &str, folder: &Path, args: &[&str]) -> Option<String> {
    let named = std::env::var_os(variable);
    let mut c = Command::new(named.as_deref().unwrap_or(usual.as_ref()));
    c.args(["--no-interface", "--no-data", "--no-fonts"]).args(args).stdin(Stdio::null());
    // Use a separate profile, so that the user's is neither read nor changed.
    c.env("GIMP2_DIRECTORY", folder.join("gimp2")).env("GIMP3_DIRECTORY", folder.join("gimp3"));
    match c.output() {
        Ok(out) => Some(String::from_utf8_lossy(&[out.stdout, out.stderr].concat()).into_owned()),
        Err(e) if named.is_some() => panic!("{variable} names no program that runs: {e}"),
        Err(_) => {
            crate::support::skipped(format_args!("there is no program `{usual}`, and {variable} names none"));
            None
        }
    }
}

pub fn gimp_2(folder: &Path, script: &str) -> Option<String> {
    gimp("PATHWARP_GIMP2", "gimp-console-2.10", folder, &["-b", script, "-b", "(gimp-quit 0)"])
}

/// Runs a Python script in GIMP 3.
pub fn gimp_3(folder: &Path, script: &str) -> Option<String> {
    let file = folder.join("run.py");
    fs::write(&file, script).unwrap();
    let run = format!("exec(open({:?}).read())", file.display().to_string());
    gimp("PATHWARP_GIMP3", "gimp-console-3.0", folder, &["--quit", "--batch-interpreter", "python-fu-eval", "-b", &run])
}

/// Script-Fu that writes an image's paths as lines: `P name`, `S closed`, and a number to a line.
pub const DUMP: &str = r#"
(define (dump image file)
  (let ((port (open-output-file file)))
    (for-each (lambda (v)
        (display "P " port) (display (car (gimp-item-get-name v)) port) (newline port)
        (let ((strokes (gimp-vectors-get-strokes v)))
          (if (> (car strokes) 0)
            (for-each (lambda (s)
                (let ((all (gimp-vectors-stroke-get-points v s)))
                  (display "S " port) (display (cadddr all) port) (newline port)
                  (for-each (lambda (n) (write n port) (newline port)) (vector->list (caddr all)))))
              (vector->list (cadr strokes))))))
      (vector->list (cadr (gimp-image-get-vectors image))))
    (close-output-port port)))
"#;

pub fn dumped(file: &Path) -> Vec<GimpPath> {
    let mut out: Vec<GimpPath> = Vec::new();
    let mut numbers: Vec<f64> = Vec::new();
    for line in fs::read_to_string(file).unwrap().lines().chain(["P "]) {
        if line.starts_with(['P', 'S']) {
            if let Some(s) = out.last_mut().and_then(|p| p.strokes.last_mut()) {
                s.points.extend(numbers.chunks_exact(2).map(|c| [c[0], c[1]]));
            }
            numbers.clear();
        }
        match line.split_at(2) {
            ("P ", name) => out.push(GimpPath { name: name.to_owned(), ..GimpPath::default() }),
            ("S ", closed) => {
                out.last_mut().unwrap().strokes.push(Stroke { closed: closed == "1", points: Vec::new() });
            }
            _ => numbers.push(line.parse().unwrap()),
        }
    }
    out.pop();
    out
}

#[track_caller]
pub fn agree(found: &[GimpPath], wanted: &[GimpPath], tolerance: f64, ends: bool) {
    let names = |all: &[GimpPath]| all.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(found), names(wanted));
    for (f, w) in found.iter().zip(wanted) {
        assert_eq!(f.strokes.len(), w.strokes.len(), "{}", f.name);
        for (f, w) in f.strokes.iter().zip(&w.strokes) {
            assert_eq!((f.closed, f.anchors()), (w.closed, w.anchors()));
            let skip = usize::from(!f.closed && !ends);
            let n = f.points.len();
            for (a, b) in f.points[skip..n - skip].iter().zip(&w.points[skip..n - skip]) {
                assert!((a[0] - b[0]).hypot(a[1] - b[1]) <= tolerance, "{a:?} {b:?}");
            }
        }
    }
}

/// The beginning of every script for GIMP 3.
pub const IN_GIMP_3: &str = r#"
import json
from gi.repository import Gio
def strokes(path):
    all = [path.stroke_get_points(s) for s in path.get_strokes()]
    return [{"closed": bool(closed), "controlpoints": list(points)} for _kind, points, closed in all]
def dump(image, file):
    found = [{"name": p.get_name(), "visible": bool(p.get_visible()), "strokes": strokes(p)} for p in image.get_paths()]
    json.dump({"paths": found}, open(file, "w"))
def build(image, file):
    for p in reversed(json.load(open(file))["paths"]):
        path = Gimp.Path.new(image, p["name"])
        for s in p["strokes"]:
            path.stroke_new_from_points(Gimp.PathStrokeType.BEZIER, s["controlpoints"], s["closed"])
        image.insert_path(path, None, 0)
        path.set_visible(p["visible"])
"#;
