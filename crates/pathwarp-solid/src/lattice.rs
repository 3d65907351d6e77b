//! Free-form deformation of space by lattices of control points.
//!
//! > X(s,t,u) = Σₖ Σⱼ Σᵢ Nᵢ(s) Nⱼ(t) Nₖ(u) wᵢⱼₖ (xᵢⱼₖ, yᵢⱼₖ, zᵢⱼₖ, 1)
//!
//! with s, t, u from 0 to 1 across a box and Bernstein polynomials or uniform clamped B-splines N (T. W. Sederberg, S. R. Parry,
//! *Free-form deformation of solid geometric models*, SIGGRAPH 1986; with weights: P. Kalra et al., 1992). i counts from the
//! left, j from the bottom, k from the back.
//!
//! Nothing moves outside the box unless the map is extended, so the faces are creases. If the k + 1 outermost layers along a face
//! are in their regular positions with weights 1, the map is Cᵏ across that face.

use crate::map::{
    Chart, Collineation, Creases3, Displaced, Fraction3, Jet3, Local, Map3, NewtonInverse3, Poly3, Quotient, Tensor,
    for_all,
};
use crate::settings::{Box3, grid};
use glam::{DMat3, DVec3};
use pathwarp::budget::Budget;
use pathwarp::engine::bspline;
use std::sync::Arc;

/// A grid of weighted control points over a box: the data of a [`LatticeMap3`].
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice3 {
    region: Box3,
    degree: [usize; 3],
    cells: [usize; 3],
    /// Regular positions along x, y and z, from 0 to 1, by number.
    regular: [Vec<f64>; 3],
    /// Displacements from the regular positions, with x running fastest.
    displacements: Vec<DVec3>,
    weights: Vec<f64>,
}

/// The polynomials of one cell.
#[derive(Debug, Clone, PartialEq)]
enum Piece {
    /// Displacements.
    Displacement(Tensor<3>),
    /// Weighted points and weights.
    Quotient(Tensor<4>),
}

impl Lattice3 {
    /// Makes a lattice that is the identity, with a `degree` of at least 1 and a number of Bézier pieces, `cells`, along each axis. A
    /// Bézier lattice has a single piece.
    #[must_use]
    pub fn regular(region: Box3, degree: [usize; 3], cells: [usize; 3]) -> Self {
        let (degree, cells) = (degree.map(|d| d.max(1)), cells.map(|c| c.max(1)));
        let regular = [0, 1, 2].map(|a| bspline::regular(degree[a], cells[a]));
        let count = regular.iter().map(Vec::len).product();
        Self { region, degree, cells, regular, displacements: vec![DVec3::ZERO; count], weights: vec![1.0; count] }
    }

    /// Returns the degrees along the axes.
    #[must_use]
    pub fn degree(&self) -> [usize; 3] {
        self.degree
    }

    /// Returns the numbers of Bézier pieces along the axes.
    #[must_use]
    pub fn cells(&self) -> [usize; 3] {
        self.cells
    }

    /// Returns the box that the lattice deforms.
    #[must_use]
    pub fn region(&self) -> Box3 {
        self.region
    }

    /// Returns the numbers of control points along the axes.
    #[must_use]
    pub fn size(&self) -> [usize; 3] {
        self.regular.each_ref().map(Vec::len)
    }

    /// Iterates over the numbers of all control points, with the first running fastest.
    pub fn nodes(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        grid(self.size())
    }

    /// Returns `true` if a control point exists.
    #[must_use]
    pub fn has(&self, node: [usize; 3]) -> bool {
        node.iter().zip(self.size()).all(|(n, size)| *n < size)
    }

