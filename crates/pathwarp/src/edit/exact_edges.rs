//! Exact edges of an offset: lines beside lines, and arcs beside arcs and around corners, which a fit only approximates.
//!
//! An edge replaces the pieces of a fitted contour that follow it. Neighbouring edges meet where they cross or touch.

use crate::outline::{EllipticArc, Outline, Seg, Subpath};
use kurbo::{Line, ParamCurve as _, ParamCurveArclen as _, PathSeg, Point, Vec2};
use std::f64::consts::TAU;

/// Limit on comparisons of pieces with edges.
const MAX_COMPARISONS: usize = 2_000_000;
/// Parameters at which a piece is compared with an edge.
const SAMPLES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// Distance at which edges touch, as a fraction of a radius or length, and the sine of an angle at which directions agree.
const TOUCH: f64 = 1e-6;

/// An exact edge at a distance from the source.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Edge {
    /// An edge beside a line of the same length.
    Line(Line),
    /// An edge beside an arc or around a corner, from an angle over a positive sweep.
    Arc { center: Point, radius: f64, start: f64, sweep: f64 },
}

impl Edge {
    /// Returns the largest distance of a piece from the edge; `None` if it exceeds the tolerance or the piece does not run along the edge.
    /// Lines extend by `reach` at both ends.
    fn distance(&self, piece: &PathSeg, tolerance: f64, reach: f64) -> Option<f64> {
        let distances = SAMPLES.map(|t| {
            let p = piece.eval(t);
            match *self {
                Self::Line(l) => {
                    let along = (l.p1 - l.p0).normalize();
                    let position = (p - l.p0).dot(along);
                    let is_beside = position >= -reach && position <= l.p0.distance(l.p1) + reach;
                    is_beside.then(|| along.cross(p - l.p0).abs())
                }
                Self::Arc { center, radius, start, sweep } => {
                    // A curve tangent to an arc leaves it slowly.
                    let slack = (2.0 * tolerance / radius).sqrt();
                    let turn = ((p - center).angle() - start + slack).rem_euclid(TAU);
                    (turn <= sweep + 2.0 * slack).then(|| (p.distance(center) - radius).abs())
                }
            }
        });
        let largest = distances.into_iter().try_fold(0.0, |largest: f64, d| Some(largest.max(d?)))?;
        (largest <= tolerance).then_some(largest)
    }

    /// Returns the nearest point of the line or circle.
    fn foot(&self, p: Point) -> Point {
        match *self {
            Self::Line(l) => {
                let along = (l.p1 - l.p0).normalize();
                l.p0 + along * along.dot(p - l.p0)
            }
            Self::Arc { center, radius, .. } => center + (p - center).normalize() * radius,
        }
    }

    /// Returns the point near `p` at which the lines or circles meet.
    fn meeting(&self, other: &Self, p: Point) -> Option<Point> {
        match (*self, *other) {
            (Self::Line(a), Self::Line(b)) => a.crossing_point(b),
            (line @ Self::Line(l), Self::Arc { center, radius, .. })
            | (Self::Arc { center, radius, .. }, line @ Self::Line(l)) => {
                let foot = line.foot(center);
                let along = (l.p1 - l.p0).normalize();
                let side = if along.dot(p - foot) < 0.0 { -1.0 } else { 1.0 };
                half_chord(foot.distance(center), radius).map(|h| foot + along * (side * h))
            }
            (Self::Arc { center: c, radius: r, .. }, Self::Arc { center: d, radius: s, .. }) => {
                let between = d - c;
                let distance = between.hypot();
                if distance <= TOUCH * r {
                    return None;
                }
                // The distance from the first center to the line through both intersections.
                let to_chord = (distance * distance + r * r - s * s) / (2.0 * distance);
                let (foot, across) = (c + between * (to_chord / distance), between.turn_90() / distance);
                let side = if across.dot(p - foot) < 0.0 { -1.0 } else { 1.0 };
                half_chord(to_chord.abs(), r).map(|h| foot + across * (side * h))
            }
        }
    }
}

/// Returns half the chord of a circle at a distance from its center: 0 for a tangent, `None` outside the circle.
fn half_chord(distance: f64, radius: f64) -> Option<f64> {
    let height = radius - distance;
    if height.abs() <= TOUCH * radius {
        return Some(0.0);
    }
    (height > 0.0).then(|| (height * (radius + distance)).sqrt())
}

