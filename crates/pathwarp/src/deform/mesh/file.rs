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
//! `points` are rows from the top, each from left to right, in user units: 3·columns + 1 in each of 3·rows + 1, patches sharing
//! the points of their common sides. `region` is the box the quilt was made on; the default is the artwork's. `x` and `y` are the
//! positions where patches meet, as shares of its width and height; by default it is divided evenly. With `fit` true the quilt is
//! laid onto the artwork's box.

use super::quilt::Quilt;
use crate::error::Error;
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
        let wrong = |what: String| Error::input(name, what);
        let region = match self.region {
            None => frame,
            Some([x, y, w, h]) if w > 0.0 && h > 0.0 && [x, y, w, h].iter().all(|v| v.abs() < 1e100) => {
                Rect::new(x, y, x + w, y + h)
            }
            Some(r) => return Err(wrong(format!("its region {r:?} is not a box x, y, width, height"))),
        };
        let points: Vec<Vec<Point>> =
            self.points.iter().map(|row| row.iter().map(|[x, y]| Point::new(*x, *y)).collect()).collect();
        let quilt = Quilt::new(name, region, points, self.x, self.y)?;
        Ok(if self.fit { quilt.on(frame) } else { quilt })
    }
}
