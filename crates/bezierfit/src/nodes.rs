//! NodeFinder nodes where a type designer would: at the structure of a drawing and at extremes, with handles along the axes. Between them are
//! as few pieces as the tolerance allows, divided alike from either end.

use crate::joined::{cover_far, fewest};
use crate::limits::{HOPELESS, MAX_PLANNED, MOVED_TURN, ON_AXIS, PLACEMENTS, SMOOTH_JOINT, TRUSTED};
use crate::merge::{FitOwn, Leg, OwnPieces, PassedLeg, ReachMemory, Reaches};
use crate::options::Nodes;
use crate::part::Part;
use crate::report::{Piece, Report};
use crate::run::{RunSegment, SegmentRun};
use crate::source::{BreakPoint, NotFinite, Quotient, Result, Source};
use crate::stretch::StretchFitter;
use kurbo::{Axis, Point, Vec2};

/// One side of a joint: the properties that decide whether the joint belongs to the structure of a drawing.
#[derive(Debug, Clone, Copy)]
pub struct Side {
    /// Direction at the joint.
    pub tangent: Vec2,
    /// Second derivative at the joint, or any vector to the side to which the curve bends.
    pub bend: Vec2,
    /// Set if this side is a straight line.
    pub is_line: bool,
}

/// Returns `true` if a smooth joint belongs to the structure of a drawing: a straight line ends there, or it is a horizontal or vertical
/// extreme with handles along the axis.
#[must_use]
pub fn is_structure(before: &Side, after: &Side) -> bool {
    let is_on_axis = |s: &Side| s.tangent.x.abs().min(s.tangent.y.abs()) <= SMOOTH_JOINT * s.tangent.hypot();
    let bend = |s: &Side| s.tangent.cross(s.bend);
    let is_extreme = is_on_axis(before) && is_on_axis(after) && bend(before) * bend(after) > 0.0;
    before.is_line != after.is_line || is_extreme
}

/// Settings for the pieces of a run with placed nodes.
#[derive(Debug, Clone, Copy)]
pub struct NodeSettings {
    /// [`Nodes::Auto`] or [`Nodes::Extremes`].
    pub nodes: Nodes,
    /// Largest allowed distance.
    pub tolerance: f64,
    /// Set if the end of the run joins its start smoothly.
    pub closed: bool,
    /// Evaluations that are left.
    pub left: f64,
}

/// Work of pieces between placed nodes.
#[derive(Debug, Clone, Copy, Default)]
pub struct PlacedWork {
    /// Number of cubics over several segments that were tried.
    pub tried: usize,
    /// Evaluations of single segments.
    pub evaluations: usize,
}

/// A node on a run: the segment, its parameter, and the direction of the handles if they must lie along an axis.
#[derive(Debug, Clone, Copy)]
struct Node {
    segment: usize,
    t: f64,
    axis: Option<Vec2>,
}

impl Node {
    /// Position along the run, in segments.
    fn position(&self) -> f64 {
        self.segment as f64 + self.t
    }
}

/// Appends the pieces of a run with placed nodes. The pieces of a closed run begin at the first of these. Returns the work.
///
/// # Errors
/// [`NotFinite`] if a segment is not finite.
pub fn placed<S: Source>(
    run: &SegmentRun<S>,
    settings: NodeSettings,
    memory: &mut ReachMemory,
    pieces: &mut Vec<Piece>,
    report: &mut Report,
) -> Result<PlacedWork> {
    let NodeSettings { nodes, tolerance, closed, left } = settings;
    let finder = NodeFinder { run, closed };
    let mut ends = if nodes == Nodes::Auto { finder.structure()? } else { finder.extremes()? };
    if closed && ends.is_empty() {
        ends = finder.outermost()?;
    }
    ends.sort_by(|a, b| a.position().total_cmp(&b.position()));
    ends.dedup_by(|b, a| b.position() - a.position() < SAME_NODE);
    if !closed || ends.is_empty() {
        let [first, last] = [run.segments.first(), run.segments.last()];
        ends.insert(0, Node { segment: 0, t: 0.0, axis: first.and_then(|s| axis_of(s.from.away)) });
        ends.push(Node { segment: run.segments.len(), t: 0.0, axis: last.and_then(|s| axis_of(s.to.into)) });
    } else {
        ends.push(Node { segment: ends[0].segment + run.segments.len(), ..ends[0] });
    }
    let mut work = PlacedWork::default();
    // Between two nodes, pieces are chosen alike from either end.
    for w in ends.windows(2) {
        let stretch = finder.stretch_between(w[0], w[1])?;
        let proof = stretch.segments.first().is_some_and(RunSegment::is_provable);
        let own = OwnPieces::new(stretch.segments.len(), |i: usize, pieces: &mut Vec<Piece>, report: &mut Report| {
            let segment = &stretch.segments[i];
            let mut fitter = StretchFitter::new(&segment.source, &segment.slow, tolerance, (proof, 0.0), left);
            fitter.evenly = true;
            cover_far(&mut fitter, [&segment.from, &segment.to], SMOOTH_JOINT, pieces, report)?;
            work.evaluations += fitter.evaluations();
            Ok(())
        });
        memory.last_reach = 0;
        work.tried += fewest(&stretch, own, (tolerance, true), memory, pieces, report)?;
    }
    Ok(work)
}

