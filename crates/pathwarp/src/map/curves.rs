//! Boundary curves of maps, with a choice of parameter.

use crate::outline::Seg;
use kurbo::{CubicBez, Line, ParamCurve, Point, Vec2};
use std::array::from_fn;
use std::f64::consts::PI;

/// The number of steps of an iteration; as many bisections exhaust double precision.
const MAX_STEPS: usize = 60;

/// Finds the root of an increasing function between `lo` and `hi`, from `start`, by Newton iteration that halves the bracket where a step
/// would leave it. `f` returns the value and the slope; `is_close` gets the argument, the value there and the next step.
pub(crate) fn increasing_root(
    (mut lo, mut hi): (f64, f64),
    start: f64,
    f: impl Fn(f64) -> (f64, f64),
    is_close: impl Fn(f64, f64, f64) -> bool,
) -> f64 {
    let mut x = start;
    for _ in 0..MAX_STEPS {
        let (value, slope) = f(x);
        let step = value / slope;
        // Test for convergence before updating the bracket, which rounding would make too small.
        if is_close(x, value, step) {
            break;
        }
        if value > 0.0 {
            hi = x;
        } else {
            lo = x;
        }
        x = if x - step > lo && x - step < hi { x - step } else { 0.5 * (lo + hi) };
    }
    x
}

// The inverse of arc length: from the distance along a curve to its parameter, to full precision.
//
// On each span of the parameter the speed |C'| is interpolated at Chebyshev points; the series is integrated term by term to the arc
// length s(u), whose inverse u(s) is interpolated at Chebyshev points in turn (Trefethen, *Approximation Theory and Approximation
// Practice*, 2013, chapters 2–4 and 19). A span on which one of the series does not converge is halved. A lookup is one binary search and
// one polynomial, and its slope is exactly 1/|C'(u)|.

/// The number of terms of a series.
const TERMS: usize = 16;
/// The largest magnitude of the last terms of a converged series: the error of the parameter, which runs from 0 to 1.
const TAIL: f64 = 2e-14;
/// The largest magnitude of the last terms of the integrated speed, relative to the whole length.
const INTEGRATION_TOLERANCE: f64 = 1e-14;
/// The number of nested halvings, enough to resolve a cusp to double precision.
const MAX_DEPTH: usize = 48;
/// The number of spans of a curve.
const MAX_SPANS: usize = 2000;

/// The inverse of a curve's arc length, as a table.
#[derive(Debug, Clone)]
pub(crate) struct ArcLength {
    spans: Vec<Span>,
}

/// A part of the parameter range on which both series converge.
#[derive(Debug, Clone)]
struct Span {
    /// The distances along the curve at the ends of the span.
    s0: f64,
    s1: f64,
    /// The coefficients of u over [s0, s1] in powers of t = −1…1. Series that converge within so few terms are as exact in this basis.
    u: [f64; TERMS],
}

impl ArcLength {
    /// Tabulates a curve over [0, 1] with speed |C'|.
    pub(crate) fn new(speed: &dyn Fn(f64) -> f64) -> Self {
        /// The number of equal parts from which the length is estimated.
        const PARTS: u32 = 4;
        let points = ChebyshevPoints::new();
        let part =
            |i: u32| Speed::new(speed, f64::from(i) / f64::from(PARTS), f64::from(i + 1) / f64::from(PARTS), &points);
        let rough: f64 = (0..PARTS).map(|i| part(i).length()).sum();
        let mut spans = Vec::new();
        let mut todo = vec![(0.0, 1.0, 0)];
        let mut distance = 0.0;
        // Depth first, left before right, so that distances accumulate in order.
        while let Some((a, b, depth)) = todo.pop() {
            let at_limit = depth >= MAX_DEPTH || spans.len() + todo.len() >= MAX_SPANS;
            let span = Speed::new(speed, a, b, &points);
            if at_limit || span.tail() <= INTEGRATION_TOLERANCE * rough {
                let c = span.inverse(&points);
                if at_limit || c[TERMS - 2].abs() + c[TERMS - 1].abs() <= TAIL {
                    let length = span.length();
                    spans.push(Span { s0: distance, s1: distance + length, u: powers(&c) });
                    distance += length;
                    continue;
                }
            }
            let middle = 0.5 * (a + b);
            todo.push((middle, b, depth + 1));
            todo.push((a, middle, depth + 1));
        }
        Self { spans }
    }

