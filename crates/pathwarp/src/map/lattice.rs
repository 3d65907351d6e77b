//! Lattices of control points: free-form deformation of the plane, by the formula at [`LatticeMap`] (T. W. Sederberg, S. R. Parry,
//! SIGGRAPH 1986; T. W. Sederberg, *Computer Aided Geometric Design*, chapter 14). i counts from the left, j from the top.
//!
//! Nothing moves outside the region, so its border is a crease. If the k + 1 outermost rows or columns along a side are in their
//! regular positions (with weights 1), the map is Cᵏ across that side. The Bézier pieces of a B-spline lattice of degree d agree
//! in d − 1 derivatives; the lines between them are creases too.

use super::newton::{kinks, push_images};
use super::{
    AffineMap, Class, Cost, Crease, Creases, Jet, Level, Map, NewtonInverse, Patch, RationalBezier, Searches, bspline,
};
use crate::budget::Budget;
use kurbo::{Affine, Point, Rect, Vec2};
use std::sync::Arc;

/// A grid of weighted control points over a region: the data of a [`LatticeMap`].
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    region: Rect,
    degree: [usize; 2],
    cells: [usize; 2],
    /// The regular positions along x and y, from 0 to 1.
    regular: [Vec<f64>; 2],
    /// The displacements from the regular positions, row by row.
    moves: Vec<Vec2>,
    weights: Vec<f64>,
}

impl Lattice {
    /// The lattice that is the identity: `degree` along x and y (at least 1), `cells` Bézier pieces along x and y (1 for a Bézier lattice).
    #[must_use]
    pub fn regular(region: Rect, degree: [usize; 2], cells: [usize; 2]) -> Self {
        let (degree, cells) = (degree.map(|d| d.max(1)), cells.map(|c| c.max(1)));
        let regular = [0, 1].map(|k| bspline::regular(degree[k], cells[k]));
        let count = regular[0].len() * regular[1].len();
        Self { region, degree, cells, regular, moves: vec![Vec2::ZERO; count], weights: vec![1.0; count] }
    }

    /// The degrees along x and y.
    #[must_use]
    pub fn degree(&self) -> [usize; 2] {
        self.degree
    }

    /// The numbers of Bézier pieces along x and y.
    #[must_use]
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// The box that the lattice deforms.
    #[must_use]
    pub fn region(&self) -> Rect {
        self.region
    }

    /// The number of control points along x.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.regular[0].len()
    }

    /// The number of control points along y.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.regular[1].len()
    }

    fn index(&self, i: usize, j: usize) -> usize {
        j * self.columns() + i
    }

    /// The position of control point (i, j) in the identity.
    #[must_use]
    pub fn regular_point(&self, i: usize, j: usize) -> Point {
        let r = self.region;
        Point::new(r.x0 + self.regular[0][i] * r.width(), r.y0 + self.regular[1][j] * r.height())
    }

    /// The position of control point (i, j).
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

    /// Returns this lattice scaled to another region.
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
        let st = [(p.x - r.x0) / r.width(), (p.y - r.y0) / r.height()];
        let [(i0, across), (j0, down)] = [0, 1].map(|k| bspline::basis(self.degree[k], self.cells[k], st[k]));
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

    /// The patch of one cell. A polynomial patch takes displacements, a rational one homogeneous points.
    fn patch(&self, [ci, cj]: [usize; 2]) -> Patch {
        let range = |a: f64, size: f64, c: usize, n: usize| {
            (a + size * (c as f64 / n as f64), a + size * ((c + 1) as f64 / n as f64))
        };
        let r = self.region;
        let (x0, x1) = range(r.x0, r.width(), ci, self.cells[0]);
        let (y0, y1) = range(r.y0, r.height(), cj, self.cells[1]);
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

    /// Returns the lattice as an affine map, if its points are an affine image of the regular ones and all weights are equal.
    fn as_affine(&self) -> Option<Affine> {
        let (m, n, r) = (self.columns() - 1, self.rows() - 1, self.region);
        if self.weights.iter().any(|w| *w != self.weights[0]) {
            return None;
        }
        let [o, u, v] = [(0, 0), (m, 0), (0, n)].map(|(i, j)| self.moves[self.index(i, j)]);
        let (u, v) = ((u - o) / r.width(), (v - o) / r.height());
        let size = self.moves.iter().map(|d| d.hypot()).fold(0.0, f64::max);
        for j in 0..=n {
            for i in 0..=m {
                let p = self.regular_point(i, j) - r.origin();
                if (o + u * p.x + v * p.y - self.moves[self.index(i, j)]).hypot() > 1e-14 * size {
                    return None;
                }
            }
        }
        let shift = o - u * r.x0 - v * r.y0;
        Some(Affine::new([1.0 + u.x, u.y, v.x, 1.0 + v.y, shift.x, shift.y]))
    }
}

