//! Inverts any smooth map of space over a box by Newton's method, and proves that each answer is near a solution.
//!
//! A grid of starting points covers the box. To invert a point q, the cells whose images come near q are tried: damped Newton
//! steps x ← x + J⁻¹(q − F(x)) run from the cell's centre until they stop changing x. The answer is accepted if the residual is
//! at rounding level, x lies in the box or outside by less than the stated reach, and β·L·η ≤ ½ with β = ‖J⁻¹‖,
//! η = |J⁻¹(q − F(x))| and L a Lipschitz bound of the Jacobian: Kantorovich's condition (L. V. Kantorovich 1948; Ortega &
//! Rheinboldt, *Iterative Solution of Nonlinear Equations*, theorem 12.6.2), measured between neighbouring starting points and
//! doubled. The inverse is undefined (NaN) at every other point.
//!
//! If the map folds, a point can have several preimages. Those in the *core* of the box, the part that the map is designed for,
//! take precedence; outside the core, only those with the orientation of the core's middle count, and of them the nearest.

use crate::map::{Jet3, Map3};
use crate::settings::{Box3, grid};
use glam::{DMat3, DVec3};
use pathwarp::budget::{Budget, Search, is_over};
use std::fmt;
use std::sync::Arc;

/// Minimum number of starting points along a side of the box.
const MIN_STARTS: usize = 8;
/// Maximum number of starting points along a side of the box.
const MAX_STARTS: usize = 32;
/// Starting points along a side for every piece of the map.
const STARTS_PER_PIECE: usize = 3;
/// Limit on Newton steps from one starting point.
const MAX_STEPS: usize = 40;
/// A Newton step is halved down to this fraction before it is given up.
const MIN_DAMPING: f64 = 1e-4;
/// Limit on starting points tried for one point.
const MAX_TRIES: usize = 12;
/// Work of inverting a point that has a preimage, as a multiple of the map's. Searches charge for more as they run.
const INVERSE_WORK: f64 = 5.0;

/// The inverse of a smooth map over a box, by damped Newton iteration.
#[derive(Clone)]
pub struct NewtonInverse3 {
    map: Arc<dyn Map3>,
    domain: Box3,
    core: Box3,
    /// The sign of the determinant in the middle of the core.
    orientation: f64,
    /// Distance outside the domain up to which answers are accepted.
    reach: f64,
    /// Starting points with their images.
    starts: Arc<[(DVec3, DVec3)]>,
    /// Indices of the starting points whose cells' images meet each bucket of a grid over `bounds`, the images' box.
    buckets: Arc<[Vec<u32>]>,
    bounds: Box3,
    /// Number of buckets along each axis.
    side: usize,
    /// Lipschitz bound of the Jacobian.
    lipschitz: f64,
    /// Rounding error of an image coordinate.
    rounding: f64,
    map_work: f64,
    /// The budget that searches charge.
    budget: Option<Arc<Budget>>,
}

impl fmt::Debug for NewtonInverse3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("NewtonInverse3").field("domain", &self.domain).finish_non_exhaustive()
    }
}

impl NewtonInverse3 {
    /// Inverts `map` over `domain`, accepting answers up to `reach` outside. `pieces` is the number of smooth pieces of the map along
    /// each axis (1, 1, 1 for a single polynomial).
    #[must_use]
    pub fn new(map: Arc<dyn Map3>, domain: Box3, reach: f64, pieces: [usize; 3]) -> Self {
        Self::with_core(map, domain, domain, reach, pieces)
    }

