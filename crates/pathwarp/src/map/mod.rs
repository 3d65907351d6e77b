//! Maps of the plane, which deformations build from their parameters.
//!
//! A [`Map`] takes every point of the drawing to its image and knows the derivatives there. [`warp_path`] samples a map along a
//! path and fits Bézier curves to the image. To map a bitmap, the inverse map gives the source of each pixel.
//!
//! # Writing a map
//!
//! [`from_fn`] makes a map from a closure. References, boxes and [`Arc`]s of maps are maps.
//!
//! Implement [`Formula`]: one function from (x, y) to (x, y), generic over the number type ([`Real`]). Run on `f64` it gives
//! values, run on [`Dual`] numbers it gives derivatives. Implement [`Map`] itself if derivatives have a cheaper closed form; only
//! [`Map::jet`], the value and both partial derivatives at a point, is required.
//!
//! Everything else is optional and makes results better:
//!
//! - [`Map::class`] reports affine and projective maps, which are applied to control points or keep lines straight.
//! - [`Map::creases`] lists the lines along which the derivative jumps and the boundary of the domain. Paths are split there, and
//!   [`Map::branch`] gives the smooth map on one side.
//! - [`Map::class`] and [`Map::image`] describe the image exactly, so that the error of a fit can be proved instead of measured.
//! - [`Map::inverse`] gives the inverse in closed form. [`NewtonInverse`] inverts any smooth map over a box.
//!
//! # Composing maps
//!
//! [`Chain`] applies maps one after another. Compose first and refit once: every refit adds to the error and to the number of
//! nodes.
//!
//! # Maps in this module
//!
//! [`AffineMap`] and [`Homography`]; [`BicubicNet`], given by 16 control points; [`LatticeMap`], free-form deformation by a
//! [`Lattice`] of any size; [`Birational`], a lattice of two rows with a closed-form inverse; and [`Coons`], given by four curved
//! sides. The maps of single deformations are in [`deform`](crate::deform).
//!
//! Coordinates are user units of the drawing's root, y down.
//!
//! [`warp_path`]: crate::refit::warp_path

/// Forwards the methods of the same name in [`Map`] and [`Formula`], except the inverse and the cost, which wrappers of maps change.
macro_rules! forward_common {
    ($self:ident => $trait:ident, $to:expr) => {
        fn class(&$self) -> Class {
            $trait::class($to)
        }
        fn creases(&$self, out: &mut Creases) {
            $trait::creases($to, out);
        }
        fn branch(&$self, inside: Point) -> Option<Arc<dyn Map>> {
            $trait::branch($to, inside)
        }
        fn image(&$self, curve: &RationalBezier) -> Option<RationalBezier> {
            $trait::image($to, curve)
        }
        fn denominator(&$self, p: Point) -> f64 {
            $trait::denominator($to, p)
        }
        fn preimages(&$self, q: Point) -> Option<Vec<Point>> {
            $trait::preimages($to, q)
        }
        fn detail(&$self, area: Rect) -> Option<f64> {
            $trait::detail($to, area)
        }
    };
}

pub(crate) use forward_common;

/// Forwards every method: a method left to its default would lose the speed of the map behind the pointer, silently.
macro_rules! forward {
    ($jet:ident $point:ident $jets:ident $points:ident $enclose:ident) => {
        fn $jet(&self, p: Point) -> Jet {
            (**self).jet(p)
        }
        fn $point(&self, p: Point) -> Point {
            (**self).point(p)
        }
        fn $jets(&self, ps: &[Point], out: &mut [Jet]) {
            (**self).jets(ps, out);
        }
        fn $points(&self, ps: &[Point], out: &mut [Point]) {
            (**self).points(ps, out);
        }
        fn $enclose(&self, along: [Enclosure; 2]) -> Option<[Enclosure; 2]> {
            (**self).enclose(along)
        }
        fn inverse(&self) -> Option<Arc<dyn Map>> {
            (**self).inverse()
        }
        fn cost(&self) -> Cost<'_> {
            (**self).cost()
        }
        forward_common!(self => Map, &**self);
    };
}

/// Implements [`Map::jet`] and [`Map::point`] by batches of one point.
macro_rules! single_by_batch {
    () => {
        fn jet(&self, p: Point) -> Jet {
            let mut out = [Jet::UNDEFINED];
            self.jets(&[p], &mut out);
            out[0]
        }
        fn point(&self, p: Point) -> Point {
            let mut out = [p];
            self.points(&[p], &mut out);
            out[0]
        }
    };
}

