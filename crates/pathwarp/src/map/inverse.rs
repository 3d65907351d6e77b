//! The inverse of any smooth map over a box, by Newton's method, with a test that the answer is one.
//!
//! A grid of starts covers the box. For a place q, the cells whose images come near q are tried: from the cell's middle,
//! damped Newton steps x ← x + J⁻¹(q − F(x)) run until they stop changing x. The answer is accepted if
//!
//! 1. the residual |F(x) − q| is rounding,
//! 2. x lies in the box (or beyond it by less than the stated reach),
//! 3. β·L·η ≤ ½, with β = ‖J(x)⁻¹‖, η = |J(x)⁻¹(q − F(x))| and L a Lipschitz bound of the Jacobian: Kantorovich's condition
//!    (L. V. Kantorovich 1948; Ortega & Rheinboldt, *Iterative Solution of Nonlinear Equations*, theorem 12.6.2), under which
//!    a solution exists within 2η of x and is the only one within about 1/(βL). On a fold β grows without bound and the test
//!    fails. L is measured between the starts and doubled: a bound for maps that the grid resolves.
//!
//! Everywhere else the inverse is not defined: its values are NaN there. Where a map folds, a place can have several
//! preimages. Those in the *core* (the part of the box the map is meant for) go before others; beyond the core only sheets
//! that lie the same way up as the core's middle count, and of those the preimage nearest to the core is given.

use super::{Jet, Map};
use kurbo::{Point, Rect, Vec2};
use std::sync::Arc;

/// Starts along a side of the box at least.
const LEAST: usize = 12;
/// And at most.
const MOST: usize = 96;
/// Newton steps from one start.
const STEPS: usize = 40;
/// Starts tried for one place.
const TRIES: usize = 16;

/// What the inverse says where it is not defined.
pub(super) const NOWHERE: Jet =
    Jet { p: Point::new(f64::NAN, f64::NAN), dx: Vec2::new(f64::NAN, f64::NAN), dy: Vec2::new(f64::NAN, f64::NAN) };

/// The inverse of a smooth map over a box.
pub struct NewtonInverse {
    map: Arc<dyn Map>,
    domain: Rect,
    core: Rect,
    /// The sign of the determinant in the core's middle.
    up: f64,
    reach: f64,
    starts: Vec<Start>,
    /// Starts by the place of their cells' images: a grid of buckets over `bounds`.
    buckets: Vec<Vec<u32>>,
    bounds: Rect,
    side: usize,
    lipschitz: f64,
    /// Rounding of an image coordinate.
    rounding: f64,
}

#[derive(Debug, Clone, Copy)]
struct Start {
    at: Point,
    image: Point,
    in_core: bool,
}

impl NewtonInverse {
    /// The inverse of `map` over `area`, with starts enough for a map that bends a few times across it; answers beyond it
    /// count up to the share `reach` of its diagonal.
    #[must_use]
    pub fn over(map: Arc<dyn Map>, area: Rect, reach: f64) -> Self {
        const PIECES: [usize; 2] = [6, 6];
        Self::new(map, area, reach * area.width().hypot(area.height()), PIECES)
    }

    /// The inverse of `map` over `domain`; answers up to `reach` beyond it count. `pieces` along x and y: how finely the map
    /// is divided (1, 1 for one polynomial piece).
    #[must_use]
    pub fn new(map: Arc<dyn Map>, domain: Rect, reach: f64, pieces: [usize; 2]) -> Self {
        Self::with_core(map, domain, domain, reach, pieces)
    }

