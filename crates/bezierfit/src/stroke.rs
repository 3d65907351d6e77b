//! Outlines of strokes: sides, joins and caps as exact curves, which are then fitted.
//!
//! The outline of a stroke consists of [`Edge`]s: curves beside the path's segments, lines, and arcs. On the inner side of a corner, the
//! edges end where they cross; where they are too short for that, lines by way of the corner link them. All contours then turn
//! around the stroke in one direction, so that nothing inside is bare under the nonzero rule.

use crate::joined::fewest;
use crate::limits::{GAPS, POINTS, STROKED};
use crate::merge::{OwnPieces, ReachMemory};
use crate::offset::Offset;
use crate::options::{Error, Options};
use crate::path::{append, subpaths};
use crate::report::{Assurance, Fitted, Piece, Report};
use crate::run::{RunSegment, SegmentRun};
use crate::source::{BreakPoint, NotFinite, Result, SlowSpots, Source};
use crate::stretch::StretchFitter;
use kurbo::{
    Arc, BezPath, Cap, CubicBez, Join, Line, ParamCurve, PathEl, PathSeg, Point, Stroke, Vec2, common::solve_quadratic,
};
use std::f64::consts::PI;

/// Length of a dash that stands for a dot, as a fraction of the width.
const DOT: f64 = 1e-5;

/// Most dashes of a path; with more, it is drawn as a line.
const MOST_DASHES: f64 = 20_000.0;

/// The outline of a path's stroke, to be filled by the nonzero rule, within `options.tolerance`.
///
/// # Errors
/// [`Error::NotFinite`] if a coordinate is not finite.
///
/// ```
/// use bezierfit::{Options, stroke};
/// use kurbo::{BezPath, Join, Shape, Stroke};
///
/// let path = BezPath::from_svg("M0 0H100V100H0Z").unwrap();
/// let outline = stroke(&path, &Stroke::new(10.0).with_join(Join::Miter), &Options::new(0.1))?;
/// assert_eq!(outline.path.to_svg(), "M5,5 L95,5 L95,95 L5,95 Z M-5,-5 L-5,105 L105,105 L105,-5 Z");
/// # Ok::<(), bezierfit::Error>(())
/// ```
pub fn stroke(path: &BezPath, style: &Stroke, options: &Options) -> Result<Fitted, Error> {
    let contours = contours(path, style, false, GAPS * options.tolerance)?;
    Ok(fit_contours(&contours, options)?)
}

/// Fits closed contours within the tolerance, less what gaps and points have used of it.
pub(crate) fn fit_contours(contours: &[Vec<Edge>], options: &Options) -> Result<Fitted> {
    let mut out = Fitted { path: BezPath::new(), report: Report::default() };
    let mut memory = ReachMemory::default();
    let inner = Options { tolerance: STROKED * options.tolerance, ..*options };
    for contour in contours.iter().filter(|c| !c.is_empty()) {
        let pieces = fit_contour(contour, &inner, &mut memory, &mut out.report)?;
        append(&mut out.path, contour[0].p0, &pieces, true);
    }
    if out.report.max_error > 0.0 {
        out.report.max_error += options.tolerance - inner.tolerance;
    }
    Ok(out)
}

/// One side of the strokes of closed subpaths, at a distance from them, with joins. Miters are cut off at the limit.
#[cfg(feature = "area")]
pub(crate) fn beside_area(path: &BezPath, style: &Stroke, distance: f64, options: &Options) -> Result<Fitted> {
    let whole = |edges: Vec<Kept>| contour_of(&edges, true);
    fit_contours(&edges_beside_area(path, style, distance, options).into_iter().map(whole).collect::<Vec<_>>(), options)
}

/// For each closed subpath, the edges on one side of its stroke, with the parameters between which they are kept.
#[cfg(feature = "area")]
pub(crate) fn edges_beside_area(path: &BezPath, style: &Stroke, distance: f64, options: &Options) -> Vec<Vec<Kept>> {
    let gap = GAPS * options.tolerance;
    let pen = Pen { style, clipped: true, half: distance.abs(), gap, point: POINTS * gap };
    let side = |subpath: BezPath| {
        let (stretches, corners) = pen.course(&subpath, true);
        if stretches.is_empty() { Vec::new() } else { pen.side(&stretches, &corners, true, distance) }
    };
    subpaths(path).map(side).collect()
}

