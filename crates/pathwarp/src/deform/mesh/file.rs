//! Quilts as files.
//!
//! ```json
//! {
//!   "region": [20, 20, 200, 100],
//!   "x": [0.5], "y": [],
//!   "points": [[[20, 20], …], …]
//! }
//! ```
//!
//! `points` has 3·rows + 1 rows from the top, each of 3·columns + 1 points from left to right, in user units; patches share the points
//! of their common sides. `region` is the box for which the quilt was made, by default the artwork's. `x` and `y` are the positions
//! where patches meet, as shares of the width and height of `region`, which is divided evenly by default. If `fit` is true, the quilt
//! is laid onto the artwork's box.

use super::quilt::{Contents, Quilt};
use crate::deform::ffd::region_in_file;
use crate::deform::warp::{self, Style, StyleParams};
use crate::error::Error;
use crate::param::NamedText;
use kurbo::{Point, Rect};
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QuiltFile {
    region: Option<[f64; 4]>,
    #[serde(default)]
    fit: bool,
    x: Option<Vec<f64>>,
    y: Option<Vec<f64>>,
    points: Vec<Vec<[f64; 2]>>,
}

/// Reads a quilt; `frame` is the default region.
pub(super) fn read(name: &str, text: &str, frame: Rect) -> Result<Quilt, Error> {
    let file: QuiltFile = serde_json::from_str(text)
        .map_err(|e| Error::input(format!("{name}:{}:{}", e.line(), e.column()), format!("is not a mesh: {e}")))?;
    file.quilt(name, frame)
}

impl QuiltFile {
    /// Checks the file's data; `frame` is the default region.
    pub(super) fn quilt(self, name: &str, frame: Rect) -> Result<Quilt, Error> {
        let region = region_in_file(name, self.region, frame)?;
        let row = |row: Vec<[f64; 2]>| row.into_iter().map(|[x, y]| Point::new(x, y)).collect();
        let quilt = Quilt::new(name, region, self.points.into_iter().map(row).collect(), self.x, self.y)?;
        Ok(if self.fit { quilt.laid_onto(frame) } else { quilt })
    }
}

/// Warps of Photoshop layers, as JSON made from the warp descriptors of a file or written by hand.
#[derive(Deserialize)]
#[serde(untagged)]
enum Warps {
    All {
        warps: Vec<LayerWarp>,
    },
    /// A single warp, as in a file written by hand.
    One(LayerWarp),
}

/// A layer's warp: the fields of its descriptor.
#[derive(Deserialize)]
struct LayerWarp {
    #[serde(default)]
    layer: String,
    #[serde(alias = "warpStyle")]
    style: String,
    /// Percent.
    #[serde(default, alias = "warpValue")]
    value: f64,
    #[serde(default, alias = "warpPerspective")]
    perspective: f64,
    #[serde(default, alias = "warpPerspectiveOther")]
    perspective_other: f64,
    #[serde(default)]
    vertical: bool,
    /// The control points of a custom warp.
    mesh: Option<QuiltFile>,
}

/// Reads the warp over `region` of the named layer, by default the only warped one.
pub(super) fn read_psd(file: &NamedText, layer: Option<&str>, region: Rect) -> Result<Contents, Error> {
    let wrong = |what: String| Error::input(&file.name, what);
    let expected = "is neither a Photoshop file nor JSON of a warp: {\"style\": \"warpArc\", \"value\": 50}";
    let warps = match serde_json::from_str(&file.text).map_err(|_| wrong(expected.into()))? {
        Warps::All { warps } => warps,
        Warps::One(warp) => vec![warp],
    };
    let all = warps.iter().map(|w| format!("`{}` ({})", w.layer, w.style)).collect::<Vec<_>>().join(", ");
    let mut chosen = warps.into_iter().filter(|w| layer.map_or(w.style != "warpNone", |l| w.layer == l));
    let warp = match (chosen.next(), chosen.next()) {
        (Some(one), None) => one,
        (None, _) if all.is_empty() => return Err(wrong("has no warped layer".into())),
        (None, _) => return Err(wrong(format!("has no such warped layer; there are {all}"))),
        (Some(_), Some(_)) => return Err(wrong(format!("has several warped layers; choose one with `layer`: {all}"))),
    };
    if let Some(mesh) = warp.mesh {
        return Ok(Contents::Quilt(mesh.quilt(&file.name, region)?.laid_onto(region), Some(warp.layer)));
    }
    let style = Style::named(&warp.style).ok_or_else(|| {
        wrong(format!("layer `{}` has the warp {}, which has no known formula", warp.layer, warp.style))
    })?;
    let distortion = [warp.perspective / 100.0, warp.perspective_other / 100.0];
    let params = StyleParams { bend: warp.value / 100.0, distortion, vertical: warp.vertical };
    let net = style.net(region.width(), region.height(), &params).map_err(|e| wrong(format!("its style {e}")))?;
    let mut built = warp::over(region, &net)?;
    built.note(format!("layer {}: style {}, bend {}%", warp.layer, style.name(), warp.value));
    Ok(Contents::Style(built))
}