/// Returns the edges at a distance from the closed subpaths of a source, on both sides, and around its corners if these are round.
fn edges(source: &Outline, by: f64, has_round_corners: bool) -> Vec<Edge> {
    let mut out = Vec::new();
    for subpath in source.subpaths.iter().filter(|s| s.closed) {
        let mut segs: Vec<Seg> = Vec::with_capacity(subpath.segs.len());
        for seg in &subpath.segs {
            match segs.last_mut().and_then(|last| Some((joined(last, seg)?, last))) {
                Some((longer, last)) => *last = longer,
                None => segs.push(*seg),
            }
        }
        if let [first, .., last] = segs.as_slice()
            && let Some(longer) = joined(last, first)
        {
            segs[0] = longer;
            segs.pop();
        }
        for seg in &segs {
            match *seg {
                Seg::Line(l) => {
                    let across = (l.p1 - l.p0).normalize().turn_90();
                    let shifts = [1.0, -1.0].map(|side| across * (side * by));
                    out.extend(shifts.map(|shift| Edge::Line(Line::new(l.p0 + shift, l.p1 + shift))));
                }
                Seg::Arc(a) if a.is_circular() => {
                    let turn = a.sweep * a.a.cross(a.b);
                    let start = (if turn > 0.0 { a.p0 } else { a.p1 } - a.center).angle();
                    let (center, r, sweep) = (a.center, a.a.hypot(), a.sweep.abs());
                    let radii = [r + by, r - by].into_iter().filter(|radius| *radius > TOUCH * r);
                    out.extend(radii.map(|radius| Edge::Arc { center, radius, start, sweep }));
                }
                _ => {}
            }
            if has_round_corners {
                out.push(Edge::Arc { center: seg.start(), radius: by, start: 0.0, sweep: TAU });
            }
        }
    }
    out
}

/// Joins two successive segments that lie on one line or circle.
fn joined(a: &Seg, b: &Seg) -> Option<Seg> {
    match (a, b) {
        (Seg::Line(k), Seg::Line(l)) => {
            let (u, v) = (k.p1 - k.p0, l.p1 - l.p0);
            let continues = u.cross(v).abs() <= TOUCH * u.hypot() * v.hypot() && u.dot(v) > 0.0;
            continues.then(|| Seg::Line(Line::new(k.p0, l.p1)))
        }
        (Seg::Arc(k), Seg::Arc(l)) => {
            let is_same_circle = (k.a, k.b) == (l.a, l.b) && k.center.distance(l.center) <= TOUCH * k.a.hypot();
            let continues = is_same_circle && k.is_circular() && l.is_circular() && k.sweep * l.sweep > 0.0;
            let sweep = (k.sweep + l.sweep).clamp(-TAU, TAU);
            continues.then_some(Seg::Arc(EllipticArc { p1: l.p1, sweep, ..*k }))
        }
        _ => None,
    }
}

/// A part of a contour: a fitted piece, or several that one edge replaces.
#[derive(Debug, Clone)]
struct Run {
    /// The fitted piece; for several, a line from their first to their last point.
    piece: PathSeg,
    /// The edge that replaces the pieces, if any does.
    edge: Option<Edge>,
    /// The middle of the first piece.
    middle: Point,
    /// The angle that all replaced pieces sweep around the edge's center.
    sweep: f64,
}

/// Returns the outline with exact edges instead of fitted pieces within `tolerance` of them. Edges lie at the distance `by` beside lines
/// and circular arcs of the source. Lines extend by `miters` at both ends; without miters, corners are round and have edges around them.
pub(super) fn insert(outline: Outline, source: &Outline, by: f64, miters: Option<f64>, tolerance: f64) -> Outline {
    let edges = edges(source, by, miters.is_none());
    if edges.len().saturating_mul(outline.segs().count()) > MAX_COMPARISONS {
        return outline;
    }
    // An arc around a corner leaves its tangent slowly: this far along a line, it is still within the tolerance.
    let reach = miters.unwrap_or_else(|| (2.0 * by * tolerance).sqrt());
    let starts: Vec<Point> = source.subpaths.iter().map(|s| s.start).collect();
    let subpaths = outline.subpaths.into_iter().map(|s| {
        let exact = s.closed.then(|| exact_contour(&s, (&edges, &starts), reach, tolerance)).flatten();
        exact.unwrap_or(s)
    });
    Outline { subpaths: subpaths.collect() }
}

