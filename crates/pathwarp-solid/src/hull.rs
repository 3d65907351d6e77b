//! Extended free-form deformation, by lattices of any shape.
//!
//! > F(p) = X̂(u) with X(u) = p
//!
//! where X is the volume of a lattice whose control points need not be regular, such as a ring around an axis, and X̂ the volume of
//! the lattice with moved points and weights (S. Coquillart, *Extended free-form deformation*, SIGGRAPH 1990). Nothing moves outside
//! the hull, so its faces are creases.

use crate::lattice::{Lattice3, LatticeMap3};
use crate::map::{Creases3, Jet3, Map3, NewtonInverse3};
use crate::settings::{Box3, grid, show};
use glam::DVec3;
use pathwarp::Error;
use pathwarp::budget::Budget;
use std::sync::Arc;

/// Extended free-form deformation of space by two lattices, before and after the change.
#[derive(Debug, Clone)]
pub(crate) struct HullMap {
    region: Box3,
    cells: [usize; 3],
    hull: Arc<LatticeMap3>,
    moved: Arc<LatticeMap3>,
    /// Finds the local coordinates of a point by inverting the hull's map.
    inner: NewtonInverse3,
}

/// Margin around the region in which local coordinates are found, as a fraction of its size. It makes the depth change its sign at a face.
const BEYOND: f64 = 1.0 / 16.0;

impl HullMap {
    /// Makes the map from a hull and the lattice with changed points and weights.
    ///
    /// # Errors
    /// [`Error::Usage`] when the hull folds or is flat.
    pub(crate) fn new(hull: &Lattice3, moved: &Lattice3) -> Result<Self, Error> {
        /// Points along each axis at which the hull's orientation is compared.
        const SAMPLES: usize = 12;
        let (region, cells) = (hull.region(), hull.cells());
        let [hull, moved] = [hull, moved].map(|l| Arc::new(LatticeMap3::new(l, true)));
        let points = grid([SAMPLES; 3]).map(|n| DVec3::from_array(n.map(|i| (i as f64 + 0.5) / SAMPLES as f64)));
        let mut jets = points.map(|t| hull.jet(region.min + t * region.size()));
        let first = jets.next().map_or(0.0, |j| j.det());
        if let Some(j) = jets.find(|j| (j.det() * first).is_nan() || j.det() * first <= 0.0) {
            let problem = format!("is flat or folds at {}; put its control points in order", show(j.p));
            return Err(Error::usage("hull", "", problem));
        }
        Ok(Self::between(hull, moved, region, cells))
    }

    fn between(hull: Arc<LatticeMap3>, moved: Arc<LatticeMap3>, region: Box3, cells: [usize; 3]) -> Self {
        let domain = region.inflate(BEYOND * region.size());
        let rounding = 1e-9 * region.diagonal();
        let inner = NewtonInverse3::with_core(Arc::clone(&hull) as Arc<dyn Map3>, region, domain, rounding, cells);
        Self { region, cells, hull, moved, inner }
    }

    /// Returns the local coordinates of a point in the hull, and their derivatives.
    pub(crate) fn local(&self, p: DVec3) -> Option<Jet3> {
        /// Distance from a face, as a fraction of the region, that counts as rounding.
        const ROUNDING: f64 = 1e-12;
        self.inner.solve(p).filter(|u| self.depth(u.p) >= -ROUNDING)
    }

    /// Returns the distance of local coordinates from the nearest face, as a fraction of the region; positive inside.
    fn depth(&self, u: DVec3) -> f64 {
        ((u - self.region.min).min(self.region.max - u) / self.region.size()).min_element()
    }
}

impl Map3 for HullMap {
    fn jet(&self, p: DVec3) -> Jet3 {
        match self.local(p) {
            Some(local) => local.then(&self.moved.jet(local.p)),
            None => Jet3::identity(p),
        }
    }

    fn creases(&self, out: &mut Creases3) {
        let map = self.clone();
        out.kink(move |p| map.inner.solve(p).map_or(-BEYOND, |u| map.depth(u.p)));
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        Some(Arc::new(Self::between(Arc::clone(&self.moved), Arc::clone(&self.hull), self.region, self.cells)))
    }

    fn work(&self) -> f64 {
        self.inner.work() + self.moved.work()
    }

    fn within(&self, budget: &Arc<Budget>) -> Option<Arc<dyn Map3>> {
        Some(Arc::new(Self { inner: self.inner.spending(budget), ..self.clone() }))
    }
}
