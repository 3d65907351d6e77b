//! GIMP's files from outside: listed, converted, warped, written back; and asked of GIMP itself where it is installed.

mod support;

use pathwarp_gimp::{GimpPath, Stroke, new_xcf, read, to_json};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use support::{expect_code, pathwarp, pathwarp_in, root, sample};

fn stroke(closed: bool, points: &[[f64; 2]]) -> Stroke {
    Stroke { closed, points: points.iter().map(|p| p.map(|v| f64::from(v as f32))).collect() }
}

/// Curves and lines, open and closed, several strokes, odd names.
fn paths() -> Vec<GimpPath> {
    let line = |a: [f64; 2], b: [f64; 2]| stroke(false, &[a, a, a, b, b, b]);
    let leaf =
        stroke(true, &[[110.3, 90.7], [60.1, 120.9], [110.7, 160.2], [300.4, 170.6], [330.8, 120.5], [280.2, 60.3]]);
    let hill = stroke(
        false,
        &[
            [20., 350.],
            [20., 350.],
            [90.1, 200.4],
            [200.6, 210.2],
            [300.3, 330.9],
            [380., 400.7],
            [520.2, 180.5],
            [610.9, 333.3],
            [610.9, 333.3],
        ],
    );
    vec![
        GimpPath { name: "Base".into(), visible: true, strokes: vec![line([10.5, 390.25], [630.0, 390.25])] },
        GimpPath { name: "leaf & <hill>".into(), visible: true, strokes: vec![leaf, hill] },
        GimpPath { name: "路径 一".into(), visible: false, strokes: vec![line([5.1, 6.2], [400.9, 77.7])] },
    ]
}

fn listed(file: &Path) -> Value {
    let (text, _) = expect_code(0, &["paths", "--json", file.to_str().unwrap()]);
    serde_json::from_str(&text).unwrap()
}

/// A path's name and its strokes: closed, and control points.
type Named = (String, Vec<(bool, Vec<[f64; 2]>)>);

/// Strokes of every path of a list.
fn strokes(list: &Value) -> Vec<Named> {
    let stroke = |s: &Value| (s["closed"].as_bool().unwrap(), serde_json::from_value(s["points"].clone()).unwrap());
    let path = |p: &Value| {
        (p["name"].as_str().unwrap().to_owned(), p["strokes"].as_array().unwrap().iter().map(stroke).collect())
    };
    list["paths"].as_array().unwrap().iter().map(path).collect()
}

#[test]
fn an_xcf_is_listed_and_referred_to_by_name() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("art.xcf");
    fs::write(&file, new_xcf([640, 400], &paths())).unwrap();
    let (table, _) = expect_code(0, &["paths", file.to_str().unwrap()]);
    assert!(table.contains("leaf & <hill>") && table.contains("mixed") && table.contains("hidden"), "{table}");
    let list = listed(&file);
    assert_eq!(list["paths"][1]["strokes"][0]["anchors"], 2);
    assert_eq!(list["paths"][1]["strokes"][0]["points"][0][0].as_f64(), Some(f64::from(110.3f32)));
    let keys: Vec<&String> = list["paths"][0].as_object().unwrap().keys().collect();
    assert_eq!(keys, ["name", "strokes", "visible"]);
    // The sample is the drawing of the same name, its grid in one path.
    let drawing = listed_svg("paper-two-anchors.svg");
    let sample = strokes(&listed(&sample("paper.xcf")));
    for (name, strokes) in &sample {
        let wanted: Vec<_> = if name == "Grid" {
            drawing.iter().filter(|(n, _)| n.starts_with(['h', 'v'])).flat_map(|(_, s)| s.clone()).collect()
        } else {
            drawing.iter().find(|(n, _)| n == name).unwrap().1.clone()
        };
        assert_eq!(*strokes, wanted, "{name}");
    }
    assert_eq!(sample.len(), 4);
    let out = pathwarp_in(dir.path(), &["paths", "-"], &fs::read(&file).unwrap());
    assert_eq!(out.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&out.stderr).contains("name the file"));
    // Wherever a path is asked for.
    let along = format!("{}#Base", file.display());
    let (svg, _) = expect_code(0, &["bend", "samples/logo.svg", "--along", &along, "-q"]);
    assert!(svg.contains("<path"));
    let (_, e) = expect_code(3, &["bend", "samples/logo.svg", "--along", &format!("{}#Bsae", file.display())]);
    assert!(e.contains("the paths are Base, leaf & <hill>, 路径 一"), "{e}");
    let (_, e) = expect_code(3, &["bend", "samples/logo.svg", "--along", file.to_str().unwrap()]);
    assert!(e.contains("holds 3 paths"), "{e}");
}

