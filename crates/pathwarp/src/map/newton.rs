//! The inverse of any smooth map over a box, by Newton's method, with a test that each answer is a solution.
//!
//! A grid of starting points covers the box. To invert a point q, the cells whose images come near q are tried: damped Newton
//! steps x ← x + J⁻¹(q − F(x)) run from the center of the cell until they no longer change x. The answer is accepted if
//!
//! 1. the residual |F(x) − q| is at rounding level,
//! 2. x lies in the box, or outside it by at most the margin,
//! 3. β·L·η ≤ ½, with β = ‖J(x)⁻¹‖, η = |J(x)⁻¹(q − F(x))| and L a Lipschitz bound of the Jacobian: Kantorovich's condition
//!    (L. V. Kantorovich 1948; Ortega & Rheinboldt, *Iterative Solution of Nonlinear Equations*, theorem 12.6.2), under which
//!    a solution exists within 2η of x and is the only one within about 1/(βL). On a fold β is unbounded and the test fails.
//!    L is measured between neighbouring starting points and doubled: a bound for maps that the grid resolves.
//!
//! The inverse is undefined (NaN) at every other point. If the map folds, a point can have several preimages. Those in the *core*
//! (the part of the box that the map is designed for) or within the margin of it take precedence; outside, only sheets with the
//! orientation of the core's center count, and of those the preimage nearest to the core is chosen.

use super::batches::{Target, broyden, by_rounds};
use super::{Batches, Cost, Crease, CreaseKind, Creases, Jet, Level, Map, Searches, detail_in};
use crate::budget::{Budget, Search, is_over};
use kurbo::{Point, Rect, Vec2};
use std::fmt;
use std::sync::Arc;

/// The smallest number of starting points along a side of the box.
const MIN_STARTS: usize = 12;
/// The largest number of starting points along a side of the box.
const MAX_STARTS: usize = 96;
/// The number of starting points along a side for every piece of the map.
const STARTS_PER_PIECE: usize = 4;
/// The number of Newton steps from one starting point.
const MAX_STEPS: usize = 40;
/// The share to which a Newton step is halved before it is given up.
const MIN_DAMPING: f64 = 1e-4;
/// The number of starting points tried for one point.
const MAX_TRIES: usize = 16;
/// The cost of comparing a starting point with those already tried, as a multiple of the cost of looking at it.
const COMPARISON_COST: usize = 6;

/// The inverse of a smooth map over a box, by damped Newton iteration.
///
/// Every answer is certified by Kantorovich's condition; points without a certified preimage in the box map to NaN. If the map
/// folds and a point has several preimages, those in the *core* of the box take precedence.
#[derive(Clone)]
pub struct NewtonInverse {
    map: Arc<dyn Map>,
    domain: Rect,
    core: Rect,
    /// The sign of the determinant at the center of the core.
    orientation: f64,
    /// The distance outside the domain within which answers count.
    margin: f64,
    starts: Arc<[StartingPoint]>,
    /// The size of a starting point's cell.
    cell: Vec2,
    /// Indices of the starting points whose cells' images meet each bucket of a grid over `bounds`.
    buckets: Arc<[Vec<u32>]>,
    bounds: Rect,
    buckets_per_side: usize,
    /// A Lipschitz bound of the Jacobian.
    lipschitz: f64,
    /// The rounding error of an image coordinate: 64 units in the last place of the largest one.
    rounding: f64,
    /// The work of one of the map's jets, in a batch or alone, whichever is less.
    map_work: f64,
    /// The work of one of the map's jets in a search.
    pub(crate) jet_work: f64,
    /// The budget that searches are charged to.
    budget: Option<Arc<Budget>>,
}

impl fmt::Debug for NewtonInverse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("NewtonInverse").field("map", &self.map).field("domain", &self.domain).finish_non_exhaustive()
    }
}

/// The center of a cell, with the map's jet there.
#[derive(Debug, Clone, Copy)]
struct StartingPoint {
    point: Point,
    jet: Jet,
    in_core: bool,
}

