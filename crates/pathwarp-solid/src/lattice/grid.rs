//! The lattice as data: control points and weights over a box.

use crate::box3::Box3;
use crate::map::{Local, Tensor};
use glam::DVec3;
use pathwarp::map::bspline;

/// A grid of weighted control points over a box: the data of a [`LatticeMap3`](super::LatticeMap3).
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice3 {
    region: Box3,
    degree: [usize; 3],
    cells: [usize; 3],
    /// Regular positions along x, y and z, from 0 to 1.
    places: [Vec<f64>; 3],
    /// Displacements from the regular positions; x runs fastest.
    moves: Vec<DVec3>,
    weights: Vec<f64>,
}

/// The polynomials of one cell.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Piece {
    /// Displacements.
    Displacement(Tensor<3>),
    /// Weighted points and weights.
    Quotient(Tensor<4>),
}

impl Lattice3 {
    /// The lattice that is the identity: `degree` along each axis (at least 1), `cells` Bézier pieces along each (1 for a Bézier
    /// lattice).
    #[must_use]
    pub fn regular(region: Box3, degree: [usize; 3], cells: [usize; 3]) -> Self {
        let (degree, cells) = (degree.map(|d| d.max(1)), cells.map(|c| c.max(1)));
        let places = [0, 1, 2].map(|a| bspline::regular(degree[a], cells[a]));
        let count = places.iter().map(Vec::len).product();
        Self { region, degree, cells, places, moves: vec![DVec3::ZERO; count], weights: vec![1.0; count] }
    }

    /// Degrees along the axes.
    #[must_use]
    pub fn degree(&self) -> [usize; 3] {
        self.degree
    }

    /// Bézier pieces along the axes.
    #[must_use]
    pub fn cells(&self) -> [usize; 3] {
        self.cells
    }

    /// The box that the lattice deforms.
    #[must_use]
    pub fn region(&self) -> Box3 {
        self.region
    }

    /// Numbers of control points along the axes.
    #[must_use]
    pub fn size(&self) -> [usize; 3] {
        [0, 1, 2].map(|a| self.places[a].len())
    }