/// One side of an open path's stroke, at a distance from it, with joins.
#[cfg(feature = "area")]
pub(crate) fn beside_path(path: &BezPath, style: &Stroke, distance: f64, options: &Options) -> Result<BezPath> {
    let gap = GAPS * options.tolerance;
    let pen = Pen { style, clipped: false, half: distance.abs(), gap, point: POINTS * gap };
    let mut out = BezPath::new();
    let (stretches, corners) = pen.course(path, false);
    if stretches.is_empty() {
        return Ok(out);
    }
    let edges = contour_of(&pen.side(&stretches, &corners, false, distance), false);
    let mut pieces = Vec::new();
    for edge in &edges {
        edge.fit(options.tolerance, &mut pieces, &mut Report::default())?;
    }
    append(&mut out, edges[0].p0, &pieces, false);
    Ok(out)
}

/// A smooth part of an outline.
#[derive(Debug, Clone, Copy)]
pub struct Edge {
    /// First point, which is the end of the edge before.
    pub p0: Point,
    /// Last point.
    pub p1: Point,
    /// The curve between both.
    pub curve: EdgeCurve,
}

/// The curve of an [`Edge`].
#[derive(Debug, Clone, Copy)]
pub enum EdgeCurve {
    /// A line.
    Line,
    /// A part of a circle.
    Arc(Arc),
    /// A curve beside a segment of the path, without cusps.
    Side(Offset),
}

impl Edge {
    pub(crate) fn line(p0: Point, p1: Point) -> Self {
        Self { p0, p1, curve: EdgeCurve::Line }
    }

    fn arc([p0, p1]: [Point; 2], center: Point, sweep: f64) -> Self {
        let from = p0 - center;
        let radius = from.hypot();
        Self { p0, p1, curve: EdgeCurve::Arc(Arc::new(center, (radius, radius), from.atan2(), sweep, 0.0)) }
    }

    fn reversed(&self) -> Self {
        let curve = match self.curve {
            EdgeCurve::Line => EdgeCurve::Line,
            EdgeCurve::Arc(a) => EdgeCurve::Arc(a.reversed()),
            EdgeCurve::Side(s) => EdgeCurve::Side(s.reversed()),
        };
        Self { p0: self.p1, p1: self.p0, curve }
    }

    fn is_line(&self) -> bool {
        matches!(self.curve, EdgeCurve::Line)
    }

    /// The part of the edge between two parameters.
    pub(crate) fn part(&self, t0: f64, t1: f64) -> Self {
        if (t0, t1) == (0.0, 1.0) {
            return *self;
        }
        let (p0, p1) = (self.eval(t0).0, self.eval(t1).0);
        let curve = match self.curve {
            EdgeCurve::Line => EdgeCurve::Line,
            EdgeCurve::Arc(a) => EdgeCurve::Arc(Arc {
                start_angle: a.start_angle + a.sweep_angle * t0,
                sweep_angle: a.sweep_angle * (t1 - t0),
                ..a
            }),
            EdgeCurve::Side(s) => EdgeCurve::Side(s.part(t0, t1)),
        };
        Self { p0, p1, curve }
    }

    /// Moves the ends of the edge to points nearby.
    fn with_ends(self, p0: Point, p1: Point) -> Self {
        let curve = match self.curve {
            EdgeCurve::Side(s) if (p0, p1) != (self.p0, self.p1) => EdgeCurve::Side(s.with_ends([p0, p1])),
            other => other,
        };
        Self { p0, p1, curve }
    }

    /// Appends pieces within a tolerance that take less time to find than the fewest.
    ///
    /// # Errors
    /// [`NotFinite`] if the edge is not finite.
    pub fn draft(&self, tolerance: f64, pieces: &mut Vec<Piece>) -> Result<()> {
        if let EdgeCurve::Side(_) = self.curve {
            // The Hermite cubic is usually near enough. The rest of the tolerance is for errors between samples.
            let (v0, v1) = (self.eval(0.0).1 / 3.0, self.eval(1.0).1 / 3.0);
            let cubic = CubicBez::new(self.p0, self.p0 + v0, self.p1 - v1, self.p1);
            let error = |t: f64| cubic.eval(t).distance(self.eval(t).0);
            if [0.2, 0.35, 0.5, 0.65, 0.8].into_iter().all(|t| error(t) <= 0.7 * tolerance) {
                pieces.push(Piece::Cubic(cubic));
                return Ok(());
            }
        }
        self.fit(tolerance, pieces, &mut Report::default())
    }

