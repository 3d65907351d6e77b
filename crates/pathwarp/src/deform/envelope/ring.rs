//! Four sides of an envelope, in the order in which the map uses them.

use crate::outline::{Outline, Seg, Subpath};
use kurbo::{BezPath, Point, Rect};

/// The sides' names, in the order of [`Ring::sides`].
pub(super) const SIDES: [&str; 4] = ["bottom", "right", "top", "left"];
/// Samples of a piece.
pub(super) const SAMPLES: u32 = 64;

/// Four sides, head to tail.
pub(in crate::deform) struct Ring {
    /// Bottom (left to right), right (upwards), top (right to left), left (downwards).
    pub(in crate::deform) sides: [Vec<Seg>; 4],
    pub(in crate::deform) notes: Vec<String>,
    pub(in crate::deform) warnings: Vec<String>,
}

/// The four corners of a closed path.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Corners {
    /// Numbers of nodes, from 1.
    Nodes([usize; 4]),
    /// The points of the path nearest to these.
    Points([Point; 4]),
}

impl Ring {
    /// Returns the sides as one closed path.
    pub(super) fn closed(&self) -> Subpath {
        let segs: Vec<Seg> = self.sides.iter().flatten().copied().collect();
        Subpath { start: segs.first().map_or(Point::ORIGIN, Seg::start), segs, closed: true }
    }

    /// Returns `true` if the bottom and the top meet at an end.
    pub(super) fn meets(&self) -> bool {
        let point = |side: &[Seg]| side.iter().all(|s| s.bounding_box().size().max_side() == 0.0);
        point(&self.sides[1]) || point(&self.sides[3])
    }

    /// Returns the sides for a preview.
    pub(super) fn path(&self) -> BezPath {
        shown(&self.closed())
    }
}

/// Returns a closed path for a preview.
pub(super) fn shown(path: &Subpath) -> BezPath {
    let all = Outline { subpaths: vec![path.clone()] };
    let size = all.bounding_box().map_or(1.0, |b| b.width() + b.height());
    all.to_bez_path(1e-4 * size)
}

/// Reverses a side.
pub(super) fn reversed(side: &[Seg]) -> Vec<Seg> {
    side.iter().rev().map(Seg::reversed).collect()
}

/// Runs the ring the other way from the bottom's end: left and right change places.
pub(super) fn mirrored([bottom, right, top, left]: [Vec<Seg>; 4]) -> [Vec<Seg>; 4] {
    [reversed(&bottom), reversed(&left), reversed(&top), reversed(&right)]
}

/// Returns twice the area between a piece and the origin.
pub(super) fn area(s: &Seg) -> f64 {
    let at = |i: u32| s.eval(f64::from(i) / f64::from(SAMPLES)).to_vec2();
    (0..SAMPLES).map(|i| at(i).cross(at(i + 1))).sum()
}

/// Returns the box of a closed path.
pub(super) fn bounds(sub: &Subpath) -> Rect {
    sub.segs.iter().map(Seg::bounding_box).reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO)
}

/// Returns a part of a segment.
pub(super) fn part(s: &Seg, a: f64, b: f64) -> Seg {
    match s {
        _ if a == 0.0 && b == 1.0 => *s,
        Seg::Arc(arc) => Seg::Arc(arc.subsegment(a, b)),
        other => other.part(a, b).unwrap_or(*other),
    }
}
