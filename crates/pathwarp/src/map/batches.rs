//! Batches of points for maps whose calls are expensive, such as those of another program: a cache, and ways to invert maps in few calls.

use super::{Class, Creases, Enclosure, Jet, Map, RationalBezier};
use crate::budget::Budget;
use kurbo::{Point, Rect, Vec2};
use std::collections::HashMap;
use std::fmt;
use std::hash::{BuildHasherDefault, Hasher};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The cost of evaluating a map.
#[derive(Clone, Copy)]
pub struct Cost<'a> {
    /// The cost of one evaluation, relative to that of a bicubic net: 1 or more.
    pub work: f64,
    /// The cost of a single jet, as Newton's method asks for it. For maps of many parts, a jet takes longer alone than in a batch.
    pub jet: f64,
    /// Set if each call is expensive and each point cheap, as when another program is asked.
    pub batches: Option<&'a dyn Batches>,
    /// Set if the map searches for its values, as inverses do, and may take more than `work`.
    pub searches: Option<&'a dyn Searches>,
}

/// A map that searches for its values.
pub trait Searches {
    /// This map, with the cost of its searches beyond [`Cost::work`] charged to `budget`. They find nothing once the budget is used up.
    fn within(&self, budget: &Arc<Budget>) -> Arc<dyn Map>;
}

impl<'a> Cost<'a> {
    /// The cost of evaluating a bicubic net, the unit of all costs.
    pub const NET: Self = Self::new(1.0);

    /// The cost of a map whose evaluation takes `work`.
    #[must_use]
    pub const fn new(work: f64) -> Self {
        /// The factor by which the work beyond that of a net grows for a jet alone.
        const ALONE: f64 = 3.0;
        Self { work, jet: 1.0 + ALONE * (work - 1.0).max(0.0), batches: None, searches: None }
    }

    setters! {
        /// This cost for a map that should be asked in batches.
        batched(by: &'a dyn Batches) => batches: Some(by);
        /// This cost for a map that searches.
        searching(by: &'a dyn Searches) => searches: Some(by);
    }
}

impl fmt::Debug for Cost<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Cost").field("work", &self.work).field("jet", &self.jet).finish_non_exhaustive()
    }
}

/// Points, and a slot for the result at each.
pub type Images<'a, T> = (&'a [Point], &'a mut [T]);

/// A map whose calls are expensive and whose points are cheap. If its [`cost`](Map::cost) has [`batches`](Cost::batches), callers collect
/// the points that they need.
pub trait Batches: Map {
    /// Maps some points and computes the jets at others, in one call where possible.
    fn points_and_jets(&self, (ps, images): Images<'_, Point>, (qs, jets): Images<'_, Jet>) {
        self.points(ps, images);
        self.jets(qs, jets);
    }

    /// Returns `true` if each derivative is a difference of several values. Callers then use values where they can.
    fn differentiates(&self) -> bool {
        false
    }

    /// Returns `true` if the map caches results, so that announcing points to [`prepare`](Self::prepare) pays.
    fn remembers(&self) -> bool {
        false
    }

    /// Announces the points whose values, and those whose jets, will be asked for next.
    fn prepare(&self, _points: &[Point], _jets: &[Point]) {}
}

/// The number of results kept before the cache is cleared, for about 40 MB.
const MAX_CACHED: usize = 1 << 19;

/// A map with a cache of its values and jets, for maps that [prefer batches](Batches).
///
/// Announced points ([`Batches::prepare`]) are computed in one call. Results equal those of the map behind the cache.
pub struct Gathered<'a> {
    map: &'a dyn Map,
    points: Mutex<Cache<Point>>,
    jets: Mutex<Cache<Jet>>,
}

impl fmt::Debug for Gathered<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Gathered").field("map", &self.map).finish_non_exhaustive()
    }
}

/// Results by the bits of their points.
type Cache<T> = HashMap<Key, T, BuildHasherDefault<Mixer>>;

/// The bits of a point's coordinates.
type Key = (u64, u64);

fn key(p: Point) -> Key {
    (p.x.to_bits(), p.y.to_bits())
}

