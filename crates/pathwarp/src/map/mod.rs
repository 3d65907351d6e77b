//! Maps of the plane, numbers only: what a deformation is once its parameters are settled.
//!
//! [`Map`] is the trait; [`Formula`] the short way to write one (a formula over any [`Real`], derivatives come from dual
//! numbers); [`Chain`] composes maps; [`Homography`] and [`AffineMap`] are the two classes that fold into one another.

mod affine;
pub mod anamorph;
pub(crate) mod arclength;
pub(crate) mod bernstein;
mod birational;
pub(crate) mod bspline;
mod chain;
mod coons;
mod crease;
pub mod dilation;
mod dual;
mod formula;
mod homography;
mod inverse;
mod jet;
mod lattice;
mod local;
mod monoid;
pub mod net;
mod patch;
mod pins;
mod quotient;
mod rational;
pub mod ruled;
mod side;
pub mod surface;
mod tiled;
pub mod triangle;

pub use affine::AffineMap;
pub use birational::{Birational, BirationalInverse, Rows};
pub use chain::Chain;
pub use coons::{Coons, Sides};
pub use crease::{Crease, CreaseKind, Creases, Level};
pub use dual::{Dual, Real};
pub use formula::Formula;
pub use homography::Homography;
pub use inverse::NewtonInverse;
pub use jet::Jet;
pub use lattice::{Lattice, LatticeMap};
pub use local::Local;
pub use monoid::{Monoid, Ray};
pub use net::BicubicNet;
pub use patch::Patch;
pub use pins::{MOST_PINS, pull};
pub use quotient::Quotient;
pub use rational::RationalBezier;
pub use ruled::{Along, Guide};
pub use side::{Pace, Side};
pub use tiled::{Row, Tiled};
pub use triangle::TriangleNet;

use kurbo::{Affine, Point};
use std::sync::Arc;

/// What kind of map it is: the kinds that keep lines need no refitting, and fold in a [`Chain`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Class {
    /// Control points map exactly.
    Affine(Affine),
    /// Lines stay lines.
    Projective(Homography),
    /// Anything else.
    Smooth,
}

/// A differentiable map of the plane, in root user units, y down.
///
/// Only [`Map::jet`] is required. The others tell the refitter more (exactness, where the map is not smooth) or let it
/// go faster (batches).
pub trait Map: Send + Sync {
    /// Value and both partial derivatives at `p`, in one evaluation. On a crease, either side's.
    fn jet(&self, p: Point) -> Jet;

    /// The value alone.
    fn point(&self, p: Point) -> Point {
        self.jet(p).p
    }

    /// A batch of jets: one virtual call, and a loop the compiler sees whole. `out` has the length of `ps`.
    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        for (p, o) in ps.iter().zip(out) {
            *o = self.jet(*p);
        }
    }

    /// A batch of values. `out` has the length of `ps`.
    fn points(&self, ps: &[Point], out: &mut [Point]) {
        for (p, o) in ps.iter().zip(out) {
            *o = self.point(*p);
        }
    }

    /// Eight values in place, coordinates apart: the layout the compiler turns into vector instructions. The refitter
    /// samples through this.
    fn lanes(&self, x: &mut [f64; 8], y: &mut [f64; 8]) {
        let mut source = [Point::ORIGIN; 8];
        for (p, (x, y)) in source.iter_mut().zip(x.iter().zip(y.iter())) {
            *p = Point::new(*x, *y);
        }
        let mut image = [Point::ORIGIN; 8];
        self.points(&source, &mut image);
        for (p, (x, y)) in image.iter().zip(x.iter_mut().zip(y)) {
            (*x, *y) = (p.x, p.y);
        }
    }

    /// The kind of map.
    fn class(&self) -> Class {
        Class::Smooth
    }

    /// Adds the places where the map is not smooth, and the edges of where it is defined.
    fn creases(&self, _out: &mut Creases) {}

    /// For a map with creases: the smooth map that agrees with this one on the piece of the plane, cut at the creases, that
    /// holds `inside`. Evaluated on the piece's edge it gives the limit from inside. `None`: the map itself is smooth.
    fn branch(&self, _inside: Point) -> Option<Arc<dyn Map>> {
        None
    }

    /// The exact image of a (rational) Bézier curve, where it is one again.
    fn image_of(&self, _curve: &RationalBezier) -> Option<RationalBezier> {
        None
    }

    /// If the map is a quotient of polynomials, of what kind: enough to prove error bounds without writing the image out.
    fn algebra(&self) -> Option<Algebra> {
        None
    }

    /// The denominators of an [`Algebra`] map at eight places.
    fn denominators(&self, _x: &[f64; 8], _y: &[f64; 8]) -> [f64; 8] {
        [1.0; 8]
    }

    /// The inverse map, where there is one.
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        None
    }
}

/// (x, y) ↦ (X/W, Y/W) with polynomials X, Y, W.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Algebra {
    /// The largest total degree (exponents of x and y together) of X, Y and W.
    pub degree: usize,
    /// Whether W is anything but 1. [`Map::denominators`] gives its values.
    pub rational: bool,
}

impl<M: Map + ?Sized> Map for Arc<M> {
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
    fn lanes(&self, x: &mut [f64; 8], y: &mut [f64; 8]) {
        (**self).lanes(x, y);
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
    fn image_of(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        (**self).image_of(curve)
    }
    fn algebra(&self) -> Option<Algebra> {
        (**self).algebra()
    }
    fn denominators(&self, x: &[f64; 8], y: &[f64; 8]) -> [f64; 8] {
        (**self).denominators(x, y)
    }
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        (**self).inverse()
    }
}
