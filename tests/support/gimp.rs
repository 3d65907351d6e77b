//! Sample paths, and lists of paths to compare.

use crate::support::expect_code;
use pathwarp_gimp::{GimpPath, Stroke};
use serde_json::Value;
use std::path::Path;

pub fn stroke(closed: bool, points: &[[f64; 2]]) -> Stroke {
    Stroke { closed, points: points.iter().map(|p| p.map(|v| f64::from(v as f32))).collect() }
}

/// Curves and lines, open and closed, with several strokes and unusual names.
pub fn paths() -> Vec<GimpPath> {
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

pub fn listed(file: &Path) -> Value {
    let (text, _) = expect_code(0, &["paths", "--json", file.to_str().unwrap()]);
    serde_json::from_str(&text).unwrap()
}

/// A path's name and its strokes; each with `true` if closed, and its control points.
pub type Named = (String, Vec<(bool, Vec<[f64; 2]>)>);

/// The strokes of every path in a list of `pathwarp paths --json`.
pub fn strokes(list: &Value) -> Vec<Named> {
    let stroke = |s: &Value| (s["closed"].as_bool().unwrap(), serde_json::from_value(s["points"].clone()).unwrap());
    let path = |p: &Value| {
        (p["name"].as_str().unwrap().to_owned(), p["strokes"].as_array().unwrap().iter().map(stroke).collect())
    };
    list["paths"].as_array().unwrap().iter().map(path).collect()
}