    /// The same with a core smaller than the box.
    #[must_use]
    pub fn with_core(map: Arc<dyn Map>, core: Rect, domain: Rect, reach: f64, pieces: [usize; 2]) -> Self {
        let [nx, ny] = pieces.map(|n| (n * 4).clamp(LEAST, MOST));
        let cell = Vec2::new(domain.width() / nx as f64, domain.height() / ny as f64);
        let at = |i: usize, j: usize| domain.origin() + Vec2::new((i as f64 + 0.5) * cell.x, (j as f64 + 0.5) * cell.y);
        let places: Vec<Point> = (0..ny).flat_map(|j| (0..nx).map(move |i| at(i, j))).collect();
        let mut jets = vec![Jet::default(); places.len()];
        map.jets(&places, &mut jets);

        let mut lipschitz: f64 = 0.0;
        let mut between = |a: &Jet, b: &Jet, apart: f64| {
            let (dx, dy) = (a.dx - b.dx, a.dy - b.dy);
            let rate = (dx.hypot2() + dy.hypot2()).sqrt() / apart;
            if rate.is_finite() {
                lipschitz = lipschitz.max(rate);
            }
        };
        for (k, jet) in jets.iter().enumerate() {
            if (k + 1) % nx != 0 {
                between(jet, &jets[k + 1], cell.x);
            }
            if k + nx < jets.len() {
                between(jet, &jets[k + nx], cell.y);
            }
        }

        // Each start with the box of its cell's image, to first order and half as large again.
        let mut starts = Vec::with_capacity(places.len());
        let mut boxes = Vec::with_capacity(places.len());
        for (at, j) in places.iter().zip(&jets).filter(|(_, j)| j.is_finite()) {
            let half = Vec2::new(
                0.75 * (j.dx.x.abs() * cell.x + j.dy.x.abs() * cell.y),
                0.75 * (j.dx.y.abs() * cell.x + j.dy.y.abs() * cell.y),
            );
            starts.push(Start { at: *at, image: j.p, in_core: core.contains(*at) });
            boxes.push(Rect::from_points(j.p - half, j.p + half));
        }
        let bounds = boxes.iter().copied().reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
        let side = nx.max(ny);
        let up = map.jet(core.center()).det().signum();
        let mut out = Self {
            map,
            core,
            up,
            domain,
            reach,
            buckets: vec![Vec::new(); side * side],
            bounds,
            side,
            lipschitz: 2.0 * lipschitz,
            rounding: 64.0
                * f64::EPSILON
                * [bounds.x0, bounds.y0, bounds.x1, bounds.y1].iter().fold(1e-300, |a: f64, v| a.max(v.abs())),
            starts,
        };
        for (k, b) in boxes.iter().enumerate() {
            let ((i0, j0), (i1, j1)) = (out.bucket(b.origin()), out.bucket(Point::new(b.x1, b.y1)));
            for j in j0..=j1 {
                for i in i0..=i1 {
                    out.buckets[j * side + i].push(k as u32);
                }
            }
        }
        out
    }

    fn bucket(&self, q: Point) -> (usize, usize) {
        let along =
            |v: f64, a: f64, b: f64| (((v - a) / (b - a) * self.side as f64).max(0.0) as usize).min(self.side - 1);
        (along(q.x, self.bounds.x0, self.bounds.x1), along(q.y, self.bounds.y0, self.bounds.y1))
    }

    /// The preimage of `q` and the inverse's derivatives there; `None` where there is none in the box.
    #[must_use]
    pub fn solve(&self, q: Point) -> Option<Jet> {
        self.solve_where(q, |_| true)
    }

    /// The same among the preimages that `accept` accepts.
    #[must_use]
    pub fn solve_where(&self, q: Point, accept: impl Fn(Point) -> bool) -> Option<Jet> {
        if !q.is_finite() || self.starts.is_empty() {
            return None;
        }
        let (i, j) = self.bucket(q);
        let near = &self.buckets[j * self.side + i];
        let off = |s: &Start| (s.image - q).hypot2();
        if near.is_empty() {
            let start = self.starts.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
            return self.from(start.at, q).filter(|found| self.counts(found) && accept(found.p));
        }
        let mut tried = [u32::MAX; TRIES];
        let mut best: Option<(f64, Jet)> = None;
        for n in 0..TRIES {
            // Starts in the core first, then by how near their images are.
            let key = |k: u32| {
                let s = &self.starts[k as usize];
                (!s.in_core, off(s))
            };
            let all = near.iter().copied().filter(|k| !tried.contains(k));
            let less = |a: &u32, b: &u32| {
                let (a, b) = (key(*a), key(*b));
                a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
            };
            let Some(k) = all.min_by(less) else { break };
            tried[n] = k;
            let Some(found) = self.from(self.starts[k as usize].at, q).filter(|f| accept(f.p)) else { continue };
            let beyond = self.beyond(found.p);
            if beyond <= self.reach {
                return Some(found);
            }
            if self.counts(&found) && best.is_none_or(|(least, _)| beyond < least) {
                best = Some((beyond, found));
            }
        }
        best.map(|b| b.1)
    }