    /// Returns the index of a control point in the order of [`nodes`](Self::nodes).
    #[must_use]
    pub fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.regular[1].len() + j) * self.regular[0].len() + i
    }

    /// Returns the position of a control point in the identity.
    #[must_use]
    pub fn regular_point(&self, node: [usize; 3]) -> DVec3 {
        self.region.min + DVec3::from_array([0, 1, 2].map(|a| self.regular[a][node[a]])) * self.region.size()
    }

    /// Returns the position of a control point.
    #[must_use]
    pub fn point(&self, node: [usize; 3]) -> DVec3 {
        self.regular_point(node) + self.displacements[self.index(node)]
    }

    /// Puts a control point at `p`.
    pub fn place(&mut self, node: [usize; 3], p: DVec3) {
        let n = self.index(node);
        self.displacements[n] = p - self.regular_point(node);
    }

    /// Moves a control point by `v`.
    pub fn shift(&mut self, node: [usize; 3], v: DVec3) {
        let n = self.index(node);
        self.displacements[n] += v;
    }

    /// Returns the weight of a control point.
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
        self.displacements[n].length() > ROUNDING * size || self.weights[n] != 1.0
    }

    /// Scales the lattice to another box.
    #[must_use]
    pub fn on(&self, region: Box3) -> Self {
        let scale = region.size() / self.region.size();
        Self { region, displacements: self.displacements.iter().map(|v| *v * scale).collect(), ..self.clone() }
    }

    /// Returns the influences of control points on `p`, with their numbers: Nᵢ·Nⱼ·Nₖ·wᵢⱼₖ / Σ, which add up to 1.
    #[must_use]
    pub fn influence(&self, p: DVec3) -> Vec<([usize; 3], f64)> {
        let at = ((p - self.region.min) / self.region.size()).to_array();
        let along = [0, 1, 2].map(|a| bspline::basis(self.degree[a], self.cells[a], at[a]));
        let [(i0, across), (j0, up), (k0, front)] = &along;
        let influence = |[i, j, k]: [usize; 3]| {
            let node = [i0 + i, j0 + j, k0 + k];
            (node, across[i] * up[j] * front[k] * self.weight(node))
        };
        let mut out: Vec<_> = grid([across.len(), up.len(), front.len()]).map(influence).collect();
        let sum: f64 = out.iter().map(|v| v.1).sum();
        out.iter_mut().for_each(|v| v.1 /= sum);
        out
    }

    /// Returns the coordinates of one cell, from −1 to 1.
    fn local(&self, cell: [usize; 3]) -> Local {
        let cells = DVec3::from_array(self.cells.map(|c| c as f64));
        let middle = (DVec3::from_array(cell.map(|c| c as f64)) + 0.5) / cells;
        let size = self.region.size();
        Local { middle: self.region.min + middle * size, scale: 2.0 * cells / size }
    }

    /// Returns the polynomials of one cell.
    fn piece(&self, cell: [usize; 3]) -> Piece {
        let matrices = [0, 1, 2].map(|a| bspline::extraction(self.degree[a], self.cells[a]).swap_remove(cell[a]));
        let size = self.degree.map(|d| d + 1);
        if self.weights.iter().all(|w| *w == self.weights[0]) {
            let displacements: Vec<[f64; 3]> = self.displacements.iter().map(DVec3::to_array).collect();
            Piece::Displacement(Tensor::bernstein(size, self.bezier(cell, &matrices, &displacements)))
        } else {
            let weighted =
                |node: [usize; 3]| (self.point(node) * self.weight(node)).extend(self.weight(node)).to_array();
            let points: Vec<[f64; 4]> = self.nodes().map(weighted).collect();
            Piece::Quotient(Tensor::bernstein(size, self.bezier(cell, &matrices, &points)))
        }
    }

    /// Returns the Bézier coefficients of one cell of a spline with the coefficients `c`, from the extraction matrices along the axes.
    fn bezier<const C: usize>(&self, cell: [usize; 3], matrices: &[Vec<Vec<f64>>; 3], c: &[[f64; C]]) -> Vec<[f64; C]> {
        let coefficient = |row: [usize; 3]| {
            let [across, up, front] = [0, 1, 2].map(|a| &matrices[a][row[a]]);
            let mut sum = [0.0; C];
            for [i, j, k] in grid([across.len(), up.len(), front.len()]) {
                let from = &c[self.index([cell[0] + i, cell[1] + j, cell[2] + k])];
                sum.iter_mut().zip(from).for_each(|(s, v)| *s += across[i] * up[j] * front[k] * v);
            }
            sum
        };
        grid(matrices.each_ref().map(Vec::len)).map(coefficient).collect()
    }
}

/// Distance, relative to the coordinates, that counts as rounding: points outside but so near to a face count as inside.
const ROUNDING: f64 = 1e-12;

/// Free-form deformation of space by a [`Lattice3`] of control points.
///
/// ```
/// use glam::DVec3;
/// use pathwarp_solid::{Box3, Lattice3, LatticeMap3, map::Map3};
///
/// let mut lattice = Lattice3::regular(Box3::new(DVec3::ZERO, DVec3::splat(90.0)), [2, 2, 2], [1, 1, 1]);
/// lattice.shift([1, 1, 1], DVec3::new(0.0, 16.0, 0.0));
/// let map = LatticeMap3::new(&lattice, false);
/// assert_eq!(map.point(DVec3::splat(45.0)), DVec3::new(45.0, 47.0, 45.0));
/// assert_eq!(map.point(DVec3::splat(100.0)), DVec3::splat(100.0)); // outside the box
/// ```
#[derive(Debug, Clone)]
pub struct LatticeMap3 {
    region: Box3,
    /// The region, enlarged to allow for rounding.
    inside: Box3,
    cells: [usize; 3],
    /// The pieces, with x running fastest.
    pieces: Arc<[(Local, Piece)]>,
    /// `true` if the outermost pieces continue beyond the region.
    extended: bool,
}