fn listed_svg(name: &str) -> Vec<Named> {
    strokes(&listed(&sample(name)))
}

/// The paper's example gives the same curves from the XCF as from the drawing.
#[test]
fn the_papers_example_is_the_same_from_gimps_file() {
    let guides = ["--base", "#Base", "--target", "#Target", "--shaper", "#Shaper", "--tolerance", "0.001", "-q"];
    let dir = tempfile::tempdir().unwrap();
    let to = |name: &str| dir.path().join(name).display().to_string();
    let run = |input: &str, out: &str| {
        let words: Vec<&str> = ["shaper", input, "-o", out].into_iter().chain(guides).collect();
        expect_code(0, &words);
    };
    let (from_svg, from_xcf, list) = (to("a.svg"), to("b.svg"), to("c.json"));
    // Lines stay lines, as GIMP's paths are.
    let keep = ["shaper", "samples/paper-two-anchors.svg", "--strokes", "keep", "-o", &from_svg];
    expect_code(0, &keep.into_iter().chain(guides).collect::<Vec<_>>());
    run("samples/paper.xcf", &from_xcf);
    run("samples/paper.xcf#Grid", &list);
    let outline = |points: &[(bool, Vec<[f64; 2]>)]| {
        let strokes = points.iter().map(|(closed, p)| Stroke { closed: *closed, points: p.clone() }).collect();
        GimpPath { strokes, ..GimpPath::default() }.outline()
    };
    let grid = listed(Path::new(&from_xcf));
    let grid = strokes(&grid);
    assert_eq!(grid.len(), 1, "guides are not artwork");
    let drawing: Vec<_> = strokes(&listed(Path::new(&from_svg)))
        .into_iter()
        .filter(|(n, _)| n.starts_with(['h', 'v']) && n.len() < 4)
        .flat_map(|(_, s)| s)
        .collect();
    assert_eq!(drawing.len(), 22);
    let distance = pathwarp::distance::symmetric(&outline(&grid[0].1), &outline(&drawing)).unwrap();
    assert!(distance < 0.002, "{distance}");
    let points = read(&fs::read(list).unwrap()).unwrap();
    let distance = pathwarp::distance::symmetric(&points[0].outline(), &outline(&drawing)).unwrap();
    assert!(points.len() == 1 && distance < 0.002, "{distance}");
}