    /// Tabulates a segment.
    pub(crate) fn of_segment(seg: &Seg) -> Self {
        Self::new(&|u| seg.deriv(u).hypot())
    }

    /// The whole length.
    pub(crate) fn length(&self) -> f64 {
        self.spans.last().map_or(0.0, |s| s.s1)
    }

    /// The parameter at distance `s`, in [0, 1].
    pub(crate) fn parameter(&self, s: f64) -> f64 {
        let i = self.spans.partition_point(|span| span.s1 < s).min(self.spans.len() - 1);
        let span = &self.spans[i];
        let size = span.s1 - span.s0;
        if size <= 0.0 {
            return span.u[0];
        }
        let t = ((s - span.s0) / size).clamp(0.0, 1.0) * 2.0 - 1.0;
        polynomial(&span.u, t).clamp(0.0, 1.0)
    }
}

/// The Chebyshev points tₖ = cos(π(k + ½)/n) of the first kind.
struct ChebyshevPoints {
    /// The values cos(πm/2n), among them all Tⱼ(tₖ) = cos(πj(2k + 1)/2n).
    cosines: [f64; 4 * TERMS],
}

impl ChebyshevPoints {
    fn new() -> Self {
        Self { cosines: from_fn(|m| (PI * m as f64 / (2 * TERMS) as f64).cos()) }
    }

    /// The value Tⱼ(tₖ).
    fn value(&self, j: usize, k: usize) -> f64 {
        self.cosines[(j * (2 * k + 1)) % (4 * TERMS)]
    }

    /// The coefficients of the polynomial with these values at the points.
    fn series(&self, values: &[f64; TERMS]) -> [f64; TERMS] {
        from_fn(|j| {
            let sum: f64 = values.iter().enumerate().map(|(k, v)| v * self.value(j, k)).sum();
            (sum * if j == 0 { 1.0 } else { 2.0 }) / TERMS as f64
        })
    }
}

/// The speed on a span [a, b] of the parameter, and its integral, as Chebyshev series in t = −1…1.
struct Speed {
    middle: f64,
    half: f64,
    speed: [f64; TERMS],
    /// The series of the length from a.
    length: [f64; TERMS + 1],
}

impl Speed {
    fn new(speed: &dyn Fn(f64) -> f64, a: f64, b: f64, points: &ChebyshevPoints) -> Self {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let v = points.series(&from_fn(|k| speed(middle + half * points.value(1, k)) * half));
        // ∫T₀ = T₁, ∫T₁ = T₂/4 and, for j > 1, ∫Tⱼ = Tⱼ₊₁/2(j + 1) − Tⱼ₋₁/2(j − 1); the constant makes the length 0 at t = −1.
        let mut length: [f64; TERMS + 1] = from_fn(|j| match j {
            0 => 0.0,
            1 => v[0] - 0.5 * v[2],
            _ => (v[j - 1] - v.get(j + 1).unwrap_or(&0.0)) / (2 * j) as f64,
        });
        length[0] = -clenshaw(&length, -1.0);
        Self { middle, half, speed: v, length }
    }

    fn length(&self) -> f64 {
        clenshaw(&self.length, 1.0)
    }

    /// The size of the last terms of the length.
    fn tail(&self) -> f64 {
        self.length[TERMS - 1].abs() + self.length[TERMS].abs()
    }

    /// The Chebyshev series of u over the distances of the span.
    fn inverse(&self, points: &ChebyshevPoints) -> [f64; TERMS] {
        let whole = self.length();
        points.series(&from_fn(|k| {
            self.middle + self.half * self.parameter(0.5 * whole * (1.0 + points.value(1, k)), whole)
        }))
    }

    /// The t at the length `wanted` of the span's `whole` length; the middle of a span without length.
    fn parameter(&self, wanted: f64, whole: f64) -> f64 {
        if whole <= 0.0 {
            return 0.0;
        }
        let start = 2.0 * wanted / whole - 1.0;
        let excess = |t: f64| (clenshaw(&self.length, t) - wanted, clenshaw(&self.speed, t));
        // The exact length ends the iteration, too: where the curve nearly stands still, the parameter converges later.
        let is_close =
            |_, excess: f64, step: f64| step.abs() <= 2.0 * f64::EPSILON || excess.abs() <= f64::EPSILON * whole;
        increasing_root((-1.0, 1.0), start, excess, is_close)
    }
}

