//! Reads and writes point lists in JSON, as returned by GIMP's `gimp-path-stroke-get-points` (3.0) and
//! `gimp-vectors-stroke-get-points` (2.x).
//!
//! ```json
//! {"width": 640, "height": 400, "paths": [{"name": "Base", "visible": true, "strokes": [
//!   {"type": 0, "closed": false, "num_points": 12, "controlpoints": [x, y, x, y, x, y, …]}]}]}
//! ```
//!
//! `num_points` counts numbers, six per anchor. Instead of `controlpoints`, a stroke may have `points`, a list of pairs.

use crate::error::Error;
use crate::path::{FileKind, GimpPath, PathFile, Stroke};
use serde::{Deserialize, Serialize};

/// The whole document.
#[derive(Serialize, Deserialize)]
struct JsonFile {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    width: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    height: Option<f64>,
    paths: Vec<JsonPath>,
}

#[derive(Serialize, Deserialize)]
struct JsonPath {
    name: String,
    #[serde(default)]
    visible: bool,
    strokes: Vec<JsonStroke>,
}

#[derive(Serialize, Deserialize)]
struct JsonStroke {
    /// Always 0, a Bézier stroke.
    #[serde(default, rename = "type")]
    kind: u32,
    closed: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    num_points: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    controlpoints: Option<Vec<f64>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    points: Option<Vec<[f64; 2]>>,
}

/// Parses a point list.
pub(crate) fn read(text: &str) -> Result<PathFile, Error> {
    let file: JsonFile = serde_json::from_str(text)
        .map_err(|e| Error::in_text(text, e.line(), e.column(), format!("not a list of GIMP paths: {e}")))?;
    let paths: Result<Vec<GimpPath>, String> = file.paths.into_iter().map(path).collect();
    let size = file.width.zip(file.height).map(|(w, h)| [w, h]);
    Ok(PathFile { kind: FileKind::Json, size, paths: paths.map_err(|e| Error::damaged(0, e))? })
}

/// Checks a path and converts it.
fn path(p: JsonPath) -> Result<GimpPath, String> {
    let stroke = |(i, s): (usize, JsonStroke)| {
        let position = || format!("path `{}`, stroke {}", p.name, i + 1);
        if s.kind != 0 {
            return Err(format!("{}: type {} is unknown; 0 is a Bézier stroke", position(), s.kind));
        }
        let points = match (s.controlpoints, s.points) {
            (Some(flat), None) if flat.len().is_multiple_of(2) => flat.chunks_exact(2).map(|c| [c[0], c[1]]).collect(),
            (None, Some(points)) => points,
            (Some(flat), None) => return Err(format!("{}: an odd number of coordinates, {}", position(), flat.len())),
            _ => return Err(format!("{}: needs either controlpoints or points", position())),
        };
        if s.num_points.is_some_and(|n| n != 2 * points.len()) {
            return Err(format!("{}: num_points differs from its {} numbers", position(), 2 * points.len()));
        }
        if !points.len().is_multiple_of(3) {
            let problem = format!("{} points, not a multiple of three (every anchor has two handles)", points.len());
            return Err(format!("{}: {problem}", position()));
        }
        if points.as_flattened().iter().any(|v| !v.is_finite()) {
            return Err(format!("{}: a coordinate is out of range", position()));
        }
        Ok(Stroke { closed: s.closed, points })
    };
    let strokes: Result<Vec<Stroke>, String> = p.strokes.into_iter().enumerate().map(stroke).collect();
    let strokes = strokes?.into_iter().filter(|s| !s.points.is_empty()).collect();
    Ok(GimpPath { name: p.name, visible: p.visible, strokes })
}

/// Writes paths as point lists in JSON. Coordinates are exact.
#[must_use]
pub fn to_json(size: Option<[f64; 2]>, paths: &[GimpPath]) -> String {
    let stroke = |s: &Stroke| JsonStroke {
        kind: 0,
        closed: s.closed,
        num_points: Some(2 * s.points.len()),
        controlpoints: Some(s.points.as_flattened().to_vec()),
        points: None,
    };
    let path = |p: &GimpPath| JsonPath {
        name: p.name.clone(),
        visible: p.visible,
        strokes: p.strokes.iter().map(stroke).collect(),
    };
    let file =
        JsonFile { width: size.map(|s| s[0]), height: size.map(|s| s[1]), paths: paths.iter().map(path).collect() };
    #[expect(clippy::expect_used, reason = "structures without maps become text in any case")]
    let text = serde_json::to_string(&file).expect("there is no map");
    text + "\n"
}