impl NewtonInverse {
    /// The inverse of `map` over `area`, with enough starting points for a map that bends a few times across it. Answers outside
    /// `area` count up to `margin` times its diagonal away.
    #[must_use]
    pub fn over(map: Arc<dyn Map>, area: Rect, margin: f64) -> Self {
        Self::new(map, area, margin * area.width().hypot(area.height()), [6, 6])
    }

    /// The inverse of `map` over `domain`. Answers up to `margin` user units outside it count. `pieces` is the number of smooth
    /// pieces of the map along x and y (1, 1 for a single polynomial).
    #[must_use]
    pub fn new(map: Arc<dyn Map>, domain: Rect, margin: f64, pieces: [usize; 2]) -> Self {
        Self::with_core(map, domain, domain, margin, pieces)
    }

    /// The inverse of `map` over `domain`, with a `core` smaller than that box; see [`NewtonInverse::new`].
    #[must_use]
    pub(crate) fn with_core(map: Arc<dyn Map>, core: Rect, domain: Rect, margin: f64, pieces: [usize; 2]) -> Self {
        let [nx, ny] = pieces.map(|n| (n * STARTS_PER_PIECE).clamp(MIN_STARTS, MAX_STARTS));
        let cell = Vec2::new(domain.width() / nx as f64, domain.height() / ny as f64);
        let center =
            |i: usize, j: usize| domain.origin() + Vec2::new((i as f64 + 0.5) * cell.x, (j as f64 + 0.5) * cell.y);
        let centers: Vec<Point> = (0..ny).flat_map(|j| (0..nx).map(move |i| center(i, j))).collect();
        let mut jets = vec![Jet::default(); centers.len()];
        map.jets(&centers, &mut jets);

        let mut lipschitz: f64 = 0.0;
        let mut compare = |a: &Jet, b: &Jet, distance: f64| {
            let (dx, dy) = (a.dx - b.dx, a.dy - b.dy);
            let rate = (dx.hypot2() + dy.hypot2()).sqrt() / distance;
            if rate.is_finite() {
                lipschitz = lipschitz.max(rate);
            }
        };
        for (k, jet) in jets.iter().enumerate() {
            if (k + 1) % nx != 0 {
                compare(jet, &jets[k + 1], cell.x);
            }
            if k + nx < jets.len() {
                compare(jet, &jets[k + nx], cell.y);
            }
        }

        // Each starting point gets a box around the image of its cell: the box of the first-order image, enlarged by half.
        let mut starts = Vec::with_capacity(centers.len());
        let mut boxes = Vec::with_capacity(centers.len());
        for (point, j) in centers.iter().zip(&jets).filter(|(_, j)| j.is_finite()) {
            let [x, y] = [(j.dx.x, j.dy.x), (j.dx.y, j.dy.y)].map(|(a, b)| a.abs() * cell.x + b.abs() * cell.y);
            let half = Vec2::new(0.75 * x, 0.75 * y);
            starts.push(StartingPoint { point: *point, jet: *j, in_core: core.contains(*point) });
            boxes.push(Rect::from_points(j.p - half, j.p + half));
        }
        let bounds = boxes.iter().copied().reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
        let largest = [bounds.x0, bounds.y0, bounds.x1, bounds.y1].map(f64::abs).into_iter().fold(1e-300, f64::max);
        let buckets_per_side = nx.max(ny);
        let orientation = map.jet(core.center()).det().signum();
        let Cost { work, jet: jet_work, .. } = map.cost();
        let mut out = Self {
            map_work: work.min(jet_work),
            jet_work,
            budget: None,
            map,
            core,
            orientation,
            domain,
            margin,
            buckets: Arc::default(),
            bounds,
            buckets_per_side,
            lipschitz: 2.0 * lipschitz,
            rounding: 64.0 * f64::EPSILON * largest,
            starts: starts.into(),
            cell,
        };
        let mut buckets = vec![Vec::new(); buckets_per_side * buckets_per_side];
        for (k, b) in boxes.iter().enumerate() {
            let ((i0, j0), (i1, j1)) = (out.bucket(b.origin()), out.bucket(Point::new(b.x1, b.y1)));
            for j in j0..=j1 {
                for i in i0..=i1 {
                    buckets[j * buckets_per_side + i].push(k as u32);
                }
            }
        }
        out.buckets = buckets.into();
        out
    }