/// Nodes on a run that are closer, in segments, are one.
const SAME_NODE: f64 = 1e-7;

/// Finds nodes on a run. Intervals between samples are numbered from the run's start by `k`; segments and their first joints by `j`. On
/// closed runs, numbers beyond the ends go on with the next round.
struct NodeFinder<'r, S> {
    run: &'r SegmentRun<S>,
    closed: bool,
}

impl<'r, S: Source> NodeFinder<'r, S> {
    /// Number of intervals between samples.
    fn intervals(&self) -> usize {
        self.run.segments.len() * self.run.per_segment
    }

    /// Change of a coordinate over an interval, relative to its length; zero if it is rounding.
    fn change(&self, c: Axis, k: isize) -> f64 {
        let k = k.rem_euclid(self.intervals() as isize) as usize;
        let v = if c == Axis::Horizontal { &self.run.x } else { &self.run.y };
        let (d, step) = (v[k + 1] - v[k], self.run.length[k + 1] - self.run.length[k]);
        if d.abs() <= ON_AXIS * step { 0.0 } else { d / step }
    }

    /// All smooth extremes: where the change of a coordinate changes its sign from one joint or interval to the next.
    fn extremes(&self) -> Result<Vec<Node>> {
        let (n, count) = (self.run.per_segment as isize, self.intervals() as isize);
        let segment = |j: isize| &self.run.segments[j.rem_euclid(count / n) as usize];
        let mut out = Vec::new();
        for c in [Axis::Horizontal, Axis::Vertical] {
            // Changes of the coordinate at joints and between samples, with the samples around. A joint at which the coordinate does
            // not change has a change on either side.
            let beside = |j: isize, t: f64| segment(j).source.eval(t).1.normalize().get_coord(c);
            let mut all: Vec<(isize, isize, f64)> = Vec::new();
            for k in 0..count {
                if k % n == 0 {
                    let (j, inside) = (k / n, BESIDE_JOINT / n as f64);
                    let slope = segment(j).from.away.get_coord(c);
                    if slope.abs() > ON_AXIS {
                        all.push((k, k, slope));
                    } else {
                        all.extend((self.closed || j > 0).then(|| (k, k, beside(j - 1, 1.0 - inside))));
                        all.push((k, k, beside(j, inside)));
                    }
                }
                all.push((k, k + 1, self.change(c, k)));
            }
            if !self.closed {
                let slope = segment(-1).to.into.get_coord(c);
                let is_on_axis = slope.abs() <= ON_AXIS;
                all.push((count, count, if is_on_axis { beside(-1, 1.0 - BESIDE_JOINT / n as f64) } else { slope }));
            }
            all.retain(|(.., change)| change.abs() > ON_AXIS);
            if let (true, Some(&(from, to, change))) = (self.closed, all.last()) {
                all.insert(0, (from - count, to - count, change));
            }
            for w in all.windows(2).filter(|w| w[0].2 * w[1].2 < 0.0) {
                let (from, to) = (w[0].0, w[1].1);
                out.extend(self.extreme(c, [from.min(to - 1), to], w[1].2)?);
            }
        }
        Ok(out)
    }

    /// The smooth extremes that lie on the bounding box of all.
    fn outermost(&self) -> Result<Vec<Node>> {
        let all = self.extremes()?;
        let points: Vec<Point> = all.iter().map(|p| self.run.segments[p.segment].source.eval(p.t).0).collect();
        let Some(first) = points.first() else { return Ok(all) };
        let b = points.iter().fold(kurbo::Rect::from_points(*first, *first), |b, p| b.union_pt(*p));
        let near = 1e-9 * (b.width() + b.height());
        let outer = |p: &Point| [p.x - b.x0, b.x1 - p.x, p.y - b.y0, b.y1 - p.y].into_iter().any(|d| d <= near);
        Ok(all.into_iter().zip(&points).filter(|(_, p)| outer(p)).map(|(node, _)| node).collect())
    }

