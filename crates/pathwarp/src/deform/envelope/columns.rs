//! A closed path filled in columns: verticals stay vertical between its lower outline b and its upper outline t.
//!
//! > (u, v) ↦ (x, b(x) + v·(t(x) − b(x))), x linear in u between the ends
//!
//! Every vertical line meets the inside in intervals. The columns are a sequence of adjacent intervals from left to right, with the
//! largest area; short thin ends beyond a jump are cut off. Where the outline jumps from one height to another, the lower height
//! continues level, or a slope leads to the greater one. Rows are the columns of the path with x and y exchanged. In what follows, the
//! low end of an interval is the one of smaller y, which is the upper one on the screen.

use super::fit::{SAMPLES, bounds, part, preview, reversed, to_unit};
use crate::deform::entry::{Built, Role};
use crate::error::{Error, show};
use crate::map::{AffineMap, Coons, Pace, Side, Sides, increasing_root};
use crate::outline::{Outline, Seg, Subpath};
use kurbo::{Affine, Line, Point, Rect, Size, StrokeOpts, common::solve_quadratic};
use std::f64::consts::PI;
use std::sync::Arc;

/// Least number of columns across a shape.
const COLUMNS: f64 = 600.0;
/// The slope after a jump, in heights of the shape per width.
const RAMP: f64 = 2.0;
/// Curves continue level after a jump, where letters stand better, if that keeps at least this share of the area left by slopes.
const LEVEL: f64 = 0.75;
/// Jumps below this share of the height are rounding.
const JUMP: f64 = 1e-6;
/// Exchanges x and y.
const TRANSPOSED: Affine = Affine::new([0.0, 1.0, 1.0, 0.0, 0.0, 0.0]);

/// The parts of a shape that artwork leaves free.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::deform) struct Margins {
    /// The artwork ends in columns lower than this share of the greatest height.
    pub(super) ends: f64,
    /// The distance between the artwork and the outline.
    pub(super) padding: f64,
}

/// A shape in columns, or in rows: two curves that face one another over a common range.
pub(super) struct Columns {
    /// The curves: bottom and top from left to right, or left and right upwards.
    pub(super) curves: [Vec<Seg>; 2],
    /// The range of the artwork, as shares of the curves' range.
    pub(super) range: [f64; 2],
    /// Points at which the outline jumps, in the order found.
    pub(super) jumps: Vec<Point>,
    /// The share of the shape's area that the columns hold.
    pub(super) coverage: f64,
}

/// A piece of an outline that runs to the right.
struct Piece {
    seg: Seg,
    from: f64,
    to: f64,
    /// `true` if it was drawn to the left.
    runs_left: bool,
    /// `true` if it bounds the band that `padding` keeps free, instead of the shape.
    bounds_band: bool,
}

/// A part of a piece: the piece's index and a range of x.
#[derive(Clone, Copy)]
struct Span {
    piece: usize,
    from: f64,
    to: f64,
}

/// An interval of a vertical line: the pieces at its ends, in the order of y, and the ordinates there.
#[derive(Clone, Copy)]
struct Interval {
    ends: [usize; 2],
    ys: [f64; 2],
}

impl Interval {
    fn height(&self) -> f64 {
        self.ys[1] - self.ys[0]
    }

    fn overlaps(&self, o: &Self) -> bool {
        self.ys[1].min(o.ys[1]) > self.ys[0].max(o.ys[0])
    }
}

/// A vertical line.
struct VerticalLine {
    x: f64,
    /// The neighbouring ends of pieces on both sides.
    between: [f64; 2],
    /// The width of the column that it represents.
    width: f64,
    intervals: Vec<Interval>,
}