/// Returns a closed contour with edges instead of the pieces that follow them. `None` if edges do not meet near the contour's nodes.
/// `starts` are the first points of the source's subpaths.
fn exact_contour(
    subpath: &Subpath,
    (edges, starts): (&[Edge], &[Point]),
    reach: f64,
    tolerance: f64,
) -> Option<Subpath> {
    let mut runs: Vec<Run> = subpath.segs.iter().map(|s| Run::new(s, edges, reach, tolerance)).collect();
    // Fitting leaves short bits between two edges.
    let is_bit = |i: usize| {
        let [before, after] = [i + runs.len() - 1, i + 1].map(|k| &runs[k % runs.len()]);
        runs[i].edge.is_none()
            && before.edge.is_some()
            && after.edge.is_some()
            && runs[i].piece.arclen(0.1 * tolerance) <= 2.0 * tolerance
    };
    let kept: Vec<bool> = (0..runs.len()).map(|i| !is_bit(i)).collect();
    let mut kept = kept.into_iter();
    runs.retain(|_| kept.next() == Some(true));
    let mut joined: Vec<Run> = Vec::with_capacity(runs.len());
    for run in runs {
        match joined.last_mut().filter(|last| last.continues_in(&run)) {
            Some(last) => {
                last.sweep += run.sweep;
                last.piece = PathSeg::Line(Line::new(last.piece.start(), run.piece.end()));
            }
            None => joined.push(run),
        }
    }
    if let [only] = joined.as_slice() {
        return whole_circle(only, starts);
    }
    if let [first, .., last] = joined.as_slice()
        && last.continues_in(first)
    {
        // The contour begins inside an edge.
        let last = joined.pop()?;
        joined[0].sweep += last.sweep;
        joined[0].piece = PathSeg::Line(Line::new(last.piece.start(), joined[0].piece.end()));
    }
    if joined.iter().all(|r| r.edge.is_none()) {
        return None;
    }
    let count = joined.len();
    let node = |i: usize| {
        let (before, after) = (&joined[(i + count - 1) % count], &joined[i]);
        let p = before.piece.end().midpoint(after.piece.start());
        match (before.edge, after.edge) {
            (Some(a), Some(b)) => a.meeting(&b, p),
            (Some(a), None) | (None, Some(a)) => Some(a.foot(p)),
            (None, None) => Some(p),
        }
    };
    let nodes = (0..count).map(node).collect::<Option<Vec<Point>>>()?;
    let segs = joined.iter().enumerate().map(|(i, r)| r.between(nodes[i], nodes[(i + 1) % count], tolerance));
    Some(Subpath { start: nodes[0], segs: segs.collect::<Option<_>>()?, closed: true })
}

/// Returns a contour that is a whole circle. It begins in the direction of the point of `starts` nearest to its first point, if near.
fn whole_circle(run: &Run, starts: &[Point]) -> Option<Subpath> {
    /// Largest difference, in radians, of directions that count as the same.
    const NEAR: f64 = 0.1;
    let Some(Edge::Arc { center, radius, .. }) = run.edge else { return None };
    let is_whole = (run.sweep.abs() - TAU).abs() < 1.0;
    let first = run.piece.start() - center;
    let turn = |v: Vec2| turn(first, v).abs();
    let near = starts.iter().map(|p| *p - center).filter(|v| turn(*v) < NEAR);
    let start = near.min_by(|a, b| turn(*a).total_cmp(&turn(*b))).unwrap_or(first).angle();
    let (a, b) = (Vec2::new(radius, 0.0), Vec2::new(0.0, radius));
    let arc = EllipticArc::new(center, a, b, start, TAU.copysign(run.sweep));
    is_whole.then(|| Subpath { start: arc.p0, segs: vec![Seg::Arc(arc)], closed: true })
}

/// The signed angle from one vector to another.
fn turn(from: Vec2, to: Vec2) -> f64 {
    from.cross(to).atan2(from.dot(to))
}