/// Free-form deformation by a [`Lattice`] of control points:
///
/// > X(s,t) = Σⱼ Σᵢ Nᵢ(s) Nⱼ(t) wᵢⱼ (xᵢⱼ, yᵢⱼ, 1),  s = (x − x₀)/(x₁ − x₀),  t = (y − y₀)/(y₁ − y₀)
///
/// with Bernstein polynomials or uniform clamped B-splines N (T. W. Sederberg, S. R. Parry, *Free-form deformation of solid
/// geometric models*, SIGGRAPH 1986). The border of the region and the lines between Bézier pieces are creases.
///
/// ```
/// use pathwarp::kurbo::{Rect, Vec2};
/// use pathwarp::map::{Lattice, LatticeMap, Map};
///
/// let mut lattice = Lattice::regular(Rect::new(0.0, 0.0, 90.0, 90.0), [3, 3], [1, 1]);
/// lattice.shift(1, 1, Vec2::new(0.0, 16.0));
/// let map = LatticeMap::new(&lattice, false);
/// assert_eq!(map.point((200.0, 10.0).into()), (200.0, 10.0).into()); // outside the region
/// assert!(map.point((30.0, 30.0).into()).y > 30.0);
/// ```
#[derive(Debug, Clone)]
pub struct LatticeMap {
    region: Rect,
    /// The region, enlarged by rounding: curves that end on the border or touch it belong to the inside.
    inside: Rect,
    cells: [usize; 2],
    /// The patches of the cells, row by row.
    patches: Vec<Arc<Patch>>,
    /// `true` if the outermost pieces continue beyond the region.
    extended: bool,
    affine: Option<Affine>,
}

/// The distance from the border, relative to the coordinates, within which outside points count as inside.
const ROUNDING: f64 = 1e-12;

impl LatticeMap {
    /// The map of `lattice`. Outside its region it is the identity or, if `extended`, continues the outermost pieces.
    #[must_use]
    pub fn new(lattice: &Lattice, extended: bool) -> Self {
        let r = lattice.region();
        let rounding = ROUNDING * (r.x0.abs() + r.y0.abs() + r.x1.abs() + r.y1.abs());
        let [across, down] = lattice.cells();
        let cells = (0..down).flat_map(|j| (0..across).map(move |i| [i, j]));
        let patch = |c: [usize; 2]| {
            let p = lattice.patch(c);
            Arc::new(if extended { p } else { p.bounded() })
        };
        let affine = lattice.as_affine().filter(|m| extended || *m == Affine::IDENTITY);
        let (inside, patches) = (r.inflate(rounding, rounding), cells.map(patch).collect());
        Self { region: r, inside, cells: lattice.cells(), patches, extended, affine }
    }

    /// A margin for the rounding of preimages, which is larger than that of points.
    fn margin(&self) -> f64 {
        1e3 * (self.inside.x1 - self.region.x1)
    }

    /// The index of the cell at `p`; `None` outside the region, where nothing moves.
    #[inline]
    fn cell(&self, p: Point) -> Option<usize> {
        let b = &self.inside;
        let is_inside = p.x >= b.x0 && p.x <= b.x1 && p.y >= b.y0 && p.y <= b.y1;
        if !is_inside && !self.extended {
            return None;
        }
        if self.patches.len() == 1 {
            return Some(0);
        }
        let r = &self.region;
        let index = |v: f64, n: usize| ((v * n as f64).max(0.0) as usize).min(n - 1);
        let i = index((p.x - r.x0) / r.width(), self.cells[0]);
        let j = index((p.y - r.y0) / r.height(), self.cells[1]);
        Some(j * self.cells[0] + i)
    }