impl LatticeMap3 {
    /// Makes the map of `lattice`. Outside its box, the map is the identity or, if `extended`, continues the outermost pieces.
    #[must_use]
    pub fn new(lattice: &Lattice3, extended: bool) -> Self {
        let region = lattice.region();
        let rounding = ROUNDING * (region.min.abs().max_element() + region.max.abs().max_element());
        Self {
            region,
            inside: region.inflate(DVec3::splat(rounding)),
            cells: lattice.cells(),
            pieces: grid(lattice.cells()).map(|c| (lattice.local(c), lattice.piece(c))).collect(),
            extended,
        }
    }

    /// Returns the piece at `p`, or `None` outside the region, where nothing moves.
    fn piece(&self, p: DVec3) -> Option<&(Local, Piece)> {
        if !self.extended && !self.inside.contains(p) {
            return None;
        }
        if self.pieces.len() == 1 {
            return self.pieces.first();
        }
        let t = (p - self.region.min) / self.region.size();
        // Casting a negative number gives 0.
        let at = |a: usize| ((t[a] * self.cells[a] as f64) as usize).min(self.cells[a] - 1);
        self.pieces.get((at(2) * self.cells[1] + at(1)) * self.cells[0] + at(0))
    }

    /// Returns the piece that applies to a whole box, `Some(None)` if nothing moves there, or `None` if a crease may cross the box.
    fn piece_on(&self, on: &Box3) -> Option<Option<&(Local, Piece)>> {
        let slack = 4.0 * (self.inside.max - self.region.max);
        let is_covered = self.extended || (self.inside.contains(on.min) && self.inside.contains(on.max));
        if !is_covered {
            let beside = on.max.cmple(self.region.min + slack).any() || on.min.cmpge(self.region.max - slack).any();
            return beside.then_some(None);
        }
        // Compare the cells of the corners, moved inwards. Along an axis on which the box is flat they are not moved: the box may lie in a
        // crease.
        let middle = on.center();
        let cell = |p: DVec3| self.piece(p).map(std::ptr::from_ref);
        let is_single = cell((on.min + slack).min(middle))? == cell((on.max - slack).max(middle))?;
        is_single.then(|| self.piece(middle))
    }

    /// Returns the common denominator at `p`, which is positive where the map is defined.
    fn denominator(&self, p: DVec3) -> f64 {
        match self.piece(p) {
            Some((local, Piece::Quotient(t))) => t.value(local.coordinates(p).to_array())[3],
            _ => 1.0,
        }
    }

    fn is_rational(&self) -> bool {
        self.pieces.iter().any(|(_, p)| matches!(p, Piece::Quotient(_)))
    }
}

impl Map3 for LatticeMap3 {
    fn jet(&self, p: DVec3) -> Jet3 {
        match self.piece(p) {
            None => Jet3::identity(p),
            Some((local, Piece::Displacement(tensor))) => {
                let d = tensor.jet(local.coordinates(p));
                let column = |a: usize| DVec3::new(d[0][a + 1], d[1][a + 1], d[2][a + 1]) * local.scale[a];
                let jacobian = DMat3::from_cols(column(0), column(1), column(2));
                Jet3 { p: p + DVec3::new(d[0][0], d[1][0], d[2][0]), d: DMat3::IDENTITY + jacobian }
            }
            Some((local, Piece::Quotient(tensor))) => {
                let d = tensor.jet(local.coordinates(p));
                let w = d[3][0];
                let image = DVec3::new(d[0][0], d[1][0], d[2][0]) / w;
                // d(N/W) = (dN − image·dW)/W.
                let column = |a: usize| {
                    (DVec3::new(d[0][a + 1], d[1][a + 1], d[2][a + 1]) - image * d[3][a + 1]) * (local.scale[a] / w)
                };
                Jet3 { p: image, d: DMat3::from_cols(column(0), column(1), column(2)) }
            }
        }
    }

