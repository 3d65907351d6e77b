//! Many computations at once, each of which asks a map for one jet after the other.
//!
//! For a map that prefers batches they proceed in rounds. In each round every computation is run anew, with the jets known so far,
//! until it asks for one that is not known. The jets that are lacking are then asked for in one call. Repeating costs little beside
//! a call, and gives the same results as asking singly.

use super::gathered::{Memory, key};
use super::{Jet, Map};
use kurbo::Point;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Rounds before the computations that are left ask singly: they are few, or endless.
const MOST_ROUNDS: usize = 100;

/// The jets known so far, and those that were asked for in this round.
#[derive(Default)]
struct Replay {
    known: Memory<Jet>,
    lacking: Mutex<Vec<Point>>,
    /// The present computation has asked for a jet that is not known. Its result, and what else it asks, mean nothing.
    stopped: AtomicBool,
}

impl Map for Replay {
    fn jet(&self, p: Point) -> Jet {
        if let Some(jet) = self.known.get(&key(p)) {
            return *jet;
        }
        if !self.stopped.swap(true, Ordering::Relaxed) {
            self.lacking.lock().unwrap_or_else(PoisonError::into_inner).push(p);
        }
        Jet::UNDEFINED
    }
}

/// The results of `f` for all items under `map`. `f` ends soon when it gets an undefined jet, and asks for jets only.
pub(super) fn by_rounds<T, R>(map: &dyn Map, items: &[T], f: impl Fn(&dyn Map, &T) -> R) -> Vec<R> {
    let mut replay = Replay::default();
    let mut results: Vec<Option<R>> = items.iter().map(|_| None).collect();
    for _ in 0..MOST_ROUNDS {
        for (item, result) in items.iter().zip(&mut results).filter(|(_, r)| r.is_none()) {
            replay.stopped.store(false, Ordering::Relaxed);
            let found = f(&replay, item);
            if !replay.stopped.load(Ordering::Relaxed) {
                *result = Some(found);
            }
        }
        let lacking = std::mem::take(replay.lacking.get_mut().unwrap_or_else(PoisonError::into_inner));
        if lacking.is_empty() {
            break;
        }
        let mut jets = vec![Jet::default(); lacking.len()];
        map.jets(&lacking, &mut jets);
        replay.known.extend(lacking.iter().map(|p| key(*p)).zip(jets));
    }
    items.iter().zip(results).map(|(item, result)| result.unwrap_or_else(|| f(map, item))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::NewtonInverse;
    use kurbo::{Rect, Vec2};
    use std::sync::Arc;
    use std::sync::atomic::AtomicUsize;

    /// A bend that counts its calls.
    #[derive(Default)]
    struct Bend {
        batches: bool,
        calls: AtomicUsize,
    }

    impl Map for Bend {
        fn jet(&self, p: Point) -> Jet {
            self.calls.fetch_add(1, Ordering::Relaxed);
            let (s, c) = (0.3 * p.y).sin_cos();
            Jet {
                p: Point::new(p.x + s, p.y + 0.1 * p.x * p.x),
                dx: Vec2::new(1.0, 0.2 * p.x),
                dy: Vec2::new(0.3 * c, 1.0),
            }
        }
        fn jets(&self, ps: &[Point], out: &mut [Jet]) {
            ps.iter().zip(out).for_each(|(p, o)| *o = self.jet(*p));
            self.calls.fetch_sub(ps.len() - 1, Ordering::Relaxed);
        }
        fn prefers_batches(&self) -> bool {
            self.batches
        }
    }

    #[test]
    fn an_inverse_by_rounds_is_the_same_in_fewer_calls() {
        let qs: Vec<Point> =
            (0..300).map(|i| Point::new(0.02 * f64::from(i) - 3.5, 1.5 - 0.011 * f64::from(i))).collect();
        let run = |batches: bool| {
            let map = Arc::new(Bend { batches, ..Bend::default() });
            let inverse = NewtonInverse::over(Arc::clone(&map) as Arc<dyn Map>, Rect::new(-2.0, -2.0, 2.0, 2.0), 0.1);
            let mut out = vec![Jet::default(); qs.len()];
            inverse.jets(&qs, &mut out);
            (out, map.calls.load(Ordering::Relaxed))
        };
        let ((singly, calls), (gathered, batches)) = (run(false), run(true));
        let same = |a: &Jet, b: &Jet| a == b || a.p.is_nan() && b.p.is_nan();
        assert!(singly.iter().zip(&gathered).all(|(a, b)| same(a, b)));
        assert!(singly.iter().any(|j| j.p.is_nan()) && singly.iter().filter(|j| j.is_finite()).count() > 200);
        assert!(calls > 1000 && batches < 100, "{calls} {batches}");
    }
}
