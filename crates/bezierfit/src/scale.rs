//! Simplifies paths at the scale of the tolerance: keeps corners that are seen from a tolerance away, and puts smooth curves in place of
//! stairs of pixels, noise, and facets between them.
//!
//! 1. **Polygon.** The path is reduced to vertices of a polygon near the tolerance (D. H. Douglas, T. K. Peucker, *Algorithms for the
//!    reduction of the number of points required to represent a digitized line or its caricature*, 1973).
//! 2. **Corners.** Between two sides of length s that turn by θ, the nearest circle is s/4·tan(θ/4) off. Where that exceeds the tolerance,
//!    no smooth curve replaces the corner.
//! 3. **Guide.** Between corners, a spline of cubics with continuous derivative is fitted to the path by least squares, with as many knots
//!    as it takes to stay well within the tolerance.
//!
//! The fewest pieces of the guide are searched for afterwards, within the rest of the tolerance.

use crate::guide::{End, Ends, Guide, Samples, off};
use crate::limits::{LONG_EDGE, SMOOTH_JOINT};
use crate::merge::ReachMemory;
use crate::options::Options;
use crate::path::{Segment, smooth_run};
use crate::report::Report;
use kurbo::{Line, ParamCurve, PathSeg, Point, Vec2};

/// Share of the tolerance that flattening uses.
const FLAT: f64 = 1.0 / 64.0;
/// Largest distance of the path from the polygon, in tolerances: swings of a tolerance to either side of a smooth curve mostly vanish.
const POLYGON: f64 = 1.4;
/// Least distance of a corner from the nearest circle, in tolerances.
const CORNER: f64 = 1.0;
/// Largest distance of a guide from the path, in tolerances.
const LOOSEST: f64 = 0.95;
/// Least length of an interval between knots, in tolerances.
const FINEST: f64 = 0.5;
/// Most times that a part which no guide follows is divided.
const DIVISIONS: usize = 3;
/// Least number of samples of each side of the polygon.
const SAMPLES: f64 = 16.0;
/// Turn of the sides, in radians, that one interval between knots covers at first, and the turn up to which one interval covers all sides:
/// a little over a quarter turn.
const FIRST_TURN: f64 = 1.0;
const ONE_TURN: f64 = 1.7;

/// A flattened subpath.
struct Flat {
    points: Vec<Point>,
    /// Segment and parameter of each point; the parameter is zero at nodes.
    at: Vec<(usize, f64)>,
}

impl Flat {
    fn new(segments: &[Segment], closed: bool, tolerance: f64) -> Self {
        let mut out = Self { points: Vec::with_capacity(segments.len() + 1), at: Vec::new() };
        for (i, s) in segments.iter().enumerate() {
            let seg = s.segment();
            out.add(seg.start(), (i, 0.0));
            if matches!(seg, PathSeg::Line(_)) {
                continue;
            }
            let c = seg.to_cubic();
            let (d0, d1, d2) = (c.p1 - c.p0, c.p2 - c.p1, c.p3 - c.p2);
            let bend = (d1 - d0).hypot().max((d2 - d1).hypot());
            let n = (6.0 * bend / (8.0 * FLAT * tolerance)).sqrt().ceil().clamp(1.0, 4096.0) as usize;
            for t in (1..n).map(|k| k as f64 / n as f64) {
                out.add(c.eval(t), (i, t));
            }
        }
        if let Some(last) = segments.last() {
            let end = last.segment().end();
            if !(closed && end == out.points[0]) {
                out.add(end, (segments.len(), 0.0));
            }
        }
        out
    }

    fn add(&mut self, p: Point, at: (usize, f64)) {
        if self.points.last() == Some(&p) {
            if at.1 == 0.0 {
                self.at.pop();
                self.at.push(at);
            }
            return;
        }
        self.points.push(p);
        self.at.push(at);
    }