/// The coefficients in powers of t of a Chebyshev series.
fn powers(series: &[f64; TERMS]) -> [f64; TERMS] {
    // By the recurrence T₀ = 1, T₁ = t, Tⱼ₊₁ = 2t·Tⱼ − Tⱼ₋₁.
    let (mut before, mut now) = ([0.0; TERMS], [0.0; TERMS]);
    (before[0], now[1]) = (1.0, 1.0);
    let mut out: [f64; TERMS] = from_fn(|k| series[0] * before[k] + series[1] * now[k]);
    for c in &series[2..] {
        let next: [f64; TERMS] = from_fn(|k| if k == 0 { 0.0 } else { 2.0 * now[k - 1] } - before[k]);
        (before, now) = (now, next);
        for (o, n) in out.iter_mut().zip(now) {
            *o += c * n;
        }
    }
    out
}

/// The value of a polynomial at `t`, by Estrin's scheme: pairs, pairs of pairs and so on do not wait for each other.
fn polynomial(c: &[f64; TERMS], t: f64) -> f64 {
    let (t2, t4) = (t * t, t * t * (t * t));
    let four: [f64; TERMS / 4] = from_fn(|i| (c[4 * i] + c[4 * i + 1] * t) + (c[4 * i + 2] + c[4 * i + 3] * t) * t2);
    (four[0] + four[1] * t4) + (four[2] + four[3] * t4) * (t4 * t4)
}

/// The sum of a Chebyshev series at `t`, by Clenshaw's recurrence.
fn clenshaw(series: &[f64], t: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    for c in series[1..].iter().rev() {
        (b1, b2) = (2.0 * t * b1 - b2 + c, b1);
    }
    t * b1 - b2 + series[0]
}

// A side of an envelope: consecutive curve segments with one parameter from 0 to 1.
//
// The parameter is proportional to arc length, to the parameters of the segments, or to the distance along an axis. Outside [0, 1]
// a segment at the pace of its parameter continues as the same line, polynomial or ellipse. At other paces it continues along its end
// tangent, but a curve at a pace along an axis no steeper than [`STEEPEST`].

/// The meaning of equal steps of a side's parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Pace {
    /// Equal distances along the curve.
    Length,
    /// Equal steps of each segment's parameter; segments share the side in proportion to their lengths.
    Parameter,
    /// Equal horizontal steps, for a curve that never turns back from left to right; it may be vertical at single points.
    Width,
    /// Equal vertical steps, for a curve that never turns back upwards or downwards.
    Height,
}

/// One side of a [`Coons`](crate::map::Coons) patch: segments with a common parameter from 0 to 1.
#[derive(Debug, Clone)]
pub struct Side {
    pieces: Vec<SidePiece>,
    /// The parameters at the ends of the pieces: 0, …, 1.
    knots: Vec<f64>,
    length: f64,
}

/// One segment of a side, with its parameter at a pace.
#[derive(Debug, Clone)]
struct SidePiece {
    seg: Seg,
    table: ArcLength,
    pace: Pace,
}

/// Speeds below this share of the piece's length count as zero, and the direction is taken further inside the piece.
const MIN_SPEED: f64 = 1e-9;
/// The distance of that inner point from the end, in the parameter of the segment.
const INWARD: f64 = 1e-5;
/// A curve that runs against an axis by less than this share of its speed does so by rounding.
const BACKWARDS: f64 = 1e-9;
/// The steepest slope with which a curve at a pace along an axis continues beyond its ends, where it may be vertical.
const STEEPEST: f64 = 4.0;
/// Pieces shorter than this share of the side are dropped.
const MIN_LENGTH: f64 = 1e-12;