#[test]
fn paths_go_back_into_a_copy() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("art.xcf");
    let bytes = new_xcf([640, 400], &paths());
    fs::write(&file, &bytes).unwrap();
    let name = file.display().to_string();
    let copy = dir.path().join("copy.xcf").display().to_string();
    expect_code(0, &["affine", &name, "--into", &copy]);
    assert_eq!(fs::read(&copy).unwrap(), bytes, "the identity changes nothing");
    // One path is warped, the others stay; the list says the same, to single precision.
    let list = dir.path().join("list.json").display().to_string();
    expect_code(0, &["wave", &format!("{name}#leaf & <hill>"), "--into", &copy, "-q"]);
    expect_code(0, &["wave", &format!("{name}#leaf & <hill>"), "-o", &list, "-q"]);
    let (after, exact) = (read(&fs::read(&copy).unwrap()).unwrap(), read(&fs::read(&list).unwrap()).unwrap());
    assert_eq!((&after[0], &after[2]), (&paths()[0], &paths()[2]));
    let single = |s: &Stroke| stroke(s.closed, &s.points);
    assert_eq!(after[1].strokes, exact[0].strokes.iter().map(single).collect::<Vec<_>>());
    assert_ne!(after[1].strokes, paths()[1].strokes);
    // A recipe does it too.
    let recipe = dir.path().join("r.toml").display().to_string();
    let again = dir.path().join("again.xcf").display().to_string();
    expect_code(0, &["wave", &format!("{name}#leaf & <hill>"), "--into", &again, "-q", "--write-recipe", &recipe]);
    let by_recipe = dir.path().join("by-recipe.xcf").display().to_string();
    expect_code(0, &["run", &recipe, &format!("{name}#leaf & <hill>"), "--into", &by_recipe, "-q"]);
    assert_eq!(fs::read(again).unwrap(), fs::read(by_recipe).unwrap());
    // Never the input itself, nothing but an XCF, and nothing is left behind.
    let (_, e) = expect_code(2, &["wave", &name, "--into", &name]);
    assert!(e.contains("the input itself"), "{e}");
    let none = dir.path().join("none.xcf").display().to_string();
    expect_code(2, &["wave", &list, "--into", &none]);
    expect_code(2, &["wave", "samples/logo.svg", "--into", &none]);
    expect_code(2, &["wave", &name, "-o", &none]);
    expect_code(2, &["wave", "samples/logo.svg", "-o", &none]);
    assert!(!Path::new(&none).exists());
    // What it is goes by its name.
    let misnamed = dir.path().join("none.svg").display().to_string();
    let (_, e) = expect_code(2, &["wave", &name, "--into", &misnamed]);
    assert!(e.contains(".xcf") && !Path::new(&misnamed).exists(), "{e}");
    assert_eq!(fs::read(&file).unwrap(), bytes);
}

#[test]
fn damaged_files_say_where_and_can_be_salvaged() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("cut.xcf");
    let bytes = new_xcf([640, 400], &paths());
    fs::write(&file, &bytes[..bytes.len() - 60]).unwrap();
    let name = file.to_str().unwrap();
    let (_, e) = expect_code(3, &["paths", name]);
    assert!(e.contains("byte ") && e.contains("--salvage"), "{e}");
    let (out, e) = expect_code(1, &["paths", name, "--salvage"]);
    assert!(out.contains("leaf") && !out.contains("路径") && e.contains("damaged"), "{out} {e}");
    let (svg, _) = expect_code(1, &["wave", name, "--salvage", "-q"]);
    assert!(svg.contains("id=\"Base\""));
    let copy = dir.path().join("copy.xcf").display().to_string();
    expect_code(2, &["wave", name, "--salvage", "--into", &copy]);
    let (svg, _) = expect_code(1, &["convert", name, "--salvage"]);
    assert!(svg.contains("width=\"640px\" height=\"400px\"") && svg.contains("viewBox=\"0 0 640 400\""), "{svg}");
}