/// A hash of coordinates. The points are computed, so they cannot be chosen to collide.
#[derive(Default)]
struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write_u64(&mut self, word: u64) {
        /// The golden ratio, as a fraction of 2⁶⁴.
        const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
        self.0 = (self.0.rotate_left(23) ^ word).wrapping_mul(GOLDEN);
        self.0 ^= self.0 >> 32;
    }

    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.write_u64((*byte).into());
        }
    }
}

impl<'a> Gathered<'a> {
    /// Puts an empty cache in front of `map`.
    #[must_use]
    pub fn new(map: &'a dyn Map) -> Self {
        Self { map, points: Mutex::default(), jets: Mutex::default() }
    }
}

/// The points of `ps` that are not in the cache.
fn missing<T>(cache: &Mutex<Cache<T>>, ps: &[Point]) -> Vec<Point> {
    let known = cache.lock().unwrap_or_else(PoisonError::into_inner);
    ps.iter().filter(|p| !known.contains_key(&key(**p))).copied().collect()
}

/// Stores the results at `ps`.
fn remember<T: Copy>(cache: &Mutex<Cache<T>>, ps: &[Point], results: &[T]) {
    let mut known = cache.lock().unwrap_or_else(PoisonError::into_inner);
    if known.len() > MAX_CACHED {
        known.clear();
    }
    known.extend(ps.iter().map(|p| key(*p)).zip(results.iter().copied()));
}

/// Copies the results at `ps` to `out`, and computes the missing ones in one call of `compute`.
fn recall<T: Copy + Default>(
    cache: &Mutex<Cache<T>>,
    ps: &[Point],
    out: &mut [T],
    compute: impl Fn(&[Point], &mut [T]),
) {
    let (mut missing, mut slots) = (Vec::new(), Vec::new());
    let known = cache.lock().unwrap_or_else(PoisonError::into_inner);
    for (p, o) in ps.iter().zip(out.iter_mut()) {
        match known.get(&key(*p)) {
            Some(result) => *o = *result,
            None => {
                missing.push(*p);
                slots.push(o);
            }
        }
    }
    // Other threads need not wait for the results.
    drop(known);
    if missing.is_empty() {
        return;
    }
    let mut results = vec![T::default(); missing.len()];
    compute(&missing, &mut results);
    remember(cache, &missing, &results);
    for (slot, result) in slots.into_iter().zip(results) {
        *slot = result;
    }
}

impl Map for Gathered<'_> {
    single_by_batch!();

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        recall(&self.jets, ps, out, |ps, out| self.map.jets(ps, out));
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        recall(&self.points, ps, out, |ps, out| self.map.points(ps, out));
    }

    fn cost(&self) -> Cost<'_> {
        Cost { searches: None, ..self.map.cost() }.batched(self)
    }

    fn enclose(&self, along: [Enclosure; 2]) -> Option<[Enclosure; 2]> {
        self.map.enclose(along)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        self.map.inverse()
    }

    forward_common!(self => Map, self.map);
}

impl Batches for Gathered<'_> {
    fn differentiates(&self) -> bool {
        self.map.cost().batches.is_some_and(Batches::differentiates)
    }

    fn remembers(&self) -> bool {
        true
    }

    fn prepare(&self, points: &[Point], jets: &[Point]) {
        let (ps, qs) = (missing(&self.points, points), missing(&self.jets, jets));
        if ps.is_empty() && qs.is_empty() {
            return;
        }
        let (mut images, mut jets) = (vec![Point::ORIGIN; ps.len()], vec![Jet::default(); qs.len()]);
        match self.map.cost().batches {
            Some(batches) => batches.points_and_jets((&ps, &mut images), (&qs, &mut jets)),
            None => {
                self.map.points(&ps, &mut images);
                self.map.jets(&qs, &mut jets);
            }
        }
        remember(&self.points, &ps, &images);
        remember(&self.jets, &qs, &jets);
    }
}

