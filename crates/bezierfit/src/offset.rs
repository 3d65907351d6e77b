//! Offset curves: curves at a distance from another.

use crate::path::Segment;
use crate::source::{BreakPoint, NotFinite, Result, Source};
use kurbo::{ParamCurve, PathSeg, Point, Vec2};

/// The curve at a distance from a segment: to its left where y points up, to its right where y points down; on the other side if the
/// distance is negative.
///
/// It has cusps where the segment's radius of curvature is the distance. A fit breaks it there.
#[derive(Debug, Clone, Copy)]
pub struct Offset {
    segment: Segment,
    distance: f64,
    /// A vector along the segment that vanishes at neither end, in the power basis. The segment's derivative, which vanishes where a handle
    /// does, is this vector times a factor.
    along: [Vec2; 3],
    /// a and b of the factor a + b·t; both 0 stand for the factor 2t(1 − t).
    factor: [f64; 2],
    /// Vectors that are added at the start and at the end, and in proportion in between.
    shift: [Vec2; 2],
}

/// Number of intervals that are searched for cusps. Each may have one cusp or a pair.
const SAMPLES: usize = 32;

/// Cusps nearer to each other or to an end are ignored.
const NEAR: f64 = 1e-7;

/// Handles shorter than this share of the control polygon have no direction.
const NO_HANDLE: f64 = 1e-9;

impl Offset {
    /// Makes the curve at a distance from a segment of a path.
    #[must_use]
    pub fn new(segment: PathSeg, distance: f64) -> Self {
        let c = segment.to_cubic();
        let [d0, d1, d2] = [c.p1 - c.p0, c.p2 - c.p1, c.p3 - c.p2].map(|d| d * 3.0);
        let least = NO_HANDLE * (d0.hypot() + d1.hypot() + d2.hypot());
        let (along, factor) = match [d0, d2].map(|d| d.hypot() <= least) {
            [true, true] => ([d1, Vec2::ZERO, Vec2::ZERO], [0.0, 0.0]),
            [true, false] => ([d1 * 2.0, d2 - d1 * 2.0, Vec2::ZERO], [0.0, 1.0]),
            [false, true] => ([d0, d1 * 2.0 - d0, Vec2::ZERO], [1.0, -1.0]),
            [false, false] => ([d0, (d1 - d0) * 2.0, d0 - d1 * 2.0 + d2], [1.0, 0.0]),
        };
        Self { segment: Segment::new(segment), distance, along, factor, shift: [Vec2::ZERO; 2] }
    }

    /// The segment beside which the curve runs.
    #[must_use]
    pub fn segment(&self) -> PathSeg {
        self.segment.segment()
    }

    /// Distance from the segment.
    #[must_use]
    pub fn distance(&self) -> f64 {
        self.distance
    }

    /// Moves the ends of the curve to `start` and `end` nearby, and points in between in proportion.
    #[must_use]
    pub fn with_ends(mut self, [start, end]: [Point; 2]) -> Self {
        self.shift = [Vec2::ZERO; 2];
        self.shift = [start - self.eval(0.0).0, end - self.eval(1.0).0];
        self
    }

    /// The part of the curve between two parameters.
    #[must_use]
    pub(crate) fn part(&self, t0: f64, t1: f64) -> Self {
        let [a, b] = self.shift;
        let shift = [t0, t1].map(|t| a * (1.0 - t) + b * t);
        Self { shift, ..Self::new(self.segment().subsegment(t0..t1), self.distance) }
    }

    /// The curve in the other direction.
    #[must_use]
    pub(crate) fn reversed(&self) -> Self {
        let [a, b] = self.shift;
        Self { shift: [b, a], ..Self::new(self.segment().reverse(), -self.distance) }
    }

    /// The vector along the segment with its derivative, taken a little aside where it vanishes, and the speed of the segment.
    fn along(&self, t: f64) -> (Vec2, Vec2, f64) {
        let [q0, q1, q2] = self.along;
        let jet = |t: f64| ((q2 * t + q1) * t + q0, q2 * (2.0 * t) + q1);
        let (mut q, mut dq) = jet(t);
        // At an inner cusp of the segment, a length below 1e-12 of the usual one is rounding.
        if q.hypot2() <= 1e-24 * (q0.hypot2() + q1.hypot2() + q2.hypot2()) {
            (q, dq) = jet(if t < 0.5 { t + 1e-7 } else { t - 1e-7 });
        }
        let factor = if self.factor == [0.0; 2] { 2.0 * t * (1.0 - t) } else { self.factor[0] + self.factor[1] * t };
        (q, dq, factor * q.hypot())
    }

    /// Unit tangent of the segment.
    #[must_use]
    pub(crate) fn direction(&self, t: f64) -> Vec2 {
        let (q, _, _) = self.along(t);
        q / q.hypot()
    }

