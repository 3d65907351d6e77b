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

use crate::guide::{End, Ends, Guide, Samples, squared_distance};
use crate::limits::{LONG_EDGE, SMOOTH_JOINT};
use crate::merge::ReachMemory;
use crate::options::Options;
use crate::path::{Segment, smooth_run};
use crate::report::Report;
use kurbo::{Line, ParamCurve, PathSeg, Point, Vec2};

/// Share of the tolerance that flattening uses.
const FLATTENING: f64 = 1.0 / 64.0;
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
/// Number of samples of each side of the polygon, and most of each edge of the path.
const SAMPLES: f64 = 16.0;
/// Turn of the sides, in radians, that one interval between knots covers at first, and the turn up to which one interval covers all sides:
/// a little over a quarter turn.
const FIRST_TURN: f64 = 1.0;
const ONE_TURN: f64 = 1.7;

/// A flattened subpath.
struct Flat {
    points: Vec<Point>,
    /// Segment and parameter of each point; the parameter is zero at nodes.
    origins: Vec<(usize, f64)>,
}

impl Flat {
    fn new(segments: &[Segment], closed: bool, tolerance: f64) -> Self {
        let mut out = Self { points: Vec::with_capacity(segments.len() + 1), origins: Vec::new() };
        for (i, s) in segments.iter().enumerate() {
            let seg = s.segment();
            out.push(seg.start(), (i, 0.0));
            if matches!(seg, PathSeg::Line(_)) {
                continue;
            }
            let c = seg.to_cubic();
            let (d0, d1, d2) = (c.p1 - c.p0, c.p2 - c.p1, c.p3 - c.p2);
            let bend = (d1 - d0).hypot().max((d2 - d1).hypot());
            // The second derivative is at most 6·bend, so n chords are within 6·bend/8n².
            let n = (6.0 * bend / (8.0 * FLATTENING * tolerance)).sqrt().ceil().clamp(1.0, 4096.0) as usize;
            for t in (1..n).map(|k| k as f64 / n as f64) {
                out.push(c.eval(t), (i, t));
            }
        }
        if let Some(last) = segments.last() {
            let end = last.segment().end();
            if !(closed && end == out.points[0]) {
                out.push(end, (segments.len(), 0.0));
            }
        }
        out
    }

    /// Appends a point. Of coincident points, the last node counts.
    fn push(&mut self, p: Point, origin: (usize, f64)) {
        if self.points.last() != Some(&p) {
            self.points.push(p);
            self.origins.push(origin);
        } else if let Some(last) = self.origins.last_mut().filter(|_| origin.1 == 0.0) {
            *last = origin;
        }
    }

    /// Index of the segment that begins at a point, if the point is a node.
    fn node(&self, i: usize) -> Option<usize> {
        let (segment, t) = self.origins[i % self.origins.len()];
        (t == 0.0).then_some(segment)
    }
}