    /// Returns this inverse with its searches charged to `budget`.
    #[must_use]
    pub(crate) fn spending(&self, budget: &Arc<Budget>) -> Self {
        // The map may be an inverse itself.
        let map = self.map.within(budget).unwrap_or_else(|| Arc::clone(&self.map));
        Self { map, budget: Some(Arc::clone(budget)), ..self.clone() }
    }

    /// The column and row of the bucket at `q`, or of the nearest one.
    fn bucket(&self, q: Point) -> (usize, usize) {
        let n = self.buckets_per_side;
        let index = |v: f64, a: f64, b: f64| (((v - a) / (b - a) * n as f64).max(0.0) as usize).min(n - 1);
        (index(q.x, self.bounds.x0, self.bounds.x1), index(q.y, self.bounds.y0, self.bounds.y1))
    }

    /// The indices of the starting points in the bucket at `q`.
    fn candidates(&self, q: Point) -> &[u32] {
        let (i, j) = self.bucket(q);
        &self.buckets[j * self.buckets_per_side + i]
    }

    /// The preimage of `q` and the derivatives of the inverse there; `None` if there is no preimage in the box.
    #[must_use]
    pub fn solve(&self, q: Point) -> Option<Jet> {
        self.solve_where(q, |_| true)
    }

    /// The first preimage of `q` that `accept` accepts, and the derivatives of the inverse there.
    #[must_use]
    pub(crate) fn solve_where(&self, q: Point, accept: impl Fn(Point) -> bool) -> Option<Jet> {
        self.charged(self.search(q, accept))
    }

    /// The first preimage of `q` that `accept` accepts, and the work done, for callers that charge it themselves.
    #[must_use]
    pub(crate) fn search(&self, q: Point, accept: impl Fn(Point) -> bool) -> (Option<Jet>, Search) {
        self.search_by(&*self.map, q, accept)
    }

    /// Charges a search to the budget and returns its result.
    fn charged(&self, (found, search): (Option<Jet>, Search)) -> Option<Jet> {
        search.spend(self.budget.as_ref(), 1, self.jet_work);
        found
    }

