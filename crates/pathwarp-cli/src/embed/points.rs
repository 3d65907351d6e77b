//! Points under a recipe.

use pathwarp::kurbo::{Point, Vec2};
use pathwarp::map::{Chain, Creases, Jet, Map};

/// A recipe built for some points: the map, and where it is defined.
#[derive(Debug, Clone)]
pub struct PointMap {
    map: Chain,
    creases: Creases,
}

impl PointMap {
    pub(super) fn new(map: Chain) -> Self {
        let mut creases = Creases::default();
        map.creases(&mut creases);
        Self { map, creases }
    }

    /// Maps `from` to `to`, of the same length. Points outside of the map's domain become NaN.
    pub fn points(&self, from: &[Point], to: &mut [Point]) {
        self.map.points(from, to);
        if self.creases.items().is_empty() {
            return;
        }
        for (p, image) in from.iter().zip(to) {
            if !self.creases.defined_at(*p) {
                *image = Jet::UNDEFINED.p;
            }
        }
    }

    /// The two columns of the Jacobian at each of `at`: the derivatives by x and by y.
    pub fn jacobians(&self, at: &[Point], out: &mut [[Vec2; 2]]) {
        let mut jets = vec![Jet::default(); at.len()];
        self.map.jets(at, &mut jets);
        for ((p, j), out) in at.iter().zip(&jets).zip(out) {
            let j = if self.creases.defined_at(*p) { j } else { &Jet::UNDEFINED };
            *out = [j.dx, j.dy];
        }
    }
}
