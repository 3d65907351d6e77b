//! First answers for the inverse of a map whose derivatives cost several values: Broyden's method for many points at a time.
//!
//! From the derivatives at a starting point, each step x ← x + H·r, with the residual r = q − F(x), needs one value. H begins as J⁻¹
//! and is corrected so that it explains the step before: H ← H + (s − H·y)·(sᵀH)/(sᵀ·H·y) for the step s and the change y of F
//! (C. G. Broyden 1965). The values of all points are asked for in one call.

use super::{Jet, Map};
use kurbo::{Point, Vec2};

/// Steps before a point is left to Newton's method.
const MOST_STEPS: usize = 12;

/// A step must shrink the residual to less than this share.
const SHRINKS: f64 = 0.7;

/// A point to be inverted, with a place near its preimage and the map's jet there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    pub(super) q: Point,
    pub(super) start: Point,
    pub(super) jet: Jet,
}

struct Search {
    index: usize,
    q: Point,
    at: Point,
    residual: Vec2,
    /// The columns of H.
    inverse: [Vec2; 2],
}

impl Search {
    /// H·v.
    fn times(&self, v: Vec2) -> Vec2 {
        self.inverse[0] * v.x + self.inverse[1] * v.y
    }

    /// Takes a step whose value is known. Returns `false` if it leads away.
    fn step(&mut self, to: Point, image: Point) -> bool {
        let residual = self.q - image;
        // Not a number where the map is undefined.
        let shrinks = residual.hypot() < SHRINKS * self.residual.hypot();
        if !shrinks {
            return false;
        }
        let (s, y) = (to - self.at, self.residual - residual);
        let explained = self.times(y);
        let scale = 1.0 / s.dot(explained);
        if scale.is_finite() {
            let along = [s.dot(self.inverse[0]), s.dot(self.inverse[1])].map(|v| v * scale);
            for (column, v) in self.inverse.iter_mut().zip(along) {
                *column += (s - explained) * v;
            }
        }
        (self.at, self.residual) = (to, residual);
        true
    }
}

/// Places whose images are within `enough` of the targets' points, as far as they are found.
pub(super) fn approach(map: &dyn Map, targets: &[Option<Target>], enough: f64) -> Vec<Option<Point>> {
    let mut found = vec![None; targets.len()];
    let search = |(index, target): (usize, &Option<Target>)| {
        let Target { q, start, jet } = (*target)?;
        let det = jet.det();
        let inverse = [Vec2::new(jet.dy.y, -jet.dx.y) / det, Vec2::new(-jet.dy.x, jet.dx.x) / det];
        Some(Search { index, q, at: start, residual: q - jet.p, inverse })
    };
    let mut active: Vec<Search> = targets.iter().enumerate().filter_map(search).collect();
    for _ in 0..MOST_STEPS {
        active.retain(|s| {
            let near = s.residual.hypot() <= enough;
            if near {
                found[s.index] = Some(s.at);
            }
            !near
        });
        if active.is_empty() {
            break;
        }
        let places: Vec<Point> = active.iter().map(|s| s.at + s.times(s.residual)).collect();
        let mut images = vec![Point::ORIGIN; places.len()];
        map.points(&places, &mut images);
        let mut steps = places.into_iter().zip(images);
        active.retain_mut(|s| steps.next().is_some_and(|(to, image)| s.step(to, image)));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Formula, NewtonInverse, Real};
    use kurbo::Rect;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    struct Bend;
    impl Formula for Bend {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x + (y * 0.3).sin(), y + x * x * 0.1)
        }
    }

    /// The bend as a program without derivatives gives it; counts the values.
    struct Slow {
        differences: bool,
        values: AtomicUsize,
    }

    impl Map for Slow {
        fn jet(&self, p: Point) -> Jet {
            self.values.fetch_add(9, Ordering::Relaxed);
            Bend.jet(p)
        }
        fn point(&self, p: Point) -> Point {
            self.values.fetch_add(1, Ordering::Relaxed);
            Bend.point(p)
        }
        fn prefers_batches(&self) -> bool {
            true
        }
        fn differentiates(&self) -> bool {
            self.differences
        }
    }

    #[test]
    fn values_alone_lead_to_the_same_inverse() {
        let inside = |i: i32| Bend.point(Point::new(0.0024 * f64::from(i) - 1.9, 1.9 - 0.07 * f64::from(i % 50)));
        let beyond = |i: i32| Point::new(3.0 + 0.02 * f64::from(i), 1.0);
        let run = |differences: bool, qs: &[Point]| {
            let map = Arc::new(Slow { differences, values: AtomicUsize::new(0) });
            let inverse = NewtonInverse::over(Arc::clone(&map) as Arc<dyn Map>, Rect::new(-2.0, -2.0, 2.0, 2.0), 0.1);
            let mut out = vec![Jet::default(); qs.len()];
            map.values.store(0, Ordering::Relaxed);
            inverse.jets(qs, &mut out);
            (out, map.values.load(Ordering::Relaxed))
        };
        for (qs, most) in
            [((0..1500).map(inside).collect::<Vec<_>>(), 0.6), ((0..100).map(beyond).collect(), f64::INFINITY)]
        {
            let ((by_jets, all), (by_values, few)) = (run(false, &qs), run(true, &qs));
            for (a, b) in by_jets.iter().zip(&by_values) {
                assert_eq!(a.p.is_nan(), b.p.is_nan(), "{a:?} {b:?}");
                let off = a.p.distance(b.p).max((a.dx - b.dx).hypot()).max((a.dy - b.dy).hypot());
                assert!(a.p.is_nan() || off < 1e-13, "{a:?} {b:?}");
            }
            println!("{all} and {few} values");
            assert!((few as f64) < most * all as f64, "{all} {few}");
        }
    }
}
