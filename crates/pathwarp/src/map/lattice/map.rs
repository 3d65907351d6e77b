//! The lattice as a map, and its inverse.

use super::Lattice;
use crate::budget::Budget;
use crate::map::nets::Patch;
use crate::map::{AffineMap, Class, Crease, CreaseKind, Creases, Jet, Level, Map, NewtonInverse, RationalBezier};
use crate::map::{Cost, Searches};
use kurbo::{Affine, Point, Rect};
use std::sync::Arc;

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
    /// Row by row.
    patches: Vec<Arc<Patch>>,
    /// The outermost pieces continue beyond the region.
    extended: bool,
    affine: Option<Affine>,
}

/// Distance from the border, relative to the coordinates, within which outside points count as inside.
const ROUNDING: f64 = 1e-12;

impl LatticeMap {
    /// The map of `lattice`. Outside its region it is the identity or, if `extended`, continues the outermost pieces.
    #[must_use]
    pub fn new(lattice: &Lattice, extended: bool) -> Self {
        let r = lattice.region();
        let reach = ROUNDING * (r.x0.abs() + r.y0.abs() + r.x1.abs() + r.y1.abs());
        let [across, down] = lattice.cells();
        let cells = (0..down).flat_map(|j| (0..across).map(move |i| [i, j]));
        let patch = |c: [usize; 2]| {
            let p = lattice.patch(c);
            Arc::new(if extended { p } else { p.bounded() })
        };
        let affine = lattice.as_affine().filter(|m| extended || *m == Affine::IDENTITY);
        Self {
            region: r,
            inside: r.inflate(reach, reach),
            cells: lattice.cells(),
            patches: cells.map(patch).collect(),
            extended,
            affine,
        }
    }

    /// The cell at `p`; `None` outside the region, where nothing moves.
    #[inline]
    fn cell(&self, p: Point) -> Option<usize> {
        let b = &self.inside;
        let within = p.x >= b.x0 && p.x <= b.x1 && p.y >= b.y0 && p.y <= b.y1;
        if !within && !self.extended {
            return None;
        }
        if self.patches.len() == 1 {
            return Some(0);
        }
        let r = &self.region;
        let along = |v: f64, n: usize| ((v * n as f64).max(0.0) as usize).min(n - 1);
        let i = along((p.x - r.x0) / r.width(), self.cells[0]);
        let j = along((p.y - r.y0) / r.height(), self.cells[1]);
        Some(j * self.cells[0] + i)
    }

