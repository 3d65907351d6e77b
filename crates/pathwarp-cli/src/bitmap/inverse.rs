//! The inverse map over a bitmap's area: every pixel of a result asks it for its place in the source.

use super::work::Inverse;
use pathwarp::budget::Budget;
use pathwarp::kurbo::{Rect, Vec2};
use pathwarp::map::{Map, NewtonInverse};
use std::sync::Arc;

/// A length that exceeds whole pixels by less than this is rounding error.
pub(crate) const ROUNDING: f64 = 1e-6;

/// Returns the map's own inverse if it holds on all of `area`, else Newton's method over it. Either counts its evaluations.
pub(crate) fn inverse(map: &Arc<dyn Map>, area: Rect, budget: &Arc<Budget>) -> Inverse {
    /// Reach beyond the area as a fraction of its diagonal: the source footprint of the pixels along its edge.
    const REACH: f64 = 0.02;
    /// Test points per side.
    const TRIED: usize = 9;
    let diagonal = area.width().hypot(area.height());
    let returns = |inverse: &Arc<dyn Map>| {
        let at = |i: usize| (i as f64 + 0.5) / TRIED as f64;
        let places = (0..TRIED * TRIED).map(|k| (at(k % TRIED), at(k / TRIED)));
        let places = places.map(|(u, v)| area.origin() + Vec2::new(u * area.width(), v * area.height()));
        places.filter(|p| map.point(*p).is_finite()).all(|p| inverse.point(map.point(p)).distance(p) < 1e-3 * diagonal)
    };
    let own = map.inverse().filter(returns);
    let newton = || Arc::new(NewtonInverse::over(Arc::clone(map), area, REACH)) as Arc<dyn Map>;
    Inverse::new(own.unwrap_or_else(newton), Arc::clone(budget))
}
