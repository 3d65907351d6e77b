//! A map restricted to a convex polygon; nothing moves outside.
//!
//! The sides of the polygon are creases, crossed exactly. Whether the map is continuous there depends on the map inside.

use super::{AffineMap, Class, Cost, Crease, Creases, Jet, Level, Map, NewtonInverse, RationalBezier, Searches};
use crate::budget::Budget;
use kurbo::{Point, Rect};
use std::sync::Arc;

/// The distance from a side, relative to the coordinates, within which outside points count as inside: curves that end on a side or
/// touch it belong to the inside.
const ROUNDING: f64 = 1e-12;

/// A map inside a convex polygon, and the identity outside.
#[derive(Clone)]
pub(crate) struct Local {
    /// The coefficients of each side's signed distance a·x + b·y + c, positive inside, and the bounding box of the side.
    sides: Vec<([f64; 3], Rect)>,
    /// Distance within which outside points count as inside, in user units.
    rounding: f64,
    inside: Arc<dyn Map>,
}

impl Local {
    /// Restricts `inside` to the convex polygon with these corners, in either orientation.
    #[must_use]
    pub(crate) fn new(corners: &[Point], inside: Arc<dyn Map>) -> Self {
        let n = corners.len();
        let side = |k: usize| {
            let (p, q, other) = (corners[k], corners[(k + 1) % n], corners[(k + 2) % n]);
            let along = (q - p).normalize();
            let turn = if along.cross(other - p) < 0.0 { -1.0 } else { 1.0 };
            let (a, b) = (-along.y * turn, along.x * turn);
            ([a, b, -(a * p.x + b * p.y)], Rect::from_points(p, q))
        };
        let size = corners.iter().fold(0.0, |m, p| f64::max(m, p.x.abs() + p.y.abs()));
        Self { sides: (0..n).map(side).collect(), rounding: ROUNDING * size, inside }
    }

    /// The signed distance from `p` to the nearest side's line, negative outside.
    fn depth(&self, p: Point) -> f64 {
        self.sides.iter().map(|([a, b, c], _)| a * p.x + b * p.y + c).fold(f64::INFINITY, f64::min)
    }

    /// The bounding box of the polygon.
    fn bounds(&self) -> Rect {
        self.sides.iter().map(|s| s.1).reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO)
    }

    /// Distance by which the inverse goes on beyond the sides, for curves that end on them.
    fn margin(&self) -> f64 {
        1e-3 * (self.bounds().width() + self.bounds().height())
    }

    /// Returns `true` if `p` is inside, up to rounding.
    fn contains(&self, p: Point) -> bool {
        self.depth(p) >= -self.rounding
    }
}

impl Map for Local {
    fn cost(&self) -> Cost<'_> {
        Cost::new(self.inside.work()) // The map inside does not search.
    }

    fn jet(&self, p: Point) -> Jet {
        if self.contains(p) { self.inside.jet(p) } else { AffineMap::IDENTITY.jet(p) }
    }

    fn point(&self, p: Point) -> Point {
        if self.contains(p) { self.inside.point(p) } else { p }
    }

    fn creases(&self, out: &mut Creases) {
        for ([a, b, c], within) in &self.sides {
            out.push(Crease::kink(Level::Stretch { a: *a, b: *b, c: *c, within: *within }));
        }
        for c in Creases::of_map(&self.inside).items() {
            let (level, local) = (c.level.clone(), self.clone());
            let level = Level::Field(Arc::new(move |p: Point| if local.contains(p) { level.at(p) } else { 1.0 }));
            out.push(Crease { level, kind: c.kind });
        }
    }

    /// The branch at the point `inside`, which may lie outside the polygon.
    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        Some(if self.contains(inside) {
            self.inside.branch(inside).unwrap_or_else(|| self.inside.clone())
        } else {
            Arc::new(AffineMap::IDENTITY)
        })
    }

    /// The image of a curve whose control points, and therefore the whole curve, lie inside, or beyond one side.
    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        let points = curve.hull()?;
        if points.iter().all(|p| self.contains(*p)) {
            return self.inside.image(curve);
        }
        let beyond = |[a, b, c]: [f64; 3]| points.iter().all(|p| a * p.x + b * p.y + c < -self.rounding);
        self.sides.iter().any(|s| beyond(s.0)).then(|| curve.clone())
    }

    fn preimages(&self, q: Point) -> Option<Vec<Point>> {
        // Preimages are less exact than points.
        let inside = self.inside.preimages(q)?.into_iter().filter(|p| self.depth(*p) >= -1e3 * self.rounding);
        Some(inside.chain((!self.contains(q)).then_some(q)).collect())
    }

    /// The inverse of the map inside, for points whose preimage lies inside, and the identity for others.
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        let inner = match self.inside.inverse().filter(|m| m.cost().searches.is_none()) {
            Some(closed) => InnerInverse::Closed(closed),
            None if !matches!(self.inside.class(), Class::Rational(_) | Class::Smooth) => return None,
            None => {
                // The map inside is a single smooth piece along x and y.
                let (inside, bounds) = (self.inside.clone(), self.bounds());
                InnerInverse::Newton(Arc::new(NewtonInverse::new(inside, bounds, self.margin(), [1, 1])))
            }
        };
        Some(Arc::new(LocalInverse { map: self.clone(), inner }))
    }
}

/// The method that inverts the map inside the polygon.
#[derive(Clone)]
enum InnerInverse {
    Closed(Arc<dyn Map>),
    Newton(Arc<NewtonInverse>),
}

/// The inverse of a [`Local`] map.
#[derive(Clone)]
struct LocalInverse {
    map: Local,
    inner: InnerInverse,
}

