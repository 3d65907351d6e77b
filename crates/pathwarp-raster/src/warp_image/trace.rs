//! Approximates the source points of the pixels of a tile by a cubic polynomial in column and row.
//!
//! Evaluating the inverse map for every pixel costs more than everything else. Over a few pixels its bicubic interpolant at the
//! 4 × 4 Chebyshev points is as accurate. Nine further values, at the extrema of the leading term of the interpolation error,
//! measure the error; if it exceeds [`MAX_ERROR`], smaller tiles are tried.

use kurbo::{Point, Vec2};
use pathwarp::map::Jet;

/// Largest error of a source point, in source pixels. At an edge from black to white within a pixel, it is a quarter of a level.
pub(super) const MAX_ERROR: f64 = 1.0 / 1024.0;
/// Interpolation points along a side.
const NODES: usize = 4;
/// Check points along a side: both ends and the middle.
const CHECKS: usize = 3;
/// Number of values of the inverse per tile.
pub(super) const SAMPLES: usize = NODES * NODES + CHECKS * CHECKS;

/// Coefficients of 1, u, u², u³.
type Cubic = [f64; NODES];

/// Converts values at the Chebyshev points of 0..1 to the coefficients of a cubic.
pub(super) struct ChebyshevBasis {
    nodes: [f64; NODES],
    /// The Lagrange polynomials of the nodes.
    lagrange: [Cubic; NODES],
}

impl ChebyshevBasis {
    pub(super) fn new() -> Self {
        let angle = |k: usize| (2 * k + 1) as f64 * std::f64::consts::PI / (2 * NODES) as f64;
        let nodes: [f64; NODES] = std::array::from_fn(|k| 0.5 - 0.5 * angle(k).cos());
        let lagrange = std::array::from_fn(|k| {
            let mut product = [1.0, 0.0, 0.0, 0.0];
            for (_, other) in nodes.iter().enumerate().filter(|(j, _)| *j != k) {
                let (before, scale) = (product, 1.0 / (nodes[k] - other));
                for (i, c) in product.iter_mut().enumerate() {
                    *c = scale * (if i > 0 { before[i - 1] } else { 0.0 } - other * before[i]);
                }
            }
            product
        });
        Self { nodes, lagrange }
    }

    /// The sample points as fractions of the width and height of the tile.
    pub(super) fn sample_points(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let nodes = self.nodes.iter().flat_map(|v| self.nodes.iter().map(move |u| (*u, *v)));
        let checks = (0..CHECKS * CHECKS).map(|k| (0.5 * (k % CHECKS) as f64, 0.5 * (k / CHECKS) as f64));
        nodes.chain(checks)
    }

    /// Interpolates the values; `None` if the error at a check point is too large. `size` is the distance between the first and the
    /// last column and row.
    pub(super) fn interpolate(&self, values: &[Point; SAMPLES], size: (f64, f64)) -> Option<Trace> {
        let mut coefficients = [[[0.0; 2]; NODES]; NODES];
        for (k, p) in values[..NODES * NODES].iter().enumerate() {
            let (column, row) = (&self.lagrange[k % NODES], &self.lagrange[k / NODES]);
            for (line, b) in coefficients.iter_mut().zip(row) {
                for (c, a) in line.iter_mut().zip(column) {
                    c[0] += a * b * p.x;
                    c[1] += a * b * p.y;
                }
            }
        }
        let out = Trace { coefficients, per_pixel: (1.0 / size.0, 1.0 / size.1) };
        let checks = self.sample_points().zip(values).skip(NODES * NODES);
        // Without an inverse, the distance is NaN.
        let is_close = |((u, v), p): ((f64, f64), &Point)| (out.jet_at(u, v).p - *p).hypot() <= MAX_ERROR;
        checks.into_iter().all(is_close).then_some(out)
    }
}

pub(super) struct Trace {
    /// Coefficients of both coordinates of the source point by powers of v, then of u.
    coefficients: [[[f64; 2]; NODES]; NODES],
    /// Change of u and v from a pixel to the next.
    per_pixel: (f64, f64),
}

impl Trace {
    /// The jet at a fraction of width and height; its derivatives are per pixel.
    pub(super) fn jet_at(&self, u: f64, v: f64) -> Jet {
        self.row(v).jet(u)
    }

    /// The jet at a column and row.
    pub(super) fn pixel(&self, column: usize, row: usize) -> Jet {
        self.jet_at(column as f64 * self.per_pixel.0, row as f64 * self.per_pixel.1)
    }

    /// The row at a fraction of the height.
    fn row(&self, v: f64) -> TraceRow {
        let [a, b, c, d] = &self.coefficients;
        let mut out = TraceRow { point: [[0.0; 2]; NODES], down: [[0.0; 2]; NODES], per_column: self.per_pixel.0 };
        for i in 0..NODES {
            for k in 0..2 {
                out.point[i][k] = ((d[i][k] * v + c[i][k]) * v + b[i][k]) * v + a[i][k];
                out.down[i][k] = ((3.0 * d[i][k] * v + 2.0 * c[i][k]) * v + b[i][k]) * self.per_pixel.1;
            }
        }
        out
    }