    /// The nodes of the source that are its structure, moved to the nearest extreme if that is near.
    fn structure(&self) -> Result<Vec<Node>> {
        let mut out = Vec::new();
        for (j, segment) in self.run.segments.iter().enumerate() {
            if !segment.kept || (j == 0 && !self.closed) {
                continue;
            }
            let t = segment.from.away;
            let c = if t.y.abs() < t.x.abs() { Axis::Vertical } else { Axis::Horizontal };
            let joint = Node { segment: j, t: 0.0, axis: None };
            let slope = t.get_coord(c);
            out.push(if slope.abs() <= ON_AXIS {
                Node { axis: Some(axis_direction(t, c)), ..joint }
            } else if slope.abs() <= MOVED_TURN {
                self.nearby_extreme(j, c, slope)?.unwrap_or(joint)
            } else {
                joint
            });
        }
        Ok(out)
    }

    /// The extreme of a coordinate nearest to joint `j`, where the coordinate changes by `slope` for each unit of length. It is searched
    /// to both sides, up to the next kept node, as long as the curve is within [`MOVED_TURN`] of the axis.
    fn nearby_extreme(&self, j: usize, c: Axis, slope: f64) -> Result<Option<Node>> {
        let (n, count) = (self.run.per_segment as isize, self.intervals() as isize);
        let start = j as isize * n;
        let is_kept = |k: isize| k % n == 0 && self.run.segments[(k / n).rem_euclid(count / n) as usize].kept;
        let mut goes_on = [true; 2];
        let joint = self.run.segments[j].from.p;
        let from_joint = |p: &Node| self.run.segments[p.segment].source.eval(p.t).0.distance(joint);
        for far in 0..count {
            let mut found: Option<Node> = None;
            for (side, k) in [start + far, start - 1 - far].into_iter().enumerate() {
                if !goes_on[side] {
                    continue;
                }
                let is_on_run = self.closed || (0..count).contains(&k);
                let is_past_node = far > 0 && is_kept(if side == 0 { k } else { k + 1 });
                let change = if is_on_run && !is_past_node { self.change(c, k) } else { f64::INFINITY };
                goes_on[side] = change.abs() <= MOVED_TURN;
                if change * slope < 0.0 && goes_on[side] {
                    // The extreme is between the middles of this interval and of the one nearer to the joint.
                    let bracket = if side == 0 { [(k - 1).max(start), k + 1] } else { [k, (k + 2).min(start)] };
                    let other = self.extreme(c, bracket, if side == 0 { change } else { slope })?;
                    found = found.into_iter().chain(other).min_by(|p, q| from_joint(p).total_cmp(&from_joint(q)));
                }
            }
            if found.is_some() || goes_on == [false; 2] {
                return Ok(found);
            }
        }
        Ok(None)
    }

    /// The extreme of a coordinate between two samples, after which the coordinate changes with the sign of `after`. `None` if the
    /// derivatives show none.
    fn extreme(&self, c: Axis, [from, to]: [isize; 2], after: f64) -> Result<Option<Node>> {
        let (n, count) = (self.run.per_segment as isize, self.run.segments.len());
        let from = if self.closed { from } else { from.max(0) };
        for k in from..to {
            let index = k.div_euclid(n).rem_euclid(count as isize) as usize;
            let (segment, part) = (&self.run.segments[index], k.rem_euclid(n));
            if part == 0 && (self.closed || index > 0) && k > from {
                let [u, v] = [self.run.segments[(index + count - 1) % count].to.into, segment.from.away];
                let [a, b] = [u.get_coord(c) * after, v.get_coord(c) * after];
                if (a < 0.0 && b > 0.0) || a.abs().min(b.abs()) <= ON_AXIS * after.abs() {
                    return Ok(Some(Node { segment: index, t: 0.0, axis: Some(axis_direction(u + v, c)) }));
                }
            }
            let share = |k: isize| k as f64 / n as f64;
            if let Some((t, d)) = turning_point(&segment.source, (c, after), [share(part), share(part + 1)])? {
                let axis = Some(axis_direction(d, c));
                let node = match t {
                    _ if t < SAME_NODE => Node { segment: index, t: 0.0, axis },
                    _ if t > 1.0 - SAME_NODE => Node { segment: index + 1, t: 0.0, axis },
                    _ => return Ok(Some(Node { segment: index, t, axis })),
                };
                // The ends of an open run are no extremes.
                let is_end = !self.closed && node.segment.is_multiple_of(count);
                return Ok((!is_end).then_some(Node { segment: node.segment % count, ..node }));
            }
        }
        Ok(None)
    }

