//! Divides subpaths into runs, each of which is one entity.

use pathwarp::kurbo::{Point, Vec2};
use pathwarp::outline::EllipticArc;
use pathwarp::{Seg, Subpath};
use std::f64::consts::TAU;

/// Largest turn of a joint in a spline, as the sine of the angle: half a degree. At a corner a new spline starts.
const SMOOTH: f64 = 0.008_73;

/// Share of the tolerance by which an arc may miss a circle and still be written as one.
const OF_TOLERANCE: f64 = 0.1;

/// The kinds of entities that a segment can be part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Lines and circular arcs.
    Straight,
    /// Bézier curves.
    Curve,
    /// An arc of an ellipse.
    Ellipse,
}

/// Segments that are one entity.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Run {
    pub(crate) kind: Kind,
    pub(crate) segs: Vec<Seg>,
    /// The run is a whole closed subpath.
    pub(crate) closed: bool,
}

/// The runs of a subpath. Arcs within the tolerance of circular ones count as such.
pub(crate) fn runs(subpath: &Subpath, tolerance: f64) -> Vec<Run> {
    let segs = merged(subpath);
    let near = OF_TOLERANCE * tolerance;
    let kinds: Vec<Kind> = segs.iter().map(|s| kind(s, near)).collect();
    let n = segs.len();
    let breaks = |i: usize| {
        let before = (i + n - 1) % n;
        let differ = kinds[before] != kinds[i] || kinds[i] == Kind::Ellipse;
        differ || kinds[i] == Kind::Curve && is_corner(&segs[before], &segs[i])
    };
    if n == 0 {
        return Vec::new();
    }
    let starts: Vec<usize> =
        (0..n).filter(|i| !subpath.closed && *i == 0 || (*i > 0 || subpath.closed) && breaks(*i)).collect();
    let Some(&first) = starts.first() else {
        return vec![Run { kind: kinds[0], segs, closed: true }];
    };
    let closed = subpath.closed && n == 1;
    let ends = starts.iter().skip(1).copied().chain([first + n]);
    let run = |(start, end): (&usize, usize)| Run {
        kind: kinds[*start],
        segs: (*start..end).map(|i| segs[i % n]).collect(),
        closed,
    };
    starts.iter().zip(ends).map(run).collect()
}

/// The segments that have a length, with consecutive arcs of one ellipse as one.
pub(crate) fn merged(subpath: &Subpath) -> Vec<Seg> {
    let mut out: Vec<Seg> = Vec::with_capacity(subpath.segs.len());
    for seg in &subpath.segs {
        if matches!(seg, Seg::Line(l) if l.p0 == l.p1) {
            continue;
        }
        match (out.last_mut(), seg) {
            (Some(Seg::Arc(last)), Seg::Arc(next)) if is_continued(last, next) => {
                *last = EllipticArc { p1: next.p1, sweep: last.sweep + next.sweep, ..*last };
            }
            _ => out.push(*seg),
        }
    }
    out
}

/// Returns `true` if an arc goes on along the ellipse of another, up to a full turn.
fn is_continued(last: &EllipticArc, next: &EllipticArc) -> bool {
    /// Rounding, as a share of the size.
    const SLACK: f64 = 1e-9;
    let slack = SLACK * last.major();
    let same = last.center.distance(next.center) <= slack
        && (last.a - next.a).hypot() <= slack
        && (last.b - next.b).hypot() <= slack;
    let turn = (last.start + last.sweep - next.start).rem_euclid(TAU);
    let follows = turn.min(TAU - turn) <= SLACK;
    same && follows && last.sweep * next.sweep > 0.0 && (last.sweep + next.sweep).abs() <= TAU + SLACK
}

fn kind(seg: &Seg, near: f64) -> Kind {
    match seg {
        Seg::Line(_) => Kind::Straight,
        Seg::Quad(_) | Seg::Cubic(_) => Kind::Curve,
        Seg::Arc(arc) if is_circular(arc, near) => Kind::Straight,
        Seg::Arc(_) => Kind::Ellipse,
    }
}

/// Returns `true` if an arc is within `near` of a circular one.
pub(crate) fn is_circular(arc: &EllipticArc, near: f64) -> bool {
    let (a, b) = (arc.a.hypot(), arc.b.hypot());
    let skew = arc.a.dot(arc.b).abs() / a.max(b);
    skew.is_finite() && (a - b).abs() + skew <= near.max(1e-9 * a)
}

/// Returns `true` if an arc is a whole ellipse.
pub(crate) fn is_whole(arc: &EllipticArc) -> bool {
    (arc.sweep.abs() - TAU).abs() < 1e-9
}

fn is_corner(before: &Seg, after: &Seg) -> bool {
    let (u, v) = (tangent(before, 1.0), tangent(after, 0.0));
    let both = u.hypot() * v.hypot();
    both > 0.0 && (u.dot(v) < 0.0 || u.cross(v).abs() > SMOOTH * both)
}

/// The direction at an end; of a curve with a handle of no length, that to the next point.
fn tangent(seg: &Seg, end: f64) -> Vec2 {
    let c = seg.to_cubic();
    let (from, others): (Point, [Point; 3]) =
        if end == 0.0 { (c.p0, [c.p1, c.p2, c.p3]) } else { (c.p3, [c.p2, c.p1, c.p0]) };
    let away = others.into_iter().map(|p| p - from).find(|v| v.hypot() > 0.0).unwrap_or(Vec2::ZERO);
    if end == 0.0 { away } else { -away }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::Outline;

    fn kinds(d: &str) -> Vec<(Kind, usize, bool)> {
        let outline = Outline::from_svg(d).unwrap();
        runs(&outline.subpaths[0], 0.01).into_iter().map(|r| (r.kind, r.segs.len(), r.closed)).collect()
    }

    #[test]
    fn contours_of_lines_and_arcs_are_one_run() {
        assert_eq!(kinds("M0,0 H50 V20 A10,10 0 0 1 40,30 H0 Z"), [(Kind::Straight, 5, true)]);
        assert_eq!(kinds("M0,0 H50 V20"), [(Kind::Straight, 2, false)]);
    }

    #[test]
    fn a_circle_in_quarters_is_one_arc() {
        let d = "M10,0 A10,10 0 0 1 0,10 A10,10 0 0 1 -10,0 A10,10 0 0 1 0,-10 A10,10 0 0 1 10,0 Z";
        assert_eq!(kinds(d), [(Kind::Straight, 1, true)]);
    }

    #[test]
    fn kinds_and_corners_divide() {
        // The run of lines goes on over the start of the subpath.
        assert_eq!(kinds("M0,0 H50 C60,0 60,20 50,20 H0 Z"), [(Kind::Curve, 1, false), (Kind::Straight, 3, false)]);
        assert_eq!(kinds("M0,0 C10,0 20,10 20,20 C20,30 30,40 40,40 C40,50 0,50 0,0 Z").len(), 2);
        assert_eq!(kinds("M0,0 A20,10 0 0 1 40,0 A20,10 0 0 0 80,0"), [(Kind::Ellipse, 1, false); 2]);
    }
}
