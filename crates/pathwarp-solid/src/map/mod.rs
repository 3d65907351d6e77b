//! Maps of space: the result of a deformation once its parameters are known.
//!
//! A [`Map3`] takes every point of a model to its image, with a Jacobian. Only [`Map3::jet`] is required; the other methods add
//! speed and knowledge: batches, creases, the inverse, and whether planes stay planes. [`Chain3`] composes maps, and
//! [`NewtonInverse3`] inverts any smooth map over a box.

mod collineation;
mod collineation_map;
mod local;
mod newton;
mod poly;
mod tensor;

use crate::settings::Box3;
use glam::{DMat3, DVec3};
use pathwarp::budget::Budget;
use pathwarp::map::CreaseKind;
use std::fmt;
use std::sync::Arc;

pub use collineation::Collineation;
pub use newton::NewtonInverse3;
pub use poly::{Chart, Fraction3};

pub(crate) use local::Local;
pub(crate) use poly::Poly3;
pub(crate) use tensor::{Displaced, Quotient, Radial, Swept, Tensor, for_all};

/// A differentiable map of space, in which x points right, y up and z towards the viewer.
///
/// Only [`Map3::jet`] is required. [`point`](Map3::point), [`points`](Map3::points) and [`jets`](Map3::jets) compute the same values
/// faster.
pub trait Map3: Send + Sync {
    /// Returns the image and the Jacobian at `p`. On a crease they are those of either side; outside the domain they are not finite.
    fn jet(&self, p: DVec3) -> Jet3;

    /// Returns the image alone.
    fn point(&self, p: DVec3) -> DVec3 {
        self.jet(p).p
    }

    /// Writes the jets at `ps` to `out`, which has the same length.
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

    /// Returns the map as a collineation, which keeps planes plane, if it is one. A [`Chain3`] folds adjacent collineations into one.
    fn collineation(&self) -> Option<&Collineation> {
        None
    }

    /// Returns the map on a box as a quotient of polynomials of at most degree `max`, if it is one there. The images of rational
    /// surfaces are then exact.
    fn fraction(&self, _on: &Box3, _max: usize) -> Option<Fraction3> {
        None
    }

    /// Returns the smooth map that agrees with this one on a box and continues beyond it, if there is one. On a crease that touches the
    /// box it has the values of the box's side; this map may have the other side's there.
    fn branch(&self, _on: &Box3) -> Option<Arc<dyn Map3>> {
        None
    }

    /// Adds the surfaces on which the map is not smooth, and the boundary of its domain.
    fn creases(&self, _out: &mut Creases3) {}

    /// Returns the inverse map, if there is a better one than [`NewtonInverse3`].
    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        None
    }

    /// Returns the cost of one evaluation for the [budget](pathwarp::budget), relative to that of a bend. At least 1.
    fn work(&self) -> f64 {
        1.0
    }

    /// Returns the map with searches that charge a budget for anything beyond [`work`](Map3::work), and find nothing once it is used up.
    /// `None` if the map does not search.
    #[doc(hidden)]
    fn within(&self, _budget: &Arc<Budget>) -> Option<Arc<dyn Map3>> {
        None
    }
}

/// Forwards every method, since a method left to its default would silently lose the speed of the map behind the pointer.
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
    fn fraction(&self, on: &Box3, max: usize) -> Option<Fraction3> {
        (**self).fraction(on, max)
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

/// The value and the Jacobian of a map of space at a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Jet3 {
    /// The value F(x, y, z).
    pub p: DVec3,
    /// The Jacobian, with the columns ∂F/∂x, ∂F/∂y and ∂F/∂z.
    pub d: DMat3,
}

impl Jet3 {
    /// The jet of a map outside its domain.
    pub const UNDEFINED: Self = Self { p: DVec3::NAN, d: DMat3::NAN };

    /// Returns the jet of the identity at `p`.
    #[must_use]
    pub fn identity(p: DVec3) -> Self {
        Self { p, d: DMat3::IDENTITY }
    }

    /// Returns the determinant of the Jacobian: the local scale of volumes, negative where the map mirrors.
    #[must_use]
    pub fn det(&self) -> f64 {
        self.d.determinant()
    }

    /// Returns the jet of `outer ∘ self`, where `outer` is the jet of the outer map at `self.p`.
    #[must_use]
    pub fn then(&self, outer: &Self) -> Self {
        Self { p: outer.p, d: outer.d * self.d }
    }

    /// Returns the direction of the image of a surface's normal `n`: the cofactors of the Jacobian, det J · J⁻ᵀ, times `n`. Unlike the
    /// inverse transpose it exists for a singular Jacobian too, and its sign follows the orientation of transformed triangles.
    #[must_use]
    pub fn normal(&self, n: DVec3) -> DVec3 {
        let [a, b, c] = [self.d.x_axis, self.d.y_axis, self.d.z_axis];
        b.cross(c) * n.x + c.cross(a) * n.y + a.cross(b) * n.z
    }

    /// Returns `true` if all twelve numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.p.is_finite() && self.d.is_finite()
    }
}

