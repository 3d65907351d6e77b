//! Before the fit: the direction in which a segment is fitted, and the places where its image may be sharp.

use super::limits::{SLOW_MARGIN, SLOW_SPEED};
use crate::outline::{EllipticArc, Seg};
use kurbo::{Point, Vec2, common::solve_cubic};
use std::cmp::Ordering;

/// Returns the segment in the direction in which every copy of it is fitted, and `true` if that is the reverse of the given
/// one.
///
/// Two shapes that share an edge run along it in opposite directions. Fitting one of them and mirroring the result gives
/// both the same curves to the last bit.
#[inline]
pub(super) fn canonical(seg: &Seg) -> (Seg, bool) {
    if is_backwards(seg) { (seg.reversed(), true) } else { (*seg, false) }
}

/// Returns `true` if [`canonical`] reverses the segment.
#[inline]
pub(super) fn is_backwards(seg: &Seg) -> bool {
    let order = match seg {
        Seg::Line(s) => compare(s.p0, s.p1),
        Seg::Quad(s) => compare(s.p0, s.p2),
        Seg::Cubic(s) => compare(s.p0, s.p3).then_with(|| compare(s.p1, s.p2)),
        Seg::Arc(s) => compare(s.p0, s.p1).then_with(|| 0.0f64.total_cmp(&s.sweep)),
    };
    order == Ordering::Greater
}

#[inline]
fn compare(a: Point, b: Point) -> Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

/// Maximum number of slow spots of a segment: more than the speed of any of them has minima.
const MAX_SLOW: usize = 4;

/// Parameters inside a segment at which it is much slower than elsewhere: cusps and near-cusps, at which the direction turns
/// within a stretch too short for evenly spaced samples.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SlowSpots {
    t: [f64; MAX_SLOW],
    len: usize,
}

impl SlowSpots {
    pub(super) fn all(&self) -> &[f64] {
        &self.t[..self.len]
    }

    pub(super) fn push(&mut self, t: f64) {
        if self.len < MAX_SLOW {
            self.t[self.len] = t;
            self.len += 1;
        }
    }

    /// The same spots in another parametrisation.
    pub(super) fn map(mut self, f: impl Fn(f64) -> f64) -> Self {
        for t in &mut self.t[..self.len] {
            *t = f(*t);
        }
        self
    }

    /// The spot well inside (t0, t1) that is nearest to the middle.
    pub(super) fn inside(&self, t0: f64, t1: f64) -> Option<f64> {
        let m = SLOW_MARGIN * (t1 - t0);
        let off = |t: f64| (t - 0.5 * (t0 + t1)).abs();
        self.all().iter().copied().filter(|t| *t > t0 + m && *t < t1 - m).min_by(|a, b| off(*a).total_cmp(&off(*b)))
    }
}

/// The slow spots of `seg`.
#[inline]
pub(super) fn slow_spots(seg: &Seg) -> SlowSpots {
    match seg {
        Seg::Line(_) => SlowSpots::default(),
        Seg::Quad(s) => {
            let (v, a) = (s.p1 - s.p0, (s.p2 - s.p1) - (s.p1 - s.p0));
            speed_minima(&[v, a, Vec2::ZERO])
        }
        Seg::Cubic(s) => {
            let (d0, d1, d2) = (s.p1 - s.p0, s.p2 - s.p1, s.p3 - s.p2);
            // With the chord q, |c'| ≥ 3(u²d₀ + 2us·d₁ + s²d₂)·q̂ ≥ 3/2·min(d₀·q̂, d₂·q̂) if no leg of the control polygon runs
            // against q. Most curves end here.
            let q = s.p3 - s.p0;
            let least = d0.dot(q).min(d2.dot(q));
            let size2 = d0.hypot2() + d1.hypot2() + d2.hypot2();
            if d1.dot(q) >= 0.0 && least > 0.0 && least * least > 0.02 * size2 * q.hypot2() {
                return SlowSpots::default();
            }
            speed_minima(&[d0, (d1 - d0) * 2.0, d2 - d1 * 2.0 + d0])
        }
        Seg::Arc(s) => flat_vertices(s),
    }
}