    /// The next starting point for `q` in its bucket: starting points in the core first, then by the distance of their images from q.
    fn next_start(&self, q: Point, tried: &[u32]) -> Option<u32> {
        let key = |k: u32| {
            let s = &self.starts[k as usize];
            (!s.in_core, (s.jet.p - q).hypot2())
        };
        self.candidates(q).iter().copied().filter(|k| !tried.contains(k)).min_by(|a, b| {
            let (a, b) = (key(*a), key(*b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        })
    }

    /// Runs [`NewtonInverse::search`] with the jets of `map`: this inverse's map, or a cache of it.
    fn search_by(&self, map: &dyn Map, q: Point, accept: impl Fn(Point) -> bool) -> (Option<Jet>, Search) {
        let mut search = Search::default();
        let found = self.preimage(map, q, accept, &mut search);
        (found, search)
    }

    /// The first preimage of `q` that `accept` accepts. Adds the work to `search`.
    fn preimage(&self, map: &dyn Map, q: Point, accept: impl Fn(Point) -> bool, search: &mut Search) -> Option<Jet> {
        if !q.is_finite() || self.starts.is_empty() || is_over(self.budget.as_ref()) {
            return None;
        }
        let count = self.candidates(q).len();
        if count == 0 {
            search.starts += self.starts.len();
            let distance = |s: &StartingPoint| (s.jet.p - q).hypot2();
            let start = self.starts.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            return self.newton(map, start.point, q, search).filter(|found| self.is_eligible(found) && accept(found.p));
        }
        let mut tried = [u32::MAX; MAX_TRIES];
        let mut best: Option<(f64, Jet)> = None;
        for n in 0..MAX_TRIES {
            search.starts += COMPARISON_COST * count;
            let Some(k) = self.next_start(q, &tried) else { break };
            tried[n] = k;
            let Some(found) = self.newton(map, self.starts[k as usize].point, q, search).filter(|f| accept(f.p)) else {
                continue;
            };
            let distance = self.distance_from_core(found.p);
            if distance <= self.margin {
                return Some(found);
            }
            if self.is_eligible(&found) && best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, found));
            }
        }
        best.map(|b| b.1)
    }

    /// For each point, its preimage found from values alone, if it is near the first starting point and in the core: up to rounding, the
    /// point where Newton's method ends too.
    fn preimages_by_values(&self, qs: &[Point]) -> Vec<Option<Point>> {
        let target = |q: &Point| {
            let start = self.starts.get(self.next_start(*q, &[])? as usize).filter(|_| q.is_finite())?;
            Some(Target { q: *q, start: start.point, jet: start.jet })
        };
        let targets: Vec<Option<Target>> = qs.iter().map(target).collect();
        let mut found = broyden(&*self.map, &targets, self.rounding);
        for (preimage, target) in found.iter_mut().zip(&targets) {
            let is_near = |p: &Point, start: Point| {
                let d = *p - start;
                d.x.abs() <= self.cell.x && d.y.abs() <= self.cell.y && self.distance_from_core(*p) <= self.margin
            };
            *preimage = preimage.filter(|p| target.as_ref().is_some_and(|t| is_near(p, t.start)));
        }
        found
    }

    /// The jets of the inverse at `qs`, at preimages found from values alone, or by Newton's method where that fails.
    fn jets_by_values(&self, qs: &[Point]) -> Vec<Jet> {
        let preimages = self.preimages_by_values(qs);
        let known: Vec<Point> = preimages.iter().flatten().copied().collect();
        let mut jets = vec![Jet::default(); known.len()];
        self.map.jets(&known, &mut jets);
        let mut next = jets.iter().zip(known);
        // One more Newton step, for which the jet is at hand.
        let polished = |(preimage, q): (&Option<Point>, &Point)| {
            preimage.and_then(|_| next.next()).and_then(|(jet, x)| {
                let step = solve(jet, *q - jet.p)?;
                self.certified(x, jet, *q - jet.p).map(|found| Jet { p: found.p + step, ..found })
            })
        };
        let found: Vec<Option<Jet>> = preimages.iter().zip(qs).map(polished).collect();
        let unsolved: Vec<Point> = found.iter().zip(qs).filter(|(f, _)| f.is_none()).map(|(_, q)| *q).collect();
        let mut rest = self.jets_by_rounds(&unsolved).into_iter();
        found.into_iter().map(|f| f.or_else(|| rest.next()).unwrap_or(Jet::UNDEFINED)).collect()
    }

    /// The jets of the inverse at `qs` by Newton's method for all of them at once.
    fn jets_by_rounds(&self, qs: &[Point]) -> Vec<Jet> {
        // Each round repeats a search from its start; only the last search is charged.
        let found = by_rounds(&*self.map, qs, |map, q| self.search_by(map, *q, |_| true));
        found.into_iter().map(|f| self.charged(f).unwrap_or(Jet::UNDEFINED)).collect()
    }

    /// The distance from the core along the axis where it is larger; 0 inside.
    fn distance_from_core(&self, p: Point) -> f64 {
        let c = &self.core;
        (c.x0 - p.x).max(p.x - c.x1).max(c.y0 - p.y).max(p.y - c.y1).max(0.0)
    }

    /// Returns `true` for a preimage in the core, or on a sheet with the orientation of the core's center.
    fn is_eligible(&self, found: &Jet) -> bool {
        found.det().signum() == self.orientation || self.distance_from_core(found.p) <= self.margin
    }

    /// Newton's method from one starting point.
    fn newton(&self, map: &dyn Map, start: Point, q: Point, search: &mut Search) -> Option<Jet> {
        // Steps stay near the box: the map may be undefined further away.
        let limits = self.domain.inflate(0.25 * self.domain.width(), 0.25 * self.domain.height());
        let mut x = start;
        let mut jet = map.jet(x);
        search.jets += 1;
        let mut residual = q - jet.p;
        for _ in 0..MAX_STEPS {
            let step = solve(&jet, residual)?;
            // Halve the step until it reduces the residual.
            let mut damping = 1.0;
            let (mut next, mut next_jet, mut next_residual) = (x, jet, residual);
            while damping > MIN_DAMPING {
                next = x + step * damping;
                next = Point::new(next.x.clamp(limits.x0, limits.x1), next.y.clamp(limits.y0, limits.y1));
                next_jet = map.jet(next);
                search.jets += 1;
                next_residual = q - next_jet.p;
                if next_residual.hypot2() < residual.hypot2() || next_residual.hypot() <= self.rounding {
                    break;
                }
                damping *= 0.5;
            }
            let (length, is_better) = ((next - x).hypot(), next_residual.hypot2() < residual.hypot2());
            if is_better || next_residual.hypot() <= self.rounding {
                (x, jet, residual) = (next, next_jet, next_residual);
            }
            let converged = length <= 4.0 * f64::EPSILON * (x.x.abs() + x.y.abs() + self.domain.width());
            if residual == Vec2::ZERO || converged || !is_better {
                return self.certified(x, &jet, residual);
            }
        }
        None
    }

    /// The jet of the inverse that leads to `x`, if the three conditions in the module's text hold.
    fn certified(&self, x: Point, jet: &Jet, residual: Vec2) -> Option<Jet> {
        let b = self.domain.inflate(self.margin, self.margin);
        let det = jet.det();
        let beta = (jet.dx.hypot2() + jet.dy.hypot2()).sqrt() / det.abs();
        let eta = solve(jet, residual)?.hypot();
        let is_solution = residual.hypot() <= self.rounding
            && (b.x0..=b.x1).contains(&x.x)
            && (b.y0..=b.y1).contains(&x.y)
            && beta * self.lipschitz * eta <= 0.5;
        is_solution.then(|| jet.inverted(x))
    }
}

