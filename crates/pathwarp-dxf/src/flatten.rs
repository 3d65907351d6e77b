//! Curves as polylines within a tolerance.

use pathwarp::Seg;
use pathwarp::kurbo::{CubicBez, ParamCurve as _, Point};

/// Deepest halving: a curve becomes at most 65536 lines.
const DEEPEST: u32 = 16;

/// Appends the points of a polyline within `tolerance` of a segment, without its first point.
pub(crate) fn flatten(seg: &Seg, tolerance: f64, out: &mut Vec<Point>) {
    match seg {
        Seg::Line(l) => out.push(l.p1),
        Seg::Quad(_) | Seg::Cubic(_) => halve(seg.to_cubic(), tolerance, 0, out),
        Seg::Arc(arc) => {
            // A small part of the tolerance for cubics, which are needed only to be halved.
            let (cubics, lines) = (0.05 * tolerance, 0.95 * tolerance);
            arc.to_cubics(cubics).for_each(|c| halve(c, lines, 0, out));
        }
    }
    if let Some(last) = out.last_mut() {
        *last = seg.end();
    }
}

/// The most lines that [`flatten`] makes of a segment.
pub(crate) fn most_lines(seg: &Seg, tolerance: f64) -> f64 {
    match seg {
        Seg::Line(_) => 1.0,
        Seg::Quad(_) | Seg::Cubic(_) => of_cubic(&seg.to_cubic(), tolerance),
        // A chord of the angle θ is r·θ²/8 away from its arc.
        Seg::Arc(a) => {
            let radius = a.a.hypot().max(a.b.hypot());
            (2.0 * a.sweep.abs() * (0.125 * radius / tolerance).sqrt()).max(1.0)
        }
    }
}

/// Every halving takes the second differences to a quarter.
fn of_cubic(c: &CubicBez, tolerance: f64) -> f64 {
    let halvings = 0.5 * (6.0 / 8.0 * second_difference(c) / tolerance).log2();
    2.0_f64.powf(halvings.ceil().clamp(0.0, f64::from(DEEPEST)))
}

fn second_difference(c: &CubicBez) -> f64 {
    let second = |p: Point, q: Point, r: Point| ((p - q) + (r - q)).hypot();
    second(c.p0, c.p1, c.p2).max(second(c.p1, c.p2, c.p3))
}

/// A chord is at most an eighth of the largest second derivative away from its curve (the error of linear interpolation); of a
/// cubic, that derivative is six times a second difference of the control points.
fn halve(c: CubicBez, tolerance: f64, depth: u32, out: &mut Vec<Point>) {
    if 6.0 / 8.0 * second_difference(&c) <= tolerance || depth == DEEPEST {
        out.push(c.p3);
        return;
    }
    let (a, b) = c.subdivide();
    halve(a, tolerance, depth + 1, out);
    halve(b, tolerance, depth + 1, out);
}