    /// Appends few pieces within a tolerance.
    ///
    /// # Errors
    /// [`NotFinite`] if the edge is not finite.
    pub fn fit(&self, tolerance: f64, pieces: &mut Vec<Piece>, report: &mut Report) -> Result<()> {
        if self.is_line() {
            pieces.push(Piece::Line(Line::new(self.p0, self.p1)));
            report.add_error(0.0, Assurance::Exact);
            return Ok(());
        }
        let slow = SlowSpots::default();
        let [from, to] = [self.end(0.0)?, self.end(1.0)?];
        StretchFitter::new(self, &slow, tolerance, (false, 0.0), f64::INFINITY).cover(&from, &to, pieces, report)
    }
}

impl Source for Edge {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        let (p, d) = match self.curve {
            EdgeCurve::Line => (self.p0.lerp(self.p1, t), self.p1 - self.p0),
            EdgeCurve::Arc(a) => {
                let from = Vec2::from_angle(a.start_angle + a.sweep_angle * t) * a.radii.x;
                (a.center + from, Vec2::new(-from.y, from.x) * a.sweep_angle)
            }
            EdgeCurve::Side(s) => s.eval(t),
        };
        let p = match t {
            0.0 => self.p0,
            1.0 => self.p1,
            _ => p,
        };
        (p, d)
    }

    fn resolved(&self, _: [f64; 2], _: usize, _: f64) -> Option<bool> {
        Some(true)
    }

    fn end(&self, t: f64) -> Result<BreakPoint> {
        let (p, d) = self.eval(t);
        match self.curve {
            EdgeCurve::Side(s) => Ok(BreakPoint { p, ..s.end(t)? }),
            _ => {
                let speed = d.hypot();
                let unit = if speed > 0.0 { d / speed } else { Vec2::ZERO };
                Ok(BreakPoint { t, p, speed, into: unit, away: unit })
            }
        }
    }
}

/// The outline of a stroke as closed contours, before anything is fitted. At joints that turn very little, gaps of up to `gap` between
/// sides are closed without a join. Segments much smaller than `gap` are points. If `clipped`, miters are cut off at the limit.
///
/// # Errors
/// [`NotFinite`] if a coordinate is not finite.
pub fn contours(path: &BezPath, style: &Stroke, clipped: bool, gap: f64) -> Result<Vec<Vec<Edge>>> {
    let control = |e: &PathEl| match *e {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => vec![p],
        PathEl::QuadTo(p, q) => vec![p, q],
        PathEl::CurveTo(p, q, r) => vec![p, q, r],
        PathEl::ClosePath => vec![],
    };
    if let Some(at) = path.elements().iter().flat_map(control).find(|p| !p.is_finite()) {
        return Err(NotFinite { t: 0.0, at });
    }
    let mut out = Vec::new();
    let half = 0.5 * style.width.abs();
    if !(half > 0.0 && half.is_finite()) {
        return Ok(out);
    }
    let pen = Pen { style, clipped, half, gap, point: POINTS * gap };
    let mut dashes = style.dash_pattern.to_vec();
    if style.start_cap != Cap::Butt || style.end_cap != Cap::Butt {
        // Dashes of zero length show their caps, but kurbo drops them.
        dashes.iter_mut().for_each(|d| *d = d.max(DOT * style.width));
    }
    let is_dashed = drawn_dashes(path.segments().map(|s| s.to_cubic()), &dashes) > 0.0;
    for subpath in subpaths(path) {
        let start = subpath.elements().first().copied();
        let is_point = subpath.elements().iter().flat_map(control).all(|p| start == Some(PathEl::MoveTo(p)));
        if is_dashed && !is_point {
            let dashed = kurbo::dash(subpath.iter(), style.dash_offset, &dashes).collect();
            subpaths(&dashed).for_each(|s| pen.draw(&s, &mut out));
        } else {
            pen.draw(&subpath, &mut out);
        }
    }
    Ok(out)
}

