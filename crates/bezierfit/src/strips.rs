//! Strips between an outline and the curve at a distance from it. Where outlines are rough, most of that curve is nearer to another
//! part of them. Strips follow only the remaining parts, so that few edges cross.

use crate::source::Source;
use crate::stroke::{Edge, EdgeCurve, Kept};
use kurbo::{BezPath, ParamCurve, ParamCurveArclen, Point, Vec2};
use std::cell::Cell;
use std::collections::HashMap;

/// Number of cells along the distance. More make the search for near points finer, and slower.
const CELLS: f64 = 6.0;
/// Longest step between the points that stand for the source, and between the points of a strip's way back, as a share of the distance.
const STEP: f64 = 0.25;
/// Shortest part of an edge that is divided, as a share of the distance.
const FINEST: f64 = 1e-3;

/// Points of outlines, by cell.
pub(crate) struct Neighbors {
    cell: f64,
    points: HashMap<[i64; 2], Vec<Point>>,
    /// Offsets to the cells that a circle of the distance touches, the nearest first, with the distances between the cells.
    cell_offsets: Vec<([i64; 2], f64)>,
    /// The last point found near, which is often near to the next one, too.
    last_near: Cell<Point>,
}

impl Neighbors {
    pub(crate) fn new(outlines: &BezPath, distance: f64) -> Self {
        let distance = distance.abs();
        let cell = distance / CELLS;
        let mut points: HashMap<[i64; 2], Vec<Point>> = HashMap::new();
        for s in outlines.segments() {
            let steps = (s.arclen(STEP * distance) / (STEP * distance)).ceil().max(1.0);
            for i in 0..steps as usize {
                let p = s.eval(i as f64 / steps);
                points.entry(cell_of(p, cell)).or_default().push(p);
            }
        }
        let furthest = CELLS.ceil() as i64 + 1;
        let cells = (-furthest..=furthest).flat_map(|x| (-furthest..=furthest).map(move |y| [x, y]));
        let gap = |c: [i64; 2]| {
            let [x, y] = c.map(|v| (v.abs() - 1).max(0) as f64 * cell);
            (c, x.hypot(y))
        };
        let mut cell_offsets: Vec<_> = cells.map(gap).filter(|(_, gap)| *gap < distance).collect();
        cell_offsets.sort_by_key(|(c, _)| (c[0] * c[0] + c[1] * c[1], *c));
        Self { cell, points, cell_offsets, last_near: Cell::new(Point::new(f64::NAN, f64::NAN)) }
    }

    /// Returns `true` if a point of the outlines is known to be nearer than `radius`, which is at most the distance.
    fn is_near(&self, p: Point, radius: f64) -> bool {
        if radius <= 0.0 {
            return false;
        }
        let is_within = |q: &&Point| q.distance_squared(p) < radius * radius;
        if is_within(&&self.last_near.get()) {
            return true;
        }
        let [x, y] = cell_of(p, self.cell);
        let cells = self.cell_offsets.iter().filter(|(_, gap)| *gap < radius);
        let mut near = cells.filter_map(|([i, j], _)| self.points.get(&[x + i, y + j])?.iter().find(is_within));
        near.next().inspect(|q| self.last_near.set(**q)).is_some()
    }
}

/// Indices of the square cell that contains a point.
pub(crate) fn cell_of(p: Point, cell: f64) -> [i64; 2] {
    #[expect(clippy::cast_possible_truncation, reason = "saturates, far from all drawings")]
    [p.x, p.y].map(|v| (v / cell).floor() as i64)
}

/// Closed contours, each along parts of the edges at `distance` that are not known to be nearer to the outlines by more than
/// `slack`, and back along the outline.
pub(crate) fn strips(edges: &[Kept], distance: f64, slack: f64, neighbors: &Neighbors) -> Vec<Vec<Edge>> {
    let radius = distance.abs();
    let step = STEP * radius;
    let least = (0.5 * slack).max(FINEST * radius);
    let remaining_parts = |edge: &Edge, slack: f64| {
        let mut out = Vec::new();
        let is_near = |p, half| neighbors.is_near(p, radius - slack - half);
        append_remaining(edge, [0.0, 1.0], &is_near, least, &mut out);
        out
    };
    // Consecutive parts are one strip where the line between them is near the outlines.
    let follows = |a: &Strip, b: &Strip| {
        let (from, to) = (a.end(), b.edges[0].p0);
        let is_short = from.distance(to) <= step && a.feet[a.feet.len() - 1].distance(b.feet[0]) <= step;
        from == to || (is_short && remaining_parts(&Edge::line(from, to), 0.0).is_empty())
    };
    let mut out: Vec<Strip> = Vec::new();
    for kept in edges {
        // Each edge is used from end to end, also beyond the crossings between which it is kept: strips overlap there. Links and edges that
        // run backwards are all nearer to the outline than the distance.
        let is_backwards = matches!(kept.edge.curve, EdgeCurve::Side(s) if s.speed(0.5) < 0.0);
        if kept.is_link || is_backwards {
            continue;
        }
        for [t0, t1] in remaining_parts(&kept.edge, slack) {
            let part = kept.edge.part(t0, t1);
            let steps = (length(&part, [0.0, 1.0]) / step).ceil().max(1.0);
            let feet = (0..=steps as usize).map(|i| foot(&kept.edge, t0 + (t1 - t0) * (i as f64 / steps), distance));
            let next = Strip { edges: vec![part], feet: feet.collect() };
            match out.last_mut() {
                Some(last) if follows(last, &next) => last.append(next),
                _ => out.push(next),
            }
        }
    }
    // Around a closed outline, the last strip may continue in the first one.
    if let [first, .., last] = &out[..]
        && follows(last, first)
    {
        let first = out.swap_remove(0);
        out[0].append(first);
    }
    match &out[..] {
        [ring] if follows(ring, ring) => ring.rings(step),
        _ => out.iter().map(|s| s.contour(step)).collect(),
    }
}