#[test]
fn conversion_keeps_names_and_numbers() {
    let dir = tempfile::tempdir().unwrap();
    let to = |name: &str| dir.path().join(name).display().to_string();
    let mut many = paths();
    many.push(GimpPath { name: "leaf ? <hill>".into(), ..many[1].clone() });
    fs::write(to("art.json"), to_json(Some([640.0, 400.0]), &many)).unwrap();
    expect_code(0, &["convert", &to("art.json"), "-o", &to("art.xcf")]);
    expect_code(0, &["convert", &to("art.xcf"), "-o", &to("art.svg")]);
    expect_code(0, &["convert", &to("art.xcf"), "-o", &to("back.json")]);
    assert_eq!(read(&fs::read(to("back.json")).unwrap()).unwrap(), many);
    let svg = read(&fs::read(to("art.svg")).unwrap()).unwrap();
    for (p, q) in many.iter().zip(&svg) {
        assert_eq!(p.name, q.name);
        for (s, t) in p.strokes.iter().zip(&q.strokes) {
            assert_eq!(stroke(s.closed, &s.points), stroke(t.closed, &t.points));
        }
    }
    // Every other reader of SVG finds the same names.
    let doc = pathwarp_svg::Document::read(&fs::read(to("art.svg")).unwrap(), "art.svg", &Default::default()).unwrap();
    assert_eq!(doc.path("leaf & <hill>").unwrap().outline.subpaths.len(), 2);
    expect_code(0, &["convert", &to("art.xcf"), "-o", &to("part.svg"), "--split"]);
    let mut names: Vec<String> =
        fs::read_dir(dir.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.retain(|n| n.starts_with("part"));
    names.sort();
    assert_eq!(names, ["part-Base.svg", "part-leaf----hill-2.svg", "part-leaf----hill.svg", "part-路径-一.svg"]);
}

#[test]
fn the_plug_in_is_put_in_place_and_taken_away() {
    let dir = tempfile::tempdir().unwrap();
    let plug_ins = dir.path().join("plug-ins");
    let d = plug_ins.to_str().unwrap();
    let (said, _) = expect_code(0, &["install", "gimp", "--dir", d, "--dry-run"]);
    assert!(said.contains("would write") && !plug_ins.exists());
    expect_code(0, &["install", "gimp", "--dir", d]);
    let home = plug_ins.join("pathwarp-gimp");
    let script = fs::read(home.join("pathwarp-gimp.py")).unwrap();
    assert_eq!(script, fs::read(root().join("integrations/gimp/pathwarp-gimp.py")).unwrap());
    let own = home.join("bin").join("pathwarp").with_extension(std::env::consts::EXE_EXTENSION);
    assert!(Command::new(own).arg("list").stdout(Stdio::null()).status().unwrap().success());
    fs::write(home.join("notes.txt"), "mine").unwrap();
    expect_code(0, &["install", "gimp", "--dir", d, "--uninstall"]);
    assert_eq!(fs::read_dir(&home).unwrap().count(), 1, "what others put there stays");
    fs::remove_file(home.join("notes.txt")).unwrap();
    expect_code(0, &["install", "gimp", "--dir", d]);
    expect_code(0, &["install", "gimp", "--dir", d, "--uninstall"]);
    assert!(!home.exists());
}

/// Runs a GIMP without a screen: the program that the environment's `variable` names, or the one of the usual name; `None` if
/// there is none.
fn gimp(variable: &str, usual: &str, folder: &Path, args: &[&str]) -> Option<String> {
    let named = std::env::var_os(variable);
    let mut c = Command::new(named.as_deref().unwrap_or(usual.as_ref()));
    c.args(["--no-interface", "--no-data", "--no-fonts"]).args(args).stdin(Stdio::null());
    // A profile of its own: nothing of the user's is read or changed.
    c.env("GIMP2_DIRECTORY", folder.join("gimp2")).env("GIMP3_DIRECTORY", folder.join("gimp3"));
    match c.output() {
        Ok(out) => Some(String::from_utf8_lossy(&[out.stdout, out.stderr].concat()).into_owned()),
        Err(e) if named.is_some() => panic!("{variable} names no program that runs: {e}"),
        Err(_) => {
            eprintln!("skipped: there is no program `{usual}` here, and {variable} names none");
            None
        }
    }
}

fn gimp_2(folder: &Path, script: &str) -> Option<String> {
    gimp("PATHWARP_GIMP2", "gimp-console-2.10", folder, &["-b", script, "-b", "(gimp-quit 0)"])
}

/// Runs a Python script in GIMP 3.
fn gimp_3(folder: &Path, script: &str) -> Option<String> {
    let file = folder.join("run.py");
    fs::write(&file, script).unwrap();
    let run = format!("exec(open({:?}).read())", file.display().to_string());
    gimp("PATHWARP_GIMP3", "gimp-console-3.0", folder, &["--quit", "--batch-interpreter", "python-fu-eval", "-b", &run])
}

/// Script-Fu that writes an image's paths as lines: `P name`, `S closed`, and a number to a line.
const DUMP: &str = r#"
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

fn dumped(file: &Path) -> Vec<GimpPath> {
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
                out.last_mut().unwrap().strokes.push(Stroke { closed: closed == "1", points: Vec::new() })
            }
            _ => numbers.push(line.parse().unwrap()),
        }
    }
    out.pop();
    out
}

