//! Flattens outlines to polygons whose images in space are within the tolerance of the true curves.

use crate::error::Error;
use crate::shape::{NamedShape, Point3, SurfaceFn};
use pathwarp::Seg;
use pathwarp::budget::{Budget, cost};
use pathwarp::kurbo::Point;

/// Maximum number of halvings of a segment.
const MOST_HALVINGS: u32 = 14;

/// A polygon or polyline in the plane of the drawing.
pub(crate) struct Polygon {
    pub(crate) points: Vec<Point>,
    pub(crate) closed: bool,
}

/// Flattens all subpaths of a shape.
pub(crate) fn polygons(
    shape: &NamedShape<'_>,
    space: &SurfaceFn<'_>,
    tolerance: f64,
    budget: &Budget,
) -> Result<Vec<Polygon>, Error> {
    let place = |p: Point| space(p).ok_or_else(|| Error::NoPlace { shape: shape.name.to_owned(), at: p });
    let mut out = Vec::new();
    for sub in &shape.outline.subpaths {
        let mut points = vec![sub.start];
        for seg in &sub.segs {
            let before = points.len();
            flatten(seg, &place, tolerance, &mut points)?;
            spend(shape.name, (points.len() - before) as f64, budget)?;
        }
        if sub.closed && points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        out.push(Polygon { points, closed: sub.closed });
    }
    Ok(out)
}

/// Counts segments of a shape.
pub(crate) fn spend(shape: &str, segments: f64, budget: &Budget) -> Result<(), Error> {
    let spent = budget.spend(cost::SEGMENT * segments);
    spent.map_err(|exceeded| Error::TooMany { shape: shape.to_owned(), exceeded })
}

/// Appends the points of a segment after its first.
fn flatten(
    seg: &Seg,
    place: &impl Fn(Point) -> Result<Point3, Error>,
    tolerance: f64,
    out: &mut Vec<Point>,
) -> Result<(), Error> {
    // Start with quarters, so that a symmetric bend is not missed.
    let mut stack: Vec<(f64, f64, u32)> =
        (0..4).rev().map(|i| (0.25 * f64::from(i), 0.25 * f64::from(i + 1), 2)).collect();
    if let Seg::Line(_) = seg {
        stack = vec![(0.0, 1.0, 0)];
    }
    while let Some((a, b, depth)) = stack.pop() {
        let (from, to) = (place(seg.eval(a))?, place(seg.eval(b))?);
        let mut off: f64 = 0.0;
        for k in [0.25, 0.5, 0.75] {
            off = off.max(chord_distance(from, to, place(seg.eval(a + k * (b - a)))?));
        }
        if off <= tolerance || depth >= MOST_HALVINGS {
            out.push(seg.eval(b));
        } else {
            let m = 0.5 * (a + b);
            stack.push((m, b, depth + 1));
            stack.push((a, m, depth + 1));
        }
    }
    Ok(())
}

/// Distance of `q` from the chord between two points.
pub(crate) fn chord_distance(a: Point3, b: Point3, q: Point3) -> f64 {
    let minus = |p: Point3, o: Point3| [p[0] - o[0], p[1] - o[1], p[2] - o[2]];
    let dot = |p: Point3, o: Point3| p[0] * o[0] + p[1] * o[1] + p[2] * o[2];
    let (c, v) = (minus(b, a), minus(q, a));
    let n = dot(c, c);
    let t = if n > 0.0 { (dot(v, c) / n).clamp(0.0, 1.0) } else { 0.0 };
    let r = [v[0] - t * c[0], v[1] - t * c[1], v[2] - t * c[2]];
    dot(r, r).sqrt()
}