pub(crate) mod batches;
mod bicubic;
mod birational;
#[doc(hidden)]
pub mod bspline;
pub(crate) mod called;
mod chain;
mod coons;
mod crease;
pub(crate) mod curves;
mod enclosure;
mod formula;
mod homography;
pub(crate) mod joint;
mod lattice;
mod local;
mod newton;
pub(crate) mod patch;
mod preimages;
mod projective;
pub(crate) mod quotient;
pub(crate) mod rational_bezier;
mod real;
pub(crate) mod tiled;

use crate::budget::Budget;
use kurbo::{Affine, Point, Rect, Vec2};
use std::fmt;
use std::sync::Arc;

pub(crate) use batches::{Batches, Cost, Gathered, Images, Searches};
pub(crate) use bicubic::complete_net;
pub use bicubic::{BicubicNet, Net};
pub use birational::{Birational, BirationalInverse, Monoid, Rows};
pub use chain::Chain;
pub use coons::{Coons, Sides};
pub use crease::{Crease, CreaseKind, Creases, Field, Level};
pub use curves::{Pace, Side};
pub use enclosure::Enclosure;
pub(crate) use enclosure::enclose_segment;
pub use formula::{Formula, FromFn, FromFnWith, from_fn, from_fn_with};
pub use homography::Homography;
pub(crate) use joint::Joint;
pub use lattice::{Lattice, LatticeMap};
pub use newton::{NewtonInverse, inverse_over};
pub use preimages::preimages;
pub use projective::AffineMap;
pub use rational_bezier::{RationalBezier, exact_images};
pub use real::{Dual, Real};

pub(crate) use curves::{Guide, GuidePace, increasing_root};
pub(crate) use local::Local;
pub(crate) use newton::{INVERSE_WORK, inverse_of};
pub(crate) use patch::{Patch, powers};
pub(crate) use preimages::Polynomials;
pub(crate) use quotient::{Plane, Quotient, source_coordinates};
pub(crate) use tiled::{TileRow, Tiled};

/// A differentiable map of the plane, in root user units, y down.
///
/// Only [`Map::jet`] is required. [`point`](Map::point), [`points`](Map::points) and [`jets`](Map::jets) are faster ways to the
/// same values; the other methods tell the refitter where the map is not smooth and what is known about it exactly.
pub trait Map: Send + Sync {
    /// The value and both partial derivatives at `p`. On a crease, the derivatives are those of one of its sides.
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

    /// The class of the map. Affine and projective maps need no refitting, and adjacent ones fold into one in a [`Chain`].
    fn class(&self) -> Class {
        Class::Smooth
    }

    /// Adds the lines along which the map is not smooth, and the boundary of its domain.
    fn creases(&self, _out: &mut Creases) {}

    /// For a map with creases: the smooth map that agrees with this one on the piece of the plane, cut at the creases, that contains
    /// `inside`. On the boundary of that piece it gives the limit from inside. `None` if the map is smooth.
    fn branch(&self, _inside: Point) -> Option<Arc<dyn Map>> {
        None
    }

    /// The exact image of a (rational) Bézier curve, if the image is one again.
    fn image(&self, _curve: &RationalBezier) -> Option<RationalBezier> {
        None
    }

    /// The common denominator W of the coordinates at `p`, for maps of a [rational class](Class::Rational): positive where the map is
    /// defined, 1 for polynomials.
    fn denominator(&self, _p: Point) -> f64 {
        1.0
    }