impl Columns {
    /// Fills a closed path in columns, or in rows unless `upright`. `None` if the margins leave nothing.
    pub(super) fn new(shape: &Subpath, upright: bool, margins: &Margins) -> Option<Self> {
        // The transposition is its own inverse.
        let turn = if upright { Affine::IDENTITY } else { TRANSPOSED };
        let mut region = Region::new(shape, turn, margins.padding)?;
        let lines = region.lines();
        let chosen = largest_sequence(&lines)?;
        let area: f64 = lines.iter().map(|l| l.width * l.intervals.iter().map(Interval::height).sum::<f64>()).sum();
        let mut curves = [0, 1].map(|end| region.trace(&chosen, end));
        region.trim(&mut curves);
        let sloping = region.smoothed(curves.clone(), RAMP)?;
        let level = region.smoothed(curves, 0.0).filter(|l| l.area >= LEVEL * sloping.area);
        let best = level.unwrap_or(sloping);
        let SmoothCurves { curves: [low, high], jumps, heights, area: held } = &best;
        let (from, to) = (low.first()?.from, low.last()?.to);
        let least = margins.ends * heights.iter().map(|h| h.1).fold(0.0, f64::max);
        let excess = |x: f64| region.y_at(high, x) - region.y_at(low, x) - least;
        let step = (to - from) / heights.len() as f64;
        // Extends an end of a run outwards to where the shape is just high enough.
        let extended = |end: f64, by: f64| {
            let beyond = (end + by).clamp(from, to);
            if excess(beyond) >= 0.0 { beyond } else { bisect(beyond, end, excess) }
        };
        // Lettering does not run through a waist.
        let runs = heights.chunk_by(|a, b| (a.1 >= least) == (b.1 >= least));
        let size = |run: &[(f64, f64)]| run.iter().map(|h| h.1).sum::<f64>();
        let run = runs.filter(|r| r[0].1 >= least).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        let (first, last) = (run[0].0, run[run.len() - 1].0);
        let range = [extended(first, -step), extended(last, step)].map(|x| (x - from) / (to - from));
        let turned_back = |c: &[Span]| -> Vec<Seg> { region.segments(c).iter().map(|s| s.transformed(turn)).collect() };
        let (low, high) = (turned_back(low), turned_back(high));
        Some(Self {
            curves: if upright { [high, low] } else { [low, high].map(|c| reversed(&c)) },
            range: if upright { range } else { [1.0 - range[1], 1.0 - range[0]] },
            jumps: jumps.iter().map(|p| turn * *p).collect(),
            coverage: held / area,
        })
    }
}

/// Two curves without jumps, the low one and the high one.
struct SmoothCurves {
    curves: [Vec<Span>; 2],
    /// Points at which slopes begin.
    jumps: Vec<Point>,
    /// Heights between the curves, at equal steps of x: (x, height).
    heights: Vec<(f64, f64)>,
    area: f64,
}

/// The inside of outlines, as their pieces.
pub(super) struct Region {
    pieces: Vec<Piece>,
    pub(super) bounds: Rect,
}

impl Region {
    /// Creates the inside of a closed path after `turn`, without a band of width `padding` along its outline.
    pub(super) fn new(shape: &Subpath, turn: Affine, padding: f64) -> Option<Self> {
        let segs: Vec<Seg> = shape.segs.iter().map(|s| s.transformed(turn)).collect();
        let bounds = segs.iter().map(Seg::bounding_box).reduce(|a, b| a.union(b))?;
        let mut region = Self { pieces: Vec::new(), bounds };
        region.add(&segs, false);
        if padding > 0.0 {
            region.add(&padding_band(&segs, padding, bounds), true);
        }
        Some(region)
    }

    /// Returns the intervals of a vertical line that are inside, in the order of y.
    pub(super) fn spans(&self, x: f64) -> Vec<[f64; 2]> {
        self.intervals(&self.pieces_at(x), x).iter().map(|v| v.ys).collect()
    }

    /// Returns the indices of the pieces that a vertical line crosses.
    fn pieces_at(&self, x: f64) -> Vec<usize> {
        (0..self.pieces.len()).filter(|i| (self.pieces[*i].from..self.pieces[*i].to).contains(&x)).collect()
    }

    /// Adds an outline, cut where its direction along x changes.
    fn add(&mut self, segs: &[Seg], bounds_band: bool) {
        for s in segs {
            let mut ts = vertical_tangents(s);
            ts.retain(|t| *t > 1e-9 && *t < 1.0 - 1e-9);
            ts.sort_by(f64::total_cmp);
            ts.insert(0, 0.0);
            ts.push(1.0);
            for t in ts.windows(2) {
                let part = part(s, t[0], t[1]);
                let (a, b) = (part.start().x, part.end().x);
                if (b - a).abs() > 1e-12 * self.bounds.width() {
                    let runs_left = b < a;
                    let seg = if runs_left { part.reversed() } else { part };
                    self.pieces.push(Piece { seg, from: a.min(b), to: a.max(b), runs_left, bounds_band });
                }
            }
        }
    }

