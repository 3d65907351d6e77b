//! Quilts: rows and columns of bicubic patches. Patch (i, j), the i-th from the left and the j-th from the top, has the control points of
//! columns 3i to 3i + 3 and rows 3j to 3j + 3; those of the last column and row belong to its neighbours too.

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

/// Three control points in a row or column, with a joint in the middle one.
struct Joint {
    /// Row and column of each.
    nodes: [[usize; 2]; 3],
    /// The shares of the box of the patches before and after.
    widths: [f64; 2],
}

/// The deformation that a file describes.
pub(super) enum Contents {
    /// The map of a warp style.
    Style(Built),
    /// A quilt, and its layer's name.
    Quilt(Quilt, Option<String>),
}

/// Returns the number of patches that a row of `points` points makes; `None` unless it is a whole number from 1 to [`MAX_PATCHES`].
fn patches(points: usize) -> Option<usize> {
    let n = points.checked_sub(1)? / 3;
    (n * 3 + 1 == points && (1..=MAX_PATCHES).contains(&n)).then_some(n)
}

/// Returns the cuts between 0 and 1 with these ends; without cuts, an even division into `n`. `None` unless they are n − 1 and rise.
fn with_ends(cuts: Option<Vec<f64>>, n: usize) -> Option<Vec<f64>> {
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
        let allowed = format!("patches take 4, 7, 10, … (up to {MAX_PATCHES} patches)");
        let height = points.len();
        let rows = patches(height).ok_or_else(|| wrong(format!("has {height} rows of points; {allowed}")))?;
        let width = points.first().map_or(0, Vec::len);
        let columns = patches(width).ok_or_else(|| wrong(format!("has {width} points in a row; {allowed}")))?;
        if let Some(j) = points.iter().position(|r| r.len() != width) {
            return Err(wrong(format!("row {j} has {} points, but row 0 has {width}", points[j].len())));
        }
        if points.iter().flatten().any(|p| !(p.x.abs() < 1e100 && p.y.abs() < 1e100)) {
            return Err(wrong("has a point with a coordinate larger than 1e100".into()));
        }
        let shares = |given: Option<Vec<f64>>, n: usize, axis: &str| {
            with_ends(given, n).ok_or_else(|| {
                let inner = n - 1;
                wrong(format!(
                    "its `{axis}` is not a rising list of the places between 0 and 1 where {n} patches meet; it takes {inner}"
                ))
            })
        };
        let (x, y) = (shares(x, columns, "x")?, shares(y, rows, "y")?);
        Ok(Self { region, x, y, points })
    }

    /// Lays the quilt onto another box.
    pub(super) fn laid_onto(mut self, region: Rect) -> Self {
        let r = self.region;
        let (scale_x, scale_y) = (region.width() / r.width(), region.height() / r.height());
        for p in self.points.iter_mut().flatten() {
            *p = Point::new(region.x0 + (p.x - r.x0) * scale_x, region.y0 + (p.y - r.y0) * scale_y);
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

    /// Returns the joints: along rows, then along columns.
    fn joints(&self) -> Vec<Joint> {
        let along = |cuts: &[f64]| -> Vec<_> {
            (1..cuts.len() - 1).map(|i| (3 * i, [cuts[i] - cuts[i - 1], cuts[i + 1] - cuts[i]])).collect()
        };
        let mut out = Vec::new();
        for r in 0..self.points.len() {
            out.extend(
                along(&self.x).into_iter().map(|(c, w)| Joint { nodes: [[r, c - 1], [r, c], [r, c + 1]], widths: w }),
            );
        }
        for (r, widths) in along(&self.y) {
            let nodes = |c| [[r - 1, c], [r, c], [r + 1, c]];
            out.extend((0..self.points[0].len()).map(|c| Joint { nodes: nodes(c), widths }));
        }
        out
    }

    /// Returns the derivatives on both sides of a joint, and its middle point.
    fn slopes(&self, joint: &Joint) -> ([Vec2; 2], Point) {
        let [a, b, c] = joint.nodes.map(|[r, c]| self.points[r][c]);
        ([(b - a) / joint.widths[0], (c - b) / joint.widths[1]], b)
    }

    /// Makes the joints C¹: handles on both sides of a joint get the mean of their two derivatives. Columns come after rows, so that
    /// the cross derivatives agree too.
    pub(super) fn smooth(&mut self) {
        for joint in self.joints() {
            let ([before, after], p) = self.slopes(&joint);
            let slope = (before + after) * 0.5;
            let [[r0, c0], _, [r1, c1]] = joint.nodes;
            self.points[r0][c0] = p - slope * joint.widths[0];
            self.points[r1][c1] = p + slope * joint.widths[1];
        }
    }

    /// Returns the number of pairs of handles that are not C¹, and the largest jump of the derivative relative to its size.
    pub(super) fn kinks(&self) -> (usize, f64) {
        /// Smaller jumps are rounding: files keep about seven digits.
        const ROUNDING: f64 = 1e-6;
        let jump = |joint: Joint| {
            let ([before, after], _) = self.slopes(&joint);
            (after - before).hypot() / before.hypot().max(after.hypot()).max(f64::MIN_POSITIVE)
        };
        let kinks = self.joints().into_iter().map(jump).filter(|jump| *jump > ROUNDING);
        kinks.fold((0, 0.0), |(count, worst), jump| (count + 1, f64::max(worst, jump)))
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
