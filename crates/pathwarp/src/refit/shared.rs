//! Edges that neighbouring shapes share. Merging leaves them alone, so that no gap opens between two shapes.
//!
//! A merged piece continues into the segments after an edge, and those differ on its two sides. The pieces of the edge alone
//! are the same for both.

use super::split;
use crate::outline::{Outline, Seg};
use kurbo::Point;

/// The segments that occur more than once in a drawing, in either direction.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SharedEdges {
    /// Sorted [`fingerprint`]s. Two segments with the same one are taken for equal: among a million segments that happens by chance
    /// once in forty million drawings, and leaves two edges unmerged.
    twice: Vec<u64>,
}

impl SharedEdges {
    /// The segments that `outlines` share, with each other or within themselves.
    #[must_use]
    pub fn among<'a>(outlines: impl IntoIterator<Item = &'a Outline>) -> Self {
        let mut all: Vec<u64> = outlines.into_iter().flat_map(Outline::segs).map(fingerprint).collect();
        all.sort_unstable();
        let mut twice: Vec<u64> = all.windows(2).filter(|w| w[0] == w[1]).map(|w| w[0]).collect();
        twice.dedup();
        Self { twice }
    }

    /// Returns `true` if `seg` is shared.
    pub(super) fn contains(&self, seg: &Seg) -> bool {
        !self.twice.is_empty() && self.twice.binary_search(&fingerprint(seg)).is_ok()
    }
}

/// A hash of the coordinates of a segment in its canonical direction, bit by bit, and of their number.
fn fingerprint(seg: &Seg) -> u64 {
    let backwards = split::is_backwards(seg);
    let ends = |p: Point, q: Point| if backwards { [q, p] } else { [p, q] };
    match seg {
        Seg::Line(s) => mixed(&ends(s.p0, s.p1)),
        Seg::Quad(s) => {
            let [p, q] = ends(s.p0, s.p2);
            mixed(&[p, s.p1, q])
        }
        Seg::Cubic(s) => {
            let ([p, q], [a, b]) = (ends(s.p0, s.p3), ends(s.p1, s.p2));
            mixed(&[p, a, b, q])
        }
        Seg::Arc(s) => {
            // The middle distinguishes arcs between the same ends. It is rounded, since the two directions compute it
            // differently.
            let (canonical, _) = split::canonical(seg);
            let m = canonical.eval(0.5);
            let [p, q] = ends(s.p0, s.p1);
            mixed(&[p, q, Point::new(f64::from(m.x as f32), f64::from(m.y as f32))])
        }
    }
}

/// Multiplies each coordinate into the hash and folds the product, so that every bit counts.
#[inline(always)]
fn mixed(points: &[Point]) -> u64 {
    /// 2⁶⁴ divided by the golden ratio, odd.
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    let mix = |hash: u64, word: u64| {
        let product = u128::from(hash ^ word) * u128::from(FACTOR);
        product as u64 ^ (product >> 64) as u64
    };
    points.iter().fold(points.len() as u64, |hash, p| mix(mix(hash, p.x.to_bits()), p.y.to_bits()))
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
