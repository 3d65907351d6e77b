//! Edges that neighbouring shapes share. Merging leaves them alone, so that no gap opens between two shapes.
//!
//! A merged piece continues into the segments after an edge, and those differ on its two sides. The pieces of the edge alone
//! are the same for both.

use super::split;
use crate::outline::{Outline, Seg};
use kurbo::Point;
use std::collections::{HashMap, HashSet};

/// The coordinates of a segment in its canonical direction, bit by bit.
type Key = Vec<u64>;

/// The segments that occur more than once in a drawing, in either direction.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SharedEdges {
    keys: HashSet<Key>,
}

impl SharedEdges {
    /// The segments that `outlines` share, with each other or within themselves.
    #[must_use]
    pub fn among<'a>(outlines: impl IntoIterator<Item = &'a Outline>) -> Self {
        let mut seen: HashMap<Key, bool> = HashMap::new();
        for seg in outlines.into_iter().flat_map(Outline::segs) {
            seen.entry(key(seg)).and_modify(|twice| *twice = true).or_insert(false);
        }
        Self { keys: seen.into_iter().filter(|(_, twice)| *twice).map(|(k, _)| k).collect() }
    }

    /// Returns `true` if `seg` is shared.
    pub(super) fn contains(&self, seg: &Seg) -> bool {
        !self.keys.is_empty() && self.keys.contains(&key(seg))
    }
}

fn key(seg: &Seg) -> Key {
    let (canonical, _) = split::canonical(seg);
    let mut numbers = Vec::with_capacity(8);
    let mut point = |p: Point| numbers.extend([p.x.to_bits(), p.y.to_bits()]);
    match canonical {
        Seg::Line(s) => [s.p0, s.p1].into_iter().for_each(point),
        Seg::Quad(s) => [s.p0, s.p1, s.p2].into_iter().for_each(point),
        Seg::Cubic(s) => [s.p0, s.p1, s.p2, s.p3].into_iter().for_each(point),
        Seg::Arc(s) => {
            // The middle distinguishes arcs between the same ends. It is rounded, since the two directions compute it
            // differently.
            let m = s.eval(0.5);
            [s.p0, s.p1].into_iter().for_each(&mut point);
            point(Point::new(f64::from(m.x as f32), f64::from(m.y as f32)));
        }
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_shared_in_both_directions() {
        let a = Outline::from_svg("M0,0 C1,2 3,4 5,5 L9,9 A4,4 0 0 1 1,1 Z").unwrap();
        let b = Outline::from_svg("M5,5 C3,4 1,2 0,0 L-9,9 M1,1 A4,4 0 0 0 9,9").unwrap();
        let shared = SharedEdges::among([&a, &b]);
        let known: Vec<bool> = a.segs().map(|s| shared.contains(s)).collect();
        assert_eq!(known, [true, false, true, false]);
        assert_eq!(SharedEdges::among([&a]), SharedEdges::default());
    }
}
