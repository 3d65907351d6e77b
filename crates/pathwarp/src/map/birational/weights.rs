//! The weights of the rows: general position, and the normalisation over all pieces.

use super::monoid::{ImplicitLine, Monoid};
use crate::error::GeometryError;
use kurbo::{Point, Rect};

/// Points closer to a line than this share of the lattice's size count as on it.
const ON_LINE: f64 = 1e-9;

/// The two rows as monoids, with the speed of t still arbitrary. Checks that the points are in general position.
pub(super) fn general_rows(
    points: &[Vec<Point>; 2],
    allow_poles: bool,
    names: &[String; 2],
) -> Result<[Monoid; 2], GeometryError> {
    let n = points[0].len() - 1;
    let b = points.iter().flatten().fold(Rect::from_points(points[0][0], points[0][0]), |b, p| b.union_pt(*p));
    let size = b.width().hypot(b.height());
    let mut lines = [0, n].map(|j| ImplicitLine::join(points[0][j], points[1][j]));
    for (line, j) in lines.iter_mut().zip([0, n]) {
        let length = line.normal.hypot();
        if length <= ON_LINE * size {
            let path = format!("{} and {}", names[0], names[1]);
            return Err(GeometryError::Coincident { path, which: [j + 1, j + 1], at: points[0][j] });
        }
        // Scale to values near 1 within the lattice, so that n-th powers stay in range.
        *line = line.scaled(1.0 / (length * size));
    }
    let [first, last] = lines;
    let side = if first.at(points[0][n]) >= 0.0 { 1.0 } else { -1.0 };
    for (row, name) in points.iter().zip(names) {
        for (i, p) in row.iter().enumerate() {
            let off = [(i > 0, side * first.at(*p), "first"), (i < n, -side * last.at(*p), "last")];
            for (counts, d, end) in off {
                if counts && (d <= ON_LINE && !allow_poles || d.abs() <= ON_LINE) {
                    let j = if end == "first" { 0 } else { n };
                    return Err(GeometryError::WrongSide {
                        path: name.clone(),
                        which: i + 1,
                        at: *p,
                        end,
                        line: [points[0][j], points[1][j]],
                        on: d.abs() <= ON_LINE,
                    });
                }
            }
        }
    }
    let not_finite = || GeometryError::NotFinite { shape: names[0].clone(), at: points[0][0] };
    let [a, b] = points;
    let rows = Monoid::new(a, first, last).zip(Monoid::new(b, first, last));
    rows.map(|(a, b)| [a, b]).ok_or_else(not_finite)
}

/// Normalises the speeds and the common factors of the rows, piece after piece.
pub(super) fn chained(raw: Vec<[Monoid; 2]>) -> Option<Vec<[Monoid; 2]>> {
    let n = raw[0][0].points().len() - 1;
    let product = |rows: &[Monoid; 2], over: usize, under: usize| -> f64 {
        rows.iter().map(|m| (m.weights()[over] / m.weights()[under]).abs().ln()).sum()
    };
    // ln g is alternately a + x and a − x; x brings the end weights as close to 1 as possible.
    let mut a = vec![0.0];
    for w in raw.windows(2) {
        let next = 0.5 * (product(&w[0], n - 1, n) - product(&w[1], 1, 0)) - a[a.len() - 1];
        a.push(next);
    }
    let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let ends = raw.iter().zip(&a).enumerate();
    let sum: f64 = ends.map(|(k, (rows, a))| sign(k) * (product(rows, n, 0) + 2.0 * n as f64 * a)).sum();
    let x = -sum / (2 * n * raw.len()) as f64;
    let mut factor = [1.0; 2];
    let mut out = Vec::with_capacity(raw.len());
    for (k, (rows, a)) in raw.into_iter().zip(a).enumerate() {
        let g = (a + sign(k) * x).exp();
        let [p, q] = rows;
        let pair = [p.paced(g)?.weighted(factor[0]), q.paced(g)?.weighted(factor[1])];
        factor = [0, 1].map(|r| pair[r].weights()[n]);
        out.push(pair);
    }
    Some(out)
}