    /// Calls `f` with each run of consecutive points in one cell and its patch, or `None` for a run outside the region.
    #[inline]
    fn runs(&self, ps: &[Point], mut f: impl FnMut(Option<&Patch>, std::ops::Range<usize>)) {
        let (c, half) = (self.inside.center(), self.inside.size() * 0.5);
        let is_inside = |p: &Point| ((p.x - c.x).abs() <= half.width) & ((p.y - c.y).abs() <= half.height);
        // Without branches, so that the compiler can use vectors.
        if self.patches.len() == 1 && (self.extended || ps.iter().fold(true, |all, p| all & is_inside(p))) {
            return f(Some(&self.patches[0]), 0..ps.len());
        }
        let mut from = 0;
        while from < ps.len() {
            let cell = self.cell(ps[from]);
            let mut to = from + 1;
            while to < ps.len() && self.cell(ps[to]) == cell {
                to += 1;
            }
            f(cell.map(|c| &*self.patches[c]), from..to);
            from = to;
        }
    }
}

impl Map for LatticeMap {
    fn cost(&self) -> Cost<'_> {
        self.patches.first().map_or(Cost::NET, Map::cost)
    }

    fn jet(&self, p: Point) -> Jet {
        self.cell(p).map_or_else(|| AffineMap::IDENTITY.jet(p), |c| self.patches[c].jet(p))
    }

    fn point(&self, p: Point) -> Point {
        self.cell(p).map_or(p, |c| self.patches[c].point(p))
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        self.runs(ps, |patch, run| match patch {
            Some(m) => m.jets(&ps[run.clone()], &mut out[run]),
            None => AffineMap::IDENTITY.jets(&ps[run.clone()], &mut out[run]),
        });
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        self.runs(ps, |patch, run| match patch {
            Some(m) => m.points(&ps[run.clone()], &mut out[run]),
            None => out[run.clone()].copy_from_slice(&ps[run]),
        });
    }

    fn class(&self) -> Class {
        self.affine.map_or(Class::Smooth, Class::Affine)
    }

    fn creases(&self, out: &mut Creases) {
        if self.affine.is_some() {
            return;
        }
        let within = self.inside;
        let mut line = |vertical: bool, coordinate: f64| {
            let (a, b, c) = if vertical { (1.0, 0.0, -coordinate) } else { (0.0, 1.0, -coordinate) };
            let level = if self.extended { Level::Line { a, b, c } } else { Level::Stretch { a, b, c, within } };
            out.push(Crease::kink(level));
        };
        if !self.extended {
            line(true, within.x0);
            line(true, within.x1);
            line(false, within.y0);
            line(false, within.y1);
        }
        let r = self.region;
        for i in 1..self.cells[0] {
            line(true, r.x0 + r.width() * (i as f64 / self.cells[0] as f64));
        }
        for j in 1..self.cells[1] {
            line(false, r.y0 + r.height() * (j as f64 / self.cells[1] as f64));
        }
        if self.patches.iter().any(|p| p.has_edge()) {
            let map = self.clone();
            out.push(Crease::edge(Level::Field(Arc::new(move |p: Point| {
                map.cell(p).map_or(1.0, |c| map.patches[c].denominator(p))
            }))));
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        if self.extended && self.patches.len() == 1 {
            return None;
        }
        Some(match self.cell(inside) {
            Some(c) => self.patches[c].clone(),
            None => Arc::new(AffineMap::IDENTITY),
        })
    }

    /// The image of a curve whose control points, and therefore the whole curve, lie in one cell or on one outer side of the region.
    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        if self.extended && self.patches.len() == 1 {
            return self.patches[0].image(curve);
        }
        let points = curve.hull()?.into_iter().map(|p| Rect::from_points(p, p));
        let (h, b) = (points.reduce(|a, b| a.union(b))?, self.inside);
        if !self.extended && (h.x1 < b.x0 || h.x0 > b.x1 || h.y1 < b.y0 || h.y0 > b.y1) {
            return Some(curve.clone());
        }
        let cell = self.cell(h.origin())?;
        (self.cell(Point::new(h.x1, h.y1)) == Some(cell)).then(|| self.patches[cell].image(curve))?
    }

    fn preimages(&self, q: Point) -> Option<Vec<Point>> {
        let mut all: Vec<Point> = self.cell(q).is_none().then_some(q).into_iter().collect();
        for (c, patch) in self.patches.iter().enumerate() {
            // Points on a border count on both its sides.
            let ([nx, ny], b) = (self.cells, patch.rect.inflate(self.margin(), self.margin()));
            let (i, j) = (c % nx, c / nx);
            let in_range = |v: f64, lo: f64, hi: f64, index: usize, n: usize| {
                (v >= lo || (self.extended && index == 0)) && (v <= hi || (self.extended && index + 1 == n))
            };
            let found = patch.preimages(q)?.into_iter();
            all.extend(found.filter(|p| in_range(p.x, b.x0, b.x1, i, nx) && in_range(p.y, b.y0, b.y1, j, ny)));
        }
        Some(all)
    }

    fn detail(&self, area: Rect) -> Option<f64> {
        self.patches.iter().filter_map(|p| p.detail(area)).reduce(f64::min)
    }

    /// The inverse by Newton's method over the region, enlarged by half its size on every side if the map is extended.
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        if let Some(m) = self.affine {
            return AffineMap(m).inverse();
        }
        Some(Arc::new(LatticeInverse::new(self)))
    }
}

