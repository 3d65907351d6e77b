//! The trait that every map of space implements.

use super::collineation::Collineation;
use super::crease::Creases3;
use super::jet::Jet3;
use super::poly::Fraction3;
use crate::box3::Box3;
use glam::DVec3;
use pathwarp::budget::Budget;
use std::sync::Arc;

/// A differentiable map of space: x right, y up, z towards the viewer.
///
/// Only [`Map3::jet`] is required. [`point`](Map3::point), [`points`](Map3::points) and [`jets`](Map3::jets) are faster ways to
/// the same values.
pub trait Map3: Send + Sync {
    /// Value and Jacobian at `p`. On a crease, those of either side; outside the domain, not finite.
    fn jet(&self, p: DVec3) -> Jet3;

    /// The value alone.
    fn point(&self, p: DVec3) -> DVec3 {
        self.jet(p).p
    }

    /// The jets at `ps`. `out` has the length of `ps`.
    fn jets(&self, ps: &[DVec3], out: &mut [Jet3]) {
        for (p, o) in ps.iter().zip(out) {
            *o = self.jet(*p);
        }
    }

    /// Replaces points by their images.
    fn points(&self, ps: &mut [DVec3]) {
        for p in ps {
            *p = self.point(*p);
        }
    }

    /// The map as a collineation, if it is one: planes stay planes. Neighbours fold into one in a [`Chain3`](super::Chain3).
    fn collineation(&self) -> Option<&Collineation> {
        None
    }

    /// The map on a box as a quotient of polynomials of degree `most` or less, if it is one there: the images of rational surfaces
    /// are then exact.
    fn fraction(&self, _on: &Box3, _most: usize) -> Option<Fraction3> {
        None
    }

    /// The smooth map that this one is on a box, if it is one there; it goes on beyond the box. A box that a crease only touches lies on
    /// its own side of it, where the map itself may take the points of the crease to the other.
    fn branch(&self, _on: &Box3) -> Option<Arc<dyn Map3>> {
        None
    }

    /// Adds the surfaces on which the map is not smooth, and the boundary of its domain.
    fn creases(&self, _out: &mut Creases3) {}

    /// The inverse map, if there is a better one than [`NewtonInverse3`](super::NewtonInverse3).
    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        None
    }

    /// The cost of one evaluation, relative to that of a bend, for the [budget](pathwarp::budget). 1 or more.
    fn work(&self) -> f64 {
        1.0
    }

    /// The same map, whose searches spend from a budget what they take beyond [`work`](Map3::work), and find nothing once it is used up.
    /// `None`: nothing is searched.
    #[doc(hidden)]
    fn within(&self, _budget: &Arc<Budget>) -> Option<Arc<dyn Map3>> {
        None
    }
}

/// Forwards every method: a method left to its default would lose the speed of the map behind the pointer, silently.
impl<M: Map3 + ?Sized> Map3 for Arc<M> {
    fn jet(&self, p: DVec3) -> Jet3 {
        (**self).jet(p)
    }
    fn point(&self, p: DVec3) -> DVec3 {
        (**self).point(p)
    }
    fn jets(&self, ps: &[DVec3], out: &mut [Jet3]) {
        (**self).jets(ps, out);
    }
    fn points(&self, ps: &mut [DVec3]) {
        (**self).points(ps);
    }
    fn collineation(&self) -> Option<&Collineation> {
        (**self).collineation()
    }
    fn fraction(&self, on: &Box3, most: usize) -> Option<Fraction3> {
        (**self).fraction(on, most)
    }
    fn branch(&self, on: &Box3) -> Option<Arc<dyn Map3>> {
        (**self).branch(on)
    }
    fn creases(&self, out: &mut Creases3) {
        (**self).creases(out);
    }
    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        (**self).inverse()
    }
    fn work(&self) -> f64 {
        (**self).work()
    }
    fn within(&self, budget: &Arc<Budget>) -> Option<Arc<dyn Map3>> {
        (**self).within(budget)
    }
}
