//! A memory in front of a map of which each call is expensive.

use super::{Class, Creases, Jet, Map, RationalBezier, RationalDegree};
use kurbo::Point;
use std::collections::HashMap;
use std::fmt;
use std::hash::{BuildHasherDefault, Hasher};
use std::sync::{Arc, Mutex, PoisonError};

/// Values remembered before they are forgotten again: some 40 MB.
const MOST_REMEMBERED: usize = 1 << 19;

/// A map with a memory of its values and jets, for maps that [prefer batches](Map::prefers_batches).
///
/// What is announced to it ([`Map::prepare`]), it asks for in one call. Its values are those of the map behind it.
pub struct Gathered<'a> {
    map: &'a dyn Map,
    points: Mutex<Memory<Point>>,
    jets: Mutex<Memory<Jet>>,
}

impl fmt::Debug for Gathered<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Gathered").field("map", &self.map).finish_non_exhaustive()
    }
}

/// Answers by the bits of their point.
pub(super) type Memory<T> = HashMap<Key, T, BuildHasherDefault<Mixer>>;

/// The key of a point: the bits of its coordinates.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Key(u64, u64);

pub(super) fn key(p: Point) -> Key {
    Key(p.x.to_bits(), p.y.to_bits())
}

/// A hash of coordinates. The points are computed here, so nobody can choose them to collide.
#[derive(Default)]
pub(super) struct Mixer(u64);

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
    /// Puts an empty memory in front of `map`.
    #[must_use]
    pub fn new(map: &'a dyn Map) -> Self {
        Self { map, points: Mutex::default(), jets: Mutex::default() }
    }
}

/// The points of `ps` that are not remembered.
fn unknown<T>(memory: &Mutex<Memory<T>>, ps: &[Point]) -> Vec<Point> {
    let known = memory.lock().unwrap_or_else(PoisonError::into_inner);
    ps.iter().filter(|p| !known.contains_key(&key(**p))).copied().collect()
}

/// Remembers the answers for `ps`.
fn remember<T: Copy>(memory: &Mutex<Memory<T>>, ps: &[Point], answers: &[T]) {
    let mut known = memory.lock().unwrap_or_else(PoisonError::into_inner);
    if known.len() > MOST_REMEMBERED {
        known.clear();
    }
    known.extend(ps.iter().map(|p| key(*p)).zip(answers.iter().copied()));
}

/// Copies the answers for `ps` to `out`; those that are not known are asked for in one call and remembered.
fn recall<T: Copy + Default>(memory: &Mutex<Memory<T>>, ps: &[Point], out: &mut [T], ask: impl Fn(&[Point], &mut [T])) {
    let (mut missing, mut places) = (Vec::new(), Vec::new());
    let known = memory.lock().unwrap_or_else(PoisonError::into_inner);
    for (p, o) in ps.iter().zip(out.iter_mut()) {
        match known.get(&key(*p)) {
            Some(answer) => *o = *answer,
            None => {
                missing.push(*p);
                places.push(o);
            }
        }
    }
    // Other threads need not wait for the answer.
    drop(known);
    if missing.is_empty() {
        return;
    }
    let mut answers = vec![T::default(); missing.len()];
    ask(&missing, &mut answers);
    remember(memory, &missing, &answers);
    for (o, answer) in places.into_iter().zip(answers) {
        *o = answer;
    }
}

impl Map for Gathered<'_> {
    fn jet(&self, p: Point) -> Jet {
        let mut out = [Jet::default()];
        self.jets(&[p], &mut out);
        out[0]
    }

    fn point(&self, p: Point) -> Point {
        let mut out = [Point::ORIGIN];
        self.points(&[p], &mut out);
        out[0]
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        recall(&self.jets, ps, out, |ps, out| self.map.jets(ps, out));
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        recall(&self.points, ps, out, |ps, out| self.map.points(ps, out));
    }

    fn class(&self) -> Class {
        self.map.class()
    }

    fn creases(&self, out: &mut Creases) {
        self.map.creases(out);
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        self.map.branch(inside)
    }

    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        self.map.image(curve)
    }

    fn rational_degree(&self) -> Option<RationalDegree> {
        self.map.rational_degree()
    }

    fn denominator(&self, p: Point) -> f64 {
        self.map.denominator(p)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        self.map.inverse()
    }

    fn work(&self) -> f64 {
        self.map.work()
    }

    fn prefers_batches(&self) -> bool {
        true
    }

    fn differentiates(&self) -> bool {
        self.map.differentiates()
    }

    fn remembers(&self) -> bool {
        true
    }

    fn prepare(&self, points: &[Point], jets: &[Point]) {
        let (ps, qs) = (unknown(&self.points, points), unknown(&self.jets, jets));
        let (mut images, mut jets) = (vec![Point::ORIGIN; ps.len()], vec![Jet::default(); qs.len()]);
        if !(ps.is_empty() && qs.is_empty()) {
            self.map.points_and_jets((&ps, &mut images), (&qs, &mut jets));
        }
        remember(&self.points, &ps, &images);
        remember(&self.jets, &qs, &jets);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

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
}
