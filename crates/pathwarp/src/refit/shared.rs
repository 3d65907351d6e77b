//! Edges that neighbouring shapes share.
//!
//! A piece that crossed the end of an edge would depend on the segments beyond, which differ on the two sides of the edge, and a gap would
//! open. So edges are fitted in chains, from one *junction* to the next, each in one direction, the same for all shapes that share it.

use super::source;
use crate::outline::{Outline, Seg, Subpath};
use kurbo::Point;
use std::collections::HashSet;

/// The segments that occur more than once in a drawing, in either direction, and how closely they are to be followed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SharedEdges {
    /// Sorted [`fingerprint`]s, each with the smallest tolerance of the contours that have the segment. Equal fingerprints are taken for
    /// equal segments: among a million segments that is wrong once in forty million drawings, and leaves two edges unmerged.
    shared: Vec<(u64, f64)>,
    /// Sorted hashes of the nodes at which contours of different tolerances meet, each with the smallest tolerance.
    nodes: Vec<(u64, f64)>,
    /// Sorted hashes of the nodes on shared segments at which other than two segments meet, counting a segment of several contours once.
    junctions: Vec<u64>,
    /// Sorted hashes of the nodes on shared segments at which closed contours begin.
    starts: Vec<u64>,
}

impl SharedEdges {
    /// The segments that `outlines` share, with each other or within themselves.
    #[must_use]
    pub fn among<'a>(outlines: impl IntoIterator<Item = &'a Outline>) -> Self {
        Self::held(outlines.into_iter().map(|o| (o, &[][..])))
    }

    /// The segments that `outlines` share, each with the tolerances of its subpaths, or none. A contour that comes again as a whole, from
    /// the same start and with the same tolerance, shares nothing with the first: both get the same curves.
    #[must_use]
    pub fn held<'a>(outlines: impl IntoIterator<Item = (&'a Outline, &'a [f64])>) -> Self {
        let outlines: Vec<(&Outline, &[f64])> = outlines.into_iter().collect();
        let (mut all, mut nodes, mut whole) = (Vec::new(), Vec::new(), HashSet::new());
        for (outline, contours) in &outlines {
            for (i, s) in outline.subpaths.iter().enumerate() {
                let tolerance = contours.get(i).copied();
                let directed = s.segs.iter().flat_map(|g| [hash_points(&[g.start(), g.end()]), fingerprint(g)]);
                let contour = directed.fold(u64::from(s.closed), mix);
                if !whole.insert((contour, tolerance.map(f64::to_bits))) {
                    continue;
                }
                all.extend(s.segs.iter().map(|g| (fingerprint(g), tolerance.unwrap_or(f64::INFINITY))));
                if let Some(tolerance) = tolerance {
                    let ends = s.segs.iter().map(Seg::start).chain([s.end()]);
                    nodes.extend(ends.map(|p| (hash_points(&[p]), tolerance)));
                }
            }
        }
        let differ = |run: &[(u64, f64)]| run[0].1 < run[run.len() - 1].1;
        let shared = smallest(all, |run| run.len() > 1);
        let mut out = Self { shared, nodes: smallest(nodes, differ), ..Self::default() };
        if !out.shared.is_empty() {
            out.add_junctions(outlines.iter().flat_map(|(o, _)| &o.subpaths));
        }
        out
    }

    /// Finds the junctions, and the nodes at which closed contours begin, on the shared segments of these subpaths.
    fn add_junctions<'a>(&mut self, subpaths: impl Iterator<Item = &'a Subpath> + Clone) {
        let shared = subpaths.clone().flat_map(|s| &s.segs).filter(|g| self.contains(g));
        let nodes: HashSet<u64> = shared.flat_map(|g| [g.start(), g.end()].map(hash_node)).collect();
        let (mut ends, mut starts) = (Vec::new(), Vec::new());
        for s in subpaths {
            for g in &s.segs {
                let both = [g.start(), g.end()].map(hash_node).into_iter().filter(|p| nodes.contains(p));
                ends.extend(both.map(|p| (p, fingerprint(g))));
            }
            // Each end of an open path counts as one more segment.
            let both = [s.start, s.end()].map(hash_node).into_iter().filter(|p| nodes.contains(p));
            if s.closed { starts.extend(both.take(1)) } else { ends.extend(both.map(|p| (p, 0))) }
        }
        ends.sort_unstable();
        ends.dedup();
        starts.sort_unstable();
        let met = ends.chunk_by(|a, b| a.0 == b.0).filter(|run| run.len() != 2);
        (self.junctions, self.starts) = (met.map(|run| run[0].0).collect(), starts);
    }

    /// Returns `true` if other than two segments meet at a node of a shared segment.
    pub(super) fn is_junction(&self, p: Point) -> bool {
        self.junctions.binary_search(&hash_node(p)).is_ok()
    }

    /// Returns `true` if two consecutive segments lie on one chain, or if neither is shared.
    pub(super) fn continues_chain(&self, before: &Seg, after: &Seg) -> bool {
        // The two directions of an arc are computed differently, so arcs end a chain.
        let is_arc = |g: &Seg| matches!(g, Seg::Arc(_));
        let is_start = |p: Point| self.starts.binary_search(&hash_node(p)).is_ok();
        match [before, after].map(|g| self.contains(g)) {
            [true, true] => {
                !(is_arc(before) || is_arc(after) || self.is_junction(after.start()) || is_start(after.start()))
            }
            [a, b] => a == b,
        }
    }

    /// Returns `true` if `seg` is shared.
    pub(super) fn contains(&self, seg: &Seg) -> bool {
        self.tolerance_of(seg).is_some()
    }

    /// The smallest tolerance of the contours that share a segment.
    pub(crate) fn tolerance_of(&self, seg: &Seg) -> Option<f64> {
        if self.shared.is_empty() { None } else { value_of(&self.shared, fingerprint(seg)) }
    }

    /// Returns `true` if one of the segments is shared.
    pub(crate) fn holds_any(&self, segs: &[Seg]) -> bool {
        segs.iter().any(|s| self.contains(s))
    }

    /// Divides an outline whose subpaths have these tolerances into spans of one tolerance each.
    #[must_use]
    pub fn spans(&self, outline: &Outline, contours: &[f64]) -> Vec<Span> {
        let mut out: Vec<Span> = Vec::new();
        for (s, &contour) in outline.subpaths.iter().zip(contours) {
            let node_tolerance = |p: Point| value_of(&self.nodes, hash_points(&[p])).unwrap_or(contour);
            let (first, mut from) = (out.len(), node_tolerance(s.start));
            for g in &s.segs {
                let tolerance = self.tolerance_of(g).map_or(contour, |t| t.min(contour));
                let to = node_tolerance(g.end());
                match out[first..].last_mut() {
                    // A node that other contours follow more closely remains a node.
                    Some(last) if last.tolerance == tolerance && from >= tolerance => {
                        last.segments += 1;
                        last.nodes[1] = to;
                    }
                    _ => out.push(Span { segments: 1, tolerance, nodes: [from, to] }),
                }
                from = to;
            }
        }
        out
    }
}