/// J⁻¹·v; `None` if J is singular.
fn solve(j: &Jet, v: Vec2) -> Option<Vec2> {
    let det = j.det();
    let out = Vec2::new(v.cross(j.dy) / det, j.dx.cross(v) / det);
    out.is_finite().then_some(out)
}

/// The work of one point of the inverse, as a multiple of the map's, where there is a preimage: a dozen jets with the steps around them, at
/// 0.4 each. [`Search::spend`] charges the jets beyond these.
pub(crate) const INVERSE_WORK: f64 = 5.0;

impl Map for NewtonInverse {
    fn cost(&self) -> Cost<'_> {
        let cost = Cost::new(INVERSE_WORK * self.map_work).searching(self);
        if self.map.prefers_batches() { cost.batched(self) } else { cost }
    }

    fn jet(&self, q: Point) -> Jet {
        self.solve(q).unwrap_or(Jet::UNDEFINED)
    }

    fn jets(&self, qs: &[Point], out: &mut [Jet]) {
        match self.map.cost().batches {
            // Derivatives that are differences of values cost more than values.
            Some(map) if map.differentiates() => out.copy_from_slice(&self.jets_by_values(qs)),
            Some(_) => out.copy_from_slice(&self.jets_by_rounds(qs)),
            None => qs.iter().zip(out).for_each(|(q, o)| *o = self.jet(*q)),
        }
    }

    fn points(&self, qs: &[Point], out: &mut [Point]) {
        let mut jets = vec![Jet::default(); qs.len()];
        self.jets(qs, &mut jets);
        out.iter_mut().zip(&jets).for_each(|(o, j)| *o = j.p);
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(self.map.clone())
    }

    /// The map's detail times σ·(σ/Σ), with σ and Σ its least and largest stretch: its least size in the image, or less where it shears.
    fn detail(&self, area: Rect) -> Option<f64> {
        let jet = self.solve(area.center())?;
        let square = jet.dx.hypot2() + jet.dy.hypot2();
        let side = 2.0 * square.sqrt() * area.size().to_vec2().hypot();
        let preimage = Rect::from_center_size(jet.p, (side, side));
        Some(detail_in(&*self.map, preimage)? * jet.det().abs() / (square * square.sqrt()))
    }
}