/// A continuous function φ on space whose zero set is a crease: a surface on which a map is not smooth, or the boundary of its domain.
/// A chain can pull the crease of a later map back through the earlier maps, as φ ∘ F.
pub type Level3 = Arc<dyn Fn(DVec3) -> f64 + Send + Sync>;

/// A crease: a level set and the behaviour there.
#[derive(Clone)]
pub struct Crease3 {
    /// The level set. At an edge, the map is defined where it is positive.
    pub level: Level3,
    /// The behaviour of the map at it.
    pub kind: CreaseKind,
}

impl fmt::Debug for Crease3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Crease3").field("kind", &self.kind).finish_non_exhaustive()
    }
}

/// The creases of a map.
#[derive(Debug, Clone, Default)]
pub struct Creases3 {
    items: Vec<Crease3>,
}

impl Creases3 {
    /// Adds a surface on which the derivative jumps.
    pub fn kink(&mut self, level: impl Fn(DVec3) -> f64 + Send + Sync + 'static) {
        self.push(Crease3 { level: Arc::new(level), kind: CreaseKind::Kink });
    }

    /// Adds a part of the domain's boundary: the map is defined where `level` is positive.
    pub fn edge(&mut self, level: impl Fn(DVec3) -> f64 + Send + Sync + 'static) {
        self.push(Crease3 { level: Arc::new(level), kind: CreaseKind::Edge });
    }

    /// Adds a crease.
    pub fn push(&mut self, crease: Crease3) {
        self.items.push(crease);
    }

    /// Returns the creases, in the order they were added.
    #[must_use]
    pub fn items(&self) -> &[Crease3] {
        &self.items
    }

    /// Returns `true` if the map is defined at `p`.
    #[must_use]
    pub fn defined_at(&self, p: DVec3) -> bool {
        self.items.iter().all(|c| c.kind != CreaseKind::Edge || (c.level)(p) > 0.0)
    }

    /// Returns `true` if a crease separates `p` and `q`, or passes through one of them.
    #[must_use]
    pub fn separate(&self, p: DVec3, q: DVec3) -> bool {
        self.items.iter().any(|c| (c.level)(p) * (c.level)(q) <= 0.0)
    }
}

/// Maps applied one after another; adjacent collineations are folded into one. For fractions and branches, ask its [`steps`](Self::steps).
#[derive(Clone, Default)]
pub struct Chain3 {
    steps: Vec<Arc<dyn Map3>>,
}

impl fmt::Debug for Chain3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Chain3").field("steps", &self.steps.len()).finish_non_exhaustive()
    }
}

impl Chain3 {
    /// Appends a map.
    pub fn push(&mut self, map: Arc<dyn Map3>) {
        let last = self.steps.last().and_then(|m| m.collineation());
        match last.zip(map.collineation()).map(|(last, next)| last.then(next)) {
            Some(both) => {
                self.steps.pop();
                self.steps.push(Arc::new(both));
            }
            None => self.steps.push(map),
        }
    }

    /// Returns the maps that are left after folding.
    #[must_use]
    pub fn steps(&self) -> &[Arc<dyn Map3>] {
        &self.steps
    }
}

impl Map3 for Chain3 {
    fn jet(&self, p: DVec3) -> Jet3 {
        self.steps.iter().fold(Jet3::identity(p), |jet, s| jet.then(&s.jet(jet.p)))
    }

    fn point(&self, p: DVec3) -> DVec3 {
        self.steps.iter().fold(p, |p, s| s.point(p))
    }

    fn points(&self, ps: &mut [DVec3]) {
        for s in &self.steps {
            s.points(ps);
        }
    }

    fn collineation(&self) -> Option<&Collineation> {
        match &self.steps[..] {
            [only] => only.collineation(),
            _ => None,
        }
    }

    fn creases(&self, out: &mut Creases3) {
        let mut before = Self::default();
        for s in &self.steps {
            let mut creases = Creases3::default();
            s.creases(&mut creases);
            for Crease3 { level, kind } in creases.items {
                let before = before.clone();
                out.push(Crease3 { level: Arc::new(move |p| level(before.point(p))), kind });
            }
            before.steps.push(Arc::clone(s));
        }
    }

    fn work(&self) -> f64 {
        self.steps.iter().map(Map3::work).sum::<f64>().max(1.0)
    }

    fn within(&self, budget: &Arc<Budget>) -> Option<Arc<dyn Map3>> {
        let within: Vec<Option<Arc<dyn Map3>>> = self.steps.iter().map(|s| s.within(budget)).collect();
        within.iter().any(Option::is_some).then(|| {
            let steps = within.into_iter().zip(&self.steps).map(|(within, s)| within.unwrap_or_else(|| Arc::clone(s)));
            Arc::new(Self { steps: steps.collect() }) as Arc<dyn Map3>
        })
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        let mut out = Self::default();
        for s in self.steps.iter().rev() {
            out.push(s.inverse()?);
        }
        Some(Arc::new(out))
    }
}