    /// How far a place is outside the core.
    fn beyond(&self, p: Point) -> f64 {
        let c = &self.core;
        (c.x0 - p.x).max(p.x - c.x1).max(c.y0 - p.y).max(p.y - c.y1).max(0.0)
    }

    /// Whether a preimage lies in the core, or on a sheet the same way up.
    fn counts(&self, found: &Jet) -> bool {
        found.det().signum() == self.up || self.beyond(found.p) <= self.reach
    }

    /// Newton's method from one start.
    fn from(&self, start: Point, q: Point) -> Option<Jet> {
        let room = self.domain.inflate(0.25 * self.domain.width(), 0.25 * self.domain.height());
        let mut x = start;
        let mut jet = self.map.jet(x);
        let mut residual = q - jet.p;
        for _ in 0..STEPS {
            let step = solve(&jet, residual)?;
            // Halved until it brings the image nearer; beyond the box's neighbourhood nothing is known of the map.
            let mut share = 1.0;
            let (mut to, mut at, mut r) = (x, jet, residual);
            while share > 1e-4 {
                to = x + step * share;
                to = Point::new(to.x.clamp(room.x0, room.x1), to.y.clamp(room.y0, room.y1));
                at = self.map.jet(to);
                r = q - at.p;
                if r.hypot2() < residual.hypot2() || r.hypot() <= self.rounding {
                    break;
                }
                share *= 0.5;
            }
            let (moved, better) = ((to - x).hypot(), r.hypot2() < residual.hypot2());
            if better || r.hypot() <= self.rounding {
                (x, jet, residual) = (to, at, r);
            }
            let still = moved <= 4.0 * f64::EPSILON * (x.x.abs() + x.y.abs() + self.domain.width());
            if residual == Vec2::ZERO || still || !better {
                return self.accepted(x, &jet, residual);
            }
        }
        None
    }

    fn accepted(&self, x: Point, jet: &Jet, residual: Vec2) -> Option<Jet> {
        let b = self.domain.inflate(self.reach, self.reach);
        let det = jet.det();
        let beta = (jet.dx.hypot2() + jet.dy.hypot2()).sqrt() / det.abs();
        let eta = solve(jet, residual)?.hypot();
        let sound = residual.hypot() <= self.rounding
            && (b.x0..=b.x1).contains(&x.x)
            && (b.y0..=b.y1).contains(&x.y)
            && beta * self.lipschitz * eta <= 0.5;
        sound.then(|| Jet { p: x, dx: Vec2::new(jet.dy.y, -jet.dx.y) / det, dy: Vec2::new(-jet.dy.x, jet.dx.x) / det })
    }
}

/// J⁻¹·v; `None` if J is singular.
fn solve(j: &Jet, v: Vec2) -> Option<Vec2> {
    let det = j.det();
    let out = Vec2::new(v.cross(j.dy) / det, j.dx.cross(v) / det);
    out.is_finite().then_some(out)
}

impl Map for NewtonInverse {
    fn jet(&self, q: Point) -> Jet {
        self.solve(q).unwrap_or(NOWHERE)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(self.map.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Formula, Real};

    struct Fold;
    impl Formula for Fold {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x * x, y + x * y * 0.1)
        }
    }

    #[test]
    fn a_smooth_map_is_undone_and_nothing_is_made_up_beyond() {
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
        // No preimage at all; one outside the box.
        assert!(inv.point(Point::new(-1.0, 0.0)).is_nan());
        assert!(inv.point(Fold.point(Point::new(0.4, 0.0))).is_nan());
        assert!(inv.point(Fold.point(Point::new(2.0, 2.5))).is_nan());
    }

    #[test]
    fn on_a_fold_there_is_no_certificate() {
        let inv = NewtonInverse::new(Arc::new(Fold), Rect::new(-1.0, -1.0, 1.0, 1.0), 1e-9, [1, 1]);
        assert!(inv.point(Point::new(0.0, 0.3)).is_nan());
        let p = inv.point(Fold.point(Point::new(0.3, 0.2)));
        assert!(Fold.point(p).distance(Fold.point(Point::new(0.3, 0.2))) < 1e-14);
    }
}