    /// Index of the segment that begins at a point, if the point is a node.
    fn node(&self, i: usize) -> Option<usize> {
        let (segment, t) = self.at[i % self.at.len()];
        (t == 0.0).then_some(segment)
    }
}

/// Marks further vertices between two, so that the polygon is within the distance `within` of the points.
fn reduce(points: &[Point], [first, last]: [usize; 2], within: f64, kept: &mut [bool]) {
    // Limits the work where the furthest point divides off little each time.
    let mut work = 40 * (last - first + 1);
    let n = points.len();
    let mut stack = vec![[first, last]];
    while let Some([i, j]) = stack.pop() {
        if j < i + 2 {
            continue;
        }
        let ends = [points[i % n], points[j % n]];
        let (mut most, mut at) = (within * within, None);
        for k in i + 1..j {
            let d = off(points[k % n], ends);
            if d > most {
                (most, at) = (d, Some(k));
            }
        }
        let Some(mut k) = at else { continue };
        work = work.saturating_sub(j - i);
        if work == 0 {
            k = i.midpoint(j);
        }
        kept[k % n] = true;
        stack.push([k, j]);
        stack.push([i, k]);
    }
}

/// Vertices of the polygon within a distance, in ascending order. If closed, the first is repeated, counted a round further.
fn vertices(points: &[Point], closed: bool, mut kept: Vec<bool>, within: f64) -> Vec<usize> {
    let n = points.len();
    let given: Vec<usize> = (0..n).filter(|i| kept[*i]).collect();
    let mut anchors = given.clone();
    if !closed {
        anchors.extend([0, n - 1]);
    } else if given.len() < 2 {
        let furthest = |i: usize| {
            let from = |j: &usize| points[i].distance_squared(points[*j]);
            (0..n).max_by(|a, b| from(a).total_cmp(&from(b))).unwrap_or(0)
        };
        let first = given.first().copied().unwrap_or_else(|| furthest(0));
        anchors = vec![first, furthest(first)];
    }
    anchors.sort_unstable();
    anchors.dedup();
    if closed {
        anchors.push(anchors[0] + n);
    }
    for pair in anchors.windows(2) {
        (kept[pair[0] % n], kept[pair[1] % n]) = (true, true);
        reduce(points, [pair[0], pair[1]], within, &mut kept);
    }
    let mut out: Vec<usize> = (0..n).filter(|i| kept[*i]).collect();
    if closed {
        out.push(out[0] + n);
    }
    out
}

/// The polygon of a subpath within a distance.
struct Polygon<'a> {
    flat: &'a Flat,
    closed: bool,
    /// Indices of points, ascending. If closed, the first is repeated at the end, counted a round further.
    vertices: Vec<usize>,
}

impl<'a> Polygon<'a> {
    /// The polygon of a path with at least three points. Points that are `kept` are vertices.
    fn new(flat: &'a Flat, closed: bool, kept: &[bool], tolerance: f64) -> Self {
        let n = flat.points.len();
        let mut within = POLYGON * tolerance;
        loop {
            let out = Self { flat, closed, vertices: vertices(&flat.points, closed, kept.to_vec(), within) };
            // A closed polygon must have an area, unless the path has none.
            if !closed || out.sides() > 3 || n < 5 || within < 1e-3 * tolerance {
                return out;
            }
            within *= 0.5;
        }
    }

    /// Index of a vertex's point, counted on over the rounds of a closed polygon.
    fn place(&self, vertex: usize) -> usize {
        let (n, sides) = (self.flat.points.len(), self.sides());
        if self.closed { self.vertices[vertex % sides] + n * (vertex / sides) } else { self.vertices[vertex] }
    }

    /// Largest distance of the points between two vertices from the line between both.
    fn off(&self, [from, to]: [usize; 2]) -> f64 {
        let [a, b] = [from, to].map(|i| self.place(i));
        let ends = [self.point(a), self.point(b)];
        (a + 1..b).map(|k| off(self.point(k), ends)).fold(0.0, f64::max).sqrt()
    }