/// Interior minima of |v|², v = v₀ + v₁t + v₂t², that are small compared with its mean: roots of the cubic v·v′ = 0.
#[inline(never)]
fn speed_minima(v: &[Vec2; 3]) -> SlowSpots {
    let [v0, v1, v2] = *v;
    let speed2 = |t: f64| (v0 + (v1 + v2 * t) * t).hypot2();
    let mean = [0.1, 0.3, 0.5, 0.7, 0.9].iter().map(|t| speed2(*t).sqrt()).sum::<f64>() / 5.0;
    let roots = solve_cubic(v0.dot(v1), 2.0 * v0.dot(v2) + v1.hypot2(), 3.0 * v1.dot(v2), 2.0 * v2.hypot2());
    let mut out = SlowSpots::default();
    for mut t in roots {
        // Two Newton steps remove the cancellation of the closed form.
        for _ in 0..2 {
            let (w, dw) = (v0 + (v1 + v2 * t) * t, v1 + v2 * (2.0 * t));
            let slope = dw.hypot2() + 2.0 * w.dot(v2);
            if slope > 0.0 {
                t -= w.dot(dw) / slope;
            }
        }
        if t > 0.0 && t < 1.0 && speed2(t).sqrt() < SLOW_SPEED * mean && !out.all().contains(&t) {
            out.push(t);
        }
    }
    out
}

/// The ends of the long axis of a flat ellipse, if they lie inside the arc.
fn flat_vertices(arc: &EllipticArc) -> SlowSpots {
    // |P'|² = A + B cos 2θ + C sin 2θ is smallest opposite to the phase (B, C).
    let (aa, bb, ab) = (arc.a.hypot2(), arc.b.hypot2(), arc.a.dot(arc.b));
    let (mean, b, c) = (0.5 * (aa + bb), 0.5 * (bb - aa), -ab);
    let mut out = SlowSpots::default();
    if (mean - b.hypot(c)).max(0.0).sqrt() >= SLOW_SPEED * mean.sqrt() || arc.sweep == 0.0 {
        return out;
    }
    let first = 0.5 * (-c).atan2(-b);
    for k in -8..=8 {
        let t = (first + f64::from(k) * std::f64::consts::PI - arc.start) / arc.sweep;
        if t > 0.0 && t < 1.0 {
            out.push(t);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::CubicBez;

    #[test]
    fn both_directions_have_one_canonical_form() {
        let segs = [
            Seg::Cubic(CubicBez::new((0.0, 0.0), (3.0, 1.0), (2.0, 5.0), (0.0, 0.0))),
            Seg::Cubic(CubicBez::new((5.0, 0.1), (3.0, 1.0), (2.0, 5.0), (0.0, 0.3))),
            Seg::Arc(EllipticArc::new(Point::new(3.0, 4.0), (5.0, 1.0).into(), (0.3, 2.0).into(), 0.7, 1.9)),
            Seg::Arc(EllipticArc::new(
                Point::new(3.0, 4.0),
                (5.0, 1.0).into(),
                (0.3, 2.0).into(),
                0.7,
                -std::f64::consts::TAU,
            )),
        ];
        for s in &segs {
            let (a, fa) = canonical(s);
            let (b, fb) = canonical(&s.reversed());
            assert_eq!(a, b);
            assert_ne!(fa, fb);
        }
    }

    #[test]
    fn a_cusp_is_found_and_a_round_curve_has_none() {
        // The handles cross so that the curve has a cusp in the middle.
        let c = Seg::Cubic(CubicBez::new((0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0)));
        let found = slow_spots(&c);
        assert_eq!(found.all().len(), 1);
        assert!((found.all()[0] - 0.5).abs() < 1e-12);
        let round = Seg::Cubic(CubicBez::new((0.0, 0.0), (55.0, 0.0), (100.0, 45.0), (100.0, 100.0)));
        assert!(slow_spots(&round).all().is_empty());
    }
}