/// The inverse of a [`LatticeMap`]: Newton's method over the region, and the identity at outside points that no point of the
/// region maps to.
#[derive(Clone)]
struct LatticeInverse {
    map: LatticeMap,
    newton: Arc<NewtonInverse>,
}

impl LatticeInverse {
    fn new(map: &LatticeMap) -> Self {
        let r = map.region;
        let (share_beyond, pieces): (f64, Arc<dyn Map>) = match (map.extended, map.patches.len()) {
            (true, 1) => (0.5, map.patches[0].clone()),
            (true, _) => (0.5, Arc::new(map.clone())),
            (false, 1) => (0.0, map.patches[0].clone()),
            // Newton steps may leave the region on their way, and must not meet the identity there.
            (false, _) => (0.0, Arc::new(LatticeMap { extended: true, affine: None, ..map.clone() })),
        };
        let domain = r.inflate(share_beyond * r.width(), share_beyond * r.height());
        // The margin exceeds that within which points count as inside, so that no gap remains.
        let newton = NewtonInverse::with_core(pieces, r, domain, map.margin(), map.cells);
        Self { map: map.clone(), newton: Arc::new(newton) }
    }
}

impl Map for LatticeInverse {
    fn cost(&self) -> Cost<'_> {
        Cost::new(2.0 * self.newton.cost().work).searching(self)
    }

    fn jet(&self, q: Point) -> Jet {
        match self.newton.solve(q) {
            Some(found) => found,
            None if self.map.cell(q).is_none() => AffineMap::IDENTITY.jet(q),
            None => Jet::UNDEFINED,
        }
    }

    fn creases(&self, out: &mut Creases) {
        push_images(kinks(&self.map), self, out);
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        if self.map.extended && self.map.patches.len() == 1 {
            return None;
        }
        let Some(found) = self.newton.solve(inside) else {
            let is_outside = self.map.cell(inside).is_none();
            return Some(if is_outside { Arc::new(AffineMap::IDENTITY) } else { self.newton.clone() });
        };
        let cell = self.map.cell(found.p)?;
        let patch = self.map.patches[cell].clone();
        // A margin for parts that end on the border of the cell.
        let (domain, margin) = (patch.rect, 1e-3 * (patch.rect.width() + patch.rect.height()));
        Some(Arc::new(NewtonInverse::new(patch, domain, margin, [1, 1])))
    }

    fn detail(&self, area: Rect) -> Option<f64> {
        self.newton.detail(area)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.map.clone()))
    }
}

impl Searches for LatticeInverse {
    fn within(&self, budget: &Arc<Budget>) -> Arc<dyn Map> {
        Arc::new(Self { map: self.map.clone(), newton: Arc::new(self.newton.spending(budget)) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two cells, the first one is the identity and the second one is bent.
    #[test]
    fn the_finest_cell_determines_the_detail() {
        let region = Rect::new(0.0, 0.0, 8.0, 4.0);
        let mut lattice = Lattice::regular(region, [2, 2], [2, 1]);
        lattice.shift(3, 0, Vec2::new(0.0, 1.0));
        assert_eq!(LatticeMap::new(&lattice, true).detail(region), Some(4.0 / 3.0));
    }
}