#[track_caller]
fn agree(found: &[GimpPath], wanted: &[GimpPath], tolerance: f64, ends: bool) {
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

#[test]
fn gimp_2_agrees_on_what_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let d = dir.path();
    let at = |name: &str| d.join(name).display().to_string();
    fs::write(at("new.xcf"), new_xcf([640, 400], &paths())).unwrap();
    // GIMP saves it with a layer, so that there are tiles behind the paths: with pointers of 32 bits, and of 64, and with a
    // floating selection, which points to its layer.
    let make = format!(
        r#"(let* ((i (car (gimp-file-load 1 "{0}" "{0}"))) (l (car (gimp-layer-new i 640 400 0 "Layer" 100 0))))
            (gimp-image-insert-layer i l 0 0) (gimp-drawable-fill l 2) (gimp-image-set-resolution i 300 200)
            (gimp-xcf-save 0 i l "{1}" "{1}") (gimp-image-convert-precision i 250) (gimp-xcf-save 0 i l "{2}" "{2}")
            (gimp-image-select-rectangle i 2 10 10 100 80) (gimp-edit-copy l) (gimp-edit-paste l 0)
            (gimp-xcf-save 0 i l "{3}" "{3}"))"#,
        at("new.xcf"),
        at("real.xcf"),
        at("deep.xcf"),
        at("floating.xcf")
    );
    let Some(said) = gimp_2(d, &make) else { return };
    assert!(d.join("floating.xcf").exists(), "{said}");
    let of = |name: &str| read(&fs::read(at(name)).unwrap()).unwrap();
    let version = |name: &str| fs::read(at(name)).unwrap()[9..13].to_vec();
    assert_eq!((version("real.xcf"), version("deep.xcf")), (b"file".to_vec(), b"v012".to_vec()));

    let mut script = String::from(DUMP);
    for file in ["real", "deep", "floating"] {
        let source = at(&format!("{file}.xcf"));
        assert_eq!(of(&format!("{file}.xcf")), paths());
        let into = |name: &str| at(&format!("{file}-{name}.xcf"));
        expect_code(0, &["affine", &source, "--into", &into("same")]);
        assert_eq!(fs::read(into("same")).unwrap(), fs::read(&source).unwrap());
        expect_code(0, &["wave", &source, "--merge", "off", "--tolerance", "1e-4", "--into", &into("waved"), "-q"]);
        assert_ne!(fs::metadata(into("waved")).unwrap().len(), fs::metadata(&source).unwrap().len());
        for name in ["same", "waved"] {
            script += &format!(
                "(let* ((i (car (gimp-file-load 1 \"{0}\" \"{0}\"))) (l (car (gimp-image-get-active-layer i))))
                   (dump i \"{1}.txt\") (file-png-save-defaults 1 i l \"{1}.png\" \"{1}.png\")
                   (if (> (car (gimp-image-get-floating-sel i)) 0) (call-with-output-file \"{1}.on\" (lambda (port)
                     (display (car (gimp-item-get-name (car (gimp-image-floating-sel-attached-to i)))) port)))))\n",
                into(name),
                at(&format!("{file}-{name}"))
            );
        }
    }
    expect_code(0, &["wave", &at("real.xcf"), "-o", &at("waved.svg"), "-q"]);
    expect_code(0, &["convert", &at("real.xcf"), "-o", &at("plain.svg")]);
    for (name, dpi) in [("plain", 72), ("plain", 300), ("waved", 72), ("waved", 300)] {
        script += &format!(
            "(let ((i (car (gimp-image-new 640 400 0)))) (gimp-image-set-resolution i {dpi} {dpi})
               (gimp-vectors-import-from-file i \"{}\" 0 0) (dump i \"{}\"))\n",
            at(&format!("{name}.svg")),
            at(&format!("{name}-{dpi}.txt"))
        );
    }
    fs::write(at("dump.scm"), script).unwrap();
    let said = gimp_2(d, &format!("(load \"{}\")", at("dump.scm"))).unwrap();
    assert!(d.join("waved-300.txt").exists(), "{said}");
    assert!(!said.to_lowercase().contains("corrupt"), "{said}");
    let pixels =
        |name: &str| pathwarp_raster::Picture::read(&fs::read(at(name)).unwrap()).unwrap().pixmap.data().to_vec();
    for file in ["real", "deep", "floating"] {
        // Ten digits of what the files hold.
        agree(&dumped(&d.join(format!("{file}-same.txt"))), &paths(), 1e-6, true);
        agree(&dumped(&d.join(format!("{file}-waved.txt"))), &of(&format!("{file}-waved.xcf")), 1e-6, true);
        // The picture is what it was.
        assert!(pixels(&format!("{file}-same.png")) == pixels(&format!("{file}-waved.png")));
    }
    for name in ["same", "waved"] {
        assert_eq!(fs::read_to_string(at(&format!("floating-{name}.on"))).unwrap_or_default(), "Layer", "{said}");
    }
    for dpi in [72, 300] {
        agree(&dumped(&d.join(format!("plain-{dpi}.txt"))), &paths(), 0.01, false);
        agree(&dumped(&d.join(format!("waved-{dpi}.txt"))), &of("waved.svg"), 0.01, false);
    }
}

