//! The inverse of arc length: from the distance along a curve to its parameter, to full precision.
//!
//! On each span of the parameter the speed |C'| is interpolated at Chebyshev points; the series is integrated term by term to the arc
//! length s(u), whose inverse u(s) is interpolated at Chebyshev points in turn (Trefethen, *Approximation Theory and Approximation
//! Practice*, 2013, chapters 2–4 and 19). A span on which one of the series does not converge is halved. A lookup is one binary search and
//! one polynomial, and its slope is exactly 1/|C'(u)|.

use super::root::increasing_root;
use crate::outline::Seg;
use std::array::from_fn;
use std::f64::consts::PI;

/// Terms of a series.
const TERMS: usize = 16;
/// Largest magnitude of the last terms of a converged series: the error of the parameter, which runs from 0 to 1.
const TAIL: f64 = 2e-14;
/// Largest magnitude of the last terms of the integrated speed, relative to the whole length.
const INTEGRATION_TOLERANCE: f64 = 1e-14;
/// Nested halvings, enough to resolve a cusp to double precision.
const MAX_DEPTH: usize = 48;
/// Spans of a curve.
const MAX_SPANS: usize = 2000;

/// The inverse of a curve's arc length.
#[derive(Debug, Clone)]
pub(crate) struct ArcLength {
    spans: Vec<Span>,
}

#[derive(Debug, Clone)]
struct Span {
    /// Distances along the curve at the ends.
    s0: f64,
    s1: f64,
    /// u over [s0, s1] by powers of t = −1…1. Series that converge within so few terms are as exact in this basis.
    u: [f64; TERMS],
}