/// Bound for the number of dashes that are drawn along these curves. 0 if the curves are drawn as lines, because there is no pattern or so
/// many dashes that they would look grey.
pub fn drawn_dashes(curves: impl Iterator<Item = CubicBez>, pattern: &[f64]) -> f64 {
    /// Entries of the pattern for each dash: a dash and a gap.
    const PAIR: f64 = 2.0;
    let period: f64 = pattern.iter().sum();
    if !(period > 0.0 && pattern.iter().all(|d| *d >= 0.0 && d.is_finite())) {
        return 0.0;
    }
    let legs = |c: CubicBez| c.p0.distance(c.p1) + c.p1.distance(c.p2) + c.p2.distance(c.p3);
    let count = curves.map(legs).sum::<f64>() / period * pattern.len() as f64 / PAIR;
    if count < MOST_DASHES { count } else { 0.0 }
}

/// Kind of point at which two parts of a path meet.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Meeting {
    /// A node.
    Node,
    /// A cusp inside a segment.
    Cusp,
    /// A point inside a segment that goes on smoothly.
    Inside,
}

/// A part of a path that never stops inside, and the kind of point at its end.
struct Stretch {
    seg: PathSeg,
    meeting: Meeting,
}

/// A corner, or the end of a path.
struct Corner {
    point: Point,
    /// Directions of the path before and after.
    into: Vec2,
    away: Vec2,
    meeting: Meeting,
}

impl Corner {
    /// Angle by which the path turns.
    fn turn(&self) -> f64 {
        let turn = self.into.cross(self.away).atan2(self.into.dot(self.away));
        if turn == -PI { PI } else { turn }
    }
}

/// Settings with which strokes are drawn.
struct Pen<'a> {
    style: &'a Stroke,
    /// Cut miters off at their limit, instead of beveling the corner.
    clipped: bool,
    /// Half of the width.
    half: f64,
    /// Longest gap between sides that is closed without a join.
    gap: f64,
    /// Size up to which a segment is a point.
    point: f64,
}

