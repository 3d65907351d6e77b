//! Degenerate segments in a form that can be offset. Where the derivative of a cubic vanishes at an end, its curvature has no
//! bound, and kurbo's offset is not finite.

use pathwarp::kurbo::{CubicBez, Line, ParamCurve as _, Point, Shape as _};
use pathwarp::{Outline, Seg, Subpath};

/// Longest piece at a degenerate end that is replaced by a line, in the curve's parameter.
const LONGEST: f64 = 0.05;

/// Returns `true` if the whole segment is the point `at`.
pub(crate) fn is_point(s: &Seg, at: Point) -> bool {
    let c = s.to_cubic();
    [c.p0, c.p1, c.p2, c.p3].iter().all(|p| *p == at)
}

/// Share of the tolerance below which a segment has no shape.
const TINY: f64 = 1e-3;

/// Returns `true` if all of a segment is nearer to its start than this.
fn is_tiny(s: &Seg, near: f64) -> bool {
    let c = s.to_cubic();
    [c.p1, c.p2, c.p3].iter().all(|p| p.distance(c.p0) < near)
}

/// The same outline, within `tolerance`, without segments of zero length and without derivatives that vanish at an end.
pub(super) fn regular(s: &Subpath, tolerance: f64) -> Subpath {
    let mut segs = Vec::with_capacity(s.segs.len());
    for g in s.segs.iter().filter(|g| !is_point(g, g.start())) {
        match g {
            _ if is_tiny(g, TINY * tolerance) => {
                segs.extend((g.start() != g.end()).then(|| Seg::Line(Line::new(g.start(), g.end()))));
            }
            Seg::Quad(q) if q.p1 == q.p0 || q.p1 == q.p2 => segs.push(Seg::Line(Line::new(q.p0, q.p2))),
            Seg::Cubic(c) => split(*c, tolerance, &mut segs),
            Seg::Line(_) | Seg::Quad(_) | Seg::Arc(_) => segs.push(*g),
        }
    }
    Subpath { segs, ..s.clone() }
}

/// Replaces the degenerate ends of a cubic by lines.
fn split(c: CubicBez, tolerance: f64, out: &mut Vec<Seg>) {
    let (first, last) = (c.p1 == c.p0, c.p2 == c.p3);
    if first && (last || c.p2 == c.p0) || last && c.p1 == c.p3 {
        out.push(Seg::Line(Line::new(c.p0, c.p3)));
        return;
    }
    let head = if first { cut(c, tolerance) } else { 0.0 };
    let tail = if last { cut(CubicBez::new(c.p3, c.p2, c.p1, c.p0), tolerance) } else { 0.0 };
    let middle = c.subsegment(head..1.0 - tail);
    if first {
        out.push(Seg::Line(Line::new(c.p0, middle.p0)));
    }
    out.push(Seg::Cubic(middle));
    if last {
        out.push(Seg::Line(Line::new(middle.p3, c.p3)));
    }
}

/// Length, in the parameter, of the piece at the degenerate start of a cubic that a line replaces. With a = p2 - p0 and
/// b = p3 - p0, the curve is p0 + 3t²(1-t)a + t³b, so the piece [0, t] differs from its chord by less than t³(3|a| + |b|), and its
/// direction from the chord's by about t|b|/|a|.
fn cut(c: CubicBez, tolerance: f64) -> f64 {
    let (a, b) = ((c.p2 - c.p0).hypot(), (c.p3 - c.p0).hypot());
    let size = 3.0 * a + b;
    LONGEST.min(LONGEST * a / size).min((0.25 * tolerance / size).cbrt())
}

/// An outline as a polygon, which can always be offset.
pub(super) fn polygon(s: &Subpath, tolerance: f64) -> Outline {
    let mut path = pathwarp::kurbo::BezPath::new();
    let one = Outline { subpaths: vec![s.clone()] }.to_bez_path(tolerance);
    pathwarp::kurbo::flatten(one.path_elements(tolerance), tolerance, |e| path.push(e));
    (&path).into()
}

#[cfg(test)]
mod tests;