    /// Returns vertical lines from left to right, with at least one between any two neighbouring ends of pieces.
    fn lines(&self) -> Vec<VerticalLine> {
        let mut events: Vec<f64> = self.pieces.iter().flat_map(|p| [p.from, p.to]).collect();
        events.sort_by(f64::total_cmp);
        events.dedup_by(|b, a| *b - *a <= 1e-11 * self.bounds.width());
        let mut out = Vec::new();
        for e in events.windows(2) {
            let middle = 0.5 * (e[0] + e[1]);
            let here = self.pieces_at(middle);
            let n = (COLUMNS * (e[1] - e[0]) / self.bounds.width()).ceil().max(1.0);
            let width = (e[1] - e[0]) / n;
            for i in 0..n as u32 {
                let x = e[0] + (f64::from(i) + 0.5) * width;
                out.push(VerticalLine { x, between: [e[0], e[1]], width, intervals: self.intervals(&here, x) });
            }
        }
        out
    }

    /// Returns the intervals of a vertical line that are inside the shape and outside the band. The line crosses the pieces `here`.
    fn intervals(&self, here: &[usize], x: f64) -> Vec<Interval> {
        let mut crossings: Vec<(f64, usize)> = here.iter().map(|i| (self.pieces[*i].y(x), *i)).collect();
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        // The winding numbers of both outlines.
        let (mut shape, mut band, mut start, mut out) = (0, 0, None, Vec::new());
        for (y, i) in crossings {
            let p = &self.pieces[i];
            let winding = if p.bounds_band { &mut band } else { &mut shape };
            *winding += if p.runs_left { -1 } else { 1 };
            match (shape != 0 && band == 0, start) {
                (true, None) => start = Some((y, i)),
                (false, Some((from, first))) => {
                    out.push(Interval { ends: [first, i], ys: [from, y] });
                    start = None;
                }
                _ => {}
            }
        }
        out.retain(|v| v.height() > 0.0);
        out
    }

    /// Returns the low (0) or high (1) ends of the chosen intervals as parts of pieces.
    fn trace(&self, chosen: &[(&VerticalLine, Interval)], end: usize) -> Vec<Span> {
        let mut out: Vec<Span> = Vec::new();
        let (first, last) = (&chosen[0], &chosen[chosen.len() - 1]);
        let mut from = self.outer_end(first, first.0.between[0]);
        for w in chosen.windows(2) {
            let ((l, a), (m, b)) = (&w[0], &w[1]);
            let (i, j) = (a.ends[end], b.ends[end]);
            if i != j {
                // One piece follows the other where one of them ends, or where they cross.
                let event = l.between[1];
                let is_event = |x: f64| (x - event).abs() <= 1e-10 * self.bounds.width();
                let over = |x: f64| self.pieces[i].y(x) - self.pieces[j].y(x);
                let ends_here =
                    l.between != m.between && (is_event(self.pieces[i].to) || is_event(self.pieces[j].from));
                let to = if ends_here { event } else { bisect(l.x, m.x, |x| over(x) * over(m.x)) };
                out.push(Span { piece: i, from, to });
                from = to;
            }
        }
        out.push(Span { piece: last.1.ends[end], from, to: self.outer_end(last, last.0.between[1]) });
        out
    }

    /// Returns the x at which an outermost interval ends: the neighbouring event, or a crossing of its two pieces before that.
    fn outer_end(&self, (line, v): &(&VerticalLine, Interval), event: f64) -> f64 {
        let height = |x: f64| self.pieces[v.ends[1]].y(x) - self.pieces[v.ends[0]].y(x);
        if height(event) >= -1e-9 * self.bounds.height() { event } else { bisect(event, line.x, height) }
    }