/// What scripts for GIMP 3 begin with.
const IN_GIMP_3: &str = r#"
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

/// Paths as items, which GIMP writes when several are selected.
#[test]
fn gimp_3_agrees_on_what_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let d = dir.path();
    let at = |name: &str| d.join(name).display().to_string();
    fs::write(at("in.json"), to_json(Some([640.0, 400.0]), &paths())).unwrap();
    let make = format!(
        r#"{IN_GIMP_3}
image = Gimp.Image.new(640, 400, Gimp.ImageBaseType.RGB)
layer = Gimp.Layer.new(image, "Layer", 640, 400, Gimp.ImageType.RGB_IMAGE, 100, Gimp.LayerMode.NORMAL)
image.insert_layer(layer, None, 0)
build(image, "{0}")
for chosen, file in [(image.get_paths(), "{1}"), (image.get_paths()[:1], "{2}")]:
    image.set_selected_paths(chosen)
    Gimp.file_save(Gimp.RunMode.NONINTERACTIVE, image, Gio.File.new_for_path(file), None)
"#,
        at("in.json"),
        at("items.xcf"),
        at("block.xcf")
    );
    let Some(said) = gimp_3(d, &make) else { return };
    assert!(d.join("block.xcf").exists(), "{said}");
    let of = |name: &str| read(&fs::read(at(name)).unwrap()).unwrap();
    let mut dumps = String::new();
    for file in ["items", "block"] {
        let source = at(&format!("{file}.xcf"));
        let items = fs::read(&source).unwrap()[9..13] >= b"v018"[..];
        assert_eq!(items, file == "items");
        assert_eq!(of(&format!("{file}.xcf")), paths());
        let waved = at(&format!("{file}-waved.xcf"));
        expect_code(0, &["wave", &source, "--merge", "off", "--tolerance", "1e-4", "--into", &waved, "-q"]);
        assert!(fs::metadata(&waved).unwrap().len() > fs::metadata(&source).unwrap().len());
        let json = at(&format!("{file}-waved.json"));
        dumps +=
            &format!("dump(Gimp.file_load(Gimp.RunMode.NONINTERACTIVE, Gio.File.new_for_path({waved:?})), {json:?})\n");
    }
    expect_code(0, &["convert", &at("items.xcf"), "-o", &at("plain.svg")]);
    let script = format!(
        r#"{IN_GIMP_3}
{dumps}
for dpi in (72, 300):
    image = Gimp.Image.new(640, 400, Gimp.ImageBaseType.RGB)
    image.set_resolution(dpi, dpi)
    image.import_paths_from_file(Gio.File.new_for_path("{0}"), False, False)
    dump(image, "{1}/plain-%d.json" % dpi)
"#,
        at("plain.svg"),
        d.display()
    );
    let said = gimp_3(d, &script).unwrap();
    assert!(d.join("plain-300.json").exists(), "{said}");
    for file in ["items", "block"] {
        assert_eq!(of(&format!("{file}-waved.json")), of(&format!("{file}-waved.xcf")), "{said}");
        assert_ne!(of(&format!("{file}-waved.json")), paths());
    }
    for dpi in [72, 300] {
        agree(&of(&format!("plain-{dpi}.json")), &paths(), 0.01, false);
    }
}

