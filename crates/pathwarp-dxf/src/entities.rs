//! Writes each subpath as one entity, exact or flattened.

use crate::file::{Codes, MODEL_SPACE, nearest};
use crate::model::Spline;
use pathwarp::kurbo::{CubicBez, ParamCurve as _, Point, Vec2};
use pathwarp::outline::EllipticArc;
use pathwarp::{Seg, Subpath};
use std::f64::consts::{PI, TAU};

/// The layer and colour of entities.
pub(crate) struct Pen<'a> {
    pub(crate) layer: &'a str,
    pub(crate) color: Option<[u8; 3]>,
}

/// Writes a subpath as one entity. It is exact if it consists of lines and circular arcs, of one ellipse, or of Bézier curves; arcs
/// among curves become cubics within a hundredth of the tolerance.
pub(crate) fn exact(out: &mut Codes, pen: &Pen<'_>, subpath: &Subpath, tolerance: f64) {
    let near = OF_TOLERANCE * tolerance;
    let segs = merged(subpath, near);
    let straight = |s: &Seg| match s {
        Seg::Line(_) => true,
        Seg::Arc(a) => is_circular(a, near),
        Seg::Quad(_) | Seg::Cubic(_) => false,
    };
    match segs.as_slice() {
        [] => {}
        [Seg::Line(l)] => {
            entity(out, pen, "LINE", "AcDbLine").point(10, l.p0).point(11, l.p1);
        }
        [Seg::Arc(a)] if is_circular(a, near) => arc(out, pen, a),
        [Seg::Arc(a)] => ellipse(out, pen, a),
        all if all.iter().all(straight) => polyline_of(out, pen, &vertices(all, subpath.closed), subpath.closed),
        all => spline(out, pen, all, subpath.closed, OF_TOLERANCE * near),
    }
}

/// Writes a subpath as one polyline. Circular arcs stay exact, as bulges.
pub(crate) fn polyline(out: &mut Codes, pen: &Pen<'_>, subpath: &Subpath, tolerance: f64) {
    let near = OF_TOLERANCE * tolerance;
    let mut segs = Vec::new();
    for seg in merged(subpath, near) {
        match seg {
            Seg::Arc(a) if is_circular(&a, near) => segs.push(seg),
            Seg::Line(_) => segs.push(seg),
            _ => {
                let mut points = vec![seg.start()];
                flatten(&seg, tolerance, &mut points);
                let lines = pathwarp::Outline::from_points(&points, false);
                segs.extend(lines.subpaths.into_iter().flat_map(|s| s.segs));
            }
        }
    }
    match segs.as_slice() {
        [] => {}
        [Seg::Arc(a)] if is_whole(a) => arc(out, pen, a),
        all => polyline_of(out, pen, &vertices(all, subpath.closed), subpath.closed),
    }
}

/// Starts an entity.
fn entity<'c>(out: &'c mut Codes, pen: &Pen<'_>, name: &str, class: &str) -> &'c mut Codes {
    let handle = out.new_handle();
    out.text(0, name).handle(5, handle).handle(330, MODEL_SPACE).text(100, "AcDbEntity").text(8, pen.layer);
    if let Some(color) = pen.color {
        let (index, is_exact) = nearest(color);
        out.whole(62, index.into());
        if !is_exact {
            let [r, g, b] = color.map(i64::from);
            out.whole(420, (r << 16) + (g << 8) + b);
        }
    }
    out.text(100, class)
}

/// A vertex with the bulge of the line behind it: the tangent of a quarter of the arc's angle, positive for counter-clockwise arcs.
type Vertex = (Point, f64);

/// Returns the vertices of lines and circular arcs.
fn vertices(segs: &[Seg], closed: bool) -> Vec<Vertex> {
    let mut out = Vec::with_capacity(segs.len() + 1);
    for seg in segs {
        match seg {
            // Beyond half a turn, the bulge grows without bound.
            Seg::Arc(a) if a.sweep.abs() > PI => {
                out.extend([a.subsegment(0.0, 0.5), a.subsegment(0.5, 1.0)].map(|h| (h.p0, bulge(&h))));
            }
            Seg::Arc(a) => out.push((a.p0, bulge(a))),
            other => out.push((other.start(), 0.0)),
        }
    }
    if !closed {
        out.extend(segs.last().map(|s| (s.end(), 0.0)));
    }
    out
}

