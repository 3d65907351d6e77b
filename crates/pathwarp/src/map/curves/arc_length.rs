//! The inverse of arc length: from the distance along a curve to its parameter, to full precision.
//!
//! The arc length L(u) = ∫|C'| is integrated by the 16-point Gauss–Legendre rule on spans, which are halved until the rule agrees
//! with the sum over both halves. On each span the inverse function u(s) is interpolated at Chebyshev points and stored as a
//! Chebyshev series (Trefethen, *Approximation Theory and Approximation Practice*, 2013, chapters 2–4); a span whose series does
//! not converge is halved as well. A lookup is one binary search and one Clenshaw sum, and its slope is exactly 1/|C'(u)|.

use kurbo::common::GAUSS_LEGENDRE_COEFFS_16;

/// Terms of a series.
const TERMS: usize = 16;
/// Largest magnitude of the last terms of a converged series: the error of the parameter, which runs from 0 to 1.
const TAIL: f64 = 2e-14;
/// Largest disagreement of the integration rule with its halves, relative to the whole length.
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
    /// Chebyshev coefficients of u over [s0, s1].
    c: [f64; TERMS],
}

impl ArcLength {
    /// Tabulates a curve over [0, 1] with speed |C'|.
    pub(crate) fn new(speed: &dyn Fn(f64) -> f64) -> Self {
        let rough: f64 = (0..16).map(|i| integral(speed, f64::from(i) / 16.0, f64::from(i + 1) / 16.0)).sum();
        let mut spans = Vec::new();
        let mut todo = vec![(0.0, 1.0, 0)];
        let mut at = 0.0;
        // Depth first, left before right, so that distances accumulate in order.
        while let Some((a, b, depth)) = todo.pop() {
            let (whole, middle) = (integral(speed, a, b), 0.5 * (a + b));
            let halves = integral(speed, a, middle) + integral(speed, middle, b);
            let last = depth >= MAX_DEPTH || spans.len() + todo.len() >= MAX_SPANS;
            let agrees = (whole - halves).abs() <= INTEGRATION_TOLERANCE * rough;
            if agrees || last {
                let c = series(speed, a, b, whole);
                if c[TERMS - 2].abs() + c[TERMS - 1].abs() <= TAIL || last {
                    spans.push(Span { s0: at, s1: at + whole, c });
                    at += whole;
                    continue;
                }
            }
            todo.push((middle, b, depth + 1));
            todo.push((a, middle, depth + 1));
        }
        Self { spans }
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
            return span.c[0];
        }
        let t = ((s - span.s0) / size).clamp(0.0, 1.0) * 2.0 - 1.0;
        // Clenshaw's recurrence.
        let (mut b1, mut b2) = (0.0, 0.0);
        for c in span.c[1..].iter().rev() {
            (b1, b2) = (2.0 * t * b1 - b2 + c, b1);
        }
        (t * b1 - b2 + span.c[0]).clamp(0.0, 1.0)
    }
}

/// ∫ speed over [a, b].
fn integral(speed: &dyn Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let (m, h) = (0.5 * (a + b), 0.5 * (b - a));
    GAUSS_LEGENDRE_COEFFS_16.iter().map(|(w, x)| w * speed(m + h * x)).sum::<f64>() * h
}

/// The Chebyshev series of u over the distances of [a, b], whose length is `whole`.
fn series(speed: &dyn Fn(f64) -> f64, a: f64, b: f64, whole: f64) -> [f64; TERMS] {
    let n = TERMS as f64;
    let angle = |k: usize| std::f64::consts::PI * (k as f64 + 0.5) / n;
    let mut u = [0.0; TERMS];
    for (k, u) in u.iter_mut().enumerate() {
        *u = solve(speed, a, b, whole, 0.5 * (1.0 + angle(k).cos()));
    }
    std::array::from_fn(|j| {
        let sum: f64 = u.iter().enumerate().map(|(k, u)| u * (j as f64 * angle(k)).cos()).sum();
        sum * if j == 0 { 1.0 } else { 2.0 } / n
    })
}

/// The u in [a, b] that divides the length of the span at `share`, by bracketed Newton iteration.
fn solve(speed: &dyn Fn(f64) -> f64, a: f64, b: f64, whole: f64, share: f64) -> f64 {
    let wanted = whole * share;
    let (mut lo, mut hi) = (a, b);
    let mut u = a + (b - a) * share;
    for _ in 0..60 {
        let off = integral(speed, a, u) - wanted;
        let step = off / speed(u);
        // Test for convergence before updating the bracket, which rounding would make too small.
        if step.abs() <= 2.0 * f64::EPSILON * (b - a) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{CubicBez, ParamCurve, ParamCurveArclen, ParamCurveDeriv};

    fn of(c: CubicBez) -> ArcLength {
        ArcLength::new(&move |u| c.deriv().eval(u).to_vec2().hypot())
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

    #[test]
    fn an_even_speed_is_one_span() {
        let table = ArcLength::new(&|_| 7.0);
        assert_eq!(table.spans.len(), 1);
        assert!((table.parameter(3.0) - 3.0 / 7.0).abs() < 1e-15);
    }
}
