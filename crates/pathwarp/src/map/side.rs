//! A side of an envelope: pieces of curve in a row, walked at a chosen pace from 0 to 1.
//!
//! The pace is by arc length, by the pieces' own parameters, or by even steps along an axis. Beyond 0 and 1 a Bézier curve at its
//! own pace runs on as the polynomial it is; everything else runs straight on along its last direction.

use super::arclength::ArcLength;
use crate::outline::Seg;
use kurbo::{CubicBez, Line, Point, Vec2};

/// What equal steps of a side's parameter are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pace {
    /// Equal distances along the curve.
    Length,
    /// Equal steps of each piece's own parameter; pieces share the side by their lengths.
    Parameter,
    /// Equal steps to the right or left (needs a curve without uprights).
    Width,
    /// Equal steps up or down (needs a curve without levels).
    Height,
}

/// A side with its pace.
#[derive(Debug, Clone)]
pub struct Side {
    pieces: Vec<Piece>,
    /// Where pieces begin and end: 0, …, 1.
    knots: Vec<f64>,
    length: f64,
}

#[derive(Debug, Clone)]
struct Piece {
    seg: Seg,
    table: ArcLength,
    pace: Pace,
}

/// Slower than this share of the piece's length is standing still: the direction is taken a little further in.
const STILL: f64 = 1e-9;
/// How much further in.
const ASIDE: f64 = 1e-5;
/// Steeper than this share of its speed against an axis, a curve is not walked by that axis.
const STEEP: f64 = 1e-3;

impl Side {
    /// The pieces, each starting where the one before ends, at this pace. `None` if they have no length, or run back, or too
    /// steeply, against the axis of the pace.
    #[must_use]
    pub fn new(segs: &[Seg], pace: Pace) -> Option<Self> {
        let measured = segs.iter().map(|s| (*s, ArcLength::new(&|u| s.deriv(u).hypot())));
        let measured: Vec<_> = measured.collect();
        let length: f64 = measured.iter().map(|m| m.1.length()).sum();
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        let kept: Vec<_> = measured.into_iter().filter(|m| m.1.length() > 1e-12 * length).collect();
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
        // Shares add up to one but for rounding.
        let n = knots.len();
        knots[n - 1] = 1.0;
        let pieces = kept.into_iter().map(|(seg, table)| Piece { seg, table, pace }).collect();
        Some(Self { pieces, knots, length })
    }

    /// A straight side.
    pub(crate) fn straight(from: Point, to: Point) -> Option<Self> {
        Self::new(&[Seg::Line(Line::new(from, to))], Pace::Parameter)
    }

    /// Its arc length.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Where its pieces meet: parameters strictly between 0 and 1, increasing.
    #[must_use]
    pub fn joints(&self) -> &[f64] {
        &self.knots[1..self.knots.len() - 1]
    }

    /// The pieces.
    pub fn segs(&self) -> impl Iterator<Item = &Seg> {
        self.pieces.iter().map(|p| &p.seg)
    }

    /// Its ends.
    #[must_use]
    pub fn ends(&self) -> [Point; 2] {
        [self.pieces[0].seg.start(), self.pieces[self.pieces.len() - 1].seg.end()]
    }

    /// The piece that holds the parameter.
    #[must_use]
    pub fn piece(&self, u: f64) -> usize {
        self.joints().partition_point(|k| *k <= u)
    }

    /// Place and derivative at `u`.
    #[must_use]
    pub fn at(&self, u: f64) -> (Point, Vec2) {
        self.on(self.piece(u), u)
    }

    /// The same on a piece that is known, run on beyond its ends.
    #[must_use]
    pub(crate) fn on(&self, piece: usize, u: f64) -> (Point, Vec2) {
        let (from, to) = (self.knots[piece], self.knots[piece + 1]);
        let (p, v) = self.pieces[piece].at((u - from) / (to - from));
        (p, v / (to - from))
    }

    /// Whether the whole side is one polynomial piece, or runs on smoothly by itself beyond its ends.
    #[must_use]
    pub(crate) fn runs_on(&self) -> bool {
        self.pieces.iter().all(|p| p.is_polynomial() || (p.pace == Pace::Parameter))
    }