    /// Cuts off short and thin ends of two curves beyond a jump or a steep step.
    fn trim(&self, curves: &mut [Vec<Span>; 2]) {
        /// Greatest length of an end, as a share of the range.
        const SHORT: f64 = 0.25;
        /// Greatest height of an end, as a share of the height on the other side: beyond a jump, and beyond a steep step.
        const THIN_AT_JUMP: f64 = 0.55;
        const THIN_AT_STEP: f64 = 0.85;
        /// Heights at a step are compared at this share of its distance from the end, on both sides.
        const BESIDE: f64 = 0.25;
        let (start, stop) = (curves[0][0].from, curves[0][curves[0].len() - 1].to);
        for right in [false, true] {
            let mut steps: Vec<(f64, bool)> = Vec::new();
            for w in curves.iter().flat_map(|c| c.windows(2)) {
                let y = |s: &Span, x: f64| self.pieces[s.piece].y(x);
                let jump = (y(&w[0], w[0].to) - y(&w[1], w[1].from)).abs() > JUMP * self.bounds.height();
                let (outer, x) = if right { (&w[1], w[1].from) } else { (&w[0], w[0].to) };
                let p = &self.pieces[outer.piece];
                let v = p.seg.deriv(p.parameter(x));
                let is_steep = v.x.abs() <= 1e-6 * v.y.abs();
                if jump || is_steep {
                    steps.push((w[0].to, jump));
                }
            }
            let beyond = |x: f64| if right { stop - x } else { x - start };
            steps.retain(|s| beyond(s.0) <= SHORT * (stop - start));
            steps.sort_by(|a, b| beyond(b.0).total_cmp(&beyond(a.0)));
            let height = |x: f64| self.y_at(&curves[1], x) - self.y_at(&curves[0], x);
            let cut = steps.into_iter().find(|(x, jump)| {
                let aside = if *jump { 1e-6 * (stop - start) } else { BESIDE * beyond(*x) };
                let aside = if right { aside } else { -aside };
                height(x + aside) <= if *jump { THIN_AT_JUMP } else { THIN_AT_STEP } * height(x - aside)
            });
            let Some((x, _)) = cut else { continue };
            for c in curves.iter_mut() {
                c.retain(|s| if right { s.from < x } else { s.to > x });
                for s in c.iter_mut() {
                    (s.from, s.to) = if right { (s.from, s.to.min(x)) } else { (s.from.max(x), s.to) };
                }
            }
        }
    }

    /// Replaces the jumps of two curves by slopes, in heights of the shape per width. `None` if the curves meet.
    fn smoothed(&mut self, mut curves: [Vec<Span>; 2], slope: f64) -> Option<SmoothCurves> {
        let mut jumps = Vec::new();
        for (curve, sign) in curves.iter_mut().zip([-1.0, 1.0]) {
            self.smooth(curve, sign, slope, &mut jumps);
        }
        let [low, high] = &curves;
        let (from, to) = (low.first()?.from, low.last()?.to);
        // In the middles of equal parts of the range.
        let xs = (0..COLUMNS as u32).map(|i| from + (to - from) * (f64::from(i) + 0.5) / COLUMNS);
        let heights: Vec<(f64, f64)> = xs.map(|x| (x, self.y_at(high, x) - self.y_at(low, x))).collect();
        let area = heights.iter().map(|h| h.1).sum::<f64>() * (to - from) / heights.len() as f64;
        heights.iter().all(|h| h.1 > 0.0).then_some(SmoothCurves { curves, jumps, heights, area })
    }

    /// Replaces the jumps of a curve by slopes; `sign` is −1 for the low and 1 for the high curve.
    fn smooth(&mut self, curve: &mut Vec<Span>, sign: f64, slope: f64, jumps: &mut Vec<Point>) {
        /// Limit on the jumps, as a slope may meet another one.
        const MAX_JUMPS: usize = 100;
        for _ in 0..MAX_JUMPS {
            // Ordinates count from the inside of the shape outwards.
            let outward = |region: &Self, s: &Span, x: f64| sign * region.pieces[s.piece].y(x);
            let jump = curve.windows(2).enumerate().find_map(|(i, w)| {
                let (a, b) = (outward(self, &w[0], w[0].to), outward(self, &w[1], w[1].from));
                ((a - b).abs() > JUMP * self.bounds.height()).then_some((i, w[0].to, a, b))
            });
            let Some((i, x, a, b)) = jump else { return };
            let start = Point::new(x, sign * a.min(b));
            jumps.push(start);
            // The slope runs outwards into the higher part, until it leaves it.
            let (right, slope) = (b > a, slope * self.bounds.height() / self.bounds.width());
            let mut higher: Vec<Span> = if right { curve.split_off(i + 1) } else { curve.drain(..=i).rev().collect() };
            let line = |x1: f64| sign * start.y + slope * (x1 - x).abs();
            let mut meeting = higher.last().map_or(x, |s| if right { s.to } else { s.from });
            let mut first_kept = higher.len();
            for (k, s) in higher.iter_mut().enumerate() {
                let (near, far) = if right { (s.from, s.to) } else { (s.to, s.from) };
                let over = |x1: f64| outward(self, s, x1) - line(x1);
                let sample = |n: u32| near + (far - near) * f64::from(n) / f64::from(SAMPLES);
                let first = u32::from(k == 0);
                let Some(n) = (first..=SAMPLES).find(|n| over(sample(*n)) <= 0.0) else { continue };
                meeting = if n == 0 { near } else { bisect(sample(n - 1), sample(n), over) };
                *if right { &mut s.from } else { &mut s.to } = meeting;
                first_kept = k;
                break;
            }
            let seg = Seg::Line(Line::new(start, (meeting, sign * line(meeting))));
            let seg = if right { seg } else { seg.reversed() };
            let (from, to) = (x.min(meeting), x.max(meeting));
            let ramp = Span { piece: self.pieces.len(), from, to };
            self.pieces.push(Piece { seg, from, to, runs_left: false, bounds_band: false });
            let kept = higher.into_iter().skip(first_kept).filter(|s| s.to > s.from);
            if right {
                curve.push(ramp);
                curve.extend(kept);
            } else {
                let kept: Vec<Span> = kept.collect();
                curve.splice(0..0, kept.into_iter().rev().chain([ramp]));
            }
        }
    }