/// Consecutive segments of one subpath with the same tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// The number of segments.
    pub segments: usize,
    /// The largest distance of their images from the output.
    pub tolerance: f64,
    /// The smallest tolerance of all contours that meet at either end, for rounding.
    pub nodes: [f64; 2],
}

/// For each key whose run of values is `kept`, the smallest of them; sorted.
fn smallest(mut all: Vec<(u64, f64)>, kept: impl Fn(&[(u64, f64)]) -> bool) -> Vec<(u64, f64)> {
    all.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    all.chunk_by(|a, b| a.0 == b.0).filter(|run| kept(run)).map(|run| run[0]).collect()
}

/// The value of a key, if it is in the list.
fn value_of(sorted: &[(u64, f64)], key: u64) -> Option<f64> {
    sorted.binary_search_by_key(&key, |(k, _)| *k).ok().map(|i| sorted[i].1)
}

/// A hash of the coordinates of a segment in its canonical direction, bit by bit, and of their number.
pub(crate) fn fingerprint(seg: &Seg) -> u64 {
    let backwards = source::is_backwards(seg);
    let ends = |p: Point, q: Point| if backwards { [q, p] } else { [p, q] };
    match seg {
        Seg::Line(s) => hash_points(&ends(s.p0, s.p1)),
        Seg::Quad(s) => {
            let [p, q] = ends(s.p0, s.p2);
            hash_points(&[p, s.p1, q])
        }
        Seg::Cubic(s) => {
            let ([p, q], [a, b]) = (ends(s.p0, s.p3), ends(s.p1, s.p2));
            hash_points(&[p, a, b, q])
        }
        Seg::Arc(s) => {
            // The middle distinguishes arcs between the same ends. It is rounded, since the two directions compute it differently.
            let (canonical, _) = source::canonical(seg);
            let m = canonical.eval(0.5);
            let [p, q] = ends(s.p0, s.p1);
            hash_points(&[p, q, Point::new(f64::from(m.x as f32), f64::from(m.y as f32))])
        }
    }
}