impl Side {
    /// A side of these segments, each starting at the end of the previous one. `None` if they have no length, or if they turn
    /// back along the axis of the pace [`Width`](Pace::Width) or [`Height`](Pace::Height).
    #[must_use]
    pub fn new(segs: &[Seg], pace: Pace) -> Option<Self> {
        let measured: Vec<_> = segs.iter().map(|s| (*s, ArcLength::of_segment(s))).collect();
        let length: f64 = measured.iter().map(|m| m.1.length()).sum();
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        let kept: Vec<_> = measured.into_iter().filter(|m| m.1.length() > MIN_LENGTH * length).collect();
        let (first, last) = (kept.first()?.0.start(), kept.last()?.0.end());
        let along = |v: Vec2| if pace == Pace::Width { v.x } else { v.y };
        let extent = along(last - first);
        let share = |s: &Seg, t: &ArcLength| match pace {
            Pace::Length | Pace::Parameter => t.length() / length,
            Pace::Width | Pace::Height => along(s.end() - s.start()) / extent,
        };
        if matches!(pace, Pace::Width | Pace::Height) && !kept.iter().all(|(s, _)| never_turns_back(s, along, extent)) {
            return None;
        }
        let mut knots = vec![0.0];
        for (i, (s, t)) in kept.iter().enumerate() {
            knots.push(knots[i] + share(s, t));
        }
        // Shares add up to 1, up to rounding.
        let n = knots.len();
        knots[n - 1] = 1.0;
        let pieces = kept.into_iter().map(|(seg, table)| SidePiece { seg, table, pace }).collect();
        Some(Self { pieces, knots, length })
    }

    /// A straight side, or a single point.
    pub(crate) fn straight(from: Point, to: Point) -> Self {
        let seg = Seg::Line(Line::new(from, to));
        let (table, pace) = (ArcLength::of_segment(&seg), Pace::Parameter);
        Self { length: table.length(), pieces: vec![SidePiece { seg, table, pace }], knots: vec![0.0, 1.0] }
    }

    /// The meaning of equal steps of the parameter.
    pub(crate) fn pace(&self) -> Pace {
        self.pieces[0].pace
    }

    /// The arc length.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The increasing parameters, strictly between 0 and 1, at which pieces meet.
    #[must_use]
    pub fn joints(&self) -> &[f64] {
        &self.knots[1..self.knots.len() - 1]
    }

    /// The segments.
    pub fn segs(&self) -> impl Iterator<Item = &Seg> {
        self.pieces.iter().map(|p| &p.seg)
    }

    /// The first and the last point.
    #[must_use]
    pub fn ends(&self) -> [Point; 2] {
        [self.pieces[0].seg.start(), self.pieces[self.pieces.len() - 1].seg.end()]
    }

    /// The index of the piece at parameter `u`; at a joint, the index of the next one.
    #[must_use]
    pub fn piece(&self, u: f64) -> usize {
        self.joints().partition_point(|k| *k <= u)
    }

    /// The point and derivative at `u`.
    #[must_use]
    pub fn at(&self, u: f64) -> (Point, Vec2) {
        self.at_piece(self.piece(u), u)
    }

    /// The point and derivative at `u` on a given piece, continued beyond its ends.
    #[must_use]
    pub(crate) fn at_piece(&self, piece: usize, u: f64) -> (Point, Vec2) {
        let (from, to) = (self.knots[piece], self.knots[piece + 1]);
        let (p, v) = self.pieces[piece].point_and_derivative((u - from) / (to - from));
        (p, v / (to - from))
    }

    /// The point at `u` on a given piece, continued beyond its ends.
    #[must_use]
    pub(crate) fn point_at_piece(&self, piece: usize, u: f64) -> Point {
        let (from, to) = (self.knots[piece], self.knots[piece + 1]);
        self.pieces[piece].point((u - from) / (to - from))
    }

    /// Returns `true` if every piece continues smoothly beyond its ends.
    #[must_use]
    pub(crate) fn continues_smoothly(&self) -> bool {
        self.pieces.iter().all(|p| p.is_polynomial() || (p.pace == Pace::Parameter))
    }

    /// The part of a piece between two parameters of the side as a cubic; `None` if it is not polynomial.
    #[must_use]
    pub(crate) fn cubic(&self, piece: usize, a: f64, b: f64) -> Option<CubicBez> {
        let (p, from, to) = (&self.pieces[piece], self.knots[piece], self.knots[piece + 1]);
        let part = p.seg.part((a - from) / (to - from), (b - from) / (to - from));
        part.filter(|_| p.is_polynomial()).map(|part| part.to_cubic())
    }