    /// Returns the y of a curve at `x`.
    fn y_at(&self, curve: &[Span], x: f64) -> f64 {
        let k = curve.partition_point(|s| s.to < x).min(curve.len() - 1);
        self.pieces[curve[k].piece].y(x)
    }

    /// Returns the segments of a curve.
    fn segments(&self, curve: &[Span]) -> Vec<Seg> {
        let segment = |s: &Span| {
            let p = &self.pieces[s.piece];
            part(&p.seg, p.parameter(s.from), p.parameter(s.to))
        };
        let mut out: Vec<Seg> = curve.iter().filter(|s| s.to > s.from).map(segment).collect();
        // Neighbours must meet to the last bit.
        for k in 1..out.len() {
            out[k - 1] = crate::anchors::ending_at(&out[k - 1], out[k].start());
        }
        out
    }
}

impl Piece {
    /// Returns the parameter of the piece at `x`.
    fn parameter(&self, x: f64) -> f64 {
        if x <= self.from || x >= self.to {
            return if x <= self.from { 0.0 } else { 1.0 };
        }
        let share = (x - self.from) / (self.to - self.from);
        match self.seg {
            Seg::Line(_) => share,
            s => increasing_root(
                (0.0, 1.0),
                share,
                |t| (s.eval(t).x - x, s.deriv(t).x),
                |t, _, step: f64| step.abs() <= f64::EPSILON * t,
            ),
        }
    }

    fn y(&self, x: f64) -> f64 {
        self.seg.eval(self.parameter(x)).y
    }
}

/// Returns the sequence of adjacent intervals from left to right that has the largest area.
fn largest_sequence(lines: &[VerticalLine]) -> Option<Vec<(&VerticalLine, Interval)>> {
    // For every interval, the largest area of a sequence that begins with it, and the next interval of that sequence.
    let mut best: Vec<Vec<(f64, Option<usize>)>> = vec![Vec::new(); lines.len()];
    for k in (0..lines.len()).rev() {
        let with_next = |v: &Interval| {
            let next = lines.get(k + 1).into_iter().flat_map(|l| l.intervals.iter().enumerate());
            let next = next.filter(|(_, w)| v.overlaps(w)).map(|(j, _)| (best[k + 1][j].0, j));
            let next = next.max_by(|a, b| a.0.total_cmp(&b.0));
            (lines[k].width * v.height() + next.map_or(0.0, |n| n.0), next.map(|n| n.1))
        };
        best[k] = lines[k].intervals.iter().map(with_next).collect();
    }
    let starts = best.iter().enumerate().flat_map(|(k, b)| b.iter().enumerate().map(move |(i, v)| (v.0, k, i)));
    let (_, mut k, first) = starts.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let (mut out, mut next) = (Vec::new(), Some(first));
    while let Some(i) = next {
        out.push((&lines[k], lines[k].intervals[i]));
        next = best[k][i].1;
        k += 1;
    }
    Some(out)
}

/// Returns the outline of the band that `padding` keeps free along an outline.
fn padding_band(segs: &[Seg], padding: f64, bounds: Rect) -> Vec<Seg> {
    let tolerance = 1e-5 * (bounds.width() + bounds.height());
    let start = segs.first().map_or(Point::ORIGIN, Seg::start);
    let outline = Outline { subpaths: vec![Subpath { start, segs: segs.to_vec(), closed: true }] };
    let style = kurbo::Stroke::new(2.0 * padding);
    let stroke = kurbo::stroke(outline.to_bez_path(tolerance), &style, &StrokeOpts::default(), tolerance);
    Outline::from(&stroke).segs().copied().collect()
}

