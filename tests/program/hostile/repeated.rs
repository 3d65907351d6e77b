//! Small work that a file requests thousands of times: gradients, pictures, texts on paths, wide strokes, dashes, pieces of a skeleton,
//! edges of a mesh.

use super::bounded::{Folder, RECT, expect, svg};
use crate::support::sample;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::fs;

/// Curves in a row.
fn curves(n: usize) -> String {
    format!("M0 0{}", "c9 90 9-90 1 1".repeat(n))
}

#[test]
fn texts_measure_their_paths() {
    let texts = "<text><textPath href='#p'>abc</textPath></text>".repeat(3000);
    expect(&format!("<path id='p' d='{}'/>{texts}", curves(10_000)), [3, 3], "work");
    expect("<path id='p' d='M0 50H90'/><text><textPath href='#p'>abc</textPath></text>", [0, 0], "");
}

#[test]
fn wide_strokes_are_counted() {
    let path = "<path d='M0 0H90C3 3 3 3 9 9'/>".repeat(3000);
    for wide in ["stroke-width='9e8'", "style='stroke:red;stroke-width: 5e7px'"] {
        expect(&format!("<g stroke='red' {wide}>{path}</g>"), [3, 3], "work");
    }
    expect(&format!("<g stroke='red' stroke-width='9e5'>{RECT}</g>"), [0, 0], "");
}

#[test]
fn all_stops_of_a_gradient_are_counted() {
    let stops: String = (0..20_000).map(|i| format!("<stop offset='{i}e-5' stop-color='#{i:06x}'/>")).collect();
    let rect = "<rect width='100' height='100' fill='url(#g)'/>";
    let folder = Folder::with(&[("a.svg", &svg(&format!("<linearGradient id='g'>{stops}</linearGradient>{rect}")))]);
    let (code, said) = folder.run(&["render", "a.svg", "-o", "o.png", "--width", "2000"]);
    assert_eq!((code, said.contains("--limit work=")), (3, true), "{said}");
    folder.run_all("a.svg");
    folder.run(&["compare", "a.svg", "a.svg"]);
}

#[test]
fn pictures_and_gradients_are_counted() {
    let mut picture = resvg::tiny_skia::Pixmap::new(2, 2).unwrap();
    picture.fill(resvg::tiny_skia::Color::BLACK);
    let png = STANDARD.encode(picture.encode_png().unwrap());
    let pictures =
        |n: usize| svg(&format!("<image width='9' height='9' href='data:image/png;base64,{png}'/>").repeat(n));
    let folder = Folder::with(&[("a.svg", &pictures(2000)), ("few.svg", &pictures(30))]).ample();
    let (code, said) = folder.run(&["swirl", "a.svg", "-o", "o.svg"]);
    assert_eq!((code, said.contains("--limit work=")), (4, true), "{said}");
    assert_eq!(folder.run(&["swirl", "few.svg", "-o", "o.svg"]).0, 0);
    let radial = |i: usize| {
        let stops = "<stop/><stop offset='1' stop-color='red'/>";
        format!(
            "<radialGradient id='g{i}' r='.{i}'>{stops}</radialGradient><rect width='90' height='90' fill='url(#g{i})'/>"
        )
    };
    let folder = Folder::with(&[("a.svg", &svg(&(0..6000).map(radial).collect::<String>()))]);
    for command in [&["swirl", "a.svg", "-o", "o.svg"][..], &["wave", "a.svg", "-o", "o.svg", "--gradients", "exact"]] {
        folder.run(command);
    }
}

#[test]
fn dashes_are_counted_before_they_are_made() {
    let circles: String = (40..90).map(|r| format!("<circle r='{r}'/>")).collect();
    let body = format!("<g fill='none' stroke='red' stroke-dasharray='.02'>{circles}</g>");
    let folder = Folder::with(&[("a.svg", &svg(&body))]);
    let (code, said) = folder.run(&["wave", "a.svg", "-o", "o.svg", "--strokes", "outline"]);
    assert!([3, 4].contains(&code) && said.contains("--limit work="), "{code}: {said}");
    folder.run_all("a.svg");
    // More dashes than are drawn, on a path whose subpaths each have fewer.
    let lines: String = (0..70).map(|y| format!("M0 {y}H900")).collect();
    let body = format!("<path d='{lines}' fill='none' stroke='red' stroke-dasharray='.1'/>");
    let folder = Folder::with(&[("a.svg", &svg(&body))]).ample();
    assert_eq!(folder.run(&["wave", "a.svg", "-o", "o.svg", "--strokes", "outline"]).0, 0);
}

