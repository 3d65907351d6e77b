//! Lengths with units are equal in px, mm and inch drawings, whatever their `viewBox`.

use super::common::text;
use crate::support::pathwarp_in;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Drawings of the same physical size: name, width and height, units per mm.
const DRAWINGS: [(&str, &str, &str, f64); 5] = [
    ("px", "377.95275590551181", "188.97637795275591", 96.0 / 25.4),
    ("mm", "100mm", "50mm", 1.0),
    ("inch", "3.937007874015748in", "1.968503937007874in", 1.0 / 25.4),
    ("micrometres", "10cm", "5cm", 1000.0),
    ("points", "100mm", "50mm", 72.0 / 25.4),
];

/// A square of 30 mm, 20 mm from the left and 10 mm from the top of a page of 100 mm by 50 mm.
fn drawing(width: &str, height: &str, per_mm: f64) -> String {
    let [w, h, x, y, s] = [100.0, 50.0, 20.0, 10.0, 30.0].map(|mm| mm * per_mm);
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' viewBox='0 0 {w} {h}'>\
         <path id='s' d='M{x},{y}h{s}v{s}h-{s}z'/></svg>"
    )
}

/// The box of path `id` in a drawing, as x, y, width and height.
fn bounds(folder: &Path, svg: &[u8], id: &str) -> [f64; 4] {
    let out = pathwarp_in(folder, &["paths", "-", "--json"], svg);
    let list: Value = serde_json::from_slice(&out.stdout).unwrap();
    let path = list["paths"].as_array().unwrap().iter().find(|p| p["name"] == id).unwrap().clone();
    [0, 1, 2, 3].map(|i| path["bounds"][i].as_f64().unwrap())
}

#[test]
fn results_have_the_same_size_in_mm() {
    let dir = tempfile::tempdir().unwrap();
    let mm = |args: &[&str]| -> Vec<[f64; 4]> {
        let one = |(name, w, h, per_mm): &(&str, &str, &str, f64)| {
            let out = pathwarp_in(dir.path(), args, drawing(w, h, *per_mm).as_bytes());
            assert_eq!(out.status.code(), Some(0), "{name} {args:?}: {}", text(&out.stderr));
            let size = bounds(dir.path(), &out.stdout, "s").map(|v| v / per_mm);
            println!("{args:?} in {name}: {:.4} x {:.4} mm at {:.4},{:.4} mm", size[2], size[3], size[0], size[1]);
            size
        };
        DRAWINGS.iter().map(one).collect()
    };
    let near = |all: &[[f64; 4]], wanted: [f64; 4]| {
        assert!(all.iter().all(|b| b.iter().zip(wanted).all(|(a, w)| (a - w).abs() < 0.005)), "{all:?} {wanted:?}");
    };
    near(&mm(&["affine", "--move-x", "10mm", "--move-y", "-0.5cm", "-q"]), [30.0, 5.0, 30.0, 30.0]);
    near(&mm(&["affine", "--move-x", "1in", "--move-y", "96px", "-q"]), [45.4, 35.4, 30.0, 30.0]);
    // 40 mm above and below the middle, by the definition of the wave.
    let waves = mm(&["wave", "--height", "4mm", "--length", "10mm", "--tolerance", "0.001mm", "-q"]);
    near(&waves, [20.0, 6.0, 30.0, 38.0]);
    // The top of a four-sided cage in mm.
    near(&mm(&["projective", "--target", "0mm,50mm 80mm,50mm 80mm,0mm 0mm,0mm", "-q"]), [0.0, 0.0, 80.0, 50.0]);
    // A label on a mug is equal in all of them, and wider than it looks.
    let label =
        mm(&["anamorph", "--distance", "50cm", "--onto", "cylinder:radius=42mm", "-q", "--tolerance", "0.001mm"]);
    near(&label, label[1]);
    let half = half_width_on_a_mug(15.0, 500.0, 42.0);
    assert!((label[1][2] - 2.0 * half).abs() < 0.01, "{label:?} {half}");
}

/// Returns arc length on a cylinder of radius `r` that touches the drawing's plane, seen from `distance` at `x` beside the axis of view.
fn half_width_on_a_mug(x: f64, distance: f64, r: f64) -> f64 {
    // The ray from (0, d) through (x, 0) meets the circle about (0, -r): p = (t x, d − t d).
    let (a, b, c) = (x * x + distance * distance, -2.0 * distance * (distance + r), (distance + r).powi(2) - r * r);
    let t = (-b - (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
    r * (t * x).atan2(distance - t * distance + r)
}

#[test]
fn tolerance_and_frame_have_units_too() {
    let dir = tempfile::tempdir().unwrap();
    for (name, w, h, per_mm) in DRAWINGS {
        let args = ["warp", "--style", "flag", "--tolerance", "0.05mm", "--report", "r.json", "-o", "o.svg", "-q"];
        let out = pathwarp_in(dir.path(), &args, drawing(w, h, per_mm).as_bytes());
        assert_eq!(out.status.code(), Some(0), "{name}: {}", text(&out.stderr));
        let report: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
        let tolerance = report["inputs"][0]["tolerance"].as_f64().unwrap();
        assert!((tolerance / per_mm - 0.05).abs() < 1e-9, "{name}: {tolerance}");
        // 50% of a frame of 40 mm.
        let args = ["affine", "--move-x", "50%", "--frame", "0mm,0mm,40mm,1cm", "-q"];
        let out = pathwarp_in(dir.path(), &args, drawing(w, h, per_mm).as_bytes());
        let b = bounds(dir.path(), &out.stdout, "s");
        assert!((b[0] / per_mm - 40.0).abs() < 1e-3, "{name}: {b:?}");
    }
}

#[test]
fn text_sized_in_mm_has_a_page_in_mm() {
    let dir = tempfile::tempdir().unwrap();
    let set = |options: &[&str]| {
        let out = pathwarp_in(dir.path(), &[&["text", "H"], options].concat(), b"");
        assert_eq!(out.status.code(), Some(0), "{options:?}: {}", text(&out.stderr));
        text(&out.stdout)
    };
    let attribute =
        |svg: &str, name: &str| svg.split(&format!(" {name}=\"")).nth(1).unwrap().split('"').next().unwrap().to_owned();
    let plain = set(&["--size", "20", "--margin", "5"]);
    for (size, margin, unit) in
        [("20mm", "5", "mm"), ("20mm", "0.5cm", "mm"), ("2cm", "5mm", "cm"), ("0.02m", "5", "mm"), ("20pt", "5", "pt")]
    {
        let svg = set(&["--size", size, "--margin", margin]);
        let per = if unit == "cm" { 10.0 } else { 1.0 };
        for name in ["width", "height"] {
            let value = attribute(&svg, name);
            let number: f64 = value.strip_suffix(unit).unwrap_or_else(|| panic!("{value} in {size}")).parse().unwrap();
            let wanted: f64 = attribute(&plain, name).parse().unwrap();
            assert!((number * per - wanted).abs() < 1e-6, "{size}: {name} {value} {wanted}");
        }
    }
    // The capital is 0.714 em high: 14.28 mm.
    let out = pathwarp_in(dir.path(), &["paths", "-", "--json"], set(&["--size", "20mm"]).as_bytes());
    let list: Value = serde_json::from_slice(&out.stdout).unwrap();
    assert!((list["paths"][0]["bounds"][3].as_f64().unwrap() - 14.28).abs() < 1e-6, "{list}");
}
