//! Subpaths as entities.

use crate::codes::Codes;
use crate::color::nearest;
use crate::file::MODEL_SPACE;
use crate::flatten::flatten;
use crate::runs::{Kind, Run, is_circular, is_whole, merged, runs};
use pathwarp::kurbo::{Point, Vec2};
use pathwarp::outline::EllipticArc;
use pathwarp::{Seg, Subpath};
use std::f64::consts::{PI, TAU};

/// The layer and colour of entities.
pub(crate) struct Pen<'a> {
    pub(crate) layer: &'a str,
    pub(crate) color: Option<[u8; 3]>,
}

/// Writes a subpath exactly.
pub(crate) fn exact(out: &mut Codes, pen: &Pen<'_>, subpath: &Subpath, tolerance: f64) {
    for run in runs(subpath, tolerance) {
        match (run.kind, run.segs.as_slice()) {
            (Kind::Curve, segs) => spline(out, pen, segs),
            (Kind::Ellipse, [Seg::Arc(arc)]) => ellipse(out, pen, arc),
            (_, [Seg::Line(l)]) if !run.closed => {
                entity(out, pen, "LINE", "AcDbLine").point(10, l.p0).point(11, l.p1);
            }
            (_, [Seg::Arc(a)]) => arc(out, pen, a),
            _ => polyline_of(out, pen, &vertices(&run), run.closed),
        }
    }
}

/// Writes a subpath as one polyline. Circular arcs stay exact, as bulges.
pub(crate) fn polyline(out: &mut Codes, pen: &Pen<'_>, subpath: &Subpath, tolerance: f64) {
    let near = 0.1 * tolerance;
    let mut segs = Vec::new();
    for seg in merged(subpath) {
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
        _ => {
            let run = Run { kind: Kind::Straight, segs, closed: subpath.closed };
            polyline_of(out, pen, &vertices(&run), run.closed);
        }
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

/// A vertex with the bulge of the line behind it: the tangent of a quarter of the angle, positive if it runs counter-clockwise.
type Vertex = (Point, f64);

/// The vertices of a run of lines and circular arcs.
fn vertices(run: &Run) -> Vec<Vertex> {
    let mut out = Vec::with_capacity(run.segs.len() + 1);
    for seg in &run.segs {
        match seg {
            // The bulge of more than half a turn grows without bound.
            Seg::Arc(a) if a.sweep.abs() > PI => {
                out.extend([a.subsegment(0.0, 0.5), a.subsegment(0.5, 1.0)].map(|h| (h.p0, bulge(&h))));
            }
            Seg::Arc(a) => out.push((a.p0, bulge(a))),
            other => out.push((other.start(), 0.0)),
        }
    }
    if !run.closed {
        out.extend(run.segs.last().map(|s| (s.end(), 0.0)));
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

/// A circle or a circular arc.
fn arc(out: &mut Codes, pen: &Pen<'_>, a: &EllipticArc) {
    let name = if is_whole(a) { "CIRCLE" } else { "ARC" };
    let radius = (a.a.hypot() + a.b.hypot()) / 2.0;
    entity(out, pen, name, "AcDbCircle").point(10, a.center).length(40, radius);
    if !is_whole(a) {
        // An arc runs counter-clockwise.
        let (from, to) = if runs_counter_clockwise(a) { (a.p0, a.p1) } else { (a.p1, a.p0) };
        let degrees = |p: Point| (p - a.center).angle().to_degrees().rem_euclid(360.0);
        out.text(100, "AcDbArc").fine(50, degrees(from)).fine(51, degrees(to));
    }
}

fn runs_counter_clockwise(a: &EllipticArc) -> bool {
    a.sweep * a.a.cross(a.b) > 0.0
}

/// An ellipse or an arc of one.
fn ellipse(out: &mut Codes, pen: &Pen<'_>, a: &EllipticArc) {
    let (major, minor, shift) = axes(a.a, a.b);
    entity(out, pen, "ELLIPSE", "AcDbEllipse").point(10, a.center).point(11, major.to_point());
    out.length(210, 0.0).length(220, 0.0).length(230, 1.0);
    out.fine(40, (minor.hypot() / major.hypot()).clamp(1e-6, 1.0));
    // The parameter of the ellipse runs counter-clockwise from its major axis.
    let turns = major.cross(minor).signum();
    let (from, to) = if is_whole(a) {
        (0.0, TAU)
    } else {
        let [start, end] = [a.start, a.start + a.sweep].map(|t| ((t - shift) * turns).rem_euclid(TAU));
        if a.sweep * turns > 0.0 { (start, end) } else { (end, start) }
    };
    out.fine(41, from).fine(42, if to > from { to } else { to + TAU });
}

/// The principal semi-axes of the ellipse c + cos θ·a + sin θ·b, the longer first, and the angle θ of the longer one.
fn axes(a: Vec2, b: Vec2) -> (Vec2, Vec2, f64) {
    // |cos θ·a + sin θ·b|² is largest where tan 2θ = 2a·b / (a² − b²).
    let shift = 0.5 * (2.0 * a.dot(b)).atan2(a.hypot2() - b.hypot2());
    let (sin, cos) = shift.sin_cos();
    (a * cos + b * sin, b * cos - a * sin, shift)
}

/// Bézier curves as one spline: every joint is a triple knot.
fn spline(out: &mut Codes, pen: &Pen<'_>, segs: &[Seg]) {
    /// A planar spline that is neither closed nor rational; closed ones start and end at the same point.
    const FLAGS: i64 = 8;
    const DEGREE: usize = 3;
    let n = segs.len();
    entity(out, pen, "SPLINE", "AcDbSpline").length(210, 0.0).length(220, 0.0).length(230, 1.0);
    out.whole(70, FLAGS).whole(71, DEGREE as i64);
    out.whole(72, (DEGREE * (n + 1) + 2) as i64).whole(73, (DEGREE * n + 1) as i64).whole(74, 0);
    out.fine(42, 1e-10).fine(43, 1e-10);
    for joint in 0..=n {
        let ends = usize::from(joint == 0 || joint == n);
        for _ in 0..DEGREE + ends {
            out.length(40, joint as f64);
        }
    }
    out.point(10, segs[0].start());
    for seg in segs {
        let c = seg.to_cubic();
        out.point(10, c.p1).point(10, c.p2).point(10, c.p3);
    }
}