#[test]
fn the_plug_in_works_in_gimp_3() {
    let dir = tempfile::tempdir().unwrap();
    let d = dir.path();
    let at = |name: &str| d.join(name).display().to_string();
    expect_code(0, &["install", "gimp", "--dir", &at("gimp3/plug-ins")]);
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
    let all = [path("Art", &art), path("Cage", &cage), path("Line", &line), path("Foot", &foot), path("Place", &place)];
    fs::write(at("in.json"), to_json(Some([640.0, 400.0]), &all)).unwrap();
    let script = format!(
        r#"{IN_GIMP_3}
image = Gimp.Image.new(640, 400, Gimp.ImageBaseType.RGB)
build(image, "{0}")
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
json.dump({{"paths": found, "said": said, "all": [p.get_name() for p in image.get_paths()]}}, open("{1}", "w"))
"#,
        at("in.json"),
        at("out.json")
    );
    let Some(said) = gimp_3(d, &script) else { return };
    assert!(d.join("out.json").exists(), "{said}");
    let text = fs::read_to_string(at("out.json")).unwrap();
    let answer: Value = serde_json::from_str(&text).unwrap();
    let new = ["Art wordart", "Art warp", "Art bend", "Art shaper #1", "Art shaper"];
    let names: Vec<&str> = new.into_iter().chain(all.iter().map(|p| p.name.as_str())).collect();
    assert_eq!(answer["all"], serde_json::json!(names), "{said}");
    assert!(answer["said"][0].as_str().unwrap().contains("Nobody"), "{answer}");
    // Messages name paths, and no file that is gone.
    let why = answer["said"][1].as_str().unwrap();
    assert!(why.contains("Line") && !why.contains("paths.json"), "{why}");
    let found = read(text.as_bytes()).unwrap();
    // The command line gives the very same points.
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

#[test]
fn hostile_files_cost_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("huge.xcf");
    // A count of 2^28 paths in a small file.
    let mut bytes = new_xcf([64, 64], &paths());
    let at = bytes.windows(5).position(|w| w == b"Base\0").unwrap();
    bytes[at - 8..at - 4].copy_from_slice(&(1u32 << 28).to_be_bytes());
    fs::write(&file, bytes).unwrap();
    let out = pathwarp(&["paths", file.to_str().unwrap()]);
    let e = String::from_utf8_lossy(&out.stderr).into_owned();
    assert!(out.status.code() == Some(3) && e.contains("268435456 paths"), "{e}");
}