impl Batches for NewtonInverse {}

impl Searches for NewtonInverse {
    fn within(&self, budget: &Arc<Budget>) -> Arc<dyn Map> {
        Arc::new(self.spending(budget))
    }
}

// The inverse of a map with creases has creases along their images, with a smooth branch on either side.

/// The inverse of a map over `area`, a box in its source: in closed form if there is one ([`Map::inverse`]), or else by Newton's method,
/// whose answers may lie a quarter of the box's diagonal outside, as strokes and handles do. It has the creases of the map.
#[must_use]
pub fn inverse_over(map: impl Map + 'static, area: Rect) -> Arc<dyn Map> {
    inverse_of(&(Arc::new(map) as Arc<dyn Map>), area)
}

/// Returns [`inverse_over`] for a map that is already shared.
pub(crate) fn inverse_of(map: &Arc<dyn Map>, area: Rect) -> Arc<dyn Map> {
    const MARGIN: f64 = 0.25;
    let by_newton = || CreasedInverse::of_pieces(map, NewtonInverse::over(Arc::clone(map), area, MARGIN));
    map.inverse().unwrap_or_else(by_newton)
}

/// The level sets of the kinks of `map`.
pub(super) fn kinks(map: &dyn Map) -> Vec<Level> {
    let all = Creases::of_map(map);
    all.items().iter().filter(|c| c.kind == CreaseKind::Kink).map(|c| c.level.clone()).collect()
}

/// Adds the images of kinks of a map: their level sets, pulled back through the map's inverse.
pub(super) fn push_images<M: Map + Clone + 'static>(kinks: Vec<Level>, inverse: &M, out: &mut Creases) {
    for level in kinks {
        let inverse = inverse.clone();
        out.push(Crease::kink(Level::Field(Arc::new(move |q: Point| level.at(inverse.point(q))))));
    }
}

/// Newton's inverse of a map that consists of smooth pieces.
pub(crate) struct CreasedInverse {
    whole: Arc<NewtonInverse>,
    map: Arc<dyn Map>,
    /// The map's creases.
    kinks: Vec<Level>,
}

impl CreasedInverse {
    /// Declares the creases of `map` in its inverse. Returns the plain inverse if there are none, or so many that searching for each takes
    /// too long.
    pub(crate) fn of_pieces(map: &Arc<dyn Map>, whole: NewtonInverse) -> Arc<dyn Map> {
        const MAX_KINKS: usize = 32;
        let (whole, kinks) = (Arc::new(whole), kinks(&**map));
        if kinks.is_empty() || kinks.len() > MAX_KINKS || map.prefers_batches() {
            return whole;
        }
        Arc::new(Self { whole, map: Arc::clone(map), kinks })
    }
}

impl Map for CreasedInverse {
    fn cost(&self) -> Cost<'_> {
        self.whole.cost().searching(self)
    }

    fn jet(&self, q: Point) -> Jet {
        self.whole.jet(q)
    }

    fn creases(&self, out: &mut Creases) {
        push_images(self.kinks.clone(), &self.whole, out);
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let inside = self.whole.solve(inside)?.p;
        let map = self.map.branch(inside)?;
        let sides = self.kinks.iter().map(|k| (k.clone(), k.at(inside))).collect();
        Some(Arc::new(BranchInverse { whole: Arc::clone(&self.whole), map, sides }))
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::clone(&self.map))
    }

    fn detail(&self, area: Rect) -> Option<f64> {
        self.whole.detail(area)
    }
}

impl Searches for CreasedInverse {
    fn within(&self, budget: &Arc<Budget>) -> Arc<dyn Map> {
        let map = self.map.within(budget).unwrap_or_else(|| Arc::clone(&self.map));
        Arc::new(Self { whole: Arc::new(self.whole.spending(budget)), map, kinks: self.kinks.clone() })
    }
}