// Many computations at once, each of which asks a map for one jet after another. Every round restarts the unfinished ones with the jets
// known so far and stops each at the first unknown jet; then one call fetches all the missing jets. Repeating the work is cheap next to a
// call, and the results are as if each computation asked alone.

/// Rounds after which the remaining computations ask alone: they are few, or endless.
const MAX_ROUNDS: usize = 100;

/// The jets known so far, and the unknown ones asked for in this round.
#[derive(Default)]
struct KnownJets {
    known: Cache<Jet>,
    missing: Mutex<Vec<Point>>,
    /// `true` once the current computation has asked for an unknown jet. Its result and its further questions mean nothing.
    stopped: AtomicBool,
}

impl Map for KnownJets {
    fn jet(&self, p: Point) -> Jet {
        if let Some(jet) = self.known.get(&key(p)) {
            return *jet;
        }
        if !self.stopped.swap(true, Ordering::Relaxed) {
            self.missing.lock().unwrap_or_else(PoisonError::into_inner).push(p);
        }
        Jet::UNDEFINED
    }
}

/// Computes `f` of the map and every item. `f` must ask for jets only, and end soon after an undefined one.
pub(super) fn by_rounds<T, R>(map: &dyn Map, items: &[T], f: impl Fn(&dyn Map, &T) -> R) -> Vec<R> {
    let mut jets_so_far = KnownJets::default();
    let mut results: Vec<Option<R>> = items.iter().map(|_| None).collect();
    for _ in 0..MAX_ROUNDS {
        for (item, result) in items.iter().zip(&mut results).filter(|(_, r)| r.is_none()) {
            jets_so_far.stopped.store(false, Ordering::Relaxed);
            let found = f(&jets_so_far, item);
            if !jets_so_far.stopped.load(Ordering::Relaxed) {
                *result = Some(found);
            }
        }
        let missing = std::mem::take(jets_so_far.missing.get_mut().unwrap_or_else(PoisonError::into_inner));
        if missing.is_empty() {
            break;
        }
        let mut jets = vec![Jet::default(); missing.len()];
        map.jets(&missing, &mut jets);
        jets_so_far.known.extend(missing.iter().map(|p| key(*p)).zip(jets));
    }
    items.iter().zip(results).map(|(item, result)| result.unwrap_or_else(|| f(map, item))).collect()
}

// Broyden's method for many points at a time: first answers for the inverse of a map whose derivatives take several values each. From the
// derivatives at a starting point, each step x ← x + H·r, with the residual r = q − F(x), needs one value. H begins as J⁻¹ and is
// corrected so that it explains the step before: H ← H + (s − H·y)·(sᵀH)/(sᵀ·H·y) for the step s and the change y of F (C. G. Broyden
// 1965). One call asks for the values of all points.

/// Steps before a point is left to Newton's method.
const MAX_STEPS: usize = 12;

/// A step must shrink the residual to less than this share.
const SHRINKAGE: f64 = 0.7;

/// A point to be inverted, with a point near its preimage and the map's jet there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    pub(super) q: Point,
    pub(super) start: Point,
    pub(super) jet: Jet,
}

/// The search for one target's preimage.
struct BroydenSearch {
    /// The index of the target.
    index: usize,
    q: Point,
    x: Point,
    residual: Vec2,
    /// The columns of H.
    inverse: [Vec2; 2],
}

impl BroydenSearch {
    /// H·v.
    fn times(&self, v: Vec2) -> Vec2 {
        self.inverse[0] * v.x + self.inverse[1] * v.y
    }

    /// Steps to a point whose image is known. Returns `false`, and stays, if the residual does not shrink enough.
    fn step(&mut self, next: Point, image: Point) -> bool {
        let residual = self.q - image;
        // Also false where the map is undefined and the residual NaN.
        let shrinks = residual.hypot() < SHRINKAGE * self.residual.hypot();
        if !shrinks {
            return false;
        }
        let (s, y) = (next - self.x, self.residual - residual);
        let explained = self.times(y);
        let scale = 1.0 / s.dot(explained);
        if scale.is_finite() {
            let along = [s.dot(self.inverse[0]), s.dot(self.inverse[1])].map(|v| v * scale);
            for (column, v) in self.inverse.iter_mut().zip(along) {
                *column += (s - explained) * v;
            }
        }
        (self.x, self.residual) = (next, residual);
        true
    }
}

