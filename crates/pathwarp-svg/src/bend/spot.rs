//! A point of a stroked path and its image: the map's derivative there in the stroke's own axes.

use crate::scene::affine::stretch;
use pathwarp::Seg;
use pathwarp::kurbo::{Affine, Vec2};
use pathwarp::map::Jet;

/// A point of a stroke's edge relative to the path, in units of half the width.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    pub(super) exact: Vec2,
    /// For the factor 1.
    pub(super) drawn: Vec2,
}

/// A point of a path and its image, in the stroke's user space before and after.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    /// Image of the user unit vectors.
    pub(super) columns: [Vec2; 2],
    /// Unit tangent and normal.
    pub(super) tangent: Vec2,
    pub(super) normal: Vec2,
    /// Those of the image, with the normal on the image's side.
    pub(super) image: [Vec2; 2],
    /// Speeds along the path and along its image.
    pub(super) here: f64,
    pub(super) there: f64,
}

pub(super) fn linear(m: Affine, v: Vec2) -> Vec2 {
    let [a, b, c, d, ..] = m.as_coeffs();
    Vec2::new(a * v.x + c * v.y, b * v.x + d * v.y)
}

pub(super) fn perpendicular(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

impl Spot {
    /// `None` where the path or its image stands still.
    pub(super) fn new(jet: &Jet, v: Vec2, read: Affine, after: Affine) -> Option<Self> {
        let (before, columns) = (linear(read.inverse(), v), columns(jet, read, after));
        let push = |v: Vec2| columns[0] * v.x + columns[1] * v.y;
        let ahead = push(before);
        let (here, there) = (before.hypot(), ahead.hypot());
        if !(here > 0.0 && there > 0.0) {
            return None;
        }
        let (tangent, to) = (before / here, ahead / there);
        let side = if columns[0].cross(columns[1]) < 0.0 { -1.0 } else { 1.0 };
        let image = [to, perpendicular(to) * side];
        Some(Self { columns, tangent, normal: perpendicular(tangent), image, here, there })
    }

    pub(super) fn push(&self, v: Vec2) -> Vec2 {
        self.columns[0] * v.x + self.columns[1] * v.y
    }

    pub(super) fn in_image(&self, v: Vec2) -> Vec2 {
        Vec2::new(v.dot(self.image[0]), v.dot(self.image[1]))
    }

    pub(super) fn area_scale(&self) -> f64 {
        self.columns[0].cross(self.columns[1]).abs().sqrt()
    }
}

pub(super) fn columns(jet: &Jet, read: Affine, after: Affine) -> [Vec2; 2] {
    [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0)].map(|e| linear(after, jet.push(linear(read, e))))
}

/// The singular values of a matrix with these columns, against a circle.
pub(super) fn ellipse([x, y]: [Vec2; 2]) -> [Pair; 2] {
    let long = stretch(Affine::new([x.x, x.y, y.x, y.y, 0.0, 0.0]));
    let short = if long > 0.0 { x.cross(y).abs() / long } else { 0.0 };
    let drawn = Vec2::new(1.0, 0.0);
    [long, short].map(|r| Pair { exact: drawn * r, drawn })
}

/// The outermost point of a join between edges with these normals; `true` if it is a miter.
pub(super) fn tip(a: Vec2, b: Vec2, limit: f64) -> (Vec2, bool) {
    let bisector = a + b;
    // The miter's length is 1 / cos(turn / 2), and |a + b| = 2 cos(turn / 2).
    let mitered = limit * bisector.hypot() >= 2.0;
    (if mitered { bisector * (2.0 / bisector.hypot2()) } else { bisector * 0.5 }, mitered)
}

/// Turn of a segment's control polygon, in radians, an upper bound of the segment's own.
pub(super) fn turn(seg: &Seg) -> f64 {
    let angle = |a: Vec2, b: Vec2| a.cross(b).atan2(a.dot(b)).abs();
    match seg {
        Seg::Line(_) => 0.0,
        Seg::Quad(q) => angle(q.p1 - q.p0, q.p2 - q.p1),
        Seg::Cubic(c) => angle(c.p1 - c.p0, c.p2 - c.p1) + angle(c.p2 - c.p1, c.p3 - c.p2),
        Seg::Arc(a) => a.sweep.abs(),
    }
}