    /// The largest distance of the side from its chord, and the point where it occurs.
    #[must_use]
    pub(crate) fn farthest_from_chord(&self) -> (f64, Point) {
        /// The number of samples per piece.
        const SAMPLES: u32 = 64;
        let [a, b] = self.ends();
        let chord = b - a;
        let distance = |p: Point| {
            let t = ((p - a).dot(chord) / chord.hypot2()).clamp(0.0, 1.0);
            p.distance(a + chord * t)
        };
        let samples = self.segs().flat_map(|s| (0..=SAMPLES).map(move |i| s.eval(f64::from(i) / f64::from(SAMPLES))));
        samples.map(|p| (distance(p), p)).fold((0.0, a), |best, here| if here.0 > best.0 { here } else { best })
    }
}

/// Returns `true` if a segment runs along an axis in the direction of `extent` only. `along` gives the component on that axis.
fn never_turns_back(s: &Seg, along: impl Fn(Vec2) -> f64, extent: f64) -> bool {
    const SAMPLES: u32 = 256;
    (0..=SAMPLES).all(|i| {
        let v = s.deriv(f64::from(i) / f64::from(SAMPLES));
        along(v) * extent.signum() >= -BACKWARDS * v.hypot()
    }) && along(s.end() - s.start()) * extent > 0.0
}

impl SidePiece {
    /// Returns `true` if the piece is a polynomial: a line at any pace, or a Bézier curve at the pace of its parameter.
    fn is_polynomial(&self) -> bool {
        match self.seg {
            Seg::Line(_) => true,
            Seg::Quad(_) | Seg::Cubic(_) => self.pace == Pace::Parameter,
            Seg::Arc(_) => false,
        }
    }

    /// The point and derivative at `t`, which runs from 0 to 1 over the piece.
    fn point_and_derivative(&self, t: f64) -> (Point, Vec2) {
        let inside = t.clamp(0.0, 1.0);
        let Some(u) = self.parameter(inside) else { return (self.seg.eval(t), self.seg.deriv(t)) };
        let inward = if u < 0.5 { u + INWARD } else { u - INWARD };
        let (mut v, length) = (self.seg.deriv(u), self.table.length());
        if self.pace == Pace::Length {
            if v.hypot() <= MIN_SPEED * length {
                v = self.seg.deriv(inward);
            }
            v *= length / v.hypot();
        } else {
            if self.along(v).abs() <= MIN_SPEED * length {
                v = self.seg.deriv(inward);
            }
            v *= self.along(self.seg.end() - self.seg.start()) / self.along(v);
            if t != inside {
                v = self.flattened(v);
            }
        }
        (self.seg.eval(u) + v * (t - inside), v)
    }

    /// The derivative with which a curve at a pace along an axis continues beyond its ends.
    fn flattened(&self, v: Vec2) -> Vec2 {
        let limit = STEEPEST * self.along(v).abs();
        let limited = |x: f64| x.clamp(-limit, limit);
        if self.pace == Pace::Width { Vec2::new(v.x, limited(v.y)) } else { Vec2::new(limited(v.x), v.y) }
    }

    /// The point at `t`, which runs from 0 to 1 over the piece.
    fn point(&self, t: f64) -> Point {
        if !(0.0..=1.0).contains(&t) {
            return self.point_and_derivative(t).0;
        }
        self.seg.eval(self.parameter(t).unwrap_or(t))
    }

    /// The segment's parameter at `t` in [0, 1]; `None` if it equals `t`, inside and beyond the ends.
    fn parameter(&self, t: f64) -> Option<f64> {
        match (self.pace, self.seg) {
            (Pace::Parameter, _) | (_, Seg::Line(_)) => None,
            (Pace::Length, _) => Some(self.table.parameter(t * self.table.length())),
            (Pace::Width | Pace::Height, _) if t <= 0.0 || t >= 1.0 => Some(t),
            (Pace::Width | Pace::Height, _) => {
                let (from, extent) = (self.seg.start(), self.along(self.seg.end() - self.seg.start()));
                let share = |u: f64| self.along(self.seg.eval(u) - from) / extent;
                let excess = |u: f64| (share(u) - t, self.along(self.seg.deriv(u)) / extent);
                Some(increasing_root((0.0, 1.0), t, excess, |u, _, step: f64| step.abs() <= f64::EPSILON * u))
            }
        }
    }