    /// The stretch between two nodes as a run. After the last segment, segments are counted from the first again.
    fn stretch_between(&self, from: Node, to: Node) -> Result<SegmentRun<Part<'r, S>>> {
        let (run, count) = (self.run, self.run.segments.len());
        let mut out = SegmentRun::new(true, to.segment + 1 - from.segment);
        (out.per_segment, out.grid) = (run.per_segment, run.per_segment / 2);
        let last = if to.t > 0.0 { to.segment } else { to.segment - 1 };
        for i in from.segment..=last {
            let segment = &run.segments[i % count];
            let end = |t: f64| match t {
                0.0 => Ok(segment.from),
                1.0 => Ok(segment.to),
                _ => segment.source.end(t),
            };
            let first = if i == from.segment { from } else { Node { t: 0.0, axis: None, ..from } };
            let second = if i == to.segment { to } else { Node { t: 1.0, axis: to.axis.filter(|_| i == last), ..to } };
            let held = |p: Node| end(p.t).map(|e| p.axis.map_or(e, |a| BreakPoint { into: a, away: a, ..e }));
            let part = Part::between(&segment.source, [held(first)?, held(second)?]);
            let form = if segment.form.is_some() { part.quotient().and_then(Quotient::provable) } else { None };
            let whole = first.t == 0.0 && second.t == 1.0;
            let samples = whole.then(|| run.samples_of(i % count));
            let mut over = segment.with_source(part, form, part.ends);
            over.slow = over.slow.map(|t| (t - first.t) / (second.t - first.t));
            out.push_sampled(over, samples)?;
        }
        Ok(out)
    }
}

/// Unit vector along the axis on which coordinate `c` does not change, in the direction of `v`.
fn axis_direction(v: Vec2, c: Axis) -> Vec2 {
    match c {
        Axis::Horizontal => Vec2::new(0.0, 1.0f64.copysign(v.y)),
        Axis::Vertical => Vec2::new(1.0f64.copysign(v.x), 0.0),
    }
}

/// Share of the interval between two samples at which the direction beside a joint is taken.
const BESIDE_JOINT: f64 = 1e-3;

/// Direction of the axis along which a unit vector is, to rounding.
fn axis_of(v: Vec2) -> Option<Vec2> {
    let constant = [Axis::Horizontal, Axis::Vertical].into_iter().find(|c| v.get_coord(*c).abs() <= ON_AXIS);
    constant.map(|c| axis_direction(v, c))
}

/// Parameter between two at which the derivative of a coordinate changes its sign to the sign of `after`, and the derivative, by the
/// Illinois method.
fn turning_point<S: Source>(
    source: &S,
    (c, after): (Axis, f64),
    [mut a, mut b]: [f64; 2],
) -> Result<Option<(f64, Vec2)>> {
    let at = |t: f64| {
        let (p, d) = source.eval(t);
        if d.is_finite() { Ok((d.get_coord(c) / d.hypot(), d)) } else { Err(NotFinite { t, at: p }) }
    };
    let ((mut fa, da), (mut fb, db)) = (at(a)?, at(b)?);
    // An end at which the direction is far below `ON_AXIS` is an extreme: the wanted one, or one to the other side close to it.
    let aside = BESIDE_JOINT * (b - a);
    if fa.abs() <= ON_AXIS * 1e-3 {
        let f = at(a + aside)?.0;
        if f * after > 0.0 {
            return Ok(Some((a, da)));
        }
        (a, fa) = (a + aside, f);
    }
    if fb.abs() <= ON_AXIS * 1e-3 {
        let f = at(b - aside)?.0;
        if f * after < 0.0 {
            return Ok(Some((b, db)));
        }
        (b, fb) = (b - aside, f);
    }
    if !(fa * fb < 0.0 && fb * after > 0.0) {
        return Ok(None);
    }
    for _ in 0..60 {
        let t = (a * fb - b * fa) / (fb - fa);
        if !t.is_finite() {
            return Ok(None);
        }
        let (f, d) = at(t)?;
        if f.abs() < 1e-12 {
            return Ok(Some((t, d)));
        }
        if f * fb < 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (t, f);
    }
    // At a cusp, the direction jumps.
    let (f, d) = at(b)?;
    Ok((f.abs() <= ON_AXIS).then_some((b, d)))
}