/// The inverse of one branch of the map. The search starts where the inverse of the whole map leads.
struct BranchInverse {
    whole: Arc<NewtonInverse>,
    map: Arc<dyn Map>,
    /// The map's creases, with the values of their functions in the branch.
    sides: Vec<(Level, f64)>,
}

impl BranchInverse {
    /// Returns `true` if `p` is in the branch or on its boundary.
    fn contains(&self, p: Point) -> bool {
        /// The rounding error, as a share of the value inside.
        const NOISE: f64 = 1e-9;
        self.sides.iter().all(|(level, inside)| level.at(p) * inside.signum() >= -NOISE * inside.abs())
    }
}

impl Map for BranchInverse {
    fn cost(&self) -> Cost<'_> {
        Cost { searches: None, ..self.whole.cost() } // Its searches are charged to the budget of the whole inverse.
    }

    fn jet(&self, q: Point) -> Jet {
        // Where the ends of a closed strip meet, a point has preimages at both ends.
        let start = self.whole.solve(q).filter(|found| self.contains(found.p));
        let start = start.or_else(|| self.whole.solve_where(q, |p| self.contains(p))).or_else(|| self.whole.solve(q));
        let Some(start) = start else { return Jet::UNDEFINED };
        let mut search = Search::default();
        let found = self.whole.newton(&*self.map, start.p, q, &mut search);
        self.whole.charged((found, search)).unwrap_or(Jet::UNDEFINED)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::clone(&self.map))
    }

    fn detail(&self, area: Rect) -> Option<f64> {
        self.whole.detail(area)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Formula, Real};
    use std::sync::atomic::{AtomicU64, Ordering};

    struct Fold;
    impl Formula for Fold {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x * x, y + x * y * 0.1)
        }
    }

    #[test]
    fn a_smooth_map_is_inverted_and_nothing_is_invented_outside() {
        let inv = NewtonInverse::new(Arc::new(Fold), Rect::new(0.5, -1.0, 3.0, 2.0), 1e-9, [1, 1]);
        for i in 0..50 {
            for j in 0..50 {
                let p = Point::new(0.5 + 0.05 * f64::from(i), -1.0 + 0.06 * f64::from(j));
                let q = Fold.point(p);
                let back = inv.jet(q);
                assert!(back.p.distance(p) < 1e-13, "{p:?} {back:?}");
                let there = Fold.jet(p).then(&back);
                assert!((there.dx - Vec2::new(1.0, 0.0)).hypot() < 1e-12);
                assert!((there.dy - Vec2::new(0.0, 1.0)).hypot() < 1e-12);
            }
        }
        // One point without a preimage, and one whose preimage is outside the box.
        assert!(inv.point(Point::new(-1.0, 0.0)).is_nan());
        assert!(inv.point(Fold.point(Point::new(0.4, 0.0))).is_nan());
        assert!(inv.point(Fold.point(Point::new(2.0, 2.5))).is_nan());
    }

    /// A map that counts its jets.
    #[derive(Default)]
    struct Counting(AtomicU64);
    impl Map for Counting {
        fn jet(&self, p: Point) -> Jet {
            self.0.fetch_add(1, Ordering::Relaxed);
            Map::jet(&Fold, p)
        }
    }

    #[test]
    fn what_is_searched_in_vain_is_counted() {
        let map = Arc::new(Counting::default());
        let inverse =
            NewtonInverse::new(Arc::clone(&map) as Arc<dyn Map>, Rect::new(-1.0, -1.0, 1.0, 1.0), 1e-9, [1, 1]);
        let budget = Arc::new(Budget::default());
        let (inverse, last) = (inverse.spending(&budget), std::cell::Cell::new(budget.left()));
        let of = |q: Point| {
            map.0.store(0, Ordering::Relaxed);
            let found = inverse.jet(q).is_finite();
            let jets = map.0.load(Ordering::Relaxed);
            let beyond = last.replace(budget.left()) - budget.left();
            (found, jets, beyond)
        };
        let (found, jets, beyond) = of(Fold.point(Point::new(0.7, 0.2)));
        assert!(found && jets <= 12 && beyond <= 5.0, "{jets} {beyond}");
        // On the fold every starting point is tried.
        let (found, jets, beyond) = of(Point::new(0.0, 0.3));
        assert!(!found && jets > 100, "{jets}");
        assert!((0.3..0.8).contains(&(beyond / jets as f64)), "{jets} {beyond}");
    }

    #[test]
    fn a_point_on_a_fold_is_not_certified() {
        let inv = NewtonInverse::new(Arc::new(Fold), Rect::new(-1.0, -1.0, 1.0, 1.0), 1e-9, [1, 1]);
        assert!(inv.point(Point::new(0.0, 0.3)).is_nan());
        let p = inv.point(Fold.point(Point::new(0.3, 0.2)));
        assert!(Fold.point(p).distance(Fold.point(Point::new(0.3, 0.2))) < 1e-14);
    }

    /// The map y + |x| / 2, with its smooth halves as branches.
    struct Roof;
    struct Half(f64);

    impl Formula for Half {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x, y + x * (0.5 * self.0))
        }
    }

    impl Map for Roof {
        fn jet(&self, p: Point) -> Jet {
            Half(p.x.signum()).jet(p)
        }

        fn creases(&self, out: &mut Creases) {
            out.push(Crease::kink(Level::Line { a: 1.0, b: 0.0, c: 0.0 }));
        }

        fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
            Some(Arc::new(Half(inside.x.signum())))
        }
    }

    #[test]
    fn an_inverse_has_a_crease_where_that_of_the_map_goes() {
        let map: Arc<dyn Map> = Arc::new(Roof);
        let back = CreasedInverse::of_pieces(
            &map,
            NewtonInverse::over(Arc::clone(&map), Rect::new(-5.0, -5.0, 5.0, 5.0), 0.1),
        );
        let creases = Creases::of_map(&back);
        let [crease] = creases.items() else { panic!("{creases:?}") };
        assert!(crease.level.at(Point::new(-1e-6, 2.0)) < 0.0 && crease.level.at(Point::new(1e-6, 2.0)) > 0.0);
        for side in [-1.0, 1.0] {
            let branch = back.branch(Point::new(side, 1.0)).unwrap();
            for x in [-2.0, -0.1, 0.0, 0.1, 2.0] {
                let jet = branch.jet(Point::new(x, 1.0));
                assert!(jet.p.distance(Point::new(x, 1.0 - 0.5 * side * x)) < 1e-12, "{x}: {jet:?}");
                assert!((jet.dx.y + 0.5 * side).abs() < 1e-12);
            }
        }
    }

    /// A strip around a circle, in two halves, whose ends meet.
    struct Ring;

    impl Formula for Ring {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            let angle = x * std::f64::consts::TAU;
            ((y + 1.0) * angle.cos(), (y + 1.0) * angle.sin())
        }

        fn creases(&self, out: &mut Creases) {
            for x in [0.0, 0.5, 1.0] {
                out.push(Crease::kink(Level::Line { a: 1.0, b: 0.0, c: -x }));
            }
        }

        fn branch(&self, _: Point) -> Option<Arc<dyn Map>> {
            Some(Arc::new(Self))
        }
    }

    #[test]
    fn where_the_ends_of_a_strip_meet_each_branch_goes_to_its_own() {
        let map: Arc<dyn Map> = Arc::new(Ring);
        let back =
            CreasedInverse::of_pieces(&map, NewtonInverse::over(Arc::clone(&map), Rect::new(0.0, -0.5, 1.0, 0.5), 0.1));
        for (side, x) in [(0.3, 0.0), (-0.3, 1.0)] {
            let branch = back.branch(Point::new(0.9, side)).unwrap();
            for r in [0.7, 1.0, 1.3] {
                let end = branch.point(Point::new(r, 0.0));
                assert!(end.distance(Point::new(x, r - 1.0)) < 1e-12, "{side} {r}: {end:?}");
            }
        }
    }
}