    /// The inverse map, if there is one.
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        None
    }

    /// All points of the plane that the map takes to `q`, in any order, perhaps with points where it is not defined. `None` if they are
    /// not known, or if there are infinitely many. See [`preimages`].
    fn preimages(&self, q: Point) -> Option<Vec<Point>> {
        match self.class() {
            Class::Affine(_) | Class::Projective(_) => Some(vec![self.inverse()?.point(q)]),
            _ => None,
        }
    }

    /// The cost of an evaluation, for [`budget`](crate::budget). Maps whose work grows with their number of parts override this.
    #[doc(hidden)]
    fn cost(&self) -> Cost<'_> {
        Cost::NET
    }

    /// Bounds the coordinates of a curve's image and their derivatives by those of the curve: the refitter accepts a piece only if nothing
    /// can hide between its samples. By default estimated from the [`detail`](Self::detail). `None` if there are no bounds; the fit is then
    /// reported as [sampled](bezierfit::Assurance::Sampled).
    fn enclose(&self, along: [Enclosure; 2]) -> Option<[Enclosure; 2]> {
        let area = Enclosure::area(&along);
        self.detail(area).map(|detail| estimated(self, along, area, detail))
    }

    /// The size of the smallest feature of the map in a box, for a map that does not [`enclose`](Self::enclose) curves by itself: a quarter
    /// of the length of its shortest wave, the radius of its narrowest bump. Infinite if every piece between its creases is one simple
    /// curve.
    fn detail(&self, _area: Rect) -> Option<f64> {
        None
    }
}

/// An estimate of the image of a curve in a box, under a map of known [detail](Map::detail).
fn estimated(map: &(impl Map + ?Sized), along: [Enclosure; 2], area: Rect, detail: f64) -> [Enclosure; 2] {
    let mut jets = [Jet::default(); 3];
    map.jets(&middle_and_corners(area), &mut jets);
    // The factor 2 is a margin for what three points do not show.
    Enclosure::estimated(along, jets[0].p, 2.0 * most_stretched(&jets), detail)
}

/// Three points that stand for a whole box: its middle and two opposite corners.
fn middle_and_corners(area: Rect) -> [Point; 3] {
    [area.center(), area.origin(), Point::new(area.x1, area.y1)]
}

/// The largest norm of some Jacobians.
fn most_stretched(jets: &[Jet]) -> f64 {
    jets.iter().map(|j| (j.dx.hypot2() + j.dy.hypot2()).sqrt()).fold(0.0, f64::max)
}

/// The size of the smallest feature of a map in a box: the [detail](Map::detail) that the map states, or else the finest feature of the
/// enclosed images of the horizontal and the vertical line through the middle.
pub(crate) fn detail_in(map: &dyn Map, area: Rect) -> Option<f64> {
    let enclosed = || {
        let middle = area.center();
        let finest_on = |line: [Enclosure; 2], length: f64| Some(length * Enclosure::finest_share(&map.enclose(line)?));
        let across = finest_on([Enclosure::between(area.x0, area.x1), middle.y.into()], area.width())?;
        Some(across.min(finest_on([middle.x.into(), Enclosure::between(area.y0, area.y1)], area.height())?))
    };
    map.detail(area).or_else(enclosed)
}

/// Shorthands for parts of the cost and the class.
impl dyn Map + '_ {
    /// See [`Cost::work`].
    #[doc(hidden)]
    #[must_use]
    pub fn work(&self) -> f64 {
        self.cost().work
    }

    /// This map with its searches, such as an inverse's, charged to `budget`; `None` if it does not search.
    #[doc(hidden)]
    #[must_use]
    pub fn within(&self, budget: &Arc<Budget>) -> Option<Arc<dyn Map>> {
        self.cost().searches.map(|s| s.within(budget))
    }

    /// Returns `true` if calls are expensive and points cheap; see [`Batches`].
    #[doc(hidden)]
    #[must_use]
    pub fn prefers_batches(&self) -> bool {
        self.cost().batches.is_some()
    }

    /// Announces the points whose values, and those whose jets, will be asked for next. Only maps that cache results listen.
    #[doc(hidden)]
    pub fn prepare(&self, points: &[Point], jets: &[Point]) {
        if let Some(batches) = self.cost().batches {
            batches.prepare(points, jets);
        }
    }

    /// See [`Class::degree`].
    #[must_use]
    pub fn rational_degree(&self) -> Option<RationalDegree> {
        self.class().degree()
    }
}

impl<M: Map + ?Sized> Map for Arc<M> {
    forward!(jet point jets points enclose);
}

/// References and boxes are maps by way of [`Formula`]. They cannot implement [`Map`] directly: another crate may implement [`Formula`] for
/// references to its types, and the implementations would overlap.
impl<M: Map + ?Sized> Formula for &M {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        S::image(*self, [x, y])
    }
    forward!(dual value duals values enclosed);
}

impl<M: Map + ?Sized> Formula for Box<M> {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        S::image(&**self, [x, y])
    }
    forward!(dual value duals values enclosed);
}

impl fmt::Debug for dyn Map + '_ {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Map({:?})", self.class())
    }
}