impl ArcLength {
    /// Tabulates a curve over [0, 1] with speed |C'|.
    pub(crate) fn new(speed: &dyn Fn(f64) -> f64) -> Self {
        /// Equal parts from which the length is estimated.
        const PARTS: u32 = 4;
        let points = Points::new();
        let part =
            |i: u32| Speed::new(speed, f64::from(i) / f64::from(PARTS), f64::from(i + 1) / f64::from(PARTS), &points);
        let rough: f64 = (0..PARTS).map(|i| part(i).length()).sum();
        let mut spans = Vec::new();
        let mut todo = vec![(0.0, 1.0, 0)];
        let mut at = 0.0;
        // Depth first, left before right, so that distances accumulate in order.
        while let Some((a, b, depth)) = todo.pop() {
            let last = depth >= MAX_DEPTH || spans.len() + todo.len() >= MAX_SPANS;
            let span = Speed::new(speed, a, b, &points);
            if last || span.tail() <= INTEGRATION_TOLERANCE * rough {
                let c = span.inverse(&points);
                if last || c[TERMS - 2].abs() + c[TERMS - 1].abs() <= TAIL {
                    let length = span.length();
                    spans.push(Span { s0: at, s1: at + length, u: powers(&c) });
                    at += length;
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
    pub(crate) fn of(seg: &Seg) -> Self {
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
struct Points {
    /// cos(πm/2n): Tⱼ(tₖ) = cos(πj(2k + 1)/2n) is one of them.
    cosines: [f64; 4 * TERMS],
}

impl Points {
    fn new() -> Self {
        Self { cosines: from_fn(|m| (PI * m as f64 / (2 * TERMS) as f64).cos()) }
    }

    /// Tⱼ(tₖ).
    fn value(&self, j: usize, k: usize) -> f64 {
        self.cosines[j * (2 * k + 1) % (4 * TERMS)]
    }

    /// The coefficients of the polynomial with these values at the points.
    fn series(&self, values: &[f64; TERMS]) -> [f64; TERMS] {
        from_fn(|j| {
            let sum: f64 = values.iter().enumerate().map(|(k, v)| v * self.value(j, k)).sum();
            sum * if j == 0 { 1.0 } else { 2.0 } / TERMS as f64
        })
    }
}

/// The speed on a span [a, b] of the parameter, and its integral, as Chebyshev series in t = −1…1.
struct Speed {
    middle: f64,
    half: f64,
    speed: [f64; TERMS],
    /// The length from a.
    length: [f64; TERMS + 1],
}

impl Speed {
    fn new(speed: &dyn Fn(f64) -> f64, a: f64, b: f64, points: &Points) -> Self {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let v = points.series(&from_fn(|k| speed(middle + half * points.value(1, k)) * half));
        // ∫T₀ = T₁ and, for j > 0, ∫Tⱼ = Tⱼ₊₁/2(j + 1) − Tⱼ₋₁/2(j − 1); the constant makes the length 0 at t = −1.
        let mut length: [f64; TERMS + 1] = from_fn(|j| match j {
            0 => 0.0,
            1 => v[0] - 0.5 * v[2],
            _ => (v[j - 1] - v.get(j + 1).unwrap_or(&0.0)) / (2 * j) as f64,
        });
        length[0] = -sum(&length, -1.0);
        Self { middle, half, speed: v, length }
    }

    fn length(&self) -> f64 {
        sum(&self.length, 1.0)
    }

    /// The size of the last terms of the length.
    fn tail(&self) -> f64 {
        self.length[TERMS - 1].abs() + self.length[TERMS].abs()
    }

    /// The Chebyshev series of u over the distances of the span.
    fn inverse(&self, points: &Points) -> [f64; TERMS] {
        let whole = self.length();
        points.series(&from_fn(|k| self.middle + self.half * self.at(0.5 * whole * (1.0 + points.value(1, k)), whole)))
    }

    /// The t whose distance from the start is `wanted` of `whole`; the middle of a span without length.
    fn at(&self, wanted: f64, whole: f64) -> f64 {
        if whole <= 0.0 {
            return 0.0;
        }
        let start = 2.0 * wanted / whole - 1.0;
        let off = |t: f64| (sum(&self.length, t) - wanted, sum(&self.speed, t));
        // Stop at the exact length, too: where the curve nearly stands still, the parameter converges later.
        let is_close = |_, off: f64, step: f64| step.abs() <= 2.0 * f64::EPSILON || off.abs() <= f64::EPSILON * whole;
        increasing_root((-1.0, 1.0), start, off, is_close)
    }
}

/// The coefficients of a Chebyshev series by powers of t.
fn powers(series: &[f64; TERMS]) -> [f64; TERMS] {
    // T₀ = 1, T₁ = t, Tⱼ₊₁ = 2t·Tⱼ − Tⱼ₋₁.
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
fn sum(series: &[f64], t: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    for c in series[1..].iter().rev() {
        (b1, b2) = (2.0 * t * b1 - b2 + c, b1);
    }
    t * b1 - b2 + series[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{CubicBez, ParamCurve, ParamCurveArclen, ParamCurveDeriv};

    fn of(c: CubicBez) -> ArcLength {
        ArcLength::of(&Seg::Cubic(c))
    }

    #[test]
    fn distances_agree_with_an_independent_integration() {
        for c in [
            CubicBez::new((0.0, 0.0), (30.0, 50.0), (70.0, -50.0), (100.0, 0.0)),
            CubicBez::new((0.0, 0.0), (100.0, 10.0), (0.0, 10.0), (100.0, 0.0)),
            CubicBez::new((0.0, 0.0), (1.0, 0.0), (99.0, 80.0), (100.0, 0.0)),
        ] {
            let table = of(c);
            assert!((table.length() - c.arclen(1e-12)).abs() < 1e-10, "{} {}", table.length(), c.arclen(1e-12));
            for i in 0..=50 {
                let s = table.length() * f64::from(i) / 50.0;
                let u = table.parameter(s);
                assert!((c.subsegment(0.0..u).arclen(1e-12) - s).abs() < 1e-9, "{s} {u} {}", table.spans.len());
            }
        }
    }

    /// |C'| = 2u·c for C = c·u² along a line: u = √(s/c), with an infinite slope at the start.
    #[test]
    fn a_start_from_rest_and_a_cusp() {
        let table = ArcLength::new(&|u| 20.0 * u);
        for s in [1e-12, 1e-6, 0.01, 1.0, 9.9] {
            assert!((table.parameter(s) - (s / 10.0).sqrt()).abs() < 1e-7, "{s} {}", table.spans.len());
        }
        assert!((table.parameter(1.0) - 0.1f64.sqrt()).abs() < 1e-13);
        let cusp = of(CubicBez::new((0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0)));
        assert!(cusp.spans.len() < 300 && (cusp.parameter(0.5 * cusp.length()) - 0.5).abs() < 1e-6);
    }

    /// Every span, kept or halved, asks for the speed at its points once; the halved ones are fewer than the kept.
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