    /// The component of a vector along the axis of the pace.
    fn along(&self, v: Vec2) -> f64 {
        if self.pace == Pace::Width { v.x } else { v.y }
    }
}

// Guide curves of ruled maps: consecutive segments with one parameter from 0 to 1.

/// The meaning of equal steps of a guide's parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum GuidePace {
    /// Equal distances along the guide.
    ArcLength,
    /// Equal steps of each segment's parameter; segments have equal shares of [0, 1].
    Parameter,
}

/// A guide curve with parameter u from 0 to 1.
#[derive(Debug, Clone)]
pub(crate) struct Guide {
    pieces: Vec<GuidePiece>,
}

/// One segment of a guide, over a range of u.
#[derive(Debug, Clone)]
pub(in crate::map) struct GuidePiece {
    seg: Seg,
    /// The parameters u at the ends.
    from: f64,
    to: f64,
    /// The inverse of arc length; `None` if u is proportional to the segment's parameter.
    table: Option<ArcLength>,
}

impl Guide {
    /// A guide of consecutive segments. `None` if there are no segments, or they have no length.
    #[must_use]
    pub(crate) fn new(segs: &[Seg], pace: GuidePace) -> Option<Self> {
        let mut lengths = Vec::with_capacity(segs.len());
        let mut tables = Vec::with_capacity(segs.len());
        for seg in segs {
            let table = ArcLength::of_segment(seg);
            lengths.push(if pace == GuidePace::ArcLength { table.length() } else { 1.0 });
            // The parameter of a line is proportional to its length.
            let proportional = pace == GuidePace::Parameter || matches!(seg, Seg::Line(_));
            tables.push((!proportional).then_some(table));
        }
        let total: f64 = lengths.iter().sum();
        let is_point = segs.iter().all(|s| s.bounding_box().size().max_side() == 0.0);
        if is_point || !total.is_finite() || total <= 0.0 {
            return None;
        }
        let mut distance = 0.0;
        let mut pieces: Vec<GuidePiece> = Vec::with_capacity(segs.len());
        for ((seg, length), table) in segs.iter().zip(lengths).zip(tables) {
            let from = distance / total;
            distance += length;
            // A segment without length covers no u.
            if length > 0.0 {
                pieces.push(GuidePiece { seg: *seg, from, to: distance / total, table });
            }
        }
        if let Some(last) = pieces.last_mut() {
            last.to = 1.0;
        }
        Some(Self { pieces })
    }

    /// The point at `u`. Beyond the ends, the outermost segments continue as the same curves, at the speed of their ends.
    #[cfg(test)]
    pub(in crate::map) fn eval(&self, u: f64) -> Point {
        self.piece(u).point(u)
    }

    /// The parameters between 0 and 1 at which pieces meet.
    pub(crate) fn joints(&self) -> impl Iterator<Item = f64> + '_ {
        self.pieces.iter().skip(1).map(|p| p.from)
    }

    /// The piece at `u`; at a joint, the previous one.
    pub(in crate::map) fn piece(&self, u: f64) -> &GuidePiece {
        let k = self.pieces.partition_point(|p| p.to < u).min(self.pieces.len() - 1);
        &self.pieces[k]
    }
}

impl GuidePiece {
    /// The point and the derivative with respect to u.
    pub(in crate::map) fn point_and_derivative(&self, u: f64) -> (Point, Vec2) {
        let share = self.share(u);
        let (t, dt) = match &self.table {
            None => (share, 1.0),
            Some(table) => {
                let length = table.length();
                let inside = share.clamp(0.0, 1.0);
                let t = table.parameter(inside * length);
                let dt = length / self.seg.deriv(t).hypot().max(f64::MIN_POSITIVE);
                (if share == inside { t } else { t + (share - inside) * dt }, dt)
            }
        };
        (self.seg.eval(t), self.seg.deriv(t) * (dt / (self.to - self.from)))
    }

    /// The point at `u`.
    pub(in crate::map) fn point(&self, u: f64) -> Point {
        let share = self.share(u);
        match &self.table {
            None => self.seg.eval(share),
            Some(table) if (0.0..=1.0).contains(&share) => self.seg.eval(table.parameter(share * table.length())),
            Some(_) => self.point_and_derivative(u).0,
        }
    }