    /// Samples between two vertices, with their lengths along the polygon as parameters, and knots where it has turned.
    fn samples(&self, [from, to]: [usize; 2], closed: bool) -> (Samples, Vec<f64>) {
        let mut samples = Samples::default();
        let (mut knots, mut along, mut turned) = (vec![0.0], 0.0, 0.0_f64);
        let turns = (from + 1..to).map(|i| self.turn(i % self.sides()).abs()).sum::<f64>();
        let first = if turns <= ONE_TURN { ONE_TURN } else { FIRST_TURN };
        for i in from..to {
            let side = self.side(i);
            let (start, length) = (self.point(self.place(i)), side.hypot());
            let edges = || (self.place(i)..self.place(i + 1)).map(|k| [self.point(k), self.point(k + 1)]);
            let fine = edges().map(|[p, q]| p.distance(q)).sum::<f64>() / SAMPLES;
            for [p, q] in edges() {
                let count = (p.distance(q) / fine).round().clamp(1.0, SAMPLES);
                for j in 0..count as usize {
                    let r = p.lerp(q, j as f64 / count);
                    let t = ((r - start).dot(side) / side.hypot2()).clamp(0.0, 1.0);
                    samples.push(along + t * length, r, p.distance(q) / count);
                }
            }
            along += length;
            turned += if i + 1 < to { self.turn((i + 1) % self.sides()) } else { 0.0 };
            if turned.abs() > first || i + 1 == to {
                knots.push(along);
                turned = 0.0;
            }
        }
        if closed && knots.len() < 5 {
            knots = (0..=4).map(|k| along * f64::from(k) / 4.0).collect();
        }
        (samples, knots)
    }

    fn point(&self, i: usize) -> Point {
        self.flat.points[i % self.flat.points.len()]
    }

    /// Number of sides.
    fn sides(&self) -> usize {
        self.vertices.len() - 1
    }

    /// A side, counted on over the rounds of a closed polygon.
    fn side(&self, i: usize) -> Vec2 {
        let i = i % self.sides();
        self.point(self.vertices[i + 1]) - self.point(self.vertices[i])
    }

    /// Turn from side `i` − 1 to side `i`.
    fn turn(&self, i: usize) -> f64 {
        let (u, v) = (self.side(i + self.sides() - 1), self.side(i));
        u.cross(v).atan2(u.dot(v))
    }

    /// Length from a vertex, forwards or backwards, up to the vertex at which the sides have turned by more than `most`.
    fn arm(&self, i: usize, forwards: bool, most: f64) -> f64 {
        let (n, mut length, mut turned) = (self.sides(), 0.0, 0.0_f64);
        for k in 0..n {
            let side = if forwards { i + k } else { i + 2 * n - 1 - k };
            length += self.side(side).hypot();
            let next = if forwards { i + k + 1 } else { i + 2 * n - 1 - k };
            if !self.closed && (next % n == 0 || forwards && next >= n || !forwards && next <= n) {
                break;
            }
            turned += self.turn(next % n);
            if turned.abs() > most {
                break;
            }
        }
        length
    }

    /// Distance of the nearest circle from the corner at a vertex: s/4·tan(θ/4).
    fn corner(&self, i: usize) -> f64 {
        let turn = self.turn(i).abs();
        let arm = self.arm(i, true, 0.5 * turn).min(self.arm(i, false, 0.5 * turn));
        0.25 * arm * (0.25 * turn).tan()
    }