#[test]
fn paths_that_control_a_map_are_counted() {
    let long = curves(16_000);
    let skeleton = svg(&format!("<path id='k' d='{long}'/>"));
    let folder = Folder::with(&[("a.svg", &fs::read(sample("logo.svg")).unwrap()), ("k.svg", &skeleton)]).ample();
    for along in ["k.svg#k", &curves(9000)] {
        let (code, said) = folder.run(&["bend", "a.svg", "--along", along, "-o", "o.svg"]);
        assert_eq!((code, said.contains("--limit work=")), (4, true), "{said}");
    }
    folder.run(&["bend", "a.svg", "--along", &curves(1000), "-o", "o.svg"]);
}

#[test]
fn halved_edges_are_counted() {
    let square = "v 0 0 0\nv 9 0 0\nv 9 9 3\nv 0 9 0\nf 1 2 3 4\n";
    let folder = Folder::with(&[("a.obj", square.as_bytes())]);
    let twist = ["solid", "bend", "a.obj", "--preset", "twist", "--along", "y", "--angle", "90", "-o", "o.obj"];
    for (refine, refused) in [("1e-9", true), ("1e-300", true), ("0.01", false)] {
        let (code, said) = folder.run(&[&twist[..], &["--refine", refine]].concat());
        assert_eq!(code == 0, !refused, "{refine}: {said}");
        assert!(!refused || said.contains("--limit work="), "{said}");
    }
}

#[test]
fn curves_that_are_near_each_other_are_compared_within_bounds() {
    let circles: String = (0..400).map(|i| format!("M{i} 0A{i} {i} 0 0 1 -{i} 0A{i} {i} 0 0 1 {i} 0Z")).collect();
    let folder = Folder::with(&[
        ("a.svg", &svg(&format!("<path id='p' d='{}'/>", curves(40_000)))),
        ("b.svg", &svg(&format!("<path id='p' d='{}'/>", circles.repeat(40)))),
        ("c.svg", &svg(&format!("<path id='p' d='M0 0{}'/>", "a1e8 1e-6 45 1 0 1 1".repeat(40_000)))),
    ]);
    for (a, b) in [("a.svg", "a.svg"), ("a.svg", "b.svg"), ("b.svg", "b.svg"), ("c.svg", "c.svg"), ("c.svg", "b.svg")] {
        let (code, said) = folder.run(&["compare", a, b]);
        assert!(code == 0 || said.contains("--limit work="), "{a} {b}: {said}");
    }
}

#[test]
fn dashes_of_strokes_that_stay_are_counted() {
    let dashes: String = (0..1300).map(|i| format!(".{} ", i % 9 + 1)).collect();
    let body =
        format!("<g fill='none' stroke='red' stroke-dasharray='{dashes}'>{}</g>", "<circle r='90'/>".repeat(3000));
    let folder = Folder::with(&[("a.svg", &svg(&body))]);
    let (code, said) = folder.run(&["wave", "a.svg", "-o", "o.svg", "--strokes", "keep"]);
    assert!(code == 4 && said.contains("--limit work="), "{code}: {said}");
}

#[test]
fn faces_that_cover_each_other_are_counted_before_they_are_drawn() {
    let square = "v 0 0 0\nv 9 0 0\nv 9 9 3\n";
    let folder = Folder::with(&[
        ("many.obj", format!("{square}{}", "f 1 2 3\n".repeat(100_000)).as_bytes()),
        ("one.obj", format!("{square}f 1 2 3\n").as_bytes()),
    ]);
    let bend = |file: &str| {
        folder.run(&["solid", "bend", file, "--preset", "taper", "--along", "x", "--preview", "o.png", "-o", "o.stl"])
    };
    let (code, said) = bend("many.obj");
    assert!(code == 3 && said.contains("--limit work="), "{code}: {said}");
    assert_eq!(bend("one.obj").0, 0);
}

/// All cells of a sheet together count as one drawing.
#[test]
fn cells_of_a_sheet_are_counted_together() {
    let marker = "<marker id='m' viewBox='0 0 1 1' markerWidth='1' markerHeight='1'><circle r='1'/></marker>";
    let path = format!("<path marker-mid='url(#m)' fill='none' stroke='red' d='M0 0{}'/>", "l1 1l1-1".repeat(3000));
    let deep = format!("<style>*{{fill:{}red{}}}</style>{RECT}", "var(--x,".repeat(9000), ")".repeat(9000));
    let empty = format!("{RECT}{}", "<g id='a'/>".repeat(25_000));
    for body in [format!("{marker}{path}"), deep, empty] {
        let folder = Folder::with(&[("a.svg", &svg(&body))]);
        folder.run(&["gallery", "a.svg", "-o", "o.svg"]);
        folder.run(&["gallery", "a.svg", "--all", "-o", "o.png"]);
    }
    // The sheet reports content missing from a cell.
    let folder = Folder::with(&[("a.svg", &svg(&format!("<image width='9' height='9' href='no.png'/>{RECT}")))]);
    let (code, said) = folder.run(&["gallery", "a.svg", "-o", "o.svg"]);
    assert_eq!((code, said.contains("no.png")), (1, true), "{said}");
}