impl Pen<'_> {
    /// Appends the contours of a subpath.
    fn draw(&self, path: &BezPath, out: &mut Vec<Vec<Edge>>) {
        let closed = matches!(path.elements().last(), Some(PathEl::ClosePath));
        let (stretches, corners) = self.course(path, closed);
        let [Some(first), Some(last)] = [stretches.first(), stretches.last()] else {
            if path.elements().len() > 1 {
                self.dot(path, out);
            }
            return;
        };
        let [left, right] =
            [self.half, -self.half].map(|d| contour_of(&self.side(&stretches, &corners, closed, d), closed));
        let back = right.iter().rev().map(Edge::reversed);
        if closed {
            out.extend([left, back.collect()]);
            return;
        }
        let mut contour = left;
        self.cap(self.style.end_cap, last.seg.end(), direction(&last.seg, 1.0), &mut contour);
        contour.extend(back);
        self.cap(self.style.start_cap, first.seg.start(), -direction(&first.seg, 0.0), &mut contour);
        out.push(unite_lines(contour));
    }

    /// The stretches of a path, and the corner after each.
    fn course(&self, path: &BezPath, closed: bool) -> (Vec<Stretch>, Vec<Corner>) {
        let stretches = self.stretches(path, closed);
        let corner = |i: usize| {
            let (before, after) = (&stretches[i], &stretches[(i + 1) % stretches.len()]);
            let (into, away) = (direction(&before.seg, 1.0), direction(&after.seg, 0.0));
            Corner { point: before.seg.end(), into, away, meeting: before.meeting }
        };
        let corners = (0..stretches.len()).map(corner).collect();
        (stretches, corners)
    }

    /// Appends the caps of a subpath without length.
    fn dot(&self, path: &BezPath, out: &mut Vec<Vec<Edge>>) {
        let Some(PathEl::MoveTo(at)) = path.elements().first().copied() else { return };
        let along = path.segments().last().map_or(Vec2::ZERO, |s| s.end() - at);
        let along = if along == Vec2::ZERO { Vec2::new(1.0, 0.0) } else { along / along.hypot() };
        let mut contour = Vec::new();
        for (cap, along) in [(self.style.end_cap, along), (self.style.start_cap, -along)] {
            if cap != Cap::Butt {
                self.cap(cap, at, along, &mut contour);
            }
        }
        if contour.len() > 1 {
            out.push(contour);
        }
    }

    /// Appends a cap from the left to the right of a path that ends at `at`.
    fn cap(&self, cap: Cap, at: Point, along: Vec2, out: &mut Vec<Edge>) {
        let left = Vec2::new(-along.y, along.x) * self.half;
        let (p0, p1, ahead) = (at + left, at - left, along * self.half);
        match cap {
            Cap::Butt => out.push(Edge::line(p0, p1)),
            Cap::Round => out.push(Edge::arc([p0, p1], at, -PI)),
            Cap::Square => {
                let corners = [p0, p0 + ahead, p1 + ahead, p1];
                out.extend(corners.windows(2).map(|w| Edge::line(w[0], w[1])));
            }
        }
    }

    /// Cuts a path where it stops or nearly does, and drops segments that are points.
    fn stretches(&self, path: &BezPath, closed: bool) -> Vec<Stretch> {
        let Some(PathEl::MoveTo(start)) = path.elements().first().copied() else { return Vec::new() };
        let mut segments: Vec<PathSeg> = Vec::new();
        let mut at = start;
        for seg in path.segments() {
            let c = seg.to_cubic();
            if [c.p1, c.p2, c.p3].iter().all(|p| p.distance(at) <= self.point) {
                continue;
            }
            segments.push(with_moved_ends(seg, at, seg.end()));
            at = seg.end();
        }
        if let (true, Some(last)) = (closed, segments.last_mut()) {
            *last = with_moved_ends(*last, last.start(), start);
        }
        let mut out = Vec::new();
        for seg in segments {
            self.append_stretches(seg, &mut out);
        }
        out
    }

    /// Appends the stretches of a segment.
    fn append_stretches(&self, seg: PathSeg, out: &mut Vec<Stretch>) {
        let c = match seg {
            PathSeg::Line(_) => return out.push(Stretch { seg, meeting: Meeting::Node }),
            other => self.without_short_handles(other.to_cubic()),
        };
        let legs = [c.p1 - c.p0, c.p2 - c.p0, c.p3 - c.p0];
        let longest = legs.iter().copied().fold(Vec2::ZERO, |a, b| if b.hypot2() > a.hypot2() { b } else { a });
        let line = longest / longest.hypot();
        // The cubic is straight to rounding, or neither it nor its sides are off by more than a share of a point.
        let rounding = 1e-12 * longest.hypot().max(c.p0.to_vec2().hypot());
        let limit = rounding.max(0.05 * self.point * (longest.hypot() / self.half).min(1.0));
        if legs.iter().all(|v| v.cross(line).abs() <= limit) {
            return self.append_straight(&c, line, out);
        }
        let mut slow = SlowSpots::of_cubic(&c).all().to_vec();
        slow.retain(|t| *t > 1e-6 && *t < 1.0 - 1e-6);
        slow.sort_by(f64::total_cmp);
        let mut t0 = 0.0;
        for t in slow.into_iter().chain([1.0]) {
            let part = if (t0, t) == (0.0, 1.0) { c } else { c.subsegment(t0..t) };
            // Where the speed is least, the radius of curvature is speed²/|c″|. A turn too tight to be seen is a cusp.
            let (speed, change) = derivative_lengths(&c, t);
            let meeting = match t {
                1.0 => Meeting::Node,
                _ if speed * speed <= self.point * change => Meeting::Cusp,
                _ => Meeting::Inside,
            };
            let mut from = 0.0;
            for to in swift_turns(&part) {
                let seg = PathSeg::Cubic(part.subsegment(from..to));
                out.push(Stretch { seg, meeting: Meeting::Inside });
                from = to;
            }
            let rest = if from == 0.0 { part } else { part.subsegment(from..1.0) };
            out.push(Stretch { seg: PathSeg::Cubic(rest), meeting });
            t0 = t;
        }
    }

    /// Appends a cubic on a straight line, as lines between the points at which it turns back.
    fn append_straight(&self, c: &CubicBez, line: Vec2, out: &mut Vec<Stretch>) {
        let x = [c.p0, c.p1, c.p2, c.p3].map(|p| (p - c.p0).dot(line));
        let d = [x[1] - x[0], x[2] - x[1], x[3] - x[2]];
        let roots = solve_quadratic(d[0], 2.0 * (d[1] - d[0]), d[0] - 2.0 * d[1] + d[2]);
        let mut turns: Vec<f64> = roots.into_iter().filter(|t| *t > 0.0 && *t < 1.0).collect();
        turns.push(1.0);
        let mut from = c.p0;
        for t in turns {
            let to = if t == 1.0 { c.p3 } else { c.eval(t) };
            if to.distance(from) > self.point {
                if let Some(before) = out.last_mut().filter(|_| from != c.p0) {
                    before.meeting = Meeting::Cusp;
                }
                out.push(Stretch { seg: PathSeg::Line(Line::new(from, to)), meeting: Meeting::Node });
                from = to;
            }
        }
        if let Some(last) = out.last_mut().filter(|_| from != c.p0) {
            last.seg = with_moved_ends(last.seg, last.seg.start(), c.p3);
        }
    }

    /// Sets handles to zero that are too short for their direction to be seen: a tenth of a point, or a ten-thousandth of the chord.
    fn without_short_handles(&self, mut c: CubicBez) -> CubicBez {
        let least = (0.1 * self.point).min(1e-4 * (c.p3 - c.p0).hypot());
        if c.p1.distance(c.p0) <= least {
            c.p1 = c.p0;
        }
        if c.p2.distance(c.p3) <= least {
            c.p2 = c.p3;
        }
        c
    }

    /// Edges on one side of a path, with their joins.
    fn side(&self, stretches: &[Stretch], corners: &[Corner], closed: bool, distance: f64) -> Vec<Kept> {
        let mut side = Side { pen: self, distance, edges: Vec::with_capacity(2 * stretches.len()) };
        for (i, stretch) in stretches.iter().enumerate() {
            let first = side.edges.len();
            side.edges.extend(edges_beside(&stretch.seg, distance).into_iter().map(|edge| Kept::new(edge, false)));
            if i > 0 {
                side.join(first - 1, first, &corners[i - 1]);
            }
        }
        if let (true, Some(corner)) = (closed, corners.last()) {
            let last = side.edges.len() - 1;
            side.join(last, 0, corner);
        }
        side.edges
    }
}