    /// Makes the inverse over a box whose core (see the module) is smaller than the box.
    pub(crate) fn with_core(map: Arc<dyn Map3>, core: Box3, domain: Box3, reach: f64, pieces: [usize; 3]) -> Self {
        let n = pieces.map(|n| (n * STARTS_PER_PIECE).clamp(MIN_STARTS, MAX_STARTS));
        let cell = domain.size() / DVec3::from_array(n.map(|n| n as f64));
        let center = |node: [usize; 3]| domain.min + cell * DVec3::from_array(node.map(|i| i as f64 + 0.5));
        let centers: Vec<DVec3> = grid(n).map(center).collect();
        let mut jets = vec![Jet3::default(); centers.len()];
        map.jets(&centers, &mut jets);

        let mut lipschitz: f64 = 0.0;
        for (axis, step) in [1, n[0], n[0] * n[1]].into_iter().enumerate() {
            for (s, jet) in jets.iter().enumerate().filter(|(s, _)| (s / step) % n[axis] + 1 < n[axis]) {
                let rate = frobenius(jets[s + step].d - jet.d) / cell[axis];
                lipschitz = if rate.is_finite() { lipschitz.max(rate) } else { lipschitz };
            }
        }
        // Bound the image of each starting point's cell by its first-order image, enlarged by half.
        let mut starts = Vec::with_capacity(centers.len());
        let mut boxes = Vec::with_capacity(centers.len());
        for (at, j) in centers.iter().zip(&jets).filter(|(_, j)| j.is_finite()) {
            let half = 0.75 * (j.d.x_axis.abs() * cell.x + j.d.y_axis.abs() * cell.y + j.d.z_axis.abs() * cell.z);
            starts.push((*at, j.p));
            boxes.push(Box3::new(j.p - half, j.p + half));
        }
        let bounds = Box3::around(boxes.iter().flat_map(|b| [b.min, b.max]));
        let bounds = bounds.unwrap_or(Box3 { min: DVec3::ZERO, max: DVec3::ZERO });
        let side = n[0].max(n[1]).max(n[2]);
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element().max(1e-300);
        let orientation = map.jet(core.center()).det().signum();
        let mut out = Self {
            map_work: map.work(),
            budget: None,
            map,
            domain,
            core,
            orientation,
            reach,
            starts: starts.into(),
            buckets: Arc::default(),
            bounds,
            side,
            lipschitz: 2.0 * lipschitz,
            rounding: 64.0 * f64::EPSILON * largest,
        };
        let mut buckets = vec![Vec::new(); side * side * side];
        for (s, b) in boxes.iter().enumerate() {
            let (from, to) = (out.bucket(b.min), out.bucket(b.max));
            for [i, j, k] in grid([0, 1, 2].map(|a| (to[a] + 1).saturating_sub(from[a]))) {
                let bucket = ((from[2] + k) * side + from[1] + j) * side + from[0] + i;
                buckets[bucket].push(u32::try_from(s).unwrap_or(0));
            }
        }
        out.buckets = buckets.into();
        out
    }

    /// Returns the inverse with searches that charge a budget.
    pub(crate) fn spending(&self, budget: &Arc<Budget>) -> Self {
        // The map may itself be an inverse that searches.
        let map = self.map.within(budget).unwrap_or_else(|| Arc::clone(&self.map));
        Self { map, budget: Some(Arc::clone(budget)), ..self.clone() }
    }

    fn bucket(&self, q: DVec3) -> [usize; 3] {
        let t = (q - self.bounds.min) / self.bounds.size() * self.side as f64;
        // Casting a negative number or NaN gives 0.
        t.to_array().map(|v| (v as usize).min(self.side - 1))
    }

    /// Returns the preimage of `q` and the derivatives of the inverse there, or `None` if there is no certified preimage in the box.
    #[must_use]
    pub fn solve(&self, q: DVec3) -> Option<Jet3> {
        let mut search = Search::default();
        let found = self.search(q, &mut search);
        search.spend(self.budget.as_ref(), 1, self.map_work);
        found
    }

