//! Very many small things at one point: edges on a scan line, caps and dashes, cusps, letters, faces at an edge.

use super::bounded::{Folder, svg};

const FLAT: [&str; 8] = ["wave", "a.svg", "-o", "o.svg", "--structure", "flatten", "--strokes", "outline"];

#[track_caller]
fn refused(folder: &Folder, args: &[&str], limits: &[&str]) {
    let (code, said) = folder.run(args);
    let named = limits.iter().any(|l| said.contains(&format!("--limit {l}=")));
    assert!([3, 4].contains(&code) && named, "{args:?} {limits:?}: {code} {said}");
}

#[test]
fn crossing_edges_are_counted_before_they_are_drawn() {
    // Back and forth across the page, to points without order.
    let lines: String = (0..100_000_u64).map(|i| format!("L{} {}", i * i % 97, i * 61 % 101)).collect();
    for paint in ["", "fill='none' stroke='red' stroke-width='3' stroke-linejoin='round'"] {
        let folder = Folder::with(&[("a.svg", &svg(&format!("<path {paint} d='M0 0{lines}'/>")))]);
        refused(&folder, &["render", "a.svg", "-o", "o.png"], &["work"]);
        refused(&folder, &["compare", "a.svg", "a.svg"], &["work"]);
        folder.run_all("a.svg");
    }
    // A waveform, whose lines do not cross.
    let coast: String = (0..4_000).map(|i| format!("l.02 {}", [9, -8, 7, -8][i % 4])).collect();
    let folder = Folder::with(&[("a.svg", &svg(&format!("<path d='M0 50{coast}'/>")))]);
    assert_eq!(folder.run(&["render", "a.svg", "-o", "o.png", "--width", "2000"]).0, 0);
}

#[test]
fn round_caps_are_counted() {
    let caps = "M5 5l0 0".repeat(110_000);
    let stroke = "fill='none' stroke='red' stroke-width='50' stroke-linecap='round'";
    let folder = Folder::with(&[("a.svg", &svg(&format!("<path {stroke} d='{caps}'/>")))]);
    refused(&folder, &["compare", "a.svg", "a.svg"], &["work"]);
    folder.run_all("a.svg");
}

#[test]
fn outlines_of_strokes_are_counted() {
    let zigzag = "l9 9l-9 9".repeat(100_000);
    let path = format!("<path fill='none' stroke='red' stroke-width='20' stroke-linejoin='round' d='M0 0{zigzag}'/>");
    let ellipses = "<ellipse rx='9' ry='3' stroke='red'/>".repeat(27_000);
    let dense = format!("<path d='M0 0{}' stroke='red'/>", "l.1 .1-.1 .1".repeat(75_000));
    for body in [path, ellipses, dense] {
        let folder = Folder::with(&[("a.svg", &svg(&body))]);
        refused(&folder, &FLAT, &["work"]);
        folder.run_all("a.svg");
    }
}

#[test]
fn letters_are_counted() {
    let dashed = "<text y='50' font-size='50' stroke='red' stroke-width='3' stroke-dasharray='.1'>";
    let folder = Folder::with(&[("a.svg", &svg(&format!("{dashed}{}</text>", "aé&amp;@".repeat(2500))))]).whole();
    refused(&folder, &["swirl", "a.svg", "-o", "o.svg"], &["work"]);
    refused(&folder, &FLAT, &["work"]);
    let many: String = (0..14_000).map(|i| format!("<text y='{i}'>ab</text>")).collect();
    let vertical = format!("<text y='9' writing-mode='tb'>{}</text>", "aあ".repeat(12_000));
    let unknown: String = (0..20_000).filter_map(|i| char::from_u32(0x4e00 + i)).collect();
    for body in [many, vertical, format!("<text y='9'>{unknown}</text>")] {
        let folder = Folder::with(&[("a.svg", &svg(&body))]);
        folder.run(&FLAT);
        folder.run(&["convert", "a.svg", "-o", "o.pdf"]);
    }
}

/// An ellipse with one tiny radius has to be enlarged until it reaches both ends of its arc, and usvg cuts it into thousands of cubics.
#[test]
fn wide_arcs_are_counted() {
    let arcs: String = (0..3000).map(|i| format!("<path d='M-9e8 {i}A9e8 1e-3 3 0 1 9e8 {i}'/>")).collect();
    let shown = format!("<path id='p' d='M-9e8 0A9e8 1e-3 3 0 1 9e8 0'/>{}", "<use href='#p'/>".repeat(10_000));
    for body in [arcs, shown] {
        let folder = Folder::with(&[("a.svg", &svg(&body))]);
        let to_dxf = ["convert", "a.svg", "--dxf-curves", "polyline", "-o", "o.dxf"];
        for args in [&["compare", "a.svg", "a.svg"][..], &["convert", "a.svg", "-o", "o.pdf"], &to_dxf] {
            refused(&folder, args, &["work"]);
        }
        folder.run_all("a.svg");
    }
    let wide = svg("<path d='M0 0A9e7 9e7 0 0 1 90 90'/>");
    assert_eq!(Folder::with(&[("a.svg", &wide)]).run(&["convert", "a.svg", "-o", "o.pdf"]).0, 0);
}

#[test]
fn faces_at_the_same_edge_are_counted() {
    let three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let (faces, polygon) = ("f 1 2 3\n".repeat(120_000), format!("f {}\n", "1 2 3 ".repeat(150_000)));
    let patches: String = (0..3000)
        .map(|_| {
            let points: String = (0..16).map(|k| format!("{} {} {}\n", k % 4, k / 4, k * k % 3)).collect();
            format!("3 3\n{points}")
        })
        .collect();
    let folder = Folder::with(&[
        ("faces.obj", format!("{three}{faces}").as_bytes()),
        ("polygon.obj", format!("{three}{polygon}").as_bytes()),
        ("patches.bpt", format!("3000\n{patches}").as_bytes()),
    ]);
    let twist = ["--preset", "twist", "--along", "y", "--angle", "90", "-o", "o.obj"];
    for file in ["faces.obj", "polygon.obj"] {
        refused(&folder, &[&["solid", "bend", file, "--refine", "0.01"][..], &twist].concat(), &["work"]);
    }
    refused(&folder, &[&["solid", "bend", "patches.bpt"][..], &twist].concat(), &["work"]);
    assert!(!folder.path().join("o.obj").exists());
}