/// Joins the kept parts of edges into one contour.
fn contour_of(kept: &[Kept], closed: bool) -> Vec<Edge> {
    let mut edges: Vec<Edge> = kept.iter().map(|k| k.edge.part(k.from, k.to)).collect();
    // Consecutive parts meet exactly.
    for i in 0..edges.len() {
        let next = (i + 1) % edges.len();
        if next != 0 || closed {
            edges[next].p0 = edges[i].p1;
        }
    }
    if closed { unite_lines_around(edges) } else { edges }
}

/// An edge, and the parameters between which it is kept.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kept {
    pub(crate) edge: Edge,
    from: f64,
    to: f64,
    /// Set if the edge leads by way of an inner corner, nearer to the path than the distance.
    #[cfg_attr(not(feature = "area"), expect(dead_code, reason = "areas alone ask"))]
    pub(crate) is_link: bool,
}

impl Kept {
    fn new(edge: Edge, is_link: bool) -> Self {
        Self { edge, from: 0.0, to: 1.0, is_link }
    }
}

/// One side of a stroke under construction.
struct Side<'a> {
    pen: &'a Pen<'a>,
    distance: f64,
    edges: Vec<Kept>,
}

impl Side<'_> {
    /// Joins an edge to a later one, or to the first.
    fn join(&mut self, a: usize, b: usize, corner: &Corner) {
        let [p, q] = [self.edges[a].edge.p1, self.edges[b].edge.p0];
        let turn = corner.turn();
        let small = p.distance(q) <= self.pen.gap && corner.into.dot(corner.away) > 0.0;
        if corner.meeting == Meeting::Inside || small {
            let (mid, before, after) = (p.midpoint(q), self.edges[a].edge, self.edges[b].edge);
            self.edges[a].edge = before.with_ends(before.p0, mid);
            self.edges[b].edge = after.with_ends(mid, after.p1);
            return;
        }
        let is_inner = self.distance * turn > 0.0;
        let links = if is_inner {
            if let Some((s, t)) = crossing(&self.edges[a].edge, &self.edges[b].edge, self.distance) {
                self.edges[a].to = s;
                self.edges[b].from = t;
                return;
            }
            vec![Edge::line(p, corner.point), Edge::line(corner.point, q)]
        } else {
            self.outer_join([p, q], turn, corner)
        };
        let links = links.into_iter().map(|edge| Kept::new(edge, is_inner));
        let index = if b > a { b } else { self.edges.len() };
        self.edges.splice(index..index, links);
    }

    /// Edges of the join on the outer side of a corner.
    fn outer_join(&self, [p, q]: [Point; 2], turn: f64, corner: &Corner) -> Vec<Edge> {
        let style = self.pen.style;
        match style.join {
            _ if corner.meeting == Meeting::Cusp => vec![Edge::arc([p, q], corner.point, turn)],
            Join::Round => vec![Edge::arc([p, q], corner.point, turn)],
            // A miter's length is the width over the cosine of half the turn.
            Join::Miter if (0.5 * turn).cos() * style.miter_limit >= 1.0 => {
                // The tangent of half the turn.
                let along = corner.into.cross(corner.away).abs() / (1.0 + corner.into.dot(corner.away));
                let tip = p + corner.into * (self.pen.half * along);
                vec![Edge::line(p, tip), Edge::line(tip, q)]
            }
            Join::Miter if self.pen.clipped && corner.into != -corner.away => {
                let length = self.pen.half * (style.miter_limit - (0.5 * turn).cos()) / (0.5 * turn.abs()).sin();
                let cut = [p, p + corner.into * length.max(0.0), q - corner.away * length.max(0.0), q];
                cut.windows(2).map(|w| Edge::line(w[0], w[1])).collect()
            }
            Join::Miter | Join::Bevel => vec![Edge::line(p, q)],
        }
    }
}