fn bulge(arc: &EllipticArc) -> f64 {
    (arc.sweep * arc.a.cross(arc.b).signum() / 4.0).tan()
}

fn polyline_of(out: &mut Codes, pen: &Pen<'_>, vertices: &[Vertex], closed: bool) {
    entity(out, pen, "LWPOLYLINE", "AcDbPolyline").whole(90, vertices.len() as i64).whole(70, closed.into());
    out.length(43, 0.0);
    for (p, bulge) in vertices {
        out.length(10, p.x).length(20, p.y);
        if *bulge != 0.0 {
            out.fine(42, *bulge);
        }
    }
}

/// Writes a circle or a circular arc.
fn arc(out: &mut Codes, pen: &Pen<'_>, a: &EllipticArc) {
    let name = if is_whole(a) { "CIRCLE" } else { "ARC" };
    let radius = (a.a.hypot() + a.b.hypot()) / 2.0;
    entity(out, pen, name, "AcDbCircle").point(10, a.center).length(40, radius);
    if !is_whole(a) {
        // DXF's arcs run counter-clockwise.
        let (from, to) = if runs_counter_clockwise(a) { (a.p0, a.p1) } else { (a.p1, a.p0) };
        let degrees = |p: Point| (p - a.center).angle().to_degrees().rem_euclid(360.0);
        out.text(100, "AcDbArc").fine(50, degrees(from)).fine(51, degrees(to));
    }
}

fn runs_counter_clockwise(a: &EllipticArc) -> bool {
    a.sweep * a.a.cross(a.b) > 0.0
}

/// Writes an ellipse or an arc of one.
fn ellipse(out: &mut Codes, pen: &Pen<'_>, a: &EllipticArc) {
    let (major, minor, shift) = axes(a.a, a.b);
    entity(out, pen, "ELLIPSE", "AcDbEllipse").point(10, a.center).point(11, major.to_point());
    out.length(210, 0.0).length(220, 0.0).length(230, 1.0);
    out.fine(40, (minor.hypot() / major.hypot()).clamp(1e-6, 1.0));
    // DXF's parameter of an ellipse runs counter-clockwise from its major axis.
    let turns = major.cross(minor).signum();
    let (from, to) = if is_whole(a) {
        (0.0, TAU)
    } else {
        let [start, end] = [a.start, a.start + a.sweep].map(|t| ((t - shift) * turns).rem_euclid(TAU));
        if a.sweep * turns > 0.0 { (start, end) } else { (end, start) }
    };
    out.fine(41, from).fine(42, if to > from { to } else { to + TAU });
}

/// Returns the principal semi-axes of the ellipse c + cos θ·a + sin θ·b, the longer first, and the angle θ of the longer one.
fn axes(a: Vec2, b: Vec2) -> (Vec2, Vec2, f64) {
    // |cos θ·a + sin θ·b|² is largest where tan 2θ = 2a·b / (a² − b²).
    let shift = 0.5 * (2.0 * a.dot(b)).atan2(a.hypot2() - b.hypot2());
    let (sin, cos) = shift.sin_cos();
    (a * cos + b * sin, b * cos - a * sin, shift)
}

/// Writes segments as one spline in which every joint is a triple knot, so that corners stay. A closed spline ends at the very point where
/// it starts. Its flag for closed splines stays off: LibreCAD up to 2.2 would draw a periodic spline of these control points instead.
fn spline(out: &mut Codes, pen: &Pen<'_>, segs: &[Seg], closed: bool, near: f64) {
    const DEGREE: usize = 3;
    let mut cubics: Vec<CubicBez> = Vec::with_capacity(segs.len());
    for seg in segs {
        match seg {
            Seg::Arc(a) => cubics.extend(a.to_cubics(near)),
            other => cubics.push(other.to_cubic()),
        }
    }
    let (Some(first), Some(last)) = (cubics.first().map(|c| c.p0), cubics.last_mut()) else { return };
    if closed {
        last.p3 = first;
    }
    let knots: Vec<f64> = joints(DEGREE, cubics.len()).collect();
    let points = std::iter::once(first).chain(cubics.iter().flat_map(|c| [c.p1, c.p2, c.p3]));
    let points: Vec<[f64; 3]> = points.map(|p| [p.x, p.y, 0.0]).collect();
    nurbs(out, pen, &Spline { layer: pen.layer, degree: DEGREE, knots: &knots, points: &points, weights: &[] });
}

