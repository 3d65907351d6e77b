//! Writes each subpath as one entity, exact or flattened.

use crate::file::{Codes, MODEL_SPACE, nearest_color};
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
    let slack = ARC_SHARE * tolerance;
    let segs = merge_arcs(subpath, slack);
    let fits_polyline = |s: &Seg| match s {
        Seg::Line(_) => true,
        Seg::Arc(a) => is_circular(a, slack),
        Seg::Quad(_) | Seg::Cubic(_) => false,
    };
    match segs.as_slice() {
        [] => {}
        [Seg::Line(l)] => {
            entity(out, pen, "LINE", "AcDbLine").point(10, l.p0).point(11, l.p1);
        }
        [Seg::Arc(a)] if is_circular(a, slack) => arc(out, pen, a),
        [Seg::Arc(a)] => ellipse(out, pen, a),
        all if all.iter().all(fits_polyline) => write_polyline(out, pen, all, subpath.closed),
        all => spline(out, pen, all, subpath.closed, ARC_SHARE * slack),
    }
}

/// Writes a subpath as one polyline. Circular arcs stay exact, as bulges.
pub(crate) fn polyline(out: &mut Codes, pen: &Pen<'_>, subpath: &Subpath, tolerance: f64) {
    let slack = ARC_SHARE * tolerance;
    let mut segs = Vec::new();
    for seg in merge_arcs(subpath, slack) {
        match seg {
            Seg::Arc(a) if is_circular(&a, slack) => segs.push(seg),
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
        all => write_polyline(out, pen, all, subpath.closed),
    }
}

/// Starts an entity.
fn entity<'c>(out: &'c mut Codes, pen: &Pen<'_>, name: &str, class: &str) -> &'c mut Codes {
    let handle = out.new_handle();
    out.text(0, name).handle(5, handle).handle(330, MODEL_SPACE).text(100, "AcDbEntity").text(8, pen.layer);
    if let Some(color) = pen.color {
        let (index, is_exact) = nearest_color(color);
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

/// Writes lines and circular arcs as a polyline of width 0.
fn write_polyline(out: &mut Codes, pen: &Pen<'_>, segs: &[Seg], closed: bool) {
    let vertices = vertices(segs, closed);
    entity(out, pen, "LWPOLYLINE", "AcDbPolyline").whole(90, vertices.len() as i64).whole(70, closed.into());
    out.length(43, 0.0);
    for (p, bulge) in vertices {
        out.length(10, p.x).length(20, p.y);
        if bulge != 0.0 {
            out.ratio(42, bulge);
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
        out.text(100, "AcDbArc").ratio(50, degrees(from)).ratio(51, degrees(to));
    }
}

fn runs_counter_clockwise(a: &EllipticArc) -> bool {
    a.sweep * a.a.cross(a.b) > 0.0
}

/// Writes an ellipse or an arc of one.
fn ellipse(out: &mut Codes, pen: &Pen<'_>, a: &EllipticArc) {
    let (major, minor, shift) = principal_axes(a.a, a.b);
    entity(out, pen, "ELLIPSE", "AcDbEllipse").point(10, a.center).point(11, major.to_point());
    // The normal of the plane.
    out.length(210, 0.0).length(220, 0.0).length(230, 1.0);
    out.ratio(40, (minor.hypot() / major.hypot()).clamp(1e-6, 1.0));
    // DXF's parameter of an ellipse runs counter-clockwise from its major axis.
    let turns = major.cross(minor).signum();
    let (from, to) = if is_whole(a) {
        (0.0, TAU)
    } else {
        let [start, end] = [a.start, a.start + a.sweep].map(|t| ((t - shift) * turns).rem_euclid(TAU));
        if a.sweep * turns > 0.0 { (start, end) } else { (end, start) }
    };
    out.ratio(41, from).ratio(42, if to > from { to } else { to + TAU });
}

/// Returns the principal semi-axes of the ellipse c + cos θ·a + sin θ·b, the longer first, and the angle θ of the longer one.
fn principal_axes(a: Vec2, b: Vec2) -> (Vec2, Vec2, f64) {
    // |cos θ·a + sin θ·b|² is largest where tan 2θ = 2a·b / (a² − b²).
    let shift = 0.5 * (2.0 * a.dot(b)).atan2(a.hypot2() - b.hypot2());
    let (sin, cos) = shift.sin_cos();
    (a * cos + b * sin, b * cos - a * sin, shift)
}

/// Writes segments as one spline in which every joint is a triple knot, so that corners stay. A closed spline ends at the very point where
/// it starts. Its flag for closed splines stays off: LibreCAD up to 2.2 would draw a periodic spline of these control points instead.
fn spline(out: &mut Codes, pen: &Pen<'_>, segs: &[Seg], closed: bool, arc_tolerance: f64) {
    const DEGREE: usize = 3;
    let mut cubics: Vec<CubicBez> = Vec::with_capacity(segs.len());
    for seg in segs {
        match seg {
            Seg::Arc(a) => cubics.extend(a.to_cubics(arc_tolerance)),
            other => cubics.push(other.to_cubic()),
        }
    }
    let (Some(first), Some(last)) = (cubics.first().map(|c| c.p0), cubics.last_mut()) else { return };
    if closed {
        last.p3 = first;
    }
    let knots: Vec<f64> = bezier_knots(DEGREE, cubics.len()).collect();
    let points = std::iter::once(first).chain(cubics.iter().flat_map(|c| [c.p1, c.p2, c.p3]));
    let points: Vec<[f64; 3]> = points.map(|p| [p.x, p.y, 0.0]).collect();
    nurbs(out, pen, &Spline { layer: pen.layer, degree: DEGREE, knots: &knots, points: &points, weights: &[] });
}

/// Returns the knots of Bézier curves of one degree in a row, at parameters 0, 1, 2 and so on.
fn bezier_knots(degree: usize, count: usize) -> impl Iterator<Item = f64> {
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
    // Programs may take knots and points for equal that are this close, in millimetres.
    out.ratio(42, 1e-10).ratio(43, 1e-10);
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
const ARC_SHARE: f64 = 0.1;

/// Returns the segments that have a length. Cubics within `slack` of a circle become arcs, and consecutive arcs of one ellipse one arc.
fn merge_arcs(subpath: &Subpath, slack: f64) -> Vec<Seg> {
    let mut out: Vec<Seg> = Vec::with_capacity(subpath.segs.len());
    for seg in &subpath.segs {
        let seg = match seg {
            Seg::Line(l) if l.p0 == l.p1 => continue,
            Seg::Cubic(c) => EllipticArc::of_cubic(c, slack).map_or(*seg, Seg::Arc),
            other => *other,
        };
        match (out.last_mut(), seg) {
            (Some(Seg::Arc(last)), Seg::Arc(next)) if is_continued(last, &next, slack) => {
                let closes = next.p1 == subpath.start && (last.sweep + next.sweep).abs() > TAU - ANGLE_SLACK;
                let sweep = if closes { TAU.copysign(last.sweep) } else { last.sweep + next.sweep };
                *last = EllipticArc { p1: next.p1, sweep, ..*last };
            }
            _ => out.push(seg),
        }
    }
    out
}

/// Allowance for the angles of arcs that stand for cubics, in radians.
const ANGLE_SLACK: f64 = 1e-2;

/// Rounding errors of arcs, as a fraction of their radius and in radians.
const ROUNDING: f64 = 1e-9;

/// Returns `true` if an arc continues along the ellipse of another, within `slack`, up to a full turn.
fn is_continued(last: &EllipticArc, next: &EllipticArc, slack: f64) -> bool {
    let slack = slack.max(ROUNDING * last.major());
    let is_same_ellipse = last.center.distance(next.center) <= slack
        && (last.a - next.a).hypot() <= slack
        && (last.b - next.b).hypot() <= slack;
    let turn = (last.start + last.sweep - next.start).rem_euclid(TAU);
    let follows = turn.min(TAU - turn) * last.major() <= slack;
    is_same_ellipse && follows && last.sweep * next.sweep > 0.0 && (last.sweep + next.sweep).abs() <= TAU + ANGLE_SLACK
}

/// Returns `true` if an arc is within `slack` of a circular one.
fn is_circular(arc: &EllipticArc, slack: f64) -> bool {
    let (a, b) = (arc.a.hypot(), arc.b.hypot());
    let skew = arc.a.dot(arc.b).abs() / a.max(b);
    skew.is_finite() && (a - b).abs() + skew <= slack.max(ROUNDING * a)
}

/// Returns `true` if an arc is a whole ellipse.
fn is_whole(arc: &EllipticArc) -> bool {
    (arc.sweep.abs() - TAU).abs() < ROUNDING
}

/// Limit on successive halvings: a curve becomes at most 65536 lines.
const MAX_DEPTH: u32 = 16;

/// Appends the points of a polyline within `tolerance` of a segment, without its first point.
fn flatten(seg: &Seg, tolerance: f64, out: &mut Vec<Point>) {
    match seg {
        Seg::Line(l) => out.push(l.p1),
        Seg::Quad(_) | Seg::Cubic(_) => flatten_cubic(seg.to_cubic(), tolerance, 0, out),
        Seg::Arc(arc) => {
            // Cubics are an intermediate step, which gets a small part of the tolerance.
            let (for_cubics, for_lines) = (0.05 * tolerance, 0.95 * tolerance);
            arc.to_cubics(for_cubics).for_each(|c| flatten_cubic(c, for_lines, 0, out));
        }
    }
    if let Some(last) = out.last_mut() {
        *last = seg.end();
    }
}

/// Returns an upper bound for the number of lines that [`flatten`] makes of a segment.
pub(crate) fn max_lines(seg: &Seg, tolerance: f64) -> f64 {
    match seg {
        Seg::Line(_) => 1.0,
        // Every halving divides the second differences by four.
        Seg::Quad(_) | Seg::Cubic(_) => {
            let halvings = 0.5 * (chord_error(&seg.to_cubic()) / tolerance).log2();
            2.0_f64.powf(halvings.ceil().clamp(0.0, f64::from(MAX_DEPTH)))
        }
        // A chord of the angle θ is r·θ²/8 away from its arc.
        Seg::Arc(a) => {
            let radius = a.a.hypot().max(a.b.hypot());
            (2.0 * a.sweep.abs() * (0.125 * radius / tolerance).sqrt()).max(1.0)
        }
    }
}

/// Returns an upper bound for the distance of a cubic from its chord: an eighth of the largest second derivative (the error of linear
/// interpolation), which is six times a second difference of the control points.
fn chord_error(c: &CubicBez) -> f64 {
    let second_difference = |p: Point, q: Point, r: Point| ((p - q) + (r - q)).hypot();
    6.0 / 8.0 * second_difference(c.p0, c.p1, c.p2).max(second_difference(c.p1, c.p2, c.p3))
}

/// Appends lines for a cubic.
fn flatten_cubic(c: CubicBez, tolerance: f64, depth: u32, out: &mut Vec<Point>) {
    if chord_error(&c) <= tolerance || depth == MAX_DEPTH {
        out.push(c.p3);
        return;
    }
    let (a, b) = c.subdivide();
    flatten_cubic(a, tolerance, depth + 1, out);
    flatten_cubic(b, tolerance, depth + 1, out);
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

    fn entity(name: &str, points: usize) -> (String, usize) {
        (name.to_owned(), points)
    }

    #[test]
    fn contours_of_lines_and_arcs_are_polylines() {
        assert_eq!(entities("M0,0 H50 V20 A10,10 0 0 1 40,30 H0 Z"), [entity("LWPOLYLINE", 5)]);
        assert_eq!(entities("M0,0 H50 V20"), [entity("LWPOLYLINE", 3)]);
        assert_eq!(entities("M0,0 H50"), [entity("LINE", 1)]);
    }

    #[test]
    fn a_circle_in_quarters_is_one_circle() {
        let d = "M10,0 A10,10 0 0 1 0,10 A10,10 0 0 1 -10,0 A10,10 0 0 1 0,-10 A10,10 0 0 1 10,0 Z";
        assert_eq!(entities(d), [entity("CIRCLE", 1)]);
    }

    #[test]
    fn a_mixed_contour_is_one_spline() {
        assert_eq!(entities("M0,0 H50 C60,0 60,20 50,20 H0 Z"), [entity("SPLINE", 13)]);
        assert_eq!(entities("M0,0 C10,0 20,10 20,20 C20,30 30,40 40,40 C40,50 0,50 0,0 Z"), [entity("SPLINE", 10)]);
        assert_eq!(entities("M0,0 A20,10 0 0 1 40,0"), [entity("ELLIPSE", 1)]);
        assert_eq!(entities("M0,0 A20,10 0 0 1 40,0 A20,10 0 0 0 80,0")[0].0, "SPLINE");
    }
}
