//! Quilts: rows and columns of bicubic patches, as files and as paths.
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
//! the points of the sides where they meet. `region` is the box the quilt was made on; without it that is the artwork's. `x` and
//! `y` say where the patches meet in it, as shares of its width and height; without them it is divided evenly. With `fit` true
//! the quilt is laid onto the artwork's box.

use crate::error::Error;
use crate::map::{BicubicNet, Map, Net, TileRow, Tiled};
use crate::param::NamedPath;
use kurbo::{Affine, BezPath, Point, Rect, Vec2};
use serde::Deserialize;
use std::sync::Arc;

/// Patches along one side at most.
const MOST: usize = 64;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    region: Option<[f64; 4]>,
    #[serde(default)]
    fit: bool,
    x: Option<Vec<f64>>,
    y: Option<Vec<f64>>,
    points: Vec<Vec<[f64; 2]>>,
}

/// Patches side by side.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Quilt {
    /// The box it is made on.
    pub(super) region: Rect,
    /// Where patches begin and end, 0 and 1 included.
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// Rows of control points.
    points: Vec<Vec<Point>>,
}

/// How many patches `points` make; `None` if no whole number from 1 to [`MOST`].
fn patches(points: usize) -> Option<usize> {
    let n = points.checked_sub(1)? / 3;
    (n * 3 + 1 == points && (1..=MOST).contains(&n)).then_some(n)
}

/// Cuts with both ends, or even ones.
fn ends(cuts: Option<Vec<f64>>, n: usize) -> Option<Vec<f64>> {
    let Some(inner) = cuts else { return Some((0..=n).map(|i| i as f64 / n as f64).collect()) };
    let all: Vec<f64> = [0.0].into_iter().chain(inner).chain([1.0]).collect();
    (all.len() == n + 1 && all.windows(2).all(|w| w[0] < w[1])).then_some(all)
}

impl Quilt {
    /// From a file's text; `frame` stands in for a region it does not name.
    pub(super) fn read(name: &str, text: &str, frame: Rect) -> Result<Self, Error> {
        let file: File = serde_json::from_str(text)
            .map_err(|e| Error::input(format!("{name}:{}:{}", e.line(), e.column()), format!("is no mesh: {e}")))?;
        Self::from_file(name, file, frame)
    }

    pub(super) fn from_file(name: &str, file: File, frame: Rect) -> Result<Self, Error> {
        let wrong = |what: String| Error::input(name, what);
        let region = match file.region {
            None => frame,
            Some([x, y, w, h]) if w > 0.0 && h > 0.0 && [x, y, w, h].iter().all(|v| v.abs() < 1e100) => {
                Rect::new(x, y, x + w, y + h)
            }
            Some(r) => return Err(wrong(format!("its region {r:?} is no box x, y, width, height"))),
        };
        let points: Vec<Vec<Point>> =
            file.points.iter().map(|row| row.iter().map(|[x, y]| Point::new(*x, *y)).collect()).collect();
        let quilt = Self::new(name, region, points, file.x, file.y)?;
        Ok(if file.fit { quilt.on(frame) } else { quilt })
    }

    /// From a path of one subpath per row of control points, each of as many cubics as there are columns of patches.
    pub(super) fn from_path(path: &NamedPath, region: Rect) -> Result<Self, Error> {
        let row = |s: &crate::outline::Subpath| {
            let cubics = s.segs.iter().map(crate::outline::Seg::to_cubic);
            std::iter::once(s.start).chain(cubics.flat_map(|c| [c.p1, c.p2, c.p3])).collect()
        };
        Self::new(&path.name, region, path.outline.subpaths.iter().map(row).collect(), None, None)
    }

    fn new(
        name: &str,
        region: Rect,
        points: Vec<Vec<Point>>,
        x: Option<Vec<f64>>,
        y: Option<Vec<f64>>,
    ) -> Result<Self, Error> {
        let wrong = |what: String| Error::input(name, what);
        let Some(rows) = patches(points.len()) else {
            let found = points.len();
            return Err(wrong(format!("has {found} rows of points; patches take 4, 7, 10, … (up to {MOST} patches)")));
        };
        let width = points.first().map_or(0, Vec::len);
        let Some(columns) = patches(width) else {
            return Err(wrong(format!("has {width} points in a row; patches take 4, 7, 10, … (up to {MOST} patches)")));
        };
        if let Some(j) = points.iter().position(|r| r.len() != width) {
            return Err(wrong(format!("row {j} has {} points, row 0 has {width}", points[j].len())));
        }
        if points.iter().flatten().any(|p| !(p.x.abs() < 1e100 && p.y.abs() < 1e100)) {
            return Err(wrong("a point is larger than 1e100".into()));
        }
        let shares = |given: Option<Vec<f64>>, n: usize, axis: &str| {
            ends(given, n).ok_or_else(|| {
                let inner = n - 1;
                wrong(format!("its `{axis}` must be {inner} rising number(s) between 0 and 1: where {n} patches meet"))
            })
        };
        let (x, y) = (shares(x, columns, "x")?, shares(y, rows, "y")?);
        Ok(Self { region, x, y, points })
    }

