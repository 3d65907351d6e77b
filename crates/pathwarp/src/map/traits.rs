//! The trait that every map implements.

use super::batch::{Lane, WIDTH};
use super::{Class, Creases, Jet, RationalBezier, RationalDegree};
use crate::budget::Budget;
use kurbo::Point;
use std::fmt;
use std::sync::Arc;

/// A differentiable map of the plane, in root user units, y down.
///
/// Only [`Map::jet`] is required. [`point`](Map::point), [`points`](Map::points) and [`jets`](Map::jets) are faster ways to the
/// same values; the other methods tell the refitter where the map is not smooth and what is known about it exactly.
pub trait Map: Send + Sync {
    /// Value and both partial derivatives at `p`. On a crease, those of either side.
    fn jet(&self, p: Point) -> Jet;

    /// The value alone.
    fn point(&self, p: Point) -> Point {
        self.jet(p).p
    }

    /// The jets at `ps`: one virtual call for all of them. `out` has the length of `ps`.
    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        for (p, o) in ps.iter().zip(out) {
            *o = self.jet(*p);
        }
    }

    /// The values at `ps`: one virtual call for all of them. `out` has the length of `ps`.
    fn points(&self, ps: &[Point], out: &mut [Point]) {
        for (p, o) in ps.iter().zip(out) {
            *o = self.point(*p);
        }
    }

    /// The class of the map. Affine and projective maps need no refitting, and neighbours fold into one in a
    /// [`Chain`](super::Chain).
    fn class(&self) -> Class {
        Class::Smooth
    }

    /// Adds the places where the map is not smooth, and the boundary of its domain.
    fn creases(&self, _out: &mut Creases) {}

    /// For a map with creases: the smooth map that agrees with this one on the piece of the plane, cut at the creases, that
    /// contains `inside`. On the boundary of that piece it gives the limit from inside. `None`: the map itself is smooth.
    fn branch(&self, _inside: Point) -> Option<Arc<dyn Map>> {
        None
    }

    /// The exact image of a (rational) Bézier curve, if the image is one again.
    fn image(&self, _curve: &RationalBezier) -> Option<RationalBezier> {
        None
    }

    /// The degree of the map if its coordinates are quotients of polynomials: enough to prove error bounds without writing out
    /// an image. A map that is [`rational`](RationalDegree::rational) implements [`denominator`](Map::denominator) too.
    fn rational_degree(&self) -> Option<RationalDegree> {
        None
    }

    /// The common denominator W of the coordinates at `p`: positive where the map is defined, 1 for polynomials.
    fn denominator(&self, _p: Point) -> f64 {
        1.0
    }

    /// The inverse map, if there is one.
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        None
    }

    /// The cost of one evaluation, relative to that of a bicubic net, for [`budget`](crate::budget): a map that takes longer the
    /// more parts it has says so here. 1 or more.
    fn work(&self) -> f64 {
        1.0
    }

    /// The cost of a jet alone, as Newton's method asks for it, relative to that of a bicubic net. A map of many parts takes longer alone
    /// than in a batch.
    #[doc(hidden)]
    fn jet_work(&self) -> f64 {
        const SINGLY: f64 = 3.0;
        1.0 + SINGLY * (self.work() - 1.0).max(0.0)
    }

    /// The same map, whose searches spend from a budget what they take beyond [`work`](Map::work), and find nothing once it is used up.
    /// `None`: nothing is searched.
    #[doc(hidden)]
    fn within(&self, _budget: &Arc<Budget>) -> Option<Arc<dyn Map>> {
        None
    }

    /// Returns `true` if a call costs much and a point little, as where another program is asked. Callers then collect the points
    /// they need.
    fn prefers_batches(&self) -> bool {
        false
    }

    /// Returns `true` if derivatives are computed from several values each, by differences. Callers then use values where they can.
    #[doc(hidden)]
    fn differentiates(&self) -> bool {
        false
    }

    /// Returns `true` for a memory in front of a map that [prefers batches](Map::prefers_batches).
    #[doc(hidden)]
    fn remembers(&self) -> bool {
        false
    }

    /// Announces points whose values and points whose jets are asked for next, to a memory in front of a map that
    /// [prefers batches](Map::prefers_batches).
    #[doc(hidden)]
    fn prepare(&self, _points: &[Point], _jets: &[Point]) {}

    /// Maps a batch of points, and gives the jets at others: one call where each costs much.
    #[doc(hidden)]
    fn points_and_jets(&self, (ps, images): (&[Point], &mut [Point]), (qs, jets): (&[Point], &mut [Jet])) {
        self.points(ps, images);
        self.jets(qs, jets);
    }

    /// Maps a batch of points in place. See [`batch`](super::batch).
    #[doc(hidden)]
    fn lanes(&self, x: &mut Lane, y: &mut Lane) {
        let mut source = [Point::ORIGIN; WIDTH];
        for (p, (x, y)) in source.iter_mut().zip(x.iter().zip(y.iter())) {
            *p = Point::new(*x, *y);
        }
        let mut image = [Point::ORIGIN; WIDTH];
        self.points(&source, &mut image);
        for (p, (x, y)) in image.iter().zip(x.iter_mut().zip(y)) {
            (*x, *y) = (p.x, p.y);
        }
    }

    /// The denominators of a batch of points. See [`batch`](super::batch).
    #[doc(hidden)]
    fn denominators(&self, x: &Lane, y: &Lane) -> Lane {
        std::array::from_fn(|i| self.denominator(Point::new(x[i], y[i])))
    }
}