/// The curve beside a segment, cut at its cusps.
fn edges_beside(seg: &PathSeg, distance: f64) -> Vec<Edge> {
    if let PathSeg::Line(l) = seg {
        let along = (l.p1 - l.p0) / l.length();
        let off = Vec2::new(-along.y, along.x) * distance;
        return vec![Edge::line(l.p0 + off, l.p1 + off)];
    }
    let whole = Offset::new(*seg, distance);
    let mut ends = whole.cusps();
    ends.push(1.0);
    let mut t0 = 0.0;
    let mut out: Vec<Edge> = Vec::with_capacity(ends.len());
    for t in ends {
        let part = if (t0, t) == (0.0, 1.0) { whole } else { Offset::new(seg.subsegment(t0..t), distance) };
        let p0 = out.last().map_or_else(|| part.eval(0.0).0, |e| e.p1);
        out.push(Edge { p0, p1: part.eval(1.0).0, curve: EdgeCurve::Side(part) });
        t0 = t;
    }
    out
}

/// Direction of a segment at its start (`t` = 0) or its end (1).
fn direction(seg: &PathSeg, t: f64) -> Vec2 {
    match seg {
        PathSeg::Line(l) => (l.p1 - l.p0) / l.length(),
        _ => Offset::new(*seg, 0.0).direction(t),
    }
}

/// Moves the ends of a segment, with their handles.
fn with_moved_ends(seg: PathSeg, start: Point, end: Point) -> PathSeg {
    if (seg.start(), seg.end()) == (start, end) {
        return seg;
    }
    match seg {
        PathSeg::Line(_) => PathSeg::Line(Line::new(start, end)),
        other => {
            let c = other.to_cubic();
            PathSeg::Cubic(CubicBez::new(start, c.p1 + (start - c.p0), c.p2 + (end - c.p3), end))
        }
    }
}

/// Parameters at which the swift turns of a cubic beside its short handles end and begin. Beside a short handle, the derivative takes the
/// direction of the next leg after about short/2d₁ or, if that is short too, √(short/other); four times as far, it has nearly turned.
fn swift_turns(c: &CubicBez) -> impl Iterator<Item = f64> {
    let [d0, d1, d2] = [c.p1 - c.p0, c.p2 - c.p1, c.p3 - c.p2].map(Vec2::hypot);
    let turn = |short: f64, other: f64| 4.0 * (0.5 * short / d1).min((short / other).sqrt());
    let [first, last] = [turn(d0, d2), turn(d2, d0)];
    let is_short = |t: &f64| *t > 1e-5 && *t < 0.3;
    [Some(first).filter(is_short), Some(last).filter(is_short).map(|t| 1.0 - t)].into_iter().flatten()
}

