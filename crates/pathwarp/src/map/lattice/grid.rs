//! The lattice as data: control points and weights over a region.

use crate::map::nets::{Patch, bspline};
use kurbo::{Affine, Point, Rect, Vec2};

/// A grid of weighted control points over a region: the data of a [`LatticeMap`](super::LatticeMap).
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    region: Rect,
    degree: [usize; 2],
    cells: [usize; 2],
    /// Regular positions along x and y, from 0 to 1.
    places: [Vec<f64>; 2],
    /// Displacements from the regular positions, row by row.
    moves: Vec<Vec2>,
    weights: Vec<f64>,
}

impl Lattice {
    /// The lattice that is the identity: `degree` along x and y (at least 1), `cells` Bézier pieces along x and y (1 for a Bézier
    /// lattice).
    #[must_use]
    pub fn regular(region: Rect, degree: [usize; 2], cells: [usize; 2]) -> Self {
        let (degree, cells) = (degree.map(|d| d.max(1)), cells.map(|c| c.max(1)));
        let places = [0, 1].map(|k| bspline::regular(degree[k], cells[k]));
        let count = places[0].len() * places[1].len();
        Self { region, degree, cells, places, moves: vec![Vec2::ZERO; count], weights: vec![1.0; count] }
    }

    /// Degrees along x and y.
    #[must_use]
    pub fn degree(&self) -> [usize; 2] {
        self.degree
    }

    /// Bézier pieces along x and y.
    #[must_use]
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// The box that the lattice deforms.
    #[must_use]
    pub fn region(&self) -> Rect {
        self.region
    }

    /// Number of control points along x.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.places[0].len()
    }

    /// Number of control points along y.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.places[1].len()
    }

    fn index(&self, i: usize, j: usize) -> usize {
        j * self.columns() + i
    }

    /// The position of control point (i, j) in the identity.
    #[must_use]
    pub fn regular_point(&self, i: usize, j: usize) -> Point {
        let r = self.region;
        Point::new(r.x0 + self.places[0][i] * r.width(), r.y0 + self.places[1][j] * r.height())
    }

    /// Control point (i, j).
    #[must_use]
    pub fn point(&self, i: usize, j: usize) -> Point {
        self.regular_point(i, j) + self.moves[self.index(i, j)]
    }

    /// Moves control point (i, j) to `p`.
    pub fn place(&mut self, i: usize, j: usize, p: Point) {
        let k = self.index(i, j);
        self.moves[k] = p - self.regular_point(i, j);
    }

    /// Moves control point (i, j) by `v`.
    pub fn shift(&mut self, i: usize, j: usize, v: Vec2) {
        let k = self.index(i, j);
        self.moves[k] += v;
    }

    /// The weight of control point (i, j).
    #[must_use]
    pub fn weight(&self, i: usize, j: usize) -> f64 {
        self.weights[self.index(i, j)]
    }

    /// Sets the weight of control point (i, j).
    pub fn set_weight(&mut self, i: usize, j: usize, w: f64) {
        let k = self.index(i, j);
        self.weights[k] = w;
    }

    /// Returns `true` if control point (i, j) differs from its regular position by more than rounding, or its weight from 1.
    #[must_use]
    pub fn is_changed(&self, i: usize, j: usize) -> bool {
        let r = self.region;
        let size = r.width() + r.height() + r.x0.abs() + r.y0.abs();
        let k = self.index(i, j);
        self.moves[k].hypot() > 1e-12 * size || self.weights[k] != 1.0
    }

    /// The same lattice scaled to another region.
    #[must_use]
    pub fn on(&self, region: Rect) -> Self {
        let (kx, ky) = (region.width() / self.region.width(), region.height() / self.region.height());
        let moves = self.moves.iter().map(|v| Vec2::new(v.x * kx, v.y * ky)).collect();
        Self { region, moves, ..self.clone() }
    }

    /// The influence of the control points at `p`: pairs of (i, j) and Nᵢ(s)·Nⱼ(t)·wᵢⱼ / Σ, which add up to 1.
    #[must_use]
    pub fn influence(&self, p: Point) -> Vec<((usize, usize), f64)> {
        let r = self.region;
        let at = [(p.x - r.x0) / r.width(), (p.y - r.y0) / r.height()];
        let [(i0, across), (j0, down)] = [0, 1].map(|k| bspline::basis(self.degree[k], self.cells[k], at[k]));
        let mut out = Vec::with_capacity(across.len() * down.len());
        for (j, b) in down.iter().enumerate() {
            for (i, a) in across.iter().enumerate() {
                out.push(((i0 + i, j0 + j), a * b * self.weight(i0 + i, j0 + j)));
            }
        }
        let sum: f64 = out.iter().map(|v| v.1).sum();
        for v in &mut out {
            v.1 /= sum;
        }
        out
    }

    /// The patch of one cell.
    pub(super) fn patch(&self, [ci, cj]: [usize; 2]) -> Patch {
        let cell = |a: f64, size: f64, c: usize, n: usize| {
            (a + size * (c as f64 / n as f64), a + size * ((c + 1) as f64 / n as f64))
        };
        let r = self.region;
        let (x0, x1) = cell(r.x0, r.width(), ci, self.cells[0]);
        let (y0, y1) = cell(r.y0, r.height(), cj, self.cells[1]);
        let rect = Rect::new(x0, y0, x1, y1);
        let across = &bspline::extraction(self.degree[0], self.cells[0])[ci];
        let down = &bspline::extraction(self.degree[1], self.cells[1])[cj];
        let (m, n) = (self.degree[0], self.degree[1]);
        let mut polynomial = Vec::with_capacity((m + 1) * (n + 1));
        let mut rational = Vec::with_capacity((m + 1) * (n + 1));
        for b in down {
            for a in across {
                let (mut v, mut h) = (Vec2::ZERO, [0.0; 3]);
                for (dj, kb) in b.iter().enumerate() {
                    for (di, ka) in a.iter().enumerate() {
                        let (i, j) = (ci + di, cj + dj);
                        let (p, w) = (self.point(i, j), self.weight(i, j));
                        v += self.moves[self.index(i, j)] * (ka * kb);
                        for (h, c) in h.iter_mut().zip([p.x * w, p.y * w, w]) {
                            *h += ka * kb * c;
                        }
                    }
                }
                polynomial.push(v);
                rational.push(h);
            }
        }
        if self.weights.iter().all(|w| *w == self.weights[0]) {
            Patch::polynomial(rect, self.degree, &polynomial)
        } else {
            Patch::rational(rect, self.degree, &rational)
        }
    }

    /// The lattice as an affine map, if its points are an affine image of the regular ones and all weights are equal.
    pub(super) fn as_affine(&self) -> Option<Affine> {
        let (m, n, r) = (self.columns() - 1, self.rows() - 1, self.region);
        if self.weights.iter().any(|w| *w != self.weights[0]) {
            return None;
        }
        let [o, u, v] = [(0, 0), (m, 0), (0, n)].map(|(i, j)| self.moves[self.index(i, j)]);
        let (u, v) = ((u - o) / r.width(), (v - o) / r.height());
        let size = self.moves.iter().map(|d| d.hypot()).fold(0.0, f64::max);
        for j in 0..=n {
            for i in 0..=m {
                let at = self.regular_point(i, j) - r.origin();
                if (o + u * at.x + v * at.y - self.moves[self.index(i, j)]).hypot() > 1e-14 * size {
                    return None;
                }
            }
        }
        let shift = o - u * r.x0 - v * r.y0;
        Some(Affine::new([1.0 + u.x, u.y, v.x, 1.0 + v.y, shift.x, shift.y]))
    }
}