    /// The same laid onto another box.
    pub(super) fn on(mut self, region: Rect) -> Self {
        let r = self.region;
        let (kx, ky) = (region.width() / r.width(), region.height() / r.height());
        for p in self.points.iter_mut().flatten() {
            *p = Point::new(region.x0 + (p.x - r.x0) * kx, region.y0 + (p.y - r.y0) * ky);
        }
        Self { region, ..self }
    }

    /// Patches along x and y.
    pub(super) fn size(&self) -> [usize; 2] {
        [self.x.len() - 1, self.y.len() - 1]
    }

    fn net(&self, i: usize, j: usize) -> Net {
        std::array::from_fn(|r| std::array::from_fn(|c| self.points[3 * j + r][3 * i + c]))
    }

    /// Makes the joints C¹: handles on both sides of a joint get the mean of their two derivatives, corners after sides, so that
    /// the cross derivatives agree too.
    pub(super) fn smooth(&mut self) {
        let level = |a: Point, b: Point, c: Point, before: f64, after: f64| {
            let slope = ((b - a) / before + (c - b) / after) * 0.5;
            (b - slope * before, b + slope * after)
        };
        for row in &mut self.points {
            for i in 1..self.x.len() - 1 {
                let (before, after) = (self.x[i] - self.x[i - 1], self.x[i + 1] - self.x[i]);
                (row[3 * i - 1], row[3 * i + 1]) = level(row[3 * i - 1], row[3 * i], row[3 * i + 1], before, after);
            }
        }
        for j in 1..self.y.len() - 1 {
            let (before, after) = (self.y[j] - self.y[j - 1], self.y[j + 1] - self.y[j]);
            for c in 0..self.points[0].len() {
                let [a, b, d] = [3 * j - 1, 3 * j, 3 * j + 1].map(|r| self.points[r][c]);
                (self.points[3 * j - 1][c], self.points[3 * j + 1][c]) = level(a, b, d, before, after);
            }
        }
    }

    /// The joints that are not C¹: how many handle pairs, and the largest jump of the derivative as a share of it.
    pub(super) fn kinks(&self) -> (usize, f64) {
        /// Files keep about seven digits.
        const ROUNDING: f64 = 1e-6;
        let (mut count, mut most) = (0, 0.0_f64);
        let mut joint = |a: Point, b: Point, c: Point, before: f64, after: f64| {
            let (l, r): (Vec2, Vec2) = ((b - a) / before, (c - b) / after);
            let jump = (r - l).hypot() / l.hypot().max(r.hypot()).max(f64::MIN_POSITIVE);
            if jump > ROUNDING {
                count += 1;
                most = most.max(jump);
            }
        };
        for row in &self.points {
            for i in 1..self.x.len() - 1 {
                let k = 3 * i;
                joint(row[k - 1], row[k], row[k + 1], self.x[i] - self.x[i - 1], self.x[i + 1] - self.x[i]);
            }
        }
        for j in 1..self.y.len() - 1 {
            for c in 0..self.points[0].len() {
                let [a, b, d] = [3 * j - 1, 3 * j, 3 * j + 1].map(|r| self.points[r][c]);
                joint(a, b, d, self.y[j] - self.y[j - 1], self.y[j + 1] - self.y[j]);
            }
        }
        (count, most)
    }

    /// The map; `None`: the region has no area.
    pub(super) fn map(&self) -> Option<Arc<dyn Map>> {
        let r = self.region;
        if !(r.width() > 0.0 && r.height() > 0.0) {
            return None;
        }
        let [columns, rows] = self.size();
        let across: Vec<f64> = self.x.iter().map(|u| r.x0 + u * r.width()).collect();
        let down: Vec<f64> = self.y.iter().map(|v| r.y0 + v * r.height()).collect();
        let patch = |i: usize, j: usize| -> Arc<dyn Map> {
            let (w, h) = (across[i + 1] - across[i], down[j + 1] - down[j]);
            let pre = Affine::new([1.0 / w, 0.0, 0.0, 1.0 / h, -across[i] / w, -down[j] / h]);
            Arc::new(BicubicNet::new(&self.net(i, j), pre))
        };
        let inner = |cuts: &[f64]| cuts[1..cuts.len() - 1].to_vec();
        let row = |j: usize| TileRow { cuts: inner(&across), maps: (0..columns).map(|i| patch(i, j)).collect() };
        Tiled::over(r, inner(&down), (0..rows).map(row).collect())
    }

    /// The sides of the patches.
    pub(super) fn curves(&self) -> BezPath {
        let mut path = BezPath::new();
        let mut line = |points: Vec<Point>| {
            path.move_to(points[0]);
            for c in points[1..].chunks_exact(3) {
                path.curve_to(c[0], c[1], c[2]);
            }
        };
        for row in self.points.iter().step_by(3) {
            line(row.clone());
        }
        for c in (0..self.points[0].len()).step_by(3) {
            line(self.points.iter().map(|row| row[c]).collect());
        }
        path
    }
}