    /// Calls `f` with each run of consecutive points in one cell and its patch, or `None` for a run outside the region.
    #[inline]
    fn runs(&self, ps: &[Point], mut f: impl FnMut(Option<&Patch>, std::ops::Range<usize>)) {
        let (c, half) = (self.inside.center(), self.inside.size() * 0.5);
        let all = |ps: &[Point]| {
            ps.iter().fold(true, |all, p| all & ((p.x - c.x).abs() <= half.width) & ((p.y - c.y).abs() <= half.height))
        };
        if self.patches.len() == 1 && (self.extended || all(ps)) {
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
        let b = self.inside;
        let mut line = |vertical: bool, at: f64| {
            let (a, b_) = if vertical { (1.0, 0.0) } else { (0.0, 1.0) };
            let level = if self.extended {
                Level::Line { a, b: b_, c: -at }
            } else {
                Level::Stretch { a, b: b_, c: -at, within: b }
            };
            out.push(Crease::kink(level));
        };
        if !self.extended {
            line(true, b.x0);
            line(true, b.x1);
            line(false, b.y0);
            line(false, b.y1);
        }
        let r = self.region;
        for i in 1..self.cells[0] {
            line(true, r.x0 + r.width() * (i as f64 / self.cells[0] as f64));
        }
        for j in 1..self.cells[1] {
            line(false, r.y0 + r.height() * (j as f64 / self.cells[1] as f64));
        }
        if self.patches.iter().any(|p| p.has_edge()) {
            let own = self.clone();
            out.push(Crease::edge(Level::Field(Arc::new(move |p| {
                own.cell(p).map_or(1.0, |c| own.patches[c].denominator(p))
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

    /// For a curve whose control points, and therefore the whole curve, lie in one cell or on one outer side of the region.
    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        if self.extended && self.patches.len() == 1 {
            return self.patches[0].image(curve);
        }
        let mut hull: Option<Rect> = None;
        for p in &curve.points {
            if p[2] <= 0.0 {
                return None;
            }
            let p = Point::new(p[0] / p[2], p[1] / p[2]);
            hull = Some(hull.map_or(Rect::from_points(p, p), |h| h.union_pt(p)));
        }
        let (h, b) = (hull?, self.inside);
        if !self.extended && (h.x1 < b.x0 || h.x0 > b.x1 || h.y1 < b.y0 || h.y0 > b.y1) {
            return Some(curve.clone());
        }
        let cell = self.cell(h.origin())?;
        (self.cell(Point::new(h.x1, h.y1)) == Some(cell)).then(|| self.patches[cell].image(curve))?
    }

    /// By Newton's method over the region, or up to half its size outside if the map is extended; see [`NewtonInverse`].
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
    inner: Arc<NewtonInverse>,
}

impl LatticeInverse {
    fn new(map: &LatticeMap) -> Self {
        let r = map.region;
        let (beyond, pieces): (f64, Arc<dyn Map>) = match (map.extended, map.patches.len()) {
            (true, 1) => (0.5, map.patches[0].clone()),
            (true, _) => (0.5, Arc::new(map.clone())),
            (false, 1) => (0.0, map.patches[0].clone()),
            // Newton steps may leave the region on their way and must not meet the identity there.
            (false, _) => (0.0, Arc::new(LatticeMap { extended: true, affine: None, ..map.clone() })),
        };
        let domain = r.inflate(beyond * r.width(), beyond * r.height());
        // Reach further than the margin within which points count as inside, so that no gap remains.
        let reach = 1e3 * (map.inside.x1 - r.x1);
        Self { map: map.clone(), inner: Arc::new(NewtonInverse::with_core(pieces, r, domain, reach, map.cells)) }
    }

    /// Returns `true` if `q` lies outside the region, where nothing moves.
    fn is_outside(&self, q: Point) -> bool {
        !self.map.extended && self.map.cell(q).is_none()
    }
}

impl Map for LatticeInverse {
    fn cost(&self) -> Cost<'_> {
        Cost::new(2.0 * self.inner.cost().work).searching(self)
    }

    fn jet(&self, q: Point) -> Jet {
        match self.inner.solve(q) {
            Some(found) => found,
            None if self.is_outside(q) => AffineMap::IDENTITY.jet(q),
            None => Jet::UNDEFINED,
        }
    }

    fn creases(&self, out: &mut Creases) {
        // The creases of the forward map, pulled back through the inverse.
        let mut own = Creases::default();
        self.map.creases(&mut own);
        for c in own.items().iter().filter(|c| c.kind == CreaseKind::Kink) {
            let (level, back) = (c.level.clone(), self.clone());
            out.push(Crease::kink(Level::Field(Arc::new(move |q| level.at(back.point(q))))));
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        if self.map.extended && self.map.patches.len() == 1 {
            return None;
        }
        let Some(found) = self.inner.solve(inside) else {
            return Some(if self.is_outside(inside) { Arc::new(AffineMap::IDENTITY) } else { self.inner.clone() });
        };
        let cell = self.map.cell(found.p)?;
        let patch = self.map.patches[cell].clone();
        // A margin for parts that end on the border of the cell.
        let (domain, reach) = (patch.rect(), 1e-3 * (patch.rect().width() + patch.rect().height()));
        Some(Arc::new(NewtonInverse::new(patch, domain, reach, [1, 1])))
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.map.clone()))
    }
}

impl Searches for LatticeInverse {
    fn within(&self, budget: &Arc<Budget>) -> Arc<dyn Map> {
        Arc::new(Self { map: self.map.clone(), inner: Arc::new(self.inner.spending(budget)) })
    }
}