/// Forwards every method: a method left to its default would lose the speed of the map behind the pointer, silently.
macro_rules! forward {
    () => {
        fn jet(&self, p: Point) -> Jet {
            (**self).jet(p)
        }
        fn point(&self, p: Point) -> Point {
            (**self).point(p)
        }
        fn jets(&self, ps: &[Point], out: &mut [Jet]) {
            (**self).jets(ps, out);
        }
        fn points(&self, ps: &[Point], out: &mut [Point]) {
            (**self).points(ps, out);
        }
        fn class(&self) -> Class {
            (**self).class()
        }
        fn creases(&self, out: &mut Creases) {
            (**self).creases(out);
        }
        fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
            (**self).branch(inside)
        }
        fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
            (**self).image(curve)
        }
        fn rational_degree(&self) -> Option<RationalDegree> {
            (**self).rational_degree()
        }
        fn denominator(&self, p: Point) -> f64 {
            (**self).denominator(p)
        }
        fn inverse(&self) -> Option<Arc<dyn Map>> {
            (**self).inverse()
        }
        fn work(&self) -> f64 {
            (**self).work()
        }
        fn jet_work(&self) -> f64 {
            (**self).jet_work()
        }
        fn within(&self, budget: &Arc<Budget>) -> Option<Arc<dyn Map>> {
            (**self).within(budget)
        }
        fn prefers_batches(&self) -> bool {
            (**self).prefers_batches()
        }
        fn differentiates(&self) -> bool {
            (**self).differentiates()
        }
        fn remembers(&self) -> bool {
            (**self).remembers()
        }
        fn prepare(&self, points: &[Point], jets: &[Point]) {
            (**self).prepare(points, jets);
        }
        fn points_and_jets(&self, points: (&[Point], &mut [Point]), jets: (&[Point], &mut [Jet])) {
            (**self).points_and_jets(points, jets);
        }
        fn lanes(&self, x: &mut Lane, y: &mut Lane) {
            (**self).lanes(x, y);
        }
        fn denominators(&self, x: &Lane, y: &Lane) -> Lane {
            (**self).denominators(x, y)
        }
    };
}

impl<M: Map + ?Sized> Map for Arc<M> {
    forward!();
}

/// Of pointers that are not shared, those to `dyn Map` are maps, as every [`Formula`](super::Formula) is one, and any crate may write a
/// formula for a reference or a box of its own type.
impl Map for &(dyn Map + '_) {
    forward!();
}

impl Map for Box<dyn Map + '_> {
    forward!();
}

