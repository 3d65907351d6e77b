//! GIMP files listed, referred to, warped, written back and converted; damaged and hostile ones.

use crate::support::gimp::{Named, listed, paths, stroke, strokes};
use crate::support::{expect_code, pathwarp, pathwarp_in, sample};
use pathwarp_gimp::{GimpPath, Stroke, new_xcf, read, to_json};
use std::fs;
use std::path::Path;

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
    // The sample holds the drawing of the same name, with the grid as one path.
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
    // A reference works for every option that takes a path.
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

/// The example of the paper gives equal curves from the XCF and from the drawing.
#[test]
fn the_example_of_the_paper_is_the_same_from_an_xcf() {
    let guides = ["--base", "#Base", "--target", "#Target", "--shaper", "#Shaper", "--tolerance", "0.001", "-q"];
    let dir = tempfile::tempdir().unwrap();
    let to = |name: &str| dir.path().join(name).display().to_string();
    let run = |input: &str, out: &str| {
        let words: Vec<&str> = ["shaper", input, "-o", out].into_iter().chain(guides).collect();
        expect_code(0, &words);
    };
    let (from_svg, from_xcf, list) = (to("a.svg"), to("b.svg"), to("c.json"));
    // Keep strokes as lines, since GIMP's paths are lines.
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
    // One path is warped, the others stay; the point list agrees to single precision.
    let list = dir.path().join("list.json").display().to_string();
    expect_code(0, &["wave", &format!("{name}#leaf & <hill>"), "--into", &copy, "-q"]);
    expect_code(0, &["wave", &format!("{name}#leaf & <hill>"), "-o", &list, "-q"]);
    let (after, exact) = (read(&fs::read(&copy).unwrap()).unwrap(), read(&fs::read(&list).unwrap()).unwrap());
    assert_eq!((&after[0], &after[2]), (&paths()[0], &paths()[2]));
    let single = |s: &Stroke| stroke(s.closed, &s.points);
    assert_eq!(after[1].strokes, exact[0].strokes.iter().map(single).collect::<Vec<_>>());
    assert_ne!(after[1].strokes, paths()[1].strokes);
    // A recipe gives the same result.
    let recipe = dir.path().join("r.toml").display().to_string();
    let again = dir.path().join("again.xcf").display().to_string();
    expect_code(0, &["wave", &format!("{name}#leaf & <hill>"), "--into", &again, "-q", "--write-recipe", &recipe]);
    let by_recipe = dir.path().join("by-recipe.xcf").display().to_string();
    expect_code(0, &["run", &recipe, &format!("{name}#leaf & <hill>"), "--into", &by_recipe, "-q"]);
    assert_eq!(fs::read(again).unwrap(), fs::read(by_recipe).unwrap());
    // The input itself and files other than an XCF are refused, and no file is left behind.
    let (_, e) = expect_code(2, &["wave", &name, "--into", &name]);
    assert!(e.contains("would be overwritten"), "{e}");
    let none = dir.path().join("none.xcf").display().to_string();
    expect_code(2, &["wave", &list, "--into", &none]);
    expect_code(2, &["wave", "samples/logo.svg", "--into", &none]);
    expect_code(2, &["wave", &name, "-o", &none]);
    expect_code(2, &["wave", "samples/logo.svg", "-o", &none]);
    assert!(!Path::new(&none).exists());
    // The extension must be that of an XCF.
    let misnamed = dir.path().join("none.svg").display().to_string();
    let (_, e) = expect_code(2, &["wave", &name, "--into", &misnamed]);
    assert!(e.contains(".xcf") && !Path::new(&misnamed).exists(), "{e}");
    assert_eq!(fs::read(&file).unwrap(), bytes);
}

/// Paths are edited before they are bent, like drawings: one command gives the result of two.
#[test]
fn paths_are_edited_before_bending() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name).display().to_string();
    fs::write(at("in.xcf"), new_xcf([640, 400], &paths())).unwrap();
    let file = format!("{}#leaf & <hill>", at("in.xcf"));
    let bend = ["wave", "--tolerance", "0.01", "--frame", "0,0,640,400", "-q"];
    expect_code(0, &[&bend[..], &[&file, "--outset", "3", "-o", &at("one.json")]].concat());
    expect_code(0, &["offset", &file, "--by", "3", "--tolerance", "0.01", "-o", &at("grown.json")]);
    expect_code(0, &[&bend[..], &[&at("grown.json"), "-o", &at("two.json")]].concat());
    let outline = |name: &str| read(&fs::read(at(name)).unwrap()).unwrap()[0].outline();
    let distance = |a: &str, b: &str| pathwarp::distance::symmetric(&outline(a), &outline(b)).unwrap();
    assert!(distance("one.json", "two.json") < 0.02 && distance("one.json", "grown.json") > 1.0);
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
    // Any reader of SVG finds these names.
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

/// Paths keep GIMP's visibility switch in SVG, warped or not. GIMP's exports do not contain it, so their paths are visible.
#[test]
fn visibility_survives_svg() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name).display().to_string();
    fs::write(at("in.xcf"), new_xcf([640, 400], &paths())).unwrap();
    let switches =
        |file: &str| -> Vec<bool> { read(&fs::read(file).unwrap()).unwrap().iter().map(|p| p.visible).collect() };
    let wanted = switches(&at("in.xcf"));
    assert!(wanted.contains(&true) && wanted.contains(&false));
    expect_code(0, &["convert", &at("in.xcf"), "-o", &at("a.svg")]);
    expect_code(0, &["wave", &at("in.xcf"), "-o", &at("b.svg"), "-q"]);
    expect_code(0, &["wave", &at("a.svg"), "-o", &at("c.svg"), "-q"]);
    for name in ["a", "b", "c"] {
        expect_code(0, &["convert", &at(&format!("{name}.svg")), "-o", &at(&format!("{name}.xcf"))]);
        assert_eq!(switches(&at(&format!("{name}.xcf"))), wanted, "{name}");
    }
    let plain = fs::read_to_string(at("a.svg")).unwrap().replace(" data-gimp-visible=\"false\"", "");
    fs::write(at("plain.svg"), plain).unwrap();
    expect_code(0, &["convert", &at("plain.svg"), "-o", &at("plain.xcf")]);
    assert!(switches(&at("plain.xcf")).iter().all(|v| *v));
}