impl LocalInverse {
    /// The preimage inside the polygon, or at most `margin` outside.
    fn preimage(&self, q: Point, margin: f64) -> Option<Jet> {
        let accept = |p: Point| self.map.depth(p) >= -margin;
        match &self.inner {
            InnerInverse::Closed(m) => Some(m.jet(q)).filter(|j| j.is_finite() && accept(j.p)),
            InnerInverse::Newton(m) => m.solve_where(q, accept),
        }
    }

    fn spending(&self, budget: &Arc<Budget>) -> Self {
        // A closed form does not search.
        let InnerInverse::Newton(m) = &self.inner else { return self.clone() };
        Self { map: self.map.clone(), inner: InnerInverse::Newton(Arc::new(m.spending(budget))) }
    }
}

impl Map for LocalInverse {
    fn cost(&self) -> Cost<'_> {
        let work = match &self.inner {
            InnerInverse::Closed(m) => m.work(),
            InnerInverse::Newton(m) => m.cost().work,
        };
        Cost::new(work).searching(self)
    }

    fn jet(&self, q: Point) -> Jet {
        match self.preimage(q, self.map.rounding) {
            Some(found) => found,
            None if !self.map.contains(q) => AffineMap::IDENTITY.jet(q),
            None => Jet::UNDEFINED,
        }
    }

    fn creases(&self, out: &mut Creases) {
        let inverse = self.clone();
        out.push(Crease::kink(Level::Field(Arc::new(move |q: Point| {
            let margin = inverse.map.margin();
            inverse.preimage(q, margin).map_or(-margin, |found| inverse.map.depth(found.p))
        }))));
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        if self.preimage(inside, self.map.rounding).is_none() {
            return Some(Arc::new(AffineMap::IDENTITY));
        }
        Some(match &self.inner {
            InnerInverse::Closed(m) => m.clone(),
            InnerInverse::Newton(_) => Arc::new(InsideInverse(self.clone())),
        })
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.map.clone()))
    }
}

impl Searches for LocalInverse {
    fn within(&self, budget: &Arc<Budget>) -> Arc<dyn Map> {
        Arc::new(self.spending(budget))
    }
}

/// The branch of a [`LocalInverse`] whose values lie inside the polygon.
struct InsideInverse(LocalInverse);

impl Map for InsideInverse {
    fn cost(&self) -> Cost<'_> {
        self.0.cost().searching(self)
    }

    fn jet(&self, q: Point) -> Jet {
        self.0.preimage(q, self.0.map.margin()).unwrap_or(Jet::UNDEFINED)
    }

    fn detail(&self, area: Rect) -> Option<f64> {
        if let InnerInverse::Newton(m) = &self.0.inner { m.detail(area) } else { None }
    }
}

impl Searches for InsideInverse {
    fn within(&self, budget: &Arc<Budget>) -> Arc<dyn Map> {
        Arc::new(Self(self.0.spending(budget)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Formula, Real};
    use kurbo::Vec2;

    struct Swell;
    impl Formula for Swell {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x, y + x * (S::from(1.0) - x) * 0.3)
        }
    }

    #[test]
    fn inside_moves_outside_stays_and_branches_reach_the_border() {
        for corners in [[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)], [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)]] {
            let m = Local::new(&corners.map(Point::from), Arc::new(Swell));
            assert_eq!(m.point((0.25, 0.25).into()), Swell.point((0.25, 0.25).into()));
            for p in [(0.6, 0.6), (-0.1, 0.2), (0.3, -0.01)] {
                assert_eq!(m.point(p.into()), p.into());
                assert_eq!(m.branch(p.into()).unwrap().point((0.2, 0.2).into()), (0.2, 0.2).into());
            }
            let b = m.branch((0.3, 0.3).into()).unwrap();
            assert_eq!(b.jet((0.5, 0.5).into()).dx, Vec2::new(1.0, 0.0));
            let back = m.inverse().unwrap();
            for p in [(0.25, 0.25), (0.8, 0.8), (0.5, 0.1)] {
                assert!(back.point(m.point(p.into())).distance(p.into()) < 1e-15);
            }
            // No point maps into the gap that the swell leaves at the bottom.
            assert!(back.point((0.5, 0.01).into()).is_nan());
        }
    }

    #[test]
    fn curves_on_one_side_have_exact_images_and_crossings_are_exact() {
        let m = Local::new(&[(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)].map(Point::from), Arc::new(AffineMap::IDENTITY));
        let curve = |ps: &[(f64, f64)]| RationalBezier::polynomial(&ps.iter().map(|p| (*p).into()).collect::<Vec<_>>());
        assert!(m.image(&curve(&[(1.0, 1.0), (2.0, 1.0)])).is_some());
        assert!(m.image(&curve(&[(3.0, 3.0), (4.0, 3.0)])).is_some());
        assert!(m.image(&curve(&[(1.0, 1.0), (4.0, 3.0)])).is_none());
        let creases = Creases::of_map(&m);
        let seg = crate::outline::Seg::Line(kurbo::Line::new((-1.0, 1.0), (9.0, 1.0)));
        // The segment enters at the left side and leaves at the slanting one. The lines of the sides do not count outside the sides.
        let at = creases.splits(&seg);
        assert!(at.len() == 2 && (at[0] - 0.1).abs() < 1e-15 && (at[1] - 0.4).abs() < 1e-15, "{at:?}");
        let below = crate::outline::Seg::Line(kurbo::Line::new((6.0, -1.0), (6.0, 9.0)));
        assert!(creases.splits(&below).is_empty());
    }
}