/// Value and both partial derivatives of a map at a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Jet {
    /// The value F(x, y).
    pub p: Point,
    /// ∂F/∂x.
    pub dx: Vec2,
    /// ∂F/∂y.
    pub dy: Vec2,
}

impl Jet {
    /// The jet of a map outside its domain: six NaNs.
    pub const UNDEFINED: Self = Self {
        p: Point::new(f64::NAN, f64::NAN),
        dx: Vec2::new(f64::NAN, f64::NAN),
        dy: Vec2::new(f64::NAN, f64::NAN),
    };

    /// The derivative in direction `v`: the Jacobian times `v`.
    #[inline]
    #[must_use]
    pub fn push(&self, v: Vec2) -> Vec2 {
        self.dx * v.x + self.dy * v.y
    }

    /// The determinant of the Jacobian: the local scale of areas, negative where the map mirrors.
    #[inline]
    #[must_use]
    pub fn det(&self) -> f64 {
        self.dx.cross(self.dy)
    }

    /// The jet of `outer ∘ self`, where `outer` is the jet of the outer map at `self.p`.
    #[inline]
    #[must_use]
    pub fn then(&self, outer: &Self) -> Self {
        Self { p: outer.p, dx: outer.push(self.dx), dy: outer.push(self.dy) }
    }

    /// The jet of the inverse map, which leads back to `p`.
    #[inline]
    #[must_use]
    pub fn inverted(&self, p: Point) -> Self {
        let (dx, dy, det) = (self.dx, self.dy, self.det());
        Self { p, dx: Vec2::new(dy.y, -dx.y) / det, dy: Vec2::new(-dy.x, dx.x) / det }
    }

    /// Returns `true` if all six numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.p.is_finite() && self.dx.is_finite() && self.dy.is_finite()
    }
}

/// The class of a map. Affine and projective maps need no refitting, and adjacent ones fold into one in a [`Chain`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Class {
    /// Control points map exactly.
    Affine(Affine),
    /// Lines stay lines.
    Projective(Homography),
    /// The coordinates are quotients of polynomials: enough to prove error bounds without writing out an image. If they have a
    /// denominator, the map implements [`Map::denominator`] too.
    Rational(RationalDegree),
    /// Anything else.
    Smooth,
}

impl Class {
    /// The degree of the map if its coordinates are quotients of polynomials.
    #[must_use]
    pub const fn degree(&self) -> Option<RationalDegree> {
        match self {
            Self::Affine(_) => Some(RationalDegree::polynomial(1)),
            Self::Projective(_) => Some(RationalDegree::rational(1)),
            Self::Rational(degree) => Some(*degree),
            Self::Smooth => None,
        }
    }
}

/// The degree of a map (x, y) ↦ (X/W, Y/W) with polynomials X, Y, W.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RationalDegree {
    /// The largest total degree (exponents of x and y together) of X, Y and W.
    pub degree: usize,
    /// `true` if W is not the constant 1. [`Map::denominator`] gives its values.
    pub rational: bool,
}

impl RationalDegree {
    /// A polynomial map: W = 1.
    #[must_use]
    pub const fn polynomial(degree: usize) -> Self {
        Self { degree, rational: false }
    }

    /// A map with a denominator.
    #[must_use]
    pub const fn rational(degree: usize) -> Self {
        Self { degree, rational: true }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A map written with `jet` alone has batches that agree with it to the last bit, also behind a pointer.
    #[test]
    fn default_batches_follow_from_the_jet() {
        struct OnlyJet;
        impl Map for OnlyJet {
            fn jet(&self, p: Point) -> Jet {
                Jet { p: Point::new(p.x * p.y, p.x - 3.0 * p.y), ..Jet::default() }
            }
        }
        let ps: Vec<Point> = (0..9).map(|i| Point::new(0.1 * f64::from(i) - 0.3, 1.7 / f64::from(i + 1))).collect();
        let expected: Vec<Point> = ps.iter().map(|p| OnlyJet.jet(*p).p).collect();
        let shared: Arc<dyn Map> = Arc::new(OnlyJet);
        let mut out = vec![Point::ORIGIN; ps.len()];
        for map in [&OnlyJet as &dyn Map, &shared, &&OnlyJet, &Box::new(OnlyJet)] {
            map.points(&ps, &mut out);
            assert_eq!(out, expected);
        }
    }
}