    /// Returns `true` if a side is one line of the source, or several in a row, and far longer than smoothly joined neighbours.
    fn is_edge(&self, i: usize, is_corner: &[bool]) -> bool {
        let own = self.side(i).hypot();
        let n = self.sides();
        let [a, b] = [self.vertices[i], self.vertices[i + 1]];
        let is_line = (a..=b).all(|k| self.flat.node(k).is_some()) && {
            let ends = [self.point(a), self.point(b)];
            (a + 1..b).all(|k| off(self.point(k), ends) <= (1e-6 * own).powi(2))
        };
        let beside = |corner: bool, side: usize| corner || own > LONG_EDGE * self.side(side).hypot();
        let first = !self.closed && i == 0;
        let last = !self.closed && i + 1 == n;
        is_line
            && (first || beside(is_corner[i], i + n - 1))
            && (last || beside(is_corner[(i + 1) % is_corner.len()], i + 1))
    }
}

/// A part of a subpath without corners that matter.
pub(crate) struct SmoothPart {
    /// Segments, which may also join at corners.
    pub(crate) segments: Vec<Segment>,
    /// Distance of the segments from the source.
    pub(crate) off: f64,
}

impl SmoothPart {
    /// Makes a part of unchanged segments of the source.
    fn of(segments: Vec<Segment>) -> Self {
        Self { segments, off: 0.0 }
    }

    /// Number of pieces that the part takes.
    fn count(&self, tolerance: f64) -> usize {
        let options = Options::new(tolerance - self.off);
        let (mut pieces, mut report, mut rest) = (Vec::new(), Report::default(), &self.segments[..]);
        while !rest.is_empty() {
            match smooth_run((rest, false), &options, &mut ReachMemory::default(), &mut pieces, &mut report) {
                Ok(count) => rest = &rest[count..],
                Err(_) => return usize::MAX,
            }
        }
        pieces.len()
    }
}

/// Turn at the joint of two segments, in radians without sign.
pub(crate) fn turn(before: &Segment, after: &Segment) -> f64 {
    let [into, away] = [tangent(before, 1.0), tangent(after, 0.0)];
    into.cross(away).atan2(into.dot(away)).abs()
}

/// Direction at the start (`t` = 0) or the end (1) of a segment.
fn tangent(segment: &Segment, t: f64) -> Vec2 {
    let seg = segment.segment();
    let c = seg.to_cubic();
    let towards =
        if t == 0.0 { [c.p1 - c.p0, c.p2 - c.p0, c.p3 - c.p0] } else { [c.p3 - c.p2, c.p3 - c.p1, c.p3 - c.p0] };
    let long = 1e-9 * (c.p3 - c.p0).hypot().max((c.p2 - c.p1).hypot());
    towards.into_iter().find(|v| v.hypot() > long).unwrap_or(towards[2])
}

/// Divides a subpath into smooth parts. Joints that turn by more than the corner angle stay; without a corner angle, those that are corners
/// when seen from a tolerance away. Callers leave out segments without length.
pub(crate) fn smooth_parts(segments: Vec<Segment>, closed: bool, options: &Options) -> Vec<SmoothPart> {
    let n = segments.len();
    let smooth = options.path_joint().min(SMOOTH_JOINT);
    let last = n.saturating_sub(usize::from(!closed));
    let kinked = |i: usize| {
        let turn = turn(&segments[i], &segments[(i + 1) % n]);
        turn > smooth && options.corner.is_none_or(|corner| turn <= corner)
    };
    if !options.nodes.merges() || n < 2 || !(0..last).any(kinked) {
        return vec![SmoothPart::of(segments)];
    }
    let flat = Flat::new(&segments, closed, options.tolerance);
    let is_corner = |i: usize| {
        options.corner.is_some_and(|c| i < n && (i > 0 || closed) && turn(&segments[(i + n - 1) % n], &segments[i]) > c)
    };
    let kept: Vec<bool> = (0..flat.points.len()).map(|i| flat.node(i).is_some_and(is_corner)).collect();
    if flat.points.len() < 3 {
        return vec![SmoothPart::of(segments)];
    }
    let polygon = Polygon::new(&flat, closed, &kept, options.tolerance);
    let scan = Scan { segments: &segments, smooth, tolerance: options.tolerance, polygon };
    let (count, parts) = scan.divide(options);
    let own = SmoothPart::of(segments);
    if count < own.count(options.tolerance) { parts } else { vec![own] }
}