/// Returns the parameters at which a segment's direction along x may change.
fn vertical_tangents(s: &Seg) -> Vec<f64> {
    match s {
        Seg::Line(_) => Vec::new(),
        Seg::Quad(q) => {
            let (a, b) = (q.p1.x - q.p0.x, q.p2.x - q.p1.x);
            vec![a / (a - b)]
        }
        Seg::Cubic(c) => {
            let (a, b, d) = (c.p1.x - c.p0.x, c.p2.x - c.p1.x, c.p3.x - c.p2.x);
            solve_quadratic(a, 2.0 * (b - a), a - 2.0 * b + d).to_vec()
        }
        Seg::Arc(e) => {
            let angle = e.b.x.atan2(e.a.x);
            // All half turns near the arc, on both sides of its start.
            let halves = ((e.start - angle) / PI).floor() as i32;
            (-3..=4).map(|k| (angle + PI * f64::from(halves + k) - e.start) / e.sweep).collect()
        }
    }
}

/// Returns the zero between `a` and `b` of a function that is positive at one end only.
pub(super) fn bisect(mut a: f64, mut b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let rising = f(b) > 0.0;
    // Sixty halvings exhaust double precision.
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        if (f(middle) > 0.0) == rising { b = middle } else { a = middle }
    }
    0.5 * (a + b)
}

/// Returns the error for a shape of which the margins leave nothing.
pub(super) fn no_room(shape: &Subpath) -> Error {
    let Size { width, height } = bounds(shape).size();
    let problem =
        format!("leaves no room: the shape is {width:.6} × {height:.6}; take less `padding` or smaller `ends`");
    Error::usage("envelope", "the shape", problem)
}

/// Builds the map of a box into the columns (or the rows) of a closed path.
pub(super) fn fill(frame: Rect, shape: &Subpath, upright: bool, margins: &Margins) -> Result<Built, Error> {
    let c = Columns::new(shape, upright, margins).ok_or_else(|| no_room(shape))?;
    let pace = if upright { Pace::Width } else { Pace::Height };
    let [a, b] = c.curves.each_ref().map(|s| Side::new(s, pace));
    let (Some(a), Some(b)) = (a, b) else { return Err(no_room(shape)) };
    let ([a0, a1], [b0, b1]) = (a.ends(), b.ends());
    let (first, last) = (Side::straight(a0, b0), Side::straight(a1, b1));
    let [from, to] = c.range;
    let (to_range, sides) = if upright {
        let to_range = Affine::new([to - from, 0.0, 0.0, 1.0, from, 0.0]);
        (to_range, Sides { bottom: a, top: b, left: first, right: last })
    } else {
        let to_range = Affine::new([1.0, 0.0, 0.0, to - from, 0.0, from]);
        (to_range, Sides { left: a, right: b, bottom: first, top: last })
    };
    let mut built = Built::new(Arc::new(AffineMap::IDENTITY));
    let (what, lines) = if upright { ("columns", "verticals") } else { ("rows", "horizontals") };
    let (length, axis) = if upright { ("height", "x") } else { ("width", "y") };
    let coordinate = |p: Point| if upright { p.x } else { p.y };
    let [first, last] = c.range.map(|s| coordinate(a0) + s * (coordinate(a1) - coordinate(a0)));
    let ends = 100.0 * margins.ends;
    built.note(format!(
        "filled in {what}, {lines} kept: from {axis} = {first:.6} to {last:.6}, where the shape is still {ends:.0} % of its greatest \
{length}"
    ));
    if margins.padding == 0.0 && c.coverage < 1.0 - 1e-3 {
        let held = 100.0 * c.coverage;
        built.note(format!("the {what} hold {held:.0} % of the shape: elsewhere such lines would leave it"));
    }
    if !c.jumps.is_empty() {
        let jumps = c.jumps.iter().map(|p| show(*p)).collect::<Vec<_>>().join(" and ");
        built.warn(format!(
            "envelope: the outline jumps at {jumps}, where no {what} can follow it: part of the shape stays empty there; `--keep nothing` \
bends the artwork round instead"
        ));
    }
    built.overlay(Role::Cage, preview(shape));
    built.map = Coons::new(sides, to_range * to_unit(frame)).simplest();
    Ok(built)
}