/// Returns the knots of Bézier curves of one degree in a row, at parameters 0, 1, 2 and so on.
fn joints(degree: usize, count: usize) -> impl Iterator<Item = f64> {
    (0..=count).flat_map(move |joint| {
        let ends = usize::from(joint == 0 || joint == count);
        std::iter::repeat_n(joint as f64, degree + ends)
    })
}

/// Writes a B-spline curve, which is rational if its weights differ, and planar if all of it is at z = 0.
pub(crate) fn nurbs(out: &mut Codes, pen: &Pen<'_>, s: &Spline<'_>) {
    const RATIONAL: i64 = 4;
    const PLANAR: i64 = 8;
    let is_rational = s.weights.windows(2).any(|w| w[0] != w[1]);
    let is_planar = s.points.iter().all(|p| p[2] == 0.0);
    entity(out, pen, "SPLINE", "AcDbSpline");
    if is_planar {
        out.length(210, 0.0).length(220, 0.0).length(230, 1.0);
    }
    out.whole(70, if is_rational { RATIONAL } else { 0 } + if is_planar { PLANAR } else { 0 });
    out.whole(71, s.degree as i64);
    out.whole(72, s.knots.len() as i64).whole(73, s.points.len() as i64).whole(74, 0);
    out.fine(42, 1e-10).fine(43, 1e-10);
    for knot in s.knots {
        out.shortest(40, *knot);
    }
    for weight in s.weights.iter().filter(|_| is_rational) {
        out.shortest(41, *weight);
    }
    for [x, y, z] in s.points {
        out.length(10, *x).length(20, *y).length(30, *z);
    }
}

/// Fraction of the tolerance by which an arc may miss a circle and still be written as one.
const OF_TOLERANCE: f64 = 0.1;

/// Returns the segments that have a length. Cubics within `near` of a circle become arcs, and consecutive arcs of one ellipse one arc.
fn merged(subpath: &Subpath, near: f64) -> Vec<Seg> {
    let mut out: Vec<Seg> = Vec::with_capacity(subpath.segs.len());
    for seg in &subpath.segs {
        let seg = match seg {
            Seg::Line(l) if l.p0 == l.p1 => continue,
            Seg::Cubic(c) => EllipticArc::of_cubic(c, near).map_or(*seg, Seg::Arc),
            other => *other,
        };
        match (out.last_mut(), seg) {
            (Some(Seg::Arc(last)), Seg::Arc(next)) if is_continued(last, &next, near) => {
                let closes = next.p1 == subpath.start && (last.sweep + next.sweep).abs() > TAU - ROUNDING;
                let sweep = if closes { TAU.copysign(last.sweep) } else { last.sweep + next.sweep };
                *last = EllipticArc { p1: next.p1, sweep, ..*last };
            }
            _ => out.push(seg),
        }
    }
    out
}

/// Allowance for the angles of arcs that stand for cubics, in radians.
const ROUNDING: f64 = 1e-2;

/// Returns `true` if an arc continues along the ellipse of another, within `near`, up to a full turn.
fn is_continued(last: &EllipticArc, next: &EllipticArc, near: f64) -> bool {
    let slack = near.max(1e-9 * last.major());
    let same = last.center.distance(next.center) <= slack
        && (last.a - next.a).hypot() <= slack
        && (last.b - next.b).hypot() <= slack;
    let turn = (last.start + last.sweep - next.start).rem_euclid(TAU);
    let follows = turn.min(TAU - turn) * last.major() <= slack;
    same && follows && last.sweep * next.sweep > 0.0 && (last.sweep + next.sweep).abs() <= TAU + ROUNDING
}

/// Returns `true` if an arc is within `near` of a circular one.
fn is_circular(arc: &EllipticArc, near: f64) -> bool {
    let (a, b) = (arc.a.hypot(), arc.b.hypot());
    let skew = arc.a.dot(arc.b).abs() / a.max(b);
    skew.is_finite() && (a - b).abs() + skew <= near.max(1e-9 * a)
}

/// Returns `true` if an arc is a whole ellipse.
fn is_whole(arc: &EllipticArc) -> bool {
    (arc.sweep.abs() - TAU).abs() < 1e-9
}