    pub(super) fn pixel_row(&self, j: usize) -> TraceRow {
        self.row(j as f64 * self.per_pixel.1)
    }
}

/// One row of a tile: polynomials in the fraction of its width, for the source point and its derivative from row to row.
pub(super) struct TraceRow {
    point: [[f64; 2]; NODES],
    down: [[f64; 2]; NODES],
    /// Change of the fraction from a column to the next.
    per_column: f64,
}

impl TraceRow {
    /// The source point of a column.
    pub(super) fn point(&self, column: usize) -> Point {
        let (u, [a, b, c, d]) = (column as f64 * self.per_column, &self.point);
        let value = |k: usize| ((d[k] * u + c[k]) * u + b[k]) * u + a[k];
        Point::new(value(0), value(1))
    }

    fn jet(&self, u: f64) -> Jet {
        let value = |c: &[[f64; 2]; NODES], k: usize| ((c[3][k] * u + c[2][k]) * u + c[1][k]) * u + c[0][k];
        let slope = |k: usize| {
            let c = &self.point;
            ((3.0 * c[3][k] * u + 2.0 * c[2][k]) * u + c[1][k]) * self.per_column
        };
        Jet {
            p: Point::new(value(&self.point, 0), value(&self.point, 1)),
            dx: Vec2::new(slope(0), slope(1)),
            dy: Vec2::new(value(&self.down, 0), value(&self.down, 1)),
        }
    }

    /// Coefficients of one coordinate of the source point minus `base`, by powers of the column.
    pub(super) fn coordinate(&self, coordinate: usize, base: f64) -> [f32; NODES] {
        self.by_column(&self.point, coordinate, base)
    }

    /// Coefficients of the derivative from row to row.
    pub(super) fn down(&self, coordinate: usize) -> [f32; NODES] {
        self.by_column(&self.down, coordinate, 0.0)
    }

    fn by_column(&self, c: &[[f64; 2]; NODES], coordinate: usize, base: f64) -> [f32; NODES] {
        let mut scale = 1.0;
        std::array::from_fn(|i| {
            let out = (c[i][coordinate] - if i == 0 { base } else { 0.0 }) * scale;
            scale *= self.per_column;
            out as f32
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trace(f: impl Fn(f64, f64) -> Point) -> Option<Trace> {
        let basis = ChebyshevBasis::new();
        let mut values = [Point::ORIGIN; SAMPLES];
        for (a, (u, v)) in values.iter_mut().zip(basis.sample_points()) {
            *a = f(31.0 * u, 31.0 * v);
        }
        basis.interpolate(&values, (31.0, 31.0))
    }

    #[test]
    fn a_cubic_and_its_derivatives_are_reproduced() {
        let f = |x: f64, y: f64| Point::new(3.0 + x - 0.01 * x * y + 1e-4 * y.powi(3), 2.0 * y + 1e-4 * x * x * y);
        let found = trace(f).unwrap();
        for (i, j) in (0..32).flat_map(|i| (0..32).map(move |j| (i, j))) {
            let (x, y) = (i as f64, j as f64);
            let jet = found.pixel(i, j);
            assert!((jet.p - f(x, y)).hypot() < 1e-11);
            assert!((jet.dx - Vec2::new(1.0 - 0.01 * y, 2e-4 * x * y)).hypot() < 1e-11);
            assert!((jet.dy - Vec2::new(3e-4 * y * y - 0.01 * x, 2.0 + 1e-4 * x * x)).hypot() < 1e-11);
            let row = found.pixel_row(j);
            for (k, want) in [jet.p.x, jet.p.y].into_iter().enumerate() {
                let c = row.coordinate(k, 3.0);
                let x = i as f32;
                let got = ((c[3] * x + c[2]) * x + c[1]) * x + c[0];
                assert!((f64::from(got) + 3.0 - want).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn other_functions_are_close_or_rejected() {
        let wave = |length: f64| move |x: f64, y: f64| Point::new(x + 5.0 * (y / length).sin(), y);
        let found = trace(wave(100.0)).unwrap();
        let off = |j: usize| (found.pixel(0, j).p.x - wave(100.0)(0.0, j as f64).x).abs();
        assert!((0..32).all(|j| off(j) < 1.1 * MAX_ERROR));
        assert!(trace(wave(20.0)).is_none());
        // A fold, and undefined values.
        assert!(trace(|x, y| Point::new((x - 11.0).abs(), y)).is_none());
        assert!(trace(|x, y| Point::new(x, if x + y > 60.0 { f64::NAN } else { y })).is_none());
    }
}