    /// Speed along the segment's direction: negative where the curve runs backwards, zero at cusps.
    pub(crate) fn speed(&self, t: f64) -> f64 {
        let (q, dq, speed) = self.along(t);
        speed - self.distance * q.cross(dq) / q.hypot2()
    }

    /// Parameters of the cusps.
    pub(crate) fn cusps(&self) -> Vec<f64> {
        // There is no cusp where the radius of curvature is at least twice the distance.
        let is_calm = |i: u32| {
            let (q, dq, speed) = self.along(f64::from(i) / 8.0);
            (self.distance * q.cross(dq)).abs() <= 0.5 * speed * q.hypot2() && speed > 0.0
        };
        if (0..=8).all(is_calm) {
            return Vec::new();
        }
        let parameter = |i: usize| i as f64 / SAMPLES as f64;
        let mut ends: Vec<f64> = (0..=SAMPLES).map(parameter).collect();
        let speeds: Vec<f64> = ends.iter().map(|t| self.speed(*t)).collect();
        // If there are two cusps between samples of one sign, the speed has the other sign at its extremum between them, which is found by
        // trisection.
        for i in 1..SAMPLES {
            let [a, b, c] = [speeds[i - 1], speeds[i], speeds[i + 1]];
            if a * b > 0.0 && b * c > 0.0 && b.abs() < a.abs().min(c.abs()) {
                let (mut low, mut high) = (parameter(i - 1), parameter(i + 1));
                for _ in 0..30 {
                    let (u, v) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
                    let [u_speed, v_speed] = [u, v].map(|t| self.speed(t) * b.signum());
                    if u_speed.min(v_speed) < 0.0 {
                        ends.push(if u_speed < v_speed { u } else { v });
                        break;
                    }
                    (low, high) = if u_speed < v_speed { (low, v) } else { (u, high) };
                }
            }
        }
        ends.sort_by(f64::total_cmp);
        let cusp_between = |w: &[f64]| {
            let (mut a, mut b) = (w[0], w[1]);
            let before = self.speed(a);
            if before * self.speed(b) >= 0.0 {
                return None;
            }
            for _ in 0..50 {
                let mid = 0.5 * (a + b);
                *if before * self.speed(mid) > 0.0 { &mut a } else { &mut b } = mid;
            }
            Some(b)
        };
        let mut out: Vec<f64> = Vec::new();
        for t in ends.windows(2).filter_map(cusp_between).filter(|t| *t > NEAR && *t < 1.0 - NEAR) {
            // Between cusps so near to each other, the curve hardly moves.
            if out.last().is_some_and(|last| t - last < NEAR) {
                out.pop();
            } else {
                out.push(t);
            }
        }
        out
    }
}

impl Source for Offset {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        let (q, dq, speed) = self.along(t);
        let along = q / q.hypot();
        let [a, b] = self.shift;
        let p = self.segment.eval(t).0 + Vec2::new(-along.y, along.x) * self.distance + a * (1.0 - t) + b * t;
        (p, along * (speed - self.distance * q.cross(dq) / q.hypot2()) + (b - a))
    }

    fn breaks(&self) -> Vec<f64> {
        let mut out = self.cusps();
        // Where the segment nearly stops, its direction may turn fast.
        out.extend(self.segment.slow_spots().all());
        out
    }

    /// Between cusps, an offset has no features that samples could miss.
    fn resolved(&self, _: [f64; 2], _: usize, _: f64) -> Option<bool> {
        Some(true)
    }

    fn end(&self, t: f64) -> Result<BreakPoint> {
        let (p, d) = self.eval(t);
        if !(p.is_finite() && d.is_finite()) {
            return Err(NotFinite { t, at: self.place(t) });
        }
        let (along, speed) = (self.direction(t), self.speed(t));
        let beside = |t: f64| along * if self.speed(t.clamp(0.0, 1.0)) < 0.0 { -1.0 } else { 1.0 };
        // The curve has one direction unless the speed is small against that beside it, at a cusp or a stop. Then points beside give two.
        let [before, after] = [self.speed(t - 1e-3), self.speed(t + 1e-3)];
        if speed.abs() > 1e-6 * before.abs().max(after.abs()) && d != Vec2::ZERO {
            let d_unit = d / d.hypot();
            return Ok(BreakPoint { t, p, speed: d.hypot(), into: d_unit, away: d_unit });
        }
        let [into, away] = [t - 1e-3, t + 1e-3].map(|s| if (0.0..=1.0).contains(&s) { s } else { 2.0 * t - s });
        Ok(BreakPoint { t, p, speed: 0.0, into: beside(into), away: beside(away) })
    }
}
