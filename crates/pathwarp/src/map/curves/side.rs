//! A side of an envelope: consecutive curve segments with one parameter from 0 to 1.
//!
//! The parameter is proportional to arc length, to the parameters of the segments, or to the distance along an axis. Outside [0, 1]
//! a Bézier segment with its own parameter continues as the same polynomial; everything else continues along its end tangent.

use super::ArcLength;
use super::root::increasing_root;
use crate::outline::Seg;
use kurbo::{CubicBez, Line, Point, Vec2};

/// The meaning of equal steps of a side's parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Pace {
    /// Equal distances along the curve.
    Length,
    /// Equal steps of each segment's own parameter; segments share the side in proportion to their lengths.
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
    /// Parameters at the ends of the pieces: 0, …, 1.
    knots: Vec<f64>,
    length: f64,
}

#[derive(Debug, Clone)]
struct SidePiece {
    seg: Seg,
    table: ArcLength,
    pace: Pace,
}

/// Speeds below this share of the piece's length count as zero, and the direction is taken further inside the piece.
const MIN_SPEED: f64 = 1e-9;
/// Distance of that point, in the parameter of the segment.
const INWARD: f64 = 1e-5;
/// A curve that runs against an axis by less than this share of its speed does so by rounding.
const BACKWARDS: f64 = 1e-9;
/// Beyond its ends, a curve at a pace along an axis runs on no steeper than this: it may be vertical there.
const STEEPEST: f64 = 4.0;
/// Pieces shorter than this share of the side are dropped.
const MIN_LENGTH: f64 = 1e-12;

impl Side {
    /// A side of these segments, each starting at the end of the previous one. `None` if they have no length, or if they turn
    /// back from the axis of a pace along one.
    #[must_use]
    pub fn new(segs: &[Seg], pace: Pace) -> Option<Self> {
        let measured: Vec<_> = segs.iter().map(|s| (*s, ArcLength::of(s))).collect();
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
        if matches!(pace, Pace::Width | Pace::Height) && !kept.iter().all(|(s, _)| runs_along(s, along, extent)) {
            return None;
        }
        let mut knots = vec![0.0];
        let mut at = 0.0;
        for (s, t) in &kept {
            at += share(s, t);
            knots.push(at);
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
        let table = ArcLength::of(&seg);
        let length = table.length();
        Self { pieces: vec![SidePiece { seg, table, pace: Pace::Parameter }], knots: vec![0.0, 1.0], length }
    }

    /// The meaning of equal steps.
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

    /// The index of the piece at parameter `u`.
    #[must_use]
    pub fn piece(&self, u: f64) -> usize {
        self.joints().partition_point(|k| *k <= u)
    }

    /// Point and derivative at `u`.
    #[must_use]
    pub fn at(&self, u: f64) -> (Point, Vec2) {
        self.on(self.piece(u), u)
    }

    /// As [`Side::at`] on a given piece, continued beyond its ends.
    #[must_use]
    pub(crate) fn on(&self, piece: usize, u: f64) -> (Point, Vec2) {
        let (from, to) = (self.knots[piece], self.knots[piece + 1]);
        let (p, v) = self.pieces[piece].at((u - from) / (to - from));
        (p, v / (to - from))
    }

    /// The point of [`Side::on`].
    #[must_use]
    pub(crate) fn point_on(&self, piece: usize, u: f64) -> Point {
        let (from, to) = (self.knots[piece], self.knots[piece + 1]);
        self.pieces[piece].point((u - from) / (to - from))
    }

    /// Returns `true` if every piece continues smoothly beyond its ends.
    #[must_use]
    pub(crate) fn runs_on(&self) -> bool {
        self.pieces.iter().all(|p| p.is_polynomial() || (p.pace == Pace::Parameter))
    }

    /// The part of a piece between two parameters of the side as a cubic; `None` if it is not polynomial.
    #[must_use]
    pub(crate) fn cubic(&self, piece: usize, a: f64, b: f64) -> Option<CubicBez> {
        let p = &self.pieces[piece];
        if !p.is_polynomial() {
            return None;
        }
        let (from, to) = (self.knots[piece], self.knots[piece + 1]);
        Some(p.seg.part((a - from) / (to - from), (b - from) / (to - from))?.to_cubic())
    }

    /// The largest distance of the side from its chord, and the point where it occurs.
    #[must_use]
    pub(crate) fn off_straight(&self) -> (f64, Point) {
        /// Samples per piece.
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

/// Returns `true` if a segment runs in one direction along the axis.
fn runs_along(s: &Seg, along: impl Fn(Vec2) -> f64, extent: f64) -> bool {
    const SAMPLES: u32 = 256;
    (0..=SAMPLES).all(|i| {
        let v = s.deriv(f64::from(i) / f64::from(SAMPLES));
        along(v) * extent.signum() >= -BACKWARDS * v.hypot()
    }) && along(s.end() - s.start()) * extent > 0.0
}

impl SidePiece {
    /// A line is polynomial at any pace, a Bézier curve at its own.
    fn is_polynomial(&self) -> bool {
        match self.seg {
            Seg::Line(_) => true,
            Seg::Quad(_) | Seg::Cubic(_) => self.pace == Pace::Parameter,
            Seg::Arc(_) => false,
        }
    }

    /// Point and derivative at `t`, which runs from 0 to 1 over the piece.
    fn at(&self, t: f64) -> (Point, Vec2) {
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

    /// The direction in which a curve at a pace along an axis runs on.
    fn flattened(&self, v: Vec2) -> Vec2 {
        let most = STEEPEST * self.along(v).abs();
        let limited = |x: f64| x.clamp(-most, most);
        if self.pace == Pace::Width { Vec2::new(v.x, limited(v.y)) } else { Vec2::new(limited(v.x), v.y) }
    }

    /// The point of [`at`](Self::at).
    fn point(&self, t: f64) -> Point {
        if !(0.0..=1.0).contains(&t) {
            return self.at(t).0;
        }
        self.seg.eval(self.parameter(t).unwrap_or(t))
    }

    /// The segment's parameter at `t` in [0, 1]; `None` if that is `t` itself, beyond the ends as well.
    fn parameter(&self, t: f64) -> Option<f64> {
        match (self.pace, self.seg) {
            (Pace::Parameter, _) | (_, Seg::Line(_)) => None,
            (Pace::Length, _) => Some(self.table.parameter(t * self.table.length())),
            (Pace::Width | Pace::Height, _) => {
                let (from, extent) = (self.seg.start(), self.along(self.seg.end() - self.seg.start()));
                let share = |u: f64| self.along(self.seg.eval(u) - from) / extent;
                Some(Self::inverse(t, share, |u| self.along(self.seg.deriv(u)) / extent))
            }
        }
    }

    /// The part of a vector along the axis of a pace along an axis.
    fn along(&self, v: Vec2) -> f64 {
        if self.pace == Pace::Width { v.x } else { v.y }
    }

    /// Solves f(u) = `t` for u in [0, 1], for an increasing `f` from 0 to 1.
    fn inverse(t: f64, f: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64) -> f64 {
        if t <= 0.0 || t >= 1.0 {
            return t;
        }
        let excess = |u: f64| (f(u) - t, slope(u));
        increasing_root((0.0, 1.0), t, excess, |u, _, step: f64| step.abs() <= f64::EPSILON * u)
    }
}