    /// All control points' numbers; the first runs fastest.
    pub fn nodes(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [nx, ny, nz] = self.size();
        (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])))
    }

    /// Returns `true` if there is such a control point.
    #[must_use]
    pub fn has(&self, node: [usize; 3]) -> bool {
        node.iter().zip(self.size()).all(|(n, size)| *n < size)
    }

    /// The position of a control point in the order of [`nodes`](Self::nodes).
    #[must_use]
    pub fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.places[1].len() + j) * self.places[0].len() + i
    }

    /// A control point's place in the identity.
    #[must_use]
    pub fn regular_point(&self, node: [usize; 3]) -> DVec3 {
        let at = |a: usize| self.places[a][node[a]];
        self.region.min + DVec3::new(at(0), at(1), at(2)) * self.region.size()
    }

    /// A control point.
    #[must_use]
    pub fn point(&self, node: [usize; 3]) -> DVec3 {
        self.regular_point(node) + self.moves[self.index(node)]
    }

    /// Puts a control point at `p`.
    pub fn place(&mut self, node: [usize; 3], p: DVec3) {
        let n = self.index(node);
        self.moves[n] = p - self.regular_point(node);
    }

    /// Moves a control point by `v`.
    pub fn shift(&mut self, node: [usize; 3], v: DVec3) {
        let n = self.index(node);
        self.moves[n] += v;
    }

    /// The weight of a control point.
    #[must_use]
    pub fn weight(&self, node: [usize; 3]) -> f64 {
        self.weights[self.index(node)]
    }

    /// Sets the weight of a control point.
    pub fn set_weight(&mut self, node: [usize; 3], w: f64) {
        let n = self.index(node);
        self.weights[n] = w;
    }

    /// Returns `true` if a control point differs from its regular position by more than rounding, or its weight from 1.
    #[must_use]
    pub fn is_changed(&self, node: [usize; 3]) -> bool {
        let size = self.region.diagonal() + self.region.min.length();
        let n = self.index(node);
        self.moves[n].length() > 1e-12 * size || self.weights[n] != 1.0
    }

    /// The same lattice scaled to another box.
    #[must_use]
    pub fn on(&self, region: Box3) -> Self {
        let scale = region.size() / self.region.size();
        Self { region, moves: self.moves.iter().map(|v| *v * scale).collect(), ..self.clone() }
    }

    /// The influence of the control points at `p`: their numbers and Nᵢ·Nⱼ·Nₖ·wᵢⱼₖ / Σ, which add up to 1.
    #[must_use]
    pub fn influence(&self, p: DVec3) -> Vec<([usize; 3], f64)> {
        let at = ((p - self.region.min) / self.region.size()).to_array();
        let along = [0, 1, 2].map(|a| bspline::basis(self.degree[a], self.cells[a], at[a]));
        let [(i0, across), (j0, up), (k0, front)] = &along;
        let mut out = Vec::with_capacity(across.len() * up.len() * front.len());
        for (k, c) in front.iter().enumerate() {
            for (j, b) in up.iter().enumerate() {
                for (i, a) in across.iter().enumerate() {
                    let node = [i0 + i, j0 + j, k0 + k];
                    out.push((node, a * b * c * self.weight(node)));
                }
            }
        }
        let sum: f64 = out.iter().map(|v| v.1).sum();
        out.iter_mut().for_each(|v| v.1 /= sum);
        out
    }

    /// The coordinates of one cell, −1 to 1.
    pub(super) fn local(&self, cell: [usize; 3]) -> Local {
        let cells = DVec3::from_array(self.cells.map(|c| c as f64));
        let middle = (DVec3::from_array(cell.map(|c| c as f64)) + 0.5) / cells;
        let size = self.region.size();
        Local { middle: self.region.min + middle * size, scale: 2.0 * cells / size }
    }

    /// The polynomials of one cell.
    pub(super) fn piece(&self, cell: [usize; 3]) -> Piece {
        let matrices = [0, 1, 2].map(|a| bspline::extraction(self.degree[a], self.cells[a]).swap_remove(cell[a]));
        let size = self.degree.map(|d| d + 1);
        if self.weights.iter().all(|w| *w == self.weights[0]) {
            let moves: Vec<[f64; 3]> = self.moves.iter().map(DVec3::to_array).collect();
            Piece::Displacement(Tensor::bernstein(size, self.bezier(cell, &matrices, &moves)))
        } else {
            let weighted =
                |node: [usize; 3]| (self.point(node) * self.weight(node)).extend(self.weight(node)).to_array();
            let all: Vec<[f64; 4]> = self.nodes().map(weighted).collect();
            Piece::Quotient(Tensor::bernstein(size, self.bezier(cell, &matrices, &all)))
        }
    }

    /// The Bézier coefficients of one cell of a spline with these coefficients.
    fn bezier<const C: usize>(&self, cell: [usize; 3], matrices: &[Vec<Vec<f64>>; 3], c: &[[f64; C]]) -> Vec<[f64; C]> {
        let [a, b, d] = matrices;
        let mut out = Vec::with_capacity(a.len() * b.len() * d.len());
        for front in d {
            for up in b {
                for across in a {
                    let mut sum = [0.0; C];
                    for (k, kc) in front.iter().enumerate() {
                        for (j, kb) in up.iter().enumerate() {
                            for (i, ka) in across.iter().enumerate() {
                                let from = &c[self.index([cell[0] + i, cell[1] + j, cell[2] + k])];
                                sum.iter_mut().zip(from).for_each(|(s, v)| *s += ka * kb * kc * v);
                            }
                        }
                    }
                    out.push(sum);
                }
            }
        }
        out
    }
}
