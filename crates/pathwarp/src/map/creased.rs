//! The inverse of a map with creases: it has creases where those of the map go, and a smooth branch on either side.

use super::newton::NewtonInverse;
use super::{Crease, CreaseKind, Creases, Jet, Level, Map};
use crate::budget::{Budget, Search};
use crate::map::{Cost, Searches};
use kurbo::{Point, Rect};
use std::sync::Arc;

/// The inverse of a map over `area`, a box in its source: in closed form if there is one ([`Map::inverse`]), or else by Newton's method,
/// whose answers may lie a quarter of the box's diagonal outside, as strokes and handles do. It has the creases of the map.
#[must_use]
pub fn inverse_over(map: &Arc<dyn Map>, area: Rect) -> Arc<dyn Map> {
    const REACH: f64 = 0.25;
    let by_newton = || CreasedInverse::of(map, NewtonInverse::over(Arc::clone(map), area, REACH));
    map.inverse().unwrap_or_else(by_newton)
}

/// Newton's inverse of a map in smooth pieces.
pub(crate) struct CreasedInverse {
    whole: Arc<NewtonInverse>,
    map: Arc<dyn Map>,
    /// The map's creases.
    kinks: Vec<Level>,
}

impl CreasedInverse {
    /// Declares the creases of `map` in its inverse; that alone if there are none, or so many that looking for each takes too long.
    pub(crate) fn of(map: &Arc<dyn Map>, whole: NewtonInverse) -> Arc<dyn Map> {
        const MOST: usize = 32;
        let (whole, mut all) = (Arc::new(whole), Creases::default());
        map.creases(&mut all);
        let kinks = all.items().iter().filter(|c| c.kind == CreaseKind::Kink).map(|c| c.level.clone());
        let kinks: Vec<Level> = kinks.collect();
        if kinks.is_empty() || kinks.len() > MOST || map.prefers_batches() {
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
        for level in &self.kinks {
            let (whole, level) = (Arc::clone(&self.whole), level.clone());
            out.push(Crease::kink(Level::Field(Arc::new(move |q| level.at(whole.point(q))))));
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let inside = self.whole.solve(inside)?.p;
        let map = self.map.branch(inside)?;
        let sides = self.kinks.iter().map(|k| (k.clone(), k.at(inside))).collect();
        Some(Arc::new(OnBranch { whole: Arc::clone(&self.whole), map, sides }))
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::clone(&self.map))
    }
}

impl Searches for CreasedInverse {
    fn within(&self, budget: &Arc<Budget>) -> Arc<dyn Map> {
        let map = self.map.within(budget).unwrap_or_else(|| Arc::clone(&self.map));
        Arc::new(Self { whole: Arc::new(self.whole.spending(budget)), map, kinks: self.kinks.clone() })
    }
}

/// The inverse of a branch of the map, found from the place to which the whole map leads.
struct OnBranch {
    whole: Arc<NewtonInverse>,
    map: Arc<dyn Map>,
    /// The map's creases with their values in the branch.
    sides: Vec<(Level, f64)>,
}

impl OnBranch {
    /// Returns `true` if `p` is in the branch, or at its boundary.
    fn holds(&self, p: Point) -> bool {
        /// Rounding, as a share of the value inside.
        const NOISE: f64 = 1e-9;
        self.sides.iter().all(|(level, inside)| level.at(p) * inside.signum() >= -NOISE * inside.abs())
    }
}

impl Map for OnBranch {
    fn cost(&self) -> Cost<'_> {
        Cost { searches: None, ..self.whole.cost() }
    }

    fn jet(&self, q: Point) -> Jet {
        // Where the ends of a closed strip meet, a point comes from both.
        let near = self.whole.solve(q).filter(|near| self.holds(near.p));
        let near = near.or_else(|| self.whole.solve_where(q, |p| self.holds(p))).or_else(|| self.whole.solve(q));
        let Some(near) = near else { return Jet::UNDEFINED };
        let mut search = Search::default();
        let found = self.whole.newton(&*self.map, near.p, q, &mut search);
        self.whole.counted((found, search)).unwrap_or(Jet::UNDEFINED)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::clone(&self.map))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Formula, Real};
    use kurbo::Rect;

    /// y + |x| / 2, and its smooth halves.
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
        let back =
            CreasedInverse::of(&map, NewtonInverse::over(Arc::clone(&map), Rect::new(-5.0, -5.0, 5.0, 5.0), 0.1));
        let mut creases = Creases::default();
        back.creases(&mut creases);
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

    /// A strip around a circle, whose ends meet, in two halves.
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
        let back = CreasedInverse::of(&map, NewtonInverse::over(Arc::clone(&map), Rect::new(0.0, -0.5, 1.0, 0.5), 0.1));
        for (side, x) in [(0.3, 0.0), (-0.3, 1.0)] {
            let branch = back.branch(Point::new(0.9, side)).unwrap();
            for r in [0.7, 1.0, 1.3] {
                let end = branch.point(Point::new(r, 0.0));
                assert!(end.distance(Point::new(x, r - 1.0)) < 1e-12, "{side} {r}: {end:?}");
            }
        }
    }
}