/// A hash of a node, the same for either sign of a zero coordinate.
fn hash_node(p: Point) -> u64 {
    hash_points(&[Point::new(p.x + 0.0, p.y + 0.0)])
}

/// Returns `true` if the agreed direction of a chain is the reverse of the given one.
pub(super) fn is_reversed(chain: &[Seg]) -> bool {
    let key = |p: Point| (p.x, p.y);
    let (Some(first), Some(last)) = (chain.first(), chain.last()) else { return false };
    // If both ends are one node, the nodes beside it decide.
    let ends = if first.start() == last.end() { [first.end(), last.start()] } else { [first.start(), last.end()] };
    key(ends[1]) < key(ends[0])
}

/// A hash of points, in which every bit of a coordinate counts.
#[inline(always)]
fn hash_points(points: &[Point]) -> u64 {
    points.iter().fold(points.len() as u64, |hash, p| mix(mix(hash, p.x.to_bits()), p.y.to_bits()))
}

/// Multiplies a word into a hash and folds the product.
#[inline(always)]
fn mix(hash: u64, word: u64) -> u64 {
    /// The odd number nearest to 2⁶⁴ divided by the golden ratio.
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    let product = u128::from(hash ^ word) * u128::from(FACTOR);
    (product as u64) ^ ((product >> 64) as u64)
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

    #[test]
    fn a_contour_that_comes_again_as_a_whole_shares_nothing() {
        let of = |d: &str| Outline::from_svg(d).unwrap();
        let a = of("M0,0 C1,2 3,4 5,5 L9,9 Z");
        assert_eq!(SharedEdges::among([&a, &a]), SharedEdges::default());
        for other in ["M5,5 L9,9 L0,0 C1,2 3,4 5,5 Z", "M0,0 L9,9 L5,5 C3,4 1,2 0,0 Z", "M0,0 C1,2 3,4 5,5 L9,9"] {
            assert!(SharedEdges::among([&a, &a, &of(other)]).contains(&a.subpaths[0].segs[0]), "{other}");
        }
    }

    #[test]
    fn a_shared_edge_has_the_smallest_tolerance_on_both_sides() {
        let a = Outline::from_svg("M0,0H9V9H0ZM20,20h1v1").unwrap();
        let b = Outline::from_svg("M9,9V0H12V9Z").unwrap();
        let (of_a, of_b) = ([3.0, 0.5], [1.0]);
        let shared = SharedEdges::held([(&a, &of_a[..]), (&b, &of_b[..])]);
        let span = |segments, tolerance, nodes| Span { segments, tolerance, nodes };
        let spans = shared.spans(&a, &of_a);
        assert_eq!(
            spans,
            [span(1, 3.0, [3.0, 1.0]), span(1, 1.0, [1.0, 1.0]), span(2, 3.0, [1.0, 3.0]), span(2, 0.5, [0.5, 0.5])]
        );
        assert_eq!(shared.spans(&b, &of_b), [span(4, 1.0, [1.0, 1.0])]);
    }
}