/// Concatenates consecutive parts and adds the numbers of their pieces.
fn together(parts: Vec<(usize, Vec<SmoothPart>)>) -> (usize, Vec<SmoothPart>) {
    let count = parts.iter().fold(0, |sum: usize, (count, _)| sum.saturating_add(*count));
    (count, parts.into_iter().flat_map(|(_, parts)| parts).collect())
}

/// A subpath with its polygon.
struct Scan<'a> {
    segments: &'a [Segment],
    /// Joints that turn by less are smooth.
    smooth: f64,
    tolerance: f64,
    polygon: Polygon<'a>,
}

impl Scan<'_> {
    /// Parts between corners and edges, and the number of their pieces.
    fn divide(&self, options: &Options) -> (usize, Vec<SmoothPart>) {
        let (polygon, n) = (&self.polygon, self.polygon.sides());
        let vertices = n + usize::from(!polygon.closed);
        let is_corner: Vec<bool> = (0..vertices)
            .map(|i| {
                let turn = self.turn(i);
                !polygon.closed && (i == 0 || i == n)
                    || match options.corner {
                        Some(corner) => turn > corner,
                        None => turn > self.smooth && polygon.corner(i) > CORNER * self.tolerance,
                    }
            })
            .collect();
        let edges: Vec<bool> = (0..n).map(|i| polygon.is_edge(i, &is_corner)).collect();
        let begins = |i: usize| {
            let before = if i == 0 && !polygon.closed { None } else { Some((i + n - 1) % n) };
            is_corner[i % vertices] || i < n && edges[i] || before.is_some_and(|b| edges[b])
        };
        let Some(first) = (0..n).find(|i| begins(*i)) else {
            return self.part([0, n], None, DIVISIONS);
        };
        let (mut from, mut out) = (first, Vec::new());
        while from < first + n {
            let to = (from + 1..first + n).find(|i| begins(i % n)).unwrap_or(first + n);
            let along = |vertex: usize, beside: usize| {
                let edge = edges[beside % n] && !is_corner[vertex % vertices];
                edge.then(|| polygon.side(beside).normalize())
            };
            out.push(self.part([from, to], Some([along(from, from + n - 1), along(to, to)]), DIVISIONS));
            from = to;
        }
        together(out)
    }

    /// Turn of the source at a vertex; 0 inside a segment.
    fn turn(&self, vertex: usize) -> f64 {
        let n = self.segments.len();
        match self.polygon.flat.node(self.polygon.vertices[vertex]) {
            Some(i) if i < n && (i > 0 || self.polygon.closed) => {
                turn(&self.segments[(i + n - 1) % n], &self.segments[i])
            }
            _ => 0.0,
        }
    }

    /// Segments of the source between two vertices.
    fn between(&self, [from, to]: [usize; 2]) -> Vec<Segment> {
        let (at, n) = (&self.polygon.flat.at, self.segments.len());
        let [(first, t0), (last, t1)] = [from, to].map(|i| {
            let place = self.polygon.place(i);
            let (segment, t) = at[place % at.len()];
            (segment + n * (place / at.len()), t)
        });
        let part = |i: usize| {
            let (t0, t1) = (if i == first { t0 } else { 0.0 }, if i == last { t1 } else { 1.0 });
            let whole = self.segments[i % n];
            if t1 - t0 == 1.0 {
                whole
            } else {
                Segment::new(PathSeg::Cubic(whole.segment().to_cubic().subsegment(t0..t1)))
            }
        };
        (first..last + usize::from(t1 > 0.0)).map(part).collect()
    }

    /// The part from one vertex to another, with the directions `ends`, and the number of its pieces. Without `ends`, it is the closed
    /// polygon. It is divided at most `divisions` times.
    fn part(
        &self,
        [from, to]: [usize; 2],
        ends: Option<[Option<Vec2>; 2]>,
        divisions: usize,
    ) -> (usize, Vec<SmoothPart>) {
        let (polygon, tolerance) = (&self.polygon, self.tolerance);
        let counted = |part: SmoothPart| (part.count(tolerance), vec![part]);
        let own = counted(SmoothPart::of(self.between([from, to])));
        if own.1[0].segments.windows(2).all(|w| turn(&w[0], &w[1]) <= self.smooth) {
            return own;
        }
        let points = [from, to].map(|i| polygon.point(polygon.place(i)));
        if to == from + 1 && ends == Some([None, None]) {
            let off = polygon.off([from, to]) + FLAT * tolerance;
            if off <= tolerance {
                let line = Segment::new(PathSeg::Line(Line::new(points[0], points[1])));
                return (1, vec![SmoothPart { segments: vec![line], off }]);
            }
        }
        let ends = match ends {
            Some([a, b]) => Ends::Open([End { point: points[0], along: a }, End { point: points[1], along: b }]),
            None => Ends::Closed,
        };
        let (mut samples, knots) = polygon.samples([from, to], matches!(ends, Ends::Closed));
        let guides = Guide::all(&mut samples, knots, ends, [LOOSEST * tolerance, FINEST * tolerance]);
        let corners = match guides {
            Ok(guides) => {
                // Take the guide with the fewest pieces, if they are fewer than the source's.
                let part = |(guide, off): (Guide, f64)| {
                    let segments = guide.cubics().map(|c| Segment::new(PathSeg::Cubic(c))).collect();
                    counted(SmoothPart { segments, off: off + FLAT * tolerance })
                };
                let best = guides.into_iter().map(part).min_by_key(|(count, _)| *count);
                match best.filter(|(count, _)| *count < own.0) {
                    Some(best) => return best,
                    None => self.sharpest([from, to]).into_iter().collect(),
                }
            }
            Err(failed) => self.beside([from, to], &failed),
        };
        // A part that no guide follows is divided at corners.
        if corners.is_empty() || divisions == 0 {
            return own;
        }
        let (stops, along) = match ends {
            Ends::Open([a, b]) => ([&[from], &corners[..], &[to]].concat(), [a.along, b.along]),
            Ends::Closed => ([&corners[..], &[corners[0] + polygon.sides()]].concat(), [None, None]),
        };
        let parts = stops.windows(2).enumerate().map(|(i, w)| {
            let ends = [if i == 0 { along[0] } else { None }, if i + 2 == stops.len() { along[1] } else { None }];
            self.part([w[0], w[1]], Some(ends), divisions - 1)
        });
        let divided = together(parts.collect());
        if divided.0 < own.0 { divided } else { own }
    }

    /// The sharpest vertex between two that are near to each other.
    fn sharpest(&self, [from, to]: [usize; 2]) -> Option<usize> {
        const NEAR: usize = 8;
        let corner = |i: &usize| self.polygon.corner(i % self.polygon.sides());
        (from + 1..to).filter(|_| to - from <= NEAR).max_by(|i, j| corner(i).total_cmp(&corner(j)))
    }

    /// Vertices between two that lie in or beside intervals of the length along the polygon; if there are none, the sharpest.
    fn beside(&self, [from, to]: [usize; 2], intervals: &[[f64; 2]]) -> Vec<usize> {
        let (mut out, mut along, mut k) = (Vec::new(), 0.0, 0);
        for i in from + 1..to {
            let (before, after) = (self.polygon.side(i - 1).hypot(), self.polygon.side(i).hypot());
            along += before;
            while intervals.get(k).is_some_and(|[_, end]| *end < along - before) {
                k += 1;
            }
            if intervals.get(k).is_some_and(|[start, _]| *start <= along + after) {
                out.push(i);
            }
        }
        if out.is_empty() { self.sharpest([from, to]).into_iter().collect() } else { out }
    }
}