/// Consecutive parts of edges, and the points of the outline beside them.
struct Strip {
    edges: Vec<Edge>,
    feet: Vec<Point>,
}

impl Strip {
    fn end(&self) -> Point {
        self.edges[self.edges.len() - 1].p1
    }

    /// Appends another strip, with a line across a gap.
    fn append(&mut self, next: Self) {
        let (from, to) = (self.end(), next.edges[0].p0);
        if from != to {
            self.edges.push(Edge::line(from, to));
        }
        self.edges.extend(next.edges);
        self.feet.extend(next.feet);
    }

    /// The points of the outline, backwards, in steps of more than `step`.
    fn back(&self, step: f64) -> Vec<Point> {
        let mut out: Vec<Point> = Vec::new();
        for p in self.feet.iter().rev() {
            if out.last().is_none_or(|last| last.distance(*p) > step) {
                out.push(*p);
            }
        }
        out
    }

    /// The contour of the strip: along the edges, and back along the outline.
    fn contour(&self, step: f64) -> Vec<Edge> {
        let mut out = self.edges.clone();
        add_lines(&mut out, self.back(step).into_iter().chain([self.feet[0], self.edges[0].p0]));
        out
    }

    /// The two contours of a closed strip: all round along the edges, and all round along the outline.
    fn rings(&self, step: f64) -> Vec<Vec<Edge>> {
        let mut outer = self.edges.clone();
        add_lines(&mut outer, [self.edges[0].p0]);
        let back = self.back(step);
        let mut inner = Vec::new();
        if let [from, to, ..] = back[..] {
            inner.push(Edge::line(from, to));
            add_lines(&mut inner, back[2..].iter().copied().chain([from]));
        }
        vec![outer, inner]
    }
}

/// Appends lines from the last edge to one point after the other.
fn add_lines(edges: &mut Vec<Edge>, points: impl IntoIterator<Item = Point>) {
    for p in points {
        let from = edges[edges.len() - 1].p1;
        if p != from {
            edges.push(Edge::line(from, p));
        }
    }
}

/// Appends the parts of an edge that are not known to be near. `is_near` takes the middle of a part and half of its length. Parts are
/// halved until their halves are no longer than `least`.
fn append_remaining(
    edge: &Edge,
    [t0, t1]: [f64; 2],
    is_near: &dyn Fn(Point, f64) -> bool,
    least: f64,
    out: &mut Vec<[f64; 2]>,
) {
    let half = 0.5 * length(edge, [t0, t1]);
    let middle = 0.5 * (t0 + t1);
    if is_near(edge.eval(middle).0, half) {
        return;
    }
    if half > least {
        append_remaining(edge, [t0, middle], is_near, least, out);
        append_remaining(edge, [middle, t1], is_near, least, out);
    } else if let Some(last) = out.last_mut().filter(|last| last[1] == t0) {
        last[1] = t1;
    } else {
        out.push([t0, t1]);
    }
}

/// The point of the outline beside a point of an edge.
fn foot(edge: &Edge, t: f64, distance: f64) -> Point {
    match edge.curve {
        EdgeCurve::Line => {
            let along = (edge.p1 - edge.p0).normalize();
            edge.p0.lerp(edge.p1, t) - Vec2::new(-along.y, along.x) * distance
        }
        EdgeCurve::Arc(a) => a.center,
        EdgeCurve::Side(s) => s.segment().eval(t),
    }
}

/// Approximate length of a part of an edge, by the largest of a few speeds.
fn length(edge: &Edge, [t0, t1]: [f64; 2]) -> f64 {
    // Lines and arcs have one speed.
    let last = if matches!(edge.curve, EdgeCurve::Side(_)) { 8 } else { 0 };
    let speeds = (0..=last).map(|i| edge.eval(t0 + (t1 - t0) * f64::from(i) / 8.0).1.hypot());
    speeds.fold(0.0, f64::max) * (t1 - t0)
}
