//! Quilts: rows and columns of bicubic patches.

use crate::deform::entry::Built;
use crate::error::Error;
use crate::map::{BicubicNet, Map, Net, TileRow, Tiled};
use crate::param::NamedPath;
use kurbo::{BezPath, Point, Rect, Vec2};
use std::sync::Arc;

/// Limit on patches along one side.
const MAX_PATCHES: usize = 64;

/// Rows and columns of bicubic patches over a box.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Quilt {
    /// The box that the patches divide.
    pub(super) region: Rect,
    /// Positions of the patches' sides, as shares of the box, from 0 to 1.
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// Rows of control points.
    points: Vec<Vec<Point>>,
}

/// The deformation that a file describes.
pub(super) enum Contents {
    /// The map of a warp style.
    Style(Built),
    /// A quilt, and its layer's name.
    Quilt(Quilt, Option<String>),
}

/// Returns the number of patches that `points` make; `None` unless it is a whole number from 1 to [`MAX_PATCHES`].
fn patches(points: usize) -> Option<usize> {
    let n = points.checked_sub(1)? / 3;
    (n * 3 + 1 == points && (1..=MAX_PATCHES).contains(&n)).then_some(n)
}

/// Returns the cuts with 0 and 1; without cuts, an even division into `n`. `None` if they do not rise.
fn ends(cuts: Option<Vec<f64>>, n: usize) -> Option<Vec<f64>> {
    let Some(inner) = cuts else { return Some((0..=n).map(|i| i as f64 / n as f64).collect()) };
    let all: Vec<f64> = [0.0].into_iter().chain(inner).chain([1.0]).collect();
    (all.len() == n + 1 && all.windows(2).all(|w| w[0] < w[1])).then_some(all)
}

impl Quilt {
    /// Reads a path with one subpath per row of control points, each of as many cubics as there are columns of patches.
    pub(super) fn from_path(path: &NamedPath, region: Rect) -> Result<Self, Error> {
        let row = |s: &crate::outline::Subpath| {
            let cubics = s.segs.iter().map(crate::outline::Seg::to_cubic);
            std::iter::once(s.start).chain(cubics.flat_map(|c| [c.p1, c.p2, c.p3])).collect()
        };
        Self::new(&path.name, region, path.outline.subpaths.iter().map(row).collect(), None, None)
    }

    /// Creates a quilt after checking its control points. `x` and `y` default to even divisions.
    pub(super) fn new(
        name: &str,
        region: Rect,
        points: Vec<Vec<Point>>,
        x: Option<Vec<f64>>,
        y: Option<Vec<f64>>,
    ) -> Result<Self, Error> {
        let wrong = |what: String| Error::input(name, what);
        let Some(rows) = patches(points.len()) else {
            let found = points.len();
            return Err(wrong(format!(
                "has {found} rows of points; patches take 4, 7, 10, … (up to {MAX_PATCHES} patches)"
            )));
        };
        let width = points.first().map_or(0, Vec::len);
        let Some(columns) = patches(width) else {
            return Err(wrong(format!(
                "has {width} points in a row; patches take 4, 7, 10, … (up to {MAX_PATCHES} patches)"
            )));
        };
        if let Some(j) = points.iter().position(|r| r.len() != width) {
            return Err(wrong(format!("row {j} has {} points, row 0 has {width}", points[j].len())));
        }
        if points.iter().flatten().any(|p| !(p.x.abs() < 1e100 && p.y.abs() < 1e100)) {
            return Err(wrong("has a point larger than 1e100".into()));
        }
        let shares = |given: Option<Vec<f64>>, n: usize, axis: &str| {
            ends(given, n).ok_or_else(|| {
                let inner = n - 1;
                wrong(format!("its `{axis}` must be {inner} rising number(s) between 0 and 1, where {n} patches meet"))
            })
        };
        let (x, y) = (shares(x, columns, "x")?, shares(y, rows, "y")?);
        Ok(Self { region, x, y, points })
    }

    /// Lays the quilt onto another box.
    pub(super) fn on(mut self, region: Rect) -> Self {
        let r = self.region;
        let (kx, ky) = (region.width() / r.width(), region.height() / r.height());
        for p in self.points.iter_mut().flatten() {
            *p = Point::new(region.x0 + (p.x - r.x0) * kx, region.y0 + (p.y - r.y0) * ky);
        }
        Self { region, ..self }
    }

    /// Returns the number of patches along x and y.
    pub(super) fn size(&self) -> [usize; 2] {
        [self.x.len() - 1, self.y.len() - 1]
    }

    fn net(&self, i: usize, j: usize) -> Net {
        std::array::from_fn(|r| std::array::from_fn(|c| self.points[3 * j + r][3 * i + c]))
    }

    /// Makes the joints C¹: handles on both sides of a joint get the mean of their two derivatives. Columns come after rows, so that
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

    /// Returns the number of pairs of handles that are not C¹, and the largest jump of the derivative relative to its size.
    pub(super) fn kinks(&self) -> (usize, f64) {
        /// Smaller jumps are rounding: files keep about seven digits.
        const ROUNDING: f64 = 1e-6;
        let (mut count, mut worst) = (0, 0.0_f64);
        let mut joint = |a: Point, b: Point, c: Point, before: f64, after: f64| {
            let (l, r): (Vec2, Vec2) = ((b - a) / before, (c - b) / after);
            let jump = (r - l).hypot() / l.hypot().max(r.hypot()).max(f64::MIN_POSITIVE);
            if jump > ROUNDING {
                count += 1;
                worst = worst.max(jump);
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
        (count, worst)
    }

    /// Returns the map; `None` if the region has no area.
    pub(super) fn map(&self) -> Option<Arc<dyn Map>> {
        let r = self.region;
        if !(r.width() > 0.0 && r.height() > 0.0) {
            return None;
        }
        let [columns, rows] = self.size();
        let across: Vec<f64> = self.x.iter().map(|u| r.x0 + u * r.width()).collect();
        let down: Vec<f64> = self.y.iter().map(|v| r.y0 + v * r.height()).collect();
        let patch = |i: usize, j: usize| -> Arc<dyn Map> {
            let rect = Rect::new(across[i], down[j], across[i + 1], down[j + 1]);
            Arc::new(BicubicNet::over(rect, &self.net(i, j)))
        };
        let inner = |cuts: &[f64]| cuts[1..cuts.len() - 1].to_vec();
        let row = |j: usize| TileRow { cuts: inner(&across), maps: (0..columns).map(|i| patch(i, j)).collect() };
        Tiled::over(r, inner(&down), (0..rows).map(row).collect())
    }

    /// Draws the sides of the patches.
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