/// Limit on successive halvings: a curve becomes at most 65536 lines.
const DEEPEST: u32 = 16;

/// Appends the points of a polyline within `tolerance` of a segment, without its first point.
fn flatten(seg: &Seg, tolerance: f64, out: &mut Vec<Point>) {
    match seg {
        Seg::Line(l) => out.push(l.p1),
        Seg::Quad(_) | Seg::Cubic(_) => halve(seg.to_cubic(), tolerance, 0, out),
        Seg::Arc(arc) => {
            // Cubics are an intermediate step, which gets a small part of the tolerance.
            let (cubics, lines) = (0.05 * tolerance, 0.95 * tolerance);
            arc.to_cubics(cubics).for_each(|c| halve(c, lines, 0, out));
        }
    }
    if let Some(last) = out.last_mut() {
        *last = seg.end();
    }
}

/// Returns an upper bound for the number of lines that [`flatten`] makes of a segment.
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

/// Returns an upper bound for the lines of a cubic: every halving divides the second differences by four.
fn of_cubic(c: &CubicBez, tolerance: f64) -> f64 {
    let halvings = 0.5 * (6.0 / 8.0 * second_difference(c) / tolerance).log2();
    2.0_f64.powf(halvings.ceil().clamp(0.0, f64::from(DEEPEST)))
}

fn second_difference(c: &CubicBez) -> f64 {
    let second = |p: Point, q: Point, r: Point| ((p - q) + (r - q)).hypot();
    second(c.p0, c.p1, c.p2).max(second(c.p1, c.p2, c.p3))
}

/// Appends lines for a cubic. A chord is at most an eighth of the largest second derivative away from its curve (the error of linear
/// interpolation), and that derivative is six times a second difference of the control points.
fn halve(c: CubicBez, tolerance: f64, depth: u32, out: &mut Vec<Point>) {
    if 6.0 / 8.0 * second_difference(&c) <= tolerance || depth == DEEPEST {
        out.push(c.p3);
        return;
    }
    let (a, b) = c.subdivide();
    halve(a, tolerance, depth + 1, out);
    halve(b, tolerance, depth + 1, out);
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::Outline;

    /// Returns the names of a path's entities, and the numbers of their vertices or control points.
    fn entities(d: &str) -> Vec<(String, usize)> {
        let outline = Outline::from_svg(d).unwrap();
        let mut out = Codes::new();
        for s in &outline.subpaths {
            exact(&mut out, &Pen { layer: "0", color: None }, s, 0.01);
        }
        let text = out.finish();
        let entity = |t: &str| {
            let name = t.lines().next().unwrap_or_default().to_owned();
            (name, t.lines().filter(|l| *l == " 10").count())
        };
        text.split("  0\n").skip(1).map(entity).collect()
    }

    fn named(name: &str, points: usize) -> (String, usize) {
        (name.to_owned(), points)
    }

    #[test]
    fn contours_of_lines_and_arcs_are_polylines() {
        assert_eq!(entities("M0,0 H50 V20 A10,10 0 0 1 40,30 H0 Z"), [named("LWPOLYLINE", 5)]);
        assert_eq!(entities("M0,0 H50 V20"), [named("LWPOLYLINE", 3)]);
        assert_eq!(entities("M0,0 H50"), [named("LINE", 1)]);
    }

    #[test]
    fn a_circle_in_quarters_is_one_circle() {
        let d = "M10,0 A10,10 0 0 1 0,10 A10,10 0 0 1 -10,0 A10,10 0 0 1 0,-10 A10,10 0 0 1 10,0 Z";
        assert_eq!(entities(d), [named("CIRCLE", 1)]);
    }

    #[test]
    fn a_mixed_contour_is_one_spline() {
        assert_eq!(entities("M0,0 H50 C60,0 60,20 50,20 H0 Z"), [named("SPLINE", 13)]);
        assert_eq!(entities("M0,0 C10,0 20,10 20,20 C20,30 30,40 40,40 C40,50 0,50 0,0 Z"), [named("SPLINE", 10)]);
        assert_eq!(entities("M0,0 A20,10 0 0 1 40,0"), [named("ELLIPSE", 1)]);
        assert_eq!(entities("M0,0 A20,10 0 0 1 40,0 A20,10 0 0 0 80,0")[0].0, "SPLINE");
    }
}