    /// The cubic that the side is between two parameters of one piece; `None` where it is no polynomial.
    #[must_use]
    pub(crate) fn cubic(&self, piece: usize, a: f64, b: f64) -> Option<CubicBez> {
        let p = &self.pieces[piece];
        if !p.is_polynomial() {
            return None;
        }
        let (from, to) = (self.knots[piece], self.knots[piece + 1]);
        Some(p.seg.part((a - from) / (to - from), (b - from) / (to - from))?.to_cubic())
    }

    /// How far the side is from the straight line between its ends at most, and where; in its own parameter's order.
    #[must_use]
    pub(crate) fn off_straight(&self) -> (f64, Point) {
        /// Samples a piece.
        const SAMPLES: u32 = 64;
        let [a, b] = self.ends();
        let chord = b - a;
        let off = |p: Point| {
            let t = ((p - a).dot(chord) / chord.hypot2()).clamp(0.0, 1.0);
            p.distance(a + chord * t)
        };
        let places = self.segs().flat_map(|s| (0..=SAMPLES).map(move |i| s.eval(f64::from(i) / f64::from(SAMPLES))));
        places.map(|p| (off(p), p)).fold((0.0, a), |best, here| if here.0 > best.0 { here } else { best })
    }
}

/// Whether a piece runs one way along the axis, nowhere too steeply.
fn runs_along(s: &Seg, along: impl Fn(Vec2) -> f64, extent: f64) -> bool {
    const SAMPLES: u32 = 256;
    (0..=SAMPLES).all(|i| {
        let v = s.deriv(f64::from(i) / f64::from(SAMPLES));
        along(v) * extent.signum() > STEEP * v.hypot()
    })
}

impl Piece {
    /// A line is one at any pace.
    fn is_polynomial(&self) -> bool {
        match self.seg {
            Seg::Line(_) => true,
            Seg::Quad(_) | Seg::Cubic(_) => self.pace == Pace::Parameter,
            Seg::Arc(_) => false,
        }
    }

    /// Place and derivative at share `t` of the piece.
    fn at(&self, t: f64) -> (Point, Vec2) {
        if self.pace == Pace::Parameter || matches!(self.seg, Seg::Line(_)) {
            return (self.seg.eval(t), self.seg.deriv(t));
        }
        let inside = t.clamp(0.0, 1.0);
        let (p, v) = match self.pace {
            Pace::Length | Pace::Parameter => {
                let length = self.table.length();
                let u = self.table.parameter(inside * length);
                let mut v = self.seg.deriv(u);
                if v.hypot() <= STILL * length {
                    v = self.seg.deriv(if u < 0.5 { u + ASIDE } else { u - ASIDE });
                }
                (self.seg.eval(u), v * (length / v.hypot()))
            }
            Pace::Width | Pace::Height => {
                let along = |v: Vec2| if self.pace == Pace::Width { v.x } else { v.y };
                let (from, extent) = (self.seg.start(), along(self.seg.end() - self.seg.start()));
                let u = Self::share(
                    inside,
                    |u| along(self.seg.eval(u) - from) / extent,
                    |u| along(self.seg.deriv(u)) / extent,
                );
                let v = self.seg.deriv(u);
                (self.seg.eval(u), v * (extent / along(v)))
            }
        };
        (p + v * (t - inside), v)
    }

    /// The u in [0, 1] where the increasing `f` is `t`: Newton's method in a shrinking bracket.
    fn share(t: f64, f: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64) -> f64 {
        if t <= 0.0 || t >= 1.0 {
            return t;
        }
        let (mut lo, mut hi, mut u) = (0.0, 1.0, t);
        for _ in 0..60 {
            let off = f(u) - t;
            let step = off / slope(u);
            if step.abs() <= f64::EPSILON * u {
                break;
            }
            if off > 0.0 {
                hi = u;
            } else {
                lo = u;
            }
            u = if u - step > lo && u - step < hi { u - step } else { 0.5 * (lo + hi) };
        }
        u
    }
}
