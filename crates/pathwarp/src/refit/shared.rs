//! Edges that neighbouring shapes share. Merging leaves them alone, so that no gap opens between two shapes.
//!
//! A merged piece continues into the segments after an edge, and those differ on its two sides. The pieces of the edge alone
//! are the same for both.

use super::split;
use crate::outline::{Outline, Seg};
use kurbo::Point;
use std::collections::{HashMap, HashSet};

/// The coordinates of a segment in its canonical direction, bit by bit, and their number.
type Key = ([u64; 8], usize);

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
    match canonical {
        Seg::Line(s) => bits(&[s.p0, s.p1]),
        Seg::Quad(s) => bits(&[s.p0, s.p1, s.p2]),
        Seg::Cubic(s) => bits(&[s.p0, s.p1, s.p2, s.p3]),
        Seg::Arc(s) => {
            // The middle distinguishes arcs between the same ends. It is rounded, since the two directions compute it
            // differently.
            let m = s.eval(0.5);
            bits(&[s.p0, s.p1, Point::new(f64::from(m.x as f32), f64::from(m.y as f32))])
        }
    }
}

fn bits(points: &[Point]) -> Key {
    let mut out = [0; 8];
    for (pair, p) in out.chunks_exact_mut(2).zip(points) {
        pair.copy_from_slice(&[p.x.to_bits(), p.y.to_bits()]);
    }
    (out, points.len())
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