/// Lengths of a cubic's first and second derivative.
fn derivative_lengths(c: &CubicBez, t: f64) -> (f64, f64) {
    let (d0, d1, d2) = (c.p1 - c.p0, c.p2 - c.p1, c.p3 - c.p2);
    let u = 1.0 - t;
    let first = (d0 * (u * u) + d1 * (2.0 * u * t) + d2 * (t * t)) * 3.0;
    let second = ((d1 - d0) * u + (d2 - d1) * t) * 6.0;
    (first.hypot(), second.hypot())
}

/// Parameters at which the last half of an edge on the inner side of a corner crosses the first half of the next. Both strokes then
/// cover the parts that are cut off.
fn crossing(a: &Edge, b: &Edge, distance: f64) -> Option<(f64, f64)> {
    /// Most Newton steps. Each doubles the correct digits.
    const STEPS: usize = 12;
    let forward = |e: &Edge| match e.curve {
        EdgeCurve::Side(s) => s.speed(0.5) > 0.0,
        _ => true,
    };
    if !(forward(a) && forward(b)) {
        return None;
    }
    let (mut s, mut t) = (1.0_f64, 0.0_f64);
    let size = a.p0.distance(a.p1) + b.p0.distance(b.p1);
    for _ in 0..STEPS {
        let ((p, u), (q, v)) = (a.eval(s), b.eval(t));
        let gap = q - p;
        if gap.hypot() <= 1e-14 * size {
            break;
        }
        let det = v.cross(u);
        s += v.cross(gap) / det;
        t += u.cross(gap) / det;
        if !((0.0..=2.0).contains(&s) && (-1.0..=1.0).contains(&t)) {
            return None;
        }
    }
    let ((p, u), (q, v)) = (a.eval(s), b.eval(t));
    let meets = q.distance(p) <= 1e-9 * size;
    // At the crossing, the sides turn in the direction of the path.
    let is_inner = u.cross(v) * distance > 0.0;
    (meets && is_inner && (0.5..1.0).contains(&s) && t > 0.0 && t <= 0.5).then_some((s, t))
}

/// Unites lines of a contour that go on in one direction.
fn unite_lines(contour: Vec<Edge>) -> Vec<Edge> {
    let mut out: Vec<Edge> = Vec::with_capacity(contour.len());
    for e in contour {
        match out.last_mut() {
            Some(last) if goes_on(last, &e) => last.p1 = e.p1,
            _ => out.push(e),
        }
    }
    out.retain(|e| !(e.is_line() && e.p0 == e.p1));
    out
}

/// Unites lines of a closed contour that go on in one direction, also across its start.
fn unite_lines_around(contour: Vec<Edge>) -> Vec<Edge> {
    let mut out = unite_lines(contour);
    if let [first, .., last] = &out[..]
        && goes_on(last, first)
    {
        out[0].p0 = last.p0;
        out.pop();
    }
    out
}

/// Returns `true` if both edges are lines in the same direction.
fn goes_on(a: &Edge, b: &Edge) -> bool {
    let (u, v) = (a.p1 - a.p0, b.p1 - b.p0);
    let is_same = u.dot(v) > 0.0 && u.cross(v).abs() <= 1e-10 * u.hypot() * v.hypot();
    a.is_line() && b.is_line() && (is_same || u == Vec2::ZERO || v == Vec2::ZERO)
}

/// Fits a contour, with few pieces across smooth joints.
fn fit_contour(edges: &[Edge], options: &Options, memory: &mut ReachMemory, report: &mut Report) -> Result<Vec<Piece>> {
    let mut pieces = Vec::with_capacity(edges.len());
    let mut i = 0;
    while i < edges.len() {
        let mut run = SegmentRun::new(false, edges.len() - i);
        let count = run.extend(&edges[i..], options.max_smooth_turn(), |edge| {
            let ends = [edge.end(0.0)?, edge.end(1.0)?];
            Ok(Some(RunSegment::new(*edge, None, ends, edge.is_line())))
        })?;
        let append_own = |k: usize, pieces: &mut Vec<Piece>, report: &mut Report| {
            edges[i + k].fit(options.tolerance, pieces, report)
        };
        if count < 2 {
            append_own(0, &mut pieces, report)?;
        } else {
            let own = OwnPieces::new(count, append_own);
            fewest(&run, own, (options.tolerance, false), memory, &mut pieces, report)?;
        }
        i += count.max(1);
    }
    Ok(pieces)
}