    fn search(&self, q: DVec3, search: &mut Search) -> Option<Jet3> {
        /// Work of selecting the nearest starting points, in examinations of each one.
        const SELECTING: usize = 30;
        if !q.is_finite() || is_over(self.budget.as_ref()) {
            return None;
        }
        let [i, j, k] = self.bucket(q);
        let near = &self.buckets[(k * self.side + j) * self.side + i];
        // Starting points in the core come first, then those with nearer images.
        let rank = |s: usize| (!self.core.contains(self.starts[s].0), self.starts[s].1.distance_squared(q), s);
        let compare = |a: &(bool, f64, usize), b: &(bool, f64, usize)| {
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2))
        };
        let mut ranked: Vec<(bool, f64, usize)> = near.iter().map(|s| rank(*s as usize)).collect();
        if ranked.is_empty() {
            search.starts += self.starts.len();
            ranked.extend((0..self.starts.len()).map(rank).min_by(|a, b| a.1.total_cmp(&b.1)));
        }
        search.starts += SELECTING * ranked.len();
        if ranked.len() > MAX_TRIES {
            ranked.select_nth_unstable_by(MAX_TRIES, compare);
            ranked.truncate(MAX_TRIES);
        }
        ranked.sort_by(compare);
        let mut best: Option<(f64, Jet3)> = None;
        for (_, _, s) in &ranked {
            let Some(found) = self.newton(self.starts[*s].0, q, search) else { continue };
            let distance = self.distance_from_core(found.p);
            if distance <= self.reach {
                return Some(found);
            }
            if found.det().signum() == self.orientation && best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, found));
            }
        }
        best.map(|b| b.1)
    }

    /// Returns the largest distance from the core along an axis; 0 inside.
    fn distance_from_core(&self, p: DVec3) -> f64 {
        (self.core.min - p).max(p - self.core.max).max_element().max(0.0)
    }

    /// Runs Newton's method from one starting point.
    fn newton(&self, start: DVec3, q: DVec3, search: &mut Search) -> Option<Jet3> {
        let allowed = self.domain.inflate(0.25 * self.domain.size());
        let mut x = start;
        let mut jet = self.map.jet(x);
        search.jets += 1;
        let mut residual = q - jet.p;
        for _ in 0..MAX_STEPS {
            let step = jet.d.inverse() * residual;
            if !step.is_finite() {
                return None;
            }
            // Halve the step until it reduces the residual. Stay near the box, since the map may be undefined further away.
            let mut damping = 1.0;
            let (mut to, mut at, mut r) = (x, jet, residual);
            while damping > MIN_DAMPING {
                to = (x + step * damping).clamp(allowed.min, allowed.max);
                at = self.map.jet(to);
                search.jets += 1;
                r = q - at.p;
                if r.length_squared() < residual.length_squared() || r.length() <= self.rounding {
                    break;
                }
                damping *= 0.5;
            }
            let (moved, better) = ((to - x).length(), r.length_squared() < residual.length_squared());
            if better || r.length() <= self.rounding {
                (x, jet, residual) = (to, at, r);
            }
            let is_still = moved <= 4.0 * f64::EPSILON * (x.abs().max_element() + self.domain.diagonal());
            if residual == DVec3::ZERO || is_still || !better {
                return self.certify(x, &jet, residual);
            }
        }
        None
    }

    /// Returns the jet of the inverse if an answer meets the three conditions in the module's text.
    fn certify(&self, x: DVec3, jet: &Jet3, residual: DVec3) -> Option<Jet3> {
        let back = jet.d.inverse();
        let eta = (back * residual).length();
        let is_certain = residual.length() <= self.rounding
            && self.domain.inflate(DVec3::splat(self.reach)).contains(x)
            && frobenius(back) * self.lipschitz * eta <= 0.5;
        is_certain.then_some(Jet3 { p: x, d: back })
    }
}

fn frobenius(m: DMat3) -> f64 {
    (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt()
}

impl Map3 for NewtonInverse3 {
    fn jet(&self, q: DVec3) -> Jet3 {
        self.solve(q).unwrap_or(Jet3::UNDEFINED)
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        Some(Arc::clone(&self.map))
    }

    fn work(&self) -> f64 {
        INVERSE_WORK * self.map_work
    }

    fn within(&self, budget: &Arc<Budget>) -> Option<Arc<dyn Map3>> {
        Some(Arc::new(self.spending(budget)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (x², y + xy/10, z + y²/5), which folds at x = 0.
    struct Fold;
    impl Map3 for Fold {
        fn jet(&self, p: DVec3) -> Jet3 {
            Jet3 {
                p: DVec3::new(p.x * p.x, p.y + 0.1 * p.x * p.y, p.z + 0.2 * p.y * p.y),
                d: DMat3::from_cols(
                    DVec3::new(2.0 * p.x, 0.1 * p.y, 0.0),
                    DVec3::new(0.0, 1.0 + 0.1 * p.x, 0.4 * p.y),
                    DVec3::Z,
                ),
            }
        }
    }

    #[test]
    fn a_smooth_map_is_inverted_and_nothing_is_invented_outside() {
        let domain = Box3::new(DVec3::new(0.5, -1.0, 0.0), DVec3::new(3.0, 2.0, 1.0));
        let inverse = NewtonInverse3::new(Arc::new(Fold), domain, 1e-9, [1, 1, 1]);
        for i in 0..1000 {
            let t = DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)) / 9.0;
            let p = domain.min + t * domain.size();
            let back = inverse.jet(Fold.point(p));
            assert!((back.p - p).length() < 1e-13, "{p} {back:?}");
            let there = Fold.jet(p).then(&back).d - DMat3::IDENTITY;
            assert!(frobenius(there) < 1e-12);
        }
        assert!(inverse.point(DVec3::new(-1.0, 0.0, 0.0)).is_nan());
        assert!(inverse.point(Fold.point(DVec3::new(0.4, 0.0, 0.5))).is_nan());
        let folded = Box3::new(DVec3::splat(-1.0), DVec3::splat(1.0));
        let inverse = NewtonInverse3::new(Arc::new(Fold), folded, 1e-9, [1, 1, 1]);
        assert!(inverse.point(DVec3::new(0.0, 0.3, 0.1)).is_nan());
    }
}