impl fmt::Debug for dyn Map + '_ {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Map({:?})", self.class())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    /// A map that overrides everything and records which methods are called.
    #[derive(Default)]
    struct Recorder(Mutex<Vec<&'static str>>);

    impl Recorder {
        fn record<T>(&self, name: &'static str, value: T) -> T {
            self.0.lock().unwrap().push(name);
            value
        }
    }

    impl Map for Recorder {
        fn jet(&self, p: Point) -> Jet {
            self.record("jet", Jet { p, ..Jet::default() })
        }
        fn point(&self, p: Point) -> Point {
            self.record("point", p)
        }
        fn jets(&self, _ps: &[Point], _out: &mut [Jet]) {
            self.record("jets", ());
        }
        fn points(&self, _ps: &[Point], _out: &mut [Point]) {
            self.record("points", ());
        }
        fn class(&self) -> Class {
            self.record("class", Class::Smooth)
        }
        fn creases(&self, _out: &mut Creases) {
            self.record("creases", ());
        }
        fn branch(&self, _inside: Point) -> Option<Arc<dyn Map>> {
            self.record("branch", None)
        }
        fn image(&self, _curve: &RationalBezier) -> Option<RationalBezier> {
            self.record("image", None)
        }
        fn rational_degree(&self) -> Option<RationalDegree> {
            self.record("rational_degree", None)
        }
        fn denominator(&self, _p: Point) -> f64 {
            self.record("denominator", 2.0)
        }
        fn inverse(&self) -> Option<Arc<dyn Map>> {
            self.record("inverse", None)
        }
        fn work(&self) -> f64 {
            self.record("work", 3.0)
        }
        fn jet_work(&self) -> f64 {
            self.record("jet_work", 5.0)
        }
        fn within(&self, _budget: &Arc<Budget>) -> Option<Arc<dyn Map>> {
            self.record("within", None)
        }
        fn prefers_batches(&self) -> bool {
            self.record("prefers_batches", true)
        }
        fn differentiates(&self) -> bool {
            self.record("differentiates", true)
        }
        fn remembers(&self) -> bool {
            self.record("remembers", true)
        }
        fn prepare(&self, _points: &[Point], _jets: &[Point]) {
            self.record("prepare", ());
        }
        fn points_and_jets(&self, _points: (&[Point], &mut [Point]), _jets: (&[Point], &mut [Jet])) {
            self.record("points_and_jets", ());
        }
        fn lanes(&self, _x: &mut Lane, _y: &mut Lane) {
            self.record("lanes", ());
        }
        fn denominators(&self, _x: &Lane, _y: &Lane) -> Lane {
            self.record("denominators", [2.0; WIDTH])
        }
    }

    /// Calls every method once, in the order of the trait.
    fn call_all(map: &impl Map) {
        let (p, curve) = (Point::new(1.0, 2.0), RationalBezier::polynomial(&[Point::ORIGIN, Point::new(1.0, 1.0)]));
        let _ = map.jet(p);
        let _ = map.point(p);
        map.jets(&[p], &mut [Jet::default()]);
        map.points(&[p], &mut [p]);
        let _ = map.class();
        map.creases(&mut Creases::default());
        let _ = map.branch(p);
        let _ = map.image(&curve);
        let _ = map.rational_degree();
        let _ = map.denominator(p);
        let _ = map.inverse();
        let _ = map.work();
        let _ = map.jet_work();
        let _ = map.within(&Arc::default());
        let _ = map.prefers_batches();
        let _ = map.differentiates();
        let _ = map.remembers();
        map.prepare(&[p], &[p]);
        map.points_and_jets((&[p], &mut [p]), (&[p], &mut [Jet::default()]));
        map.lanes(&mut [1.0; WIDTH], &mut [2.0; WIDTH]);
        let _ = map.denominators(&[1.0; WIDTH], &[2.0; WIDTH]);
    }

    #[test]
    fn pointers_forward_every_method() {
        let direct = Recorder::default();
        call_all(&direct);
        let expected = direct.0.into_inner().unwrap();
        // The trait's own text says how many methods there are, so that a new one cannot be forgotten here.
        let text = include_str!("traits.rs");
        let declared = text.split("\n}\n").next().unwrap().matches("\n    fn ").count();
        assert_eq!(expected.len(), declared);

        let shared = Arc::new(Recorder::default());
        call_all(&shared);
        assert_eq!(*shared.0.lock().unwrap(), expected);
        let shared = Arc::new(Recorder::default());
        let erased: Arc<dyn Map> = shared.clone();
        call_all(&erased);
        assert_eq!(*shared.0.lock().unwrap(), expected);
        let lent = Recorder::default();
        call_all(&(&lent as &dyn Map));
        assert_eq!(*lent.0.lock().unwrap(), expected);
        let boxed: Box<dyn Map> = Box::new(Arc::clone(&shared));
        call_all(&boxed);
        assert_eq!(shared.0.lock().unwrap()[expected.len()..], expected);
    }

    /// A map written with `jet` alone has batches that agree with it to the last bit.
    #[test]
    fn default_batches_follow_from_the_jet() {
        struct OnlyJet;
        impl Map for OnlyJet {
            fn jet(&self, p: Point) -> Jet {
                Jet { p: Point::new(p.x * p.y, p.x - 3.0 * p.y), ..Jet::default() }
            }
        }
        let mut x: Lane = std::array::from_fn(|i| 0.1 * i as f64 - 0.3);
        let mut y: Lane = std::array::from_fn(|i| 1.7 / (i + 1) as f64);
        let expected: Vec<Point> = x.iter().zip(&y).map(|(x, y)| OnlyJet.point(Point::new(*x, *y))).collect();
        OnlyJet.lanes(&mut x, &mut y);
        assert!(expected.iter().enumerate().all(|(i, p)| p.x == x[i] && p.y == y[i]));
        assert_eq!(OnlyJet.denominators(&x, &y), [1.0; WIDTH]);
    }
}