impl Run {
    /// Returns a piece with the edge that it follows most closely, if any.
    fn new(seg: &Seg, edges: &[Edge], reach: f64, tolerance: f64) -> Self {
        let piece = match *seg {
            Seg::Line(l) => PathSeg::Line(l),
            ref other => PathSeg::Cubic(other.to_cubic()),
        };
        let near = edges.iter().filter_map(|e| Some((e.distance(&piece, tolerance, reach)?, *e)));
        let edge = near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, edge)| edge);
        let sweep = match edge {
            Some(Edge::Arc { center, .. }) => {
                SAMPLES.windows(2).map(|t| turn(piece.eval(t[0]) - center, piece.eval(t[1]) - center)).sum()
            }
            _ => 0.0,
        };
        Self { piece, edge, middle: piece.eval(0.5), sweep }
    }

    /// Returns `true` if both runs follow the same line or circle in the same direction.
    fn continues_in(&self, next: &Self) -> bool {
        match (self.edge, next.edge) {
            (Some(Edge::Line(k)), Some(Edge::Line(l))) => {
                let (u, v) = (k.p1 - k.p0, l.p1 - l.p0);
                let slack = TOUCH * u.hypot();
                u.cross(v).abs() <= slack * v.hypot() && u.cross(l.p0 - k.p0).abs() <= slack * u.hypot()
            }
            (Some(Edge::Arc { center: c, radius: r, .. }), Some(Edge::Arc { center: d, radius: s, .. })) => {
                c.distance(d) + (r - s).abs() <= TOUCH * r && self.sweep * next.sweep > 0.0
            }
            _ => false,
        }
    }

    /// Returns the segment of the run between two nodes. `None` if it runs backwards, or strays from the pieces that it replaces.
    fn between(&self, p0: Point, p1: Point, tolerance: f64) -> Option<Seg> {
        let chord = self.piece.end() - self.piece.start();
        match self.edge {
            Some(Edge::Line(_)) => (chord.dot(p1 - p0) > 0.0).then(|| Seg::Line(Line::new(p0, p1))),
            Some(Edge::Arc { center, radius, .. }) => {
                let from = (p0 - center).angle();
                let turn = ((p1 - center).angle() - from).rem_euclid(TAU);
                let sweep = if self.sweep > 0.0 { turn } else { turn - TAU };
                let (a, b) = (Vec2::new(radius, 0.0), Vec2::new(0.0, radius));
                let arc = EllipticArc::new(center, a, b, from, sweep);
                // The middle must lie on the arc, not opposite.
                let position = ((self.middle - center).angle() - from) * sweep.signum();
                let is_on_arc = position.rem_euclid(TAU) <= sweep.abs();
                (is_on_arc && (sweep - self.sweep).abs() < 1.0).then_some(Seg::Arc(EllipticArc { p0, p1, ..arc }))
            }
            None => {
                let [shift0, shift1] = [p0 - self.piece.start(), p1 - self.piece.end()];
                let is_near = shift0.hypot() <= tolerance && shift1.hypot() <= tolerance;
                is_near.then(|| match self.piece {
                    PathSeg::Line(_) => Seg::Line(Line::new(p0, p1)),
                    other => {
                        let mut c = other.to_cubic();
                        (c.p0, c.p1, c.p2, c.p3) = (p0, c.p1 + shift0, c.p2 + shift1, p1);
                        Seg::Cubic(c)
                    }
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit::{Offset, OpenPaths, Side, moved};
    use crate::refit::Options;
    use kurbo::{Join, Rect};

    fn grown(path: &str, by: f64, join: Join) -> Outline {
        let side = if by > 0.0 { Side::Outside } else { Side::Inside };
        let offset = Offset { by: by.abs(), join, side, even_odd: false, open: OpenPaths::Move };
        moved(&Outline::from_svg(path).unwrap(), &offset, &Options::new(0.05), &[]).unwrap().outline
    }

    /// Offsets of rectangles with rounded corners are such rectangles, with sharp corners where arcs collapse.
    #[test]
    fn lines_and_arcs_stay_exact() {
        let path = "M20,10H80A10,10 0 0 1 90,20V60A10,10 0 0 1 80,70H20A10,10 0 0 1 10,60V20A10,10 0 0 1 20,10Z";
        for (by, join) in
            [(3.0, Join::Round), (-4.0, Join::Round), (-10.0, Join::Round), (-10.0, Join::Miter), (-17.5, Join::Round)]
        {
            let out = grown(path, by, join);
            let [subpath] = out.subpaths.as_slice() else { panic!("{by}: {out:?}") };
            let (radius, count) = (10.0 + by, if by > -10.0 { 8 } else { 4 });
            assert_eq!(subpath.segs.len(), count, "{by}: {subpath:?}");
            for seg in &subpath.segs {
                match seg {
                    Seg::Arc(a) => assert!((a.a.hypot() - radius).abs() < 1e-9, "{by}: {a:?}"),
                    Seg::Line(l) => assert!((l.p1 - l.p0).x.abs().min((l.p1 - l.p0).y.abs()) < 1e-9, "{by}: {l:?}"),
                    other => panic!("{by}: {other:?}"),
                }
            }
            let bounds = Outline::from(&out.to_bez_path(1e-9)).bounding_box().unwrap();
            let wanted = Rect::new(10.0, 10.0, 90.0, 70.0).inflate(by, by);
            assert!((bounds.x0 - wanted.x0).abs() + (bounds.y1 - wanted.y1).abs() < 1e-6, "{by}: {bounds:?}");
        }
    }

    /// Mirroring reverses the axes of arcs.
    #[test]
    fn mirrored_arcs_stay_arcs() {
        let path = "M60,20H80A8,8 0 0 1 80,36H60A8,8 0 0 1 60,20Z";
        let mirrored = Outline::from_svg(path).unwrap().transformed(kurbo::Affine::FLIP_Y);
        let offset = Offset { by: 0.2, join: Join::Miter, side: Side::Outside, even_odd: false, open: OpenPaths::Move };
        let out = moved(&mirrored, &offset, &Options::new(0.02), &[]).unwrap().outline;
        let arcs = out.segs().filter(|s| matches!(s, Seg::Arc(a) if (a.a.hypot() - 8.2).abs() < 1e-9));
        assert_eq!((arcs.count(), out.segs().count()), (2, 4), "{out:?}");
    }

    /// A hexagon grows by arcs around its corners, or by miters.
    #[test]
    fn corners_are_arcs_or_miters() {
        let path =
            "M60,0 L30,51.9615242270663 L-30,51.9615242270663 L-60,0 L-30,-51.9615242270663 L30,-51.9615242270663 Z";
        let round = grown(path, 7.0, Join::Round);
        let kinds = round.segs().filter(|s| matches!(s, Seg::Arc(a) if (a.a.hypot() - 7.0).abs() < 1e-9)).count();
        assert_eq!((kinds, round.segs().count()), (6, 12), "{round:?}");
        let sharp = grown(path, 7.0, Join::Miter);
        let tips = sharp.subpaths[0].anchors();
        let reach = 60.0 + 7.0 / (std::f64::consts::PI / 3.0).sin();
        assert!(tips.len() == 6 && tips.iter().all(|p| (p.to_vec2().hypot() - reach).abs() < 1e-9), "{tips:?}");
    }

    #[test]
    fn circles_stay_circles_where_they_begin() {
        for start in [0.0_f64, 0.7, 2.0, 4.4] {
            for (r, by) in [(30.0, 3.0), (30.0, -3.0), (5.0, 40.0), (300.0, -299.0)] {
                let at = |angle: f64| Point::new(7.0 + r * angle.cos(), -3.0 + r * angle.sin());
                let [p, q] = [at(start), at(start + 2.5)];
                let path = format!("M{},{}A{r},{r} 0 0 1 {},{}A{r},{r} 0 1 1 {},{}Z", p.x, p.y, q.x, q.y, p.x, p.y);
                let out = grown(&path, by, Join::Round);
                let [Seg::Arc(arc)] = out.subpaths[0].segs[..] else { panic!("{start} {r} {by}: {out:?}") };
                assert!(arc.center.distance(Point::new(7.0, -3.0)) < 1e-9 && (arc.a.hypot() - r - by).abs() < 1e-9);
                let (from, wanted) = ((arc.p0 - arc.center).normalize(), (p - arc.center).normalize());
                assert!((from - wanted).hypot() < 1e-9, "{start} {r} {by}: starts at {:?}", arc.p0);
            }
        }
    }
}