    /// The parameter of `u` within the piece, from 0 to 1.
    fn share(&self, u: f64) -> f64 {
        (u - self.from) / (self.to - self.from)
    }

    /// The piece over [u0, u1] as a cubic in u; `None` if it is not polynomial in u.
    pub(in crate::map) fn cubic(&self, u0: f64, u1: f64) -> Option<CubicBez> {
        if self.table.is_some() || matches!(self.seg, Seg::Arc(_)) {
            return None;
        }
        let c = self.seg.to_cubic();
        let whole = u0 == self.from && u1 == self.to;
        Some(if whole { c } else { c.subsegment(self.share(u0)..self.share(u1)) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{ParamCurveArclen, ParamCurveDeriv};

    #[test]
    fn distances_agree_with_an_independent_integration() {
        for c in [
            CubicBez::new((0.0, 0.0), (30.0, 50.0), (70.0, -50.0), (100.0, 0.0)),
            CubicBez::new((0.0, 0.0), (100.0, 10.0), (0.0, 10.0), (100.0, 0.0)),
            CubicBez::new((0.0, 0.0), (1.0, 0.0), (99.0, 80.0), (100.0, 0.0)),
        ] {
            let table = ArcLength::of_segment(&Seg::Cubic(c));
            assert!((table.length() - c.arclen(1e-12)).abs() < 1e-10, "{} {}", table.length(), c.arclen(1e-12));
            for i in 0..=50 {
                let s = table.length() * f64::from(i) / 50.0;
                let u = table.parameter(s);
                assert!((c.subsegment(0.0..u).arclen(1e-12) - s).abs() < 1e-9, "{s} {u} {}", table.spans.len());
            }
        }
    }

    /// Speed 2u·c for C = c·u² along a line: u = √(s/c), with an infinite slope at the start.
    #[test]
    fn a_start_from_rest_and_a_cusp() {
        let table = ArcLength::new(&|u| 20.0 * u);
        for s in [1e-12, 1e-6, 0.01, 1.0, 9.9] {
            assert!((table.parameter(s) - (s / 10.0).sqrt()).abs() < 1e-7, "{s} {}", table.spans.len());
        }
        assert!((table.parameter(1.0) - 0.1f64.sqrt()).abs() < 1e-13);
        let cusp = CubicBez::new((0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0));
        let cusp = ArcLength::of_segment(&Seg::Cubic(cusp));
        assert!(cusp.spans.len() < 300 && (cusp.parameter(0.5 * cusp.length()) - 0.5).abs() < 1e-6);
    }

    /// The speed is evaluated once at the points of every span, kept or halved; there are fewer halved spans than kept ones.
    #[test]
    fn a_hairpin_takes_few_evaluations() {
        let c = CubicBez::new((0.0, 0.0), (9.0, 90.0), (9.0, -90.0), (1.0, 1.0));
        let asked = std::cell::Cell::new(0);
        let table = ArcLength::new(&|u| {
            asked.set(asked.get() + 1);
            c.deriv().eval(u).to_vec2().hypot()
        });
        assert!(asked.get() < (4 + 2 * table.spans.len()) * TERMS, "{} for {} spans", asked.get(), table.spans.len());
        assert!(table.spans.len() < 60, "{}", table.spans.len());
        assert!((table.length() - c.arclen(1e-13)).abs() < 1e-11);
    }

    #[test]
    fn a_point_has_no_length() {
        let table = ArcLength::new(&|_| 0.0);
        assert_eq!((table.length(), table.parameter(0.0), table.spans.len()), (0.0, 0.5, 1));
        let half = ArcLength::new(&|u| if u < 0.5 { 0.0 } else { 2.0 });
        assert!((half.length() - 1.0).abs() < 1e-9 && (half.parameter(0.5) - 0.75).abs() < 1e-9);
        assert!((0..=8).all(|i| half.parameter(f64::from(i) / 8.0).is_finite()));
    }

    #[test]
    fn an_even_speed_is_one_span() {
        let table = ArcLength::new(&|_| 7.0);
        assert_eq!(table.spans.len(), 1);
        assert!((table.parameter(3.0) - 3.0 / 7.0).abs() < 1e-15);
    }
}