    fn point(&self, p: DVec3) -> DVec3 {
        match self.piece(p) {
            None => p,
            Some((local, Piece::Displacement(tensor))) => {
                p + DVec3::from_array(tensor.value(local.coordinates(p).to_array()))
            }
            Some((local, Piece::Quotient(tensor))) => {
                let [x, y, z, w] = tensor.value(local.coordinates(p).to_array());
                DVec3::new(x, y, z) / w
            }
        }
    }

    fn points(&self, ps: &mut [DVec3]) {
        match &*self.pieces {
            [(local, piece)] if self.extended || ps.iter().all(|p| self.inside.contains(*p)) => match piece {
                Piece::Displacement(tensor) => for_all(&Displaced { local: *local, tensor }, ps),
                Piece::Quotient(tensor) => for_all(&Quotient { local: *local, tensor }, ps),
            },
            _ => ps.iter_mut().for_each(|p| *p = self.point(*p)),
        }
    }

    fn fraction(&self, on: &Box3, max: usize) -> Option<Fraction3> {
        let chart = Chart::on(on);
        let Some((local, piece)) = self.piece_on(on)? else {
            return Some(Fraction3::identity(chart));
        };
        let t = chart.local(local);
        let parts = match piece {
            Piece::Displacement(tensor) if tensor.total_degree() <= max => {
                let ([x, y, z], [dx, dy, dz]) = (chart.xyz(), tensor.in_terms_of(&t));
                [x.plus(1.0, &dx), y.plus(1.0, &dy), z.plus(1.0, &dz), Poly3::constant(1.0)]
            }
            Piece::Quotient(tensor) if tensor.total_degree() <= max => tensor.in_terms_of(&t),
            _ => return None,
        };
        Some(Fraction3 { chart, parts })
    }

    fn branch(&self, on: &Box3) -> Option<Arc<dyn Map3>> {
        Some(match self.piece_on(on)? {
            None => Arc::new(Collineation::IDENTITY),
            Some(piece) => {
                Arc::new(Self { cells: [1; 3], pieces: [piece.clone()].into(), extended: true, ..self.clone() })
            }
        })
    }

    fn creases(&self, out: &mut Creases3) {
        for a in 0..3 {
            let mut plane = |at: f64| out.kink(move |p| p[a] - at);
            if !self.extended {
                plane(self.inside.min[a]);
                plane(self.inside.max[a]);
            }
            for c in 1..self.cells[a] {
                plane(self.region.min[a] + self.region.size()[a] * (c as f64 / self.cells[a] as f64));
            }
        }
        if self.is_rational() {
            let map = self.clone();
            out.edge(move |p| map.denominator(p));
        }
    }

    /// Inverts by Newton's method over the region, or up to half its size outside if the map is extended. Outside points that are not
    /// the image of a point of the region stay where they are.
    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        let margin = if self.extended { 0.5 } else { 0.0 };
        let domain = self.region.inflate(margin * self.region.size());
        // Newton steps may leave the region on the way, where they must not meet the identity.
        let smooth = Self { extended: true, ..self.clone() };
        let rounding = 1e3 * (self.inside.max - self.region.max).max_element();
        let inner = NewtonInverse3::with_core(Arc::new(smooth), self.region, domain, rounding, self.cells);
        Some(Arc::new(LatticeInverse { map: self.clone(), inner }))
    }

    /// Grows with the number of control points of a piece, all of which affect a point.
    fn work(&self) -> f64 {
        const EACH: f64 = 1.0 / 16.0;
        let degrees = match self.pieces.first() {
            Some((_, Piece::Displacement(t))) => t.degrees(),
            Some((_, Piece::Quotient(t))) => t.degrees(),
            None => return 1.0,
        };
        1.0 + EACH * degrees.iter().map(|d| d + 1).product::<usize>() as f64
    }
}

/// The inverse of a [`LatticeMap3`].
struct LatticeInverse {
    map: LatticeMap3,
    inner: NewtonInverse3,
}

impl Map3 for LatticeInverse {
    fn jet(&self, q: DVec3) -> Jet3 {
        match self.inner.solve(q) {
            Some(found) => found,
            None if self.map.piece(q).is_none() => Jet3::identity(q),
            None => Jet3::UNDEFINED,
        }
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        Some(Arc::new(self.map.clone()))
    }

    fn work(&self) -> f64 {
        self.inner.work()
    }

    fn within(&self, budget: &Arc<Budget>) -> Option<Arc<dyn Map3>> {
        Some(Arc::new(Self { map: self.map.clone(), inner: self.inner.spending(budget) }))
    }
}