/// Marks further vertices between two, so that the polygon is within the distance `within` of the points.
fn reduce(points: &[Point], [first, last]: [usize; 2], within: f64, kept: &mut [bool]) {
    // Limits the work where the furthest point divides off little each time: after that, stretches are halved.
    let mut work = 40 * (last - first + 1);
    let n = points.len();
    let mut stack = vec![[first, last]];
    while let Some([i, j]) = stack.pop() {
        if j < i + 2 {
            continue;
        }
        let ends = [points[i % n], points[j % n]];
        let (mut most, mut furthest) = (within * within, None);
        for k in i + 1..j {
            let d = squared_distance(points[k % n], ends);
            if d > most {
                (most, furthest) = (d, Some(k));
            }
        }
        let Some(mut k) = furthest else { continue };
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
    fn point_index(&self, vertex: usize) -> usize {
        let (n, sides) = (self.flat.points.len(), self.sides());
        if self.closed { self.vertices[vertex % sides] + n * (vertex / sides) } else { self.vertices[vertex] }
    }

    /// Largest distance of the points between two vertices from the line between both.
    fn distance_from_line(&self, [from, to]: [usize; 2]) -> f64 {
        let [a, b] = [from, to].map(|i| self.point_index(i));
        let ends = [self.point(a), self.point(b)];
        (a + 1..b).map(|k| squared_distance(self.point(k), ends)).fold(0.0, f64::max).sqrt()
    }

    /// Samples between two vertices, with their lengths along the polygon as parameters, and knots wherever it has turned by
    /// [`FIRST_TURN`].
    fn samples(&self, [from, to]: [usize; 2], closed: bool) -> (Samples, Vec<f64>) {
        let mut samples = Samples::default();
        let (mut knots, mut along, mut turned) = (vec![0.0], 0.0, 0.0_f64);
        let turns = (from + 1..to).map(|i| self.turn(i % self.sides()).abs()).sum::<f64>();
        let most_turn = if turns <= ONE_TURN { ONE_TURN } else { FIRST_TURN };
        for i in from..to {
            let side = self.side(i);
            let (start, length) = (self.point(self.point_index(i)), side.hypot());
            let edges = || (self.point_index(i)..self.point_index(i + 1)).map(|k| [self.point(k), self.point(k + 1)]);
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
            if turned.abs() > most_turn || i + 1 == to {
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
            if !self.closed && (next % n == 0 || if forwards { next >= n } else { next <= n }) {
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
    fn corner_height(&self, i: usize) -> f64 {
        let turn = self.turn(i).abs();
        let arm = self.arm(i, true, 0.5 * turn).min(self.arm(i, false, 0.5 * turn));
        0.25 * arm * (0.25 * turn).tan()
    }

    /// Returns `true` if a side is one line of the source, or several in a row, and far longer than smoothly joined neighbours.
    fn is_edge(&self, i: usize, is_corner: &[bool]) -> bool {
        let (length, n) = (self.side(i).hypot(), self.sides());
        let [a, b] = [self.vertices[i], self.vertices[i + 1]];
        let is_line = (a..=b).all(|k| self.flat.node(k).is_some()) && {
            let ends = [self.point(a), self.point(b)];
            (a + 1..b).all(|k| squared_distance(self.point(k), ends) <= (1e-6 * length).powi(2))
        };
        let ends_beside = |corner: bool, side: usize| corner || length > LONG_EDGE * self.side(side).hypot();
        let is_first = !self.closed && i == 0;
        let is_last = !self.closed && i + 1 == n;
        is_line
            && (is_first || ends_beside(is_corner[i], i + n - 1))
            && (is_last || ends_beside(is_corner[(i + 1) % is_corner.len()], i + 1))
    }
}

/// A part of a subpath without corners that matter.
pub(crate) struct SmoothPart {
    /// Segments, which may also join at corners.
    pub(crate) segments: Vec<Segment>,
    /// Bound for the distance of the segments from the source.
    pub(crate) distance: f64,
}

/// Consecutive parts and the number of their pieces.
type CountedParts = (usize, Vec<SmoothPart>);

impl SmoothPart {
    /// Makes a part of unchanged segments of the source.
    fn unchanged(segments: Vec<Segment>) -> Self {
        Self { segments, distance: 0.0 }
    }

    /// Number of pieces that the part takes.
    fn count(&self, tolerance: f64) -> usize {
        let options = Options::new(tolerance - self.distance);
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
    let rounding = 1e-9 * (c.p3 - c.p0).hypot().max((c.p2 - c.p1).hypot());
    towards.into_iter().find(|v| v.hypot() > rounding).unwrap_or(towards[2])
}

/// Divides a subpath into smooth parts. Joints that turn by more than the corner angle stay; without a corner angle, those that are corners
/// when seen from a tolerance away. Callers leave out segments without length.
pub(crate) fn smooth_parts(segments: Vec<Segment>, closed: bool, options: &Options) -> Vec<SmoothPart> {
    let n = segments.len();
    let smooth = options.max_inner_turn().min(SMOOTH_JOINT);
    let last = n.saturating_sub(usize::from(!closed));
    let kinked = |i: usize| {
        let turn = turn(&segments[i], &segments[(i + 1) % n]);
        turn > smooth && options.corner.is_none_or(|corner| turn <= corner)
    };
    if !options.nodes.merges() || n < 2 || !(0..last).any(kinked) {
        return vec![SmoothPart::unchanged(segments)];
    }
    let flat = Flat::new(&segments, closed, options.tolerance);
    let is_corner = |i: usize| {
        options.corner.is_some_and(|c| i < n && (i > 0 || closed) && turn(&segments[(i + n - 1) % n], &segments[i]) > c)
    };
    let kept: Vec<bool> = (0..flat.points.len()).map(|i| flat.node(i).is_some_and(is_corner)).collect();
    if flat.points.len() < 3 {
        return vec![SmoothPart::unchanged(segments)];
    }
    let polygon = Polygon::new(&flat, closed, &kept, options.tolerance);
    let scan = Scan { segments: &segments, smooth, tolerance: options.tolerance, polygon };
    let (count, parts) = scan.divide(options);
    let own = SmoothPart::unchanged(segments);
    if count < own.count(options.tolerance) { parts } else { vec![own] }
}

/// Concatenates consecutive parts and adds the numbers of their pieces.
fn concatenated(parts: Vec<CountedParts>) -> CountedParts {
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
    fn divide(&self, options: &Options) -> CountedParts {
        let (polygon, n) = (&self.polygon, self.polygon.sides());
        let vertices = n + usize::from(!polygon.closed);
        let is_sharp = |i: usize| match options.corner {
            Some(corner) => self.turn(i) > corner,
            None => self.turn(i) > self.smooth && polygon.corner_height(i) > CORNER * self.tolerance,
        };
        let is_end = |i: usize| !polygon.closed && (i == 0 || i == n);
        let is_corner: Vec<bool> = (0..vertices).map(|i| is_end(i) || is_sharp(i)).collect();
        let edges: Vec<bool> = (0..n).map(|i| polygon.is_edge(i, &is_corner)).collect();
        let begins = |i: usize| {
            let before = if i == 0 && !polygon.closed { None } else { Some((i + n - 1) % n) };
            is_corner[i % vertices] || (i < n && edges[i]) || before.is_some_and(|b| edges[b])
        };
        let Some(first) = (0..n).find(|i| begins(*i)) else {
            return self.part([0, n], None, DIVISIONS);
        };
        let (mut from, mut out) = (first, Vec::new());
        while from < first + n {
            let to = (from + 1..first + n).find(|i| begins(i % n)).unwrap_or(first + n);
            // Where a smooth part meets an edge, it has the edge's direction.
            let direction = |vertex: usize, beside: usize| {
                let is_smooth = edges[beside % n] && !is_corner[vertex % vertices];
                is_smooth.then(|| polygon.side(beside).normalize())
            };
            out.push(self.part([from, to], Some([direction(from, from + n - 1), direction(to, to)]), DIVISIONS));
            from = to;
        }
        concatenated(out)
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
    fn segments_between(&self, [from, to]: [usize; 2]) -> Vec<Segment> {
        let (origins, n) = (&self.polygon.flat.origins, self.segments.len());
        let [(first, t0), (last, t1)] = [from, to].map(|vertex| {
            let i = self.polygon.point_index(vertex);
            let (segment, t) = origins[i % origins.len()];
            (segment + n * (i / origins.len()), t)
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
    fn part(&self, [from, to]: [usize; 2], ends: Option<[Option<Vec2>; 2]>, divisions: usize) -> CountedParts {
        let (polygon, tolerance) = (&self.polygon, self.tolerance);
        let counted = |part: SmoothPart| (part.count(tolerance), vec![part]);
        let own = counted(SmoothPart::unchanged(self.segments_between([from, to])));
        if own.1[0].segments.windows(2).all(|w| turn(&w[0], &w[1]) <= self.smooth) {
            return own;
        }
        let points = [from, to].map(|i| polygon.point(polygon.point_index(i)));
        if to == from + 1 && ends == Some([None, None]) {
            let distance = polygon.distance_from_line([from, to]) + FLATTENING * tolerance;
            if distance <= tolerance {
                let line = Segment::new(PathSeg::Line(Line::new(points[0], points[1])));
                return (1, vec![SmoothPart { segments: vec![line], distance }]);
            }
        }
        let ends = match ends {
            Some([a, b]) => {
                Ends::Open([End { point: points[0], direction: a }, End { point: points[1], direction: b }])
            }
            None => Ends::Closed,
        };
        let (mut samples, knots) = polygon.samples([from, to], matches!(ends, Ends::Closed));
        let guides = Guide::candidates(&mut samples, knots, ends, [LOOSEST * tolerance, FINEST * tolerance]);
        let corners = match guides {
            Ok(guides) => {
                // Take the guide with the fewest pieces, if they are fewer than the source's.
                let part = |(guide, distance): (Guide, f64)| {
                    let segments = guide.cubics().map(|c| Segment::new(PathSeg::Cubic(c))).collect();
                    counted(SmoothPart { segments, distance: distance + FLATTENING * tolerance })
                };
                let best = guides.into_iter().map(part).min_by_key(|(count, _)| *count);
                match best.filter(|(count, _)| *count < own.0) {
                    Some(best) => return best,
                    None => self.sharpest([from, to]).into_iter().collect(),
                }
            }
            Err(failed) => self.vertices_beside([from, to], &failed),
        };
        // A part that no guide follows is divided at corners.
        if corners.is_empty() || divisions == 0 {
            return own;
        }
        let (stops, [first, last]) = match ends {
            Ends::Open([a, b]) => ([&[from], &corners[..], &[to]].concat(), [a.direction, b.direction]),
            Ends::Closed => ([&corners[..], &[corners[0] + polygon.sides()]].concat(), [None, None]),
        };
        let parts = stops.windows(2).enumerate().map(|(i, w)| {
            let ends = [first.filter(|_| i == 0), last.filter(|_| i + 2 == stops.len())];
            self.part([w[0], w[1]], Some(ends), divisions - 1)
        });
        let divided = concatenated(parts.collect());
        if divided.0 < own.0 { divided } else { own }
    }

    /// The sharpest vertex between two that are near to each other.
    fn sharpest(&self, [from, to]: [usize; 2]) -> Option<usize> {
        const NEAR: usize = 8;
        let corner = |i: &usize| self.polygon.corner_height(i % self.polygon.sides());
        (from + 1..to).filter(|_| to - from <= NEAR).max_by(|i, j| corner(i).total_cmp(&corner(j)))
    }

    /// Vertices between two that lie in or beside intervals of the length along the polygon; if there are none, the sharpest.
    fn vertices_beside(&self, [from, to]: [usize; 2], intervals: &[[f64; 2]]) -> Vec<usize> {
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