/// For each target, a point whose image is at most `tolerance` from it, if one is found.
pub(super) fn broyden(map: &dyn Map, targets: &[Option<Target>], tolerance: f64) -> Vec<Option<Point>> {
    let mut found = vec![None; targets.len()];
    let search = |(index, target): (usize, &Option<Target>)| {
        let Target { q, start, jet } = (*target)?;
        let back = jet.inverted(start);
        Some(BroydenSearch { index, q, x: start, residual: q - jet.p, inverse: [back.dx, back.dy] })
    };
    let mut active: Vec<BroydenSearch> = targets.iter().enumerate().filter_map(search).collect();
    for _ in 0..MAX_STEPS {
        active.retain(|s| {
            let is_solved = s.residual.hypot() <= tolerance;
            if is_solved {
                found[s.index] = Some(s.x);
            }
            !is_solved
        });
        if active.is_empty() {
            break;
        }
        let next: Vec<Point> = active.iter().map(|s| s.x + s.times(s.residual)).collect();
        let mut images = vec![Point::ORIGIN; next.len()];
        map.points(&next, &mut images);
        let mut steps = next.into_iter().zip(images);
        active.retain_mut(|s| steps.next().is_some_and(|(next, image)| s.step(next, image)));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Formula, NewtonInverse, Real};
    use kurbo::Rect;
    use std::sync::atomic::AtomicUsize;

    /// Counts calls and points.
    #[derive(Default)]
    struct Counting([AtomicUsize; 2]);

    impl Map for Counting {
        fn jet(&self, p: Point) -> Jet {
            Jet { p: Point::new(p.y, -p.x), ..Jet::default() }
        }
        fn points(&self, ps: &[Point], out: &mut [Point]) {
            self.0[0].fetch_add(1, Ordering::Relaxed);
            self.0[1].fetch_add(ps.len(), Ordering::Relaxed);
            for (p, o) in ps.iter().zip(out) {
                *o = self.jet(*p).p;
            }
        }
    }

    #[test]
    fn announced_points_are_asked_for_once() {
        let map = Counting::default();
        let gathered = Gathered::new(&map);
        let ps: Vec<Point> = (0..40).map(|i| Point::new(f64::from(i % 30), 2.0)).collect();
        gathered.prepare(&ps[..10], &[]);
        let mut out = vec![Point::ORIGIN; ps.len()];
        for _ in 0..3 {
            gathered.points(&ps, &mut out);
            assert!(ps.iter().zip(&out).all(|(p, q)| *q == Point::new(p.y, -p.x)));
        }
        let [calls, points] = map.0.map(AtomicUsize::into_inner);
        assert_eq!((calls, points), (2, 10 + 20));
    }

    /// A bend that counts its calls.
    #[derive(Default)]
    struct CountedBend {
        batches: bool,
        calls: AtomicUsize,
    }

    impl Map for CountedBend {
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
        fn cost(&self) -> Cost<'_> {
            if self.batches { Cost::NET.batched(self) } else { Cost::NET }
        }
    }

    impl Batches for CountedBend {}

    #[test]
    fn an_inverse_by_rounds_is_the_same_in_fewer_calls() {
        let qs: Vec<Point> =
            (0..300).map(|i| Point::new(0.02 * f64::from(i) - 3.5, 1.5 - 0.011 * f64::from(i))).collect();
        let run = |batches: bool| {
            let map = Arc::new(CountedBend { batches, ..CountedBend::default() });
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

    struct Bend;
    impl Formula for Bend {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x + (y * 0.3).sin(), y + x * x * 0.1)
        }
    }

    /// The bend computed by a program without derivatives; counts the values.
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
        fn cost(&self) -> Cost<'_> {
            Cost::NET.batched(self)
        }
    }

    impl Batches for Slow {
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
            assert!((few as f64) < most * all as f64, "{all} {few}");
        }
    }
}