/// Most pieces found by quantiles of the difficulty; stretches that take more are searched from both ends.
const MAX_QUANTILES: usize = 2 * MAX_PLANNED;

/// Largest error ÷ tolerance that predicts a number of pieces: four to the sixth power, for four pieces.
const MAX_PREDICTIVE: f64 = 4096.0;

impl<S: Source, F: FitOwn> Reaches<'_, S, F> {
    /// Legs with few pieces of about equal difficulty, chosen alike from either end. `None` if the segments have fewer pieces.
    pub(crate) fn even(&mut self) -> Result<Option<Vec<PassedLeg>>> {
        let last = self.last();
        let (mut n, mut placements, mut searched) = (1, 0, false);
        let mut ends = vec![0, last];
        loop {
            if n > self.own.segments() && n > self.own.total()? {
                return Ok(None);
            }
            let (mut fits, mut sums) = (true, vec![0.0]);
            for (i, w) in ends.windows(2).enumerate() {
                let error = self.error(w[0], w[1])?.clamp(1e-4, MAX_PREDICTIVE);
                sums.push(sums[i] + error.powf(1.0 / 6.0));
                fits &= error <= 1.0;
            }
            if fits {
                let legs: Vec<Leg> = ends.windows(2).map(|w| Leg { from: w[0], to: w[1], merged: true }).collect();
                if let Some(found) = self.pieces_of(&legs)? {
                    return Ok(Some(found));
                }
            }
            placements += 1;
            let mut next = n;
            if sums[n] > n as f64 * HOPELESS || placements >= PLACEMENTS {
                next = (n + 1).max((sums[n] * TRUSTED).ceil() as usize);
                placements = 0;
            }
            if next > MAX_QUANTILES && !searched {
                searched = true;
                if let Some(found) = self.middles()? {
                    (n, ends) = (found.len() - 1, found);
                    continue;
                }
            }
            let quantiles = if next <= MAX_QUANTILES { self.quantiles(&ends, &sums, next) } else { None };
            let Some(quantiles) = quantiles else {
                return if self.own.total()? <= next { Ok(None) } else { self.fewest() };
            };
            (ends, n) = (quantiles, next);
        }
    }

    /// Grid points that divide the difficulty into equal parts. `sums` are the sums of the difficulty up to the grid points `ends`.
    /// `None` if two of the results coincide.
    fn quantiles(&self, ends: &[usize], sums: &[f64], parts: usize) -> Option<Vec<usize>> {
        let (n, last) = (ends.len() - 1, self.last());
        let mut out = vec![0];
        for i in 1..parts {
            let quantile = sums[n] * i as f64 / parts as f64;
            let leg = (1..n).find(|k| sums[*k] >= quantile).unwrap_or(n);
            let [a, b] = [ends[leg - 1], ends[leg]].map(|k| self.run.length_at(k));
            let length = a + (b - a) * (quantile - sums[leg - 1]) / (sums[leg] - sums[leg - 1]);
            let next = self.nearest_grid_point(length, [out[i - 1], last - 1]);
            if next == out[i - 1] || next == last {
                return None;
            }
            out.push(next);
        }
        out.push(last);
        Some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::MergeSettings;
    use crate::path::Segment;
    use kurbo::{Line, PathSeg};

    /// Where nearly all difficulty lies before the last grid point, several quantiles are nearest to it.
    #[test]
    fn quantiles_do_not_leave_the_run() {
        let mut run = SegmentRun::new(true, 2);
        for x in [0.0, 1.0] {
            let source = Segment::new(PathSeg::Line(Line::new((x, 0.0), (x + 1.0, 0.0))));
            let ends = [source.end(0.0).unwrap(), source.end(1.0).unwrap()];
            assert!(run.push(RunSegment::new(source, None, ends, true)).unwrap());
        }
        let own = OwnPieces::new(2, |_: usize, _: &mut Vec<Piece>, _: &mut Report| Ok(()));
        let settings = MergeSettings { tolerance: 0.1, proof: false, marks: false, again: false, evenly: true };
        let mut memory = ReachMemory::default();
        let reaches = Reaches::new(&run, own, settings, &mut memory);
        let last = reaches.last();
        assert_eq!(reaches.quantiles(&[0, last - 1, last], &[0.0, 0.1, 8.1], 8), None);
        assert_eq!(reaches.quantiles(&[0, last], &[0.0, 2.0], 2), Some(vec![0, last / 2, last]));
    }
}
