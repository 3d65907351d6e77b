//! Point lists as JSON: what GIMP's `gimp-path-stroke-get-points` (3.0) and `gimp-vectors-stroke-get-points` (2.x) answer.
//!
//! ```json
//! {"width": 640, "height": 400, "paths": [{"name": "Base", "visible": true, "strokes": [
//!   {"type": 0, "closed": false, "num_points": 12, "controlpoints": [x, y, x, y, x, y, …]}]}]}
//! ```
//!
//! `num_points` counts numbers, six for an anchor. `points` as pairs, as `pathwarp paths --json` lists them, is understood too.

use crate::error::Error;
use crate::open::{File, Kind};
use crate::path::{GimpPath, Stroke};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct Image {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    width: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    height: Option<f64>,
    paths: Vec<Path>,
}

#[derive(Serialize, Deserialize)]
struct Path {
    name: String,
    #[serde(default)]
    visible: bool,
    strokes: Vec<Points>,
}

#[derive(Serialize, Deserialize)]
struct Points {
    /// The one kind there is: Bézier.
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

pub(crate) fn read(text: &str) -> Result<File, Error> {
    let image: Image = serde_json::from_str(text).map_err(|e| {
        let lines = text.split_inclusive('\n').take(e.line().saturating_sub(1));
        let at = lines.map(str::len).sum::<usize>() + e.column().saturating_sub(1);
        Error::at(at as u64, format!("this is no list of GIMP's paths: {e}"))
    })?;
    let paths: Result<Vec<GimpPath>, String> = image.paths.into_iter().map(path).collect();
    let size = image.width.zip(image.height).map(|(w, h)| [w, h]);
    Ok(File { kind: Kind::Json, size, paths: paths.map_err(|e| Error::at(0, e))? })
}

fn path(p: Path) -> Result<GimpPath, String> {
    let stroke = |(i, s): (usize, Points)| {
        let place = || format!("path `{}`, stroke {}", p.name, i + 1);
        if s.kind != 0 {
            return Err(format!("{}: type {} is unknown; 0 is a Bézier stroke", place(), s.kind));
        }
        let points = match (s.controlpoints, s.points) {
            (Some(flat), None) if flat.len().is_multiple_of(2) => flat.chunks_exact(2).map(|c| [c[0], c[1]]).collect(),
            (None, Some(points)) => points,
            (Some(flat), None) => return Err(format!("{}: {} control points are no pairs", place(), flat.len())),
            _ => return Err(format!("{}: either controlpoints or points must be there", place())),
        };
        if s.num_points.is_some_and(|n| n != 2 * points.len()) {
            return Err(format!("{}: num_points does not count its {} numbers", place(), 2 * points.len()));
        }
        if !points.len().is_multiple_of(3) {
            return Err(format!(
                "{}: {} points; every anchor has three, itself and two handles",
                place(),
                points.len()
            ));
        }
        if points.as_flattened().iter().any(|v| !v.is_finite()) {
            return Err(format!("{}: a coordinate is too large to be a number", place()));
        }
        Ok(Stroke { closed: s.closed, points })
    };
    let strokes: Result<Vec<Stroke>, String> = p.strokes.into_iter().enumerate().map(stroke).collect();
    let strokes = strokes?.into_iter().filter(|s| !s.points.is_empty()).collect();
    Ok(GimpPath { name: p.name, visible: p.visible, strokes })
}

/// The paths as JSON point lists, every number to the last bit.
#[must_use]
pub fn to_json(size: Option<[f64; 2]>, paths: &[GimpPath]) -> String {
    let points = |s: &Stroke| Points {
        kind: 0,
        closed: s.closed,
        num_points: Some(2 * s.points.len()),
        controlpoints: Some(s.points.as_flattened().to_vec()),
        points: None,
    };
    let path = |p: &GimpPath| Path {
        name: p.name.clone(),
        visible: p.visible,
        strokes: p.strokes.iter().map(points).collect(),
    };
    let image =
        Image { width: size.map(|s| s[0]), height: size.map(|s| s[1]), paths: paths.iter().map(path).collect() };
    // Nothing in there can fail: no maps, and numbers are finite.
    serde_json::to_string(&image).unwrap_or_default() + "\n"
}
