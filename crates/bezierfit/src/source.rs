//! Sources of a fit: curves that give points and derivatives, and further properties that are known.

use crate::limits::SLOW_SPEED;
use crate::sample::{Lane, Lanes, sum};
use kurbo::{CubicBez, Point, QuadBez, Vec2, common::solve_cubic};

/// Below this share of its usual size a derivative is rounding and gives no direction.
pub const VANISHING_DERIVATIVE: f64 = 1e-9;

/// Distance, as a share of the segment, at which a one-sided tangent is taken where the derivative vanishes. Far above rounding;
/// the direction is off by about the same number of radians, a five-hundredth of the 0.01° to which joints are kept smooth.
pub(crate) const ONE_SIDED_STEP: f64 = 3e-7;

/// A curve with a parameter from 0 to 1. A closure from a parameter to a point and a derivative is one.
///
/// Only [`eval`](Source::eval) must be written. The other methods compute values faster, or describe properties that make the fit
/// quicker or its error provable.
pub trait Source {
    /// Point and derivative at `t`.
    fn eval(&self, t: f64) -> (Point, Vec2);

    /// Writes the points at eight parameters.
    #[inline]
    fn points(&self, t: &Lane, out: &mut Lanes) {
        for i in 0..8 {
            let (p, _) = self.eval(t[i]);
            (out.x[i], out.y[i]) = (p.x, p.y);
        }
    }

    /// Parameters inside (0, 1) at which the curve has a corner, a cusp or a jump.
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Returns `true` if the coordinates are polynomials of low degree or quotients of such, so that a few samples show how far a cubic
    /// is from the curve.
    fn is_simple(&self) -> bool {
        false
    }

    /// The curve as a quotient of polynomials, which makes its error provable.
    fn quotient(&self) -> Option<Quotient> {
        None
    }

    /// Values of the denominator at eight parameters, for a [`quotient`](Source::quotient) that leaves them to the source.
    fn denominators(&self, _t: &Lane) -> Lane {
        [1.0; 8]
    }

    /// Returns `true` if samples at `intervals` equal steps between two parameters determine the curve: if no point between them can be
    /// further than a share of `tolerance` from a prediction by them. `None` if that is not known. Then the curve is sampled at more,
    /// uneven parameters, and the report's assurance is [`Sampled`](crate::Assurance::Sampled).
    ///
    /// A curve with features of a known size, such as a quarter of its shortest wavelength, returns `true` if the samples are at most half
    /// of that size apart.
    fn resolved(&self, _between: [f64; 2], _intervals: usize, _tolerance: f64) -> Option<bool> {
        self.is_simple().then_some(true)
    }

    /// The point that reports name for `t`: by default the curve's point.
    fn place(&self, t: f64) -> Point {
        self.eval(t).0
    }

    /// The point at `t` with the tangents before and after it.
    ///
    /// # Errors
    /// [`NotFinite`] if the curve is not finite at `t`.
    fn end(&self, t: f64) -> Result<BreakPoint, NotFinite> {
        let (p, d) = self.eval(t);
        if !(p.is_finite() && d.is_finite()) {
            return Err(NotFinite { t, at: self.place(t) });
        }
        // A thousandth of the curve away, the derivative has its usual size.
        let aside = if t < 0.5 { t + 1e-3 } else { t - 1e-3 };
        let speed = d.hypot();
        if speed > VANISHING_DERIVATIVE * self.eval(aside).1.hypot() {
            return Ok(BreakPoint { t, p, speed, into: d / speed, away: d / speed });
        }
        Ok(BreakPoint { t, p, speed: 0.0, into: tangent_beside(self, t, -1.0), away: tangent_beside(self, t, 1.0) })
    }

    /// Announces the points and ends of several curves that are requested next, for curves whose calls are expensive.
    #[doc(hidden)]
    fn announce<'s>(
        _points: &mut dyn Iterator<Item = (&'s Self, Lane)>,
        _ends: &mut dyn Iterator<Item = (&'s Self, f64)>,
    ) where
        Self: Sized + 's,
    {
    }
}

impl<F: Fn(f64) -> (Point, Vec2)> Source for F {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        self(t)
    }
}

/// Forwards every method, so that [`fit`](crate::fit()) is compiled once for all sources.
impl Source for &dyn Source {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        (**self).eval(t)
    }

    fn points(&self, t: &Lane, out: &mut Lanes) {
        (**self).points(t, out);
    }

    fn breaks(&self) -> Vec<f64> {
        (**self).breaks()
    }

    fn is_simple(&self) -> bool {
        (**self).is_simple()
    }

    fn quotient(&self) -> Option<Quotient> {
        (**self).quotient()
    }

    fn denominators(&self, t: &Lane) -> Lane {
        (**self).denominators(t)
    }

    fn resolved(&self, between: [f64; 2], intervals: usize, tolerance: f64) -> Option<bool> {
        (**self).resolved(between, intervals, tolerance)
    }

    fn place(&self, t: f64) -> Point {
        (**self).place(t)
    }

    fn end(&self, t: f64) -> Result<BreakPoint, NotFinite> {
        (**self).end(t)
    }
}

/// A curve that is not finite at some parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NotFinite {
    /// The parameter.
    pub t: f64,
    /// The [point](Source::place) that stands for it in reports.
    pub at: Point,
}

impl std::fmt::Display for NotFinite {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the curve is not finite at its parameter {}", self.t)
    }
}

impl std::error::Error for NotFinite {}

/// A value that needs a curve to be finite.
pub(crate) type Result<T, E = NotFinite> = std::result::Result<T, E>;

/// A point between two pieces, with the tangents on both sides.
#[derive(Debug, Clone, Copy)]
pub struct BreakPoint {
    /// The parameter.
    pub t: f64,
    /// The point.
    pub p: Point,
    /// Speed with respect to the parameter; zero where the derivative vanishes.
    pub speed: f64,
    /// Unit tangent just before.
    pub into: Vec2,
    /// Unit tangent just after.
    pub away: Vec2,
}

/// A curve as a quotient of polynomials in its parameter.
#[derive(Debug, Clone)]
pub struct Quotient {
    /// Degree of numerators and denominator.
    pub degree: usize,
    /// Degree of the denominator; 0 if there is none.
    pub below: usize,
    /// Bernstein coefficients of the denominator. If `None`, [`Source::denominators`] gives its values.
    pub weights: Option<Vec<f64>>,
    /// Distance of the pieces' ends from the curve, if larger than rounding.
    pub blur: f64,
}

impl Quotient {
    /// A polynomial, which has no denominator.
    #[must_use]
    pub fn polynomial(degree: usize) -> Self {
        Self { degree, below: 0, weights: None, blur: 0.0 }
    }

    /// Values of the denominator at eight parameters.
    pub(crate) fn denominators(&self, source: &impl Source, t: &Lane) -> Lane {
        self.weights.as_ref().map_or_else(|| source.denominators(t), |w| bernstein(w, t))
    }
}

/// Values of the polynomial with Bernstein coefficients `b` at eight parameters.
fn bernstein(b: &[f64], t: &Lane) -> Lane {
    let n = b.len() - 1;
    let mut out = [0.0; 8];
    for i in 0..8 {
        // Each term is the one before times t/(1−t), or in the second half in reverse order with the inverse: at most one.
        let flip = t[i] > 0.5;
        let (s, u) = if flip { (1.0 - t[i], t[i]) } else { (t[i], 1.0 - t[i]) };
        let ratio = s / u;
        let (mut sum, mut binomial) = (0.0, 1.0);
        let mut power = u.powi(n as i32);
        for k in 0..=n {
            let c = if flip { b[n - k] } else { b[k] };
            sum += binomial * power * c;
            power *= ratio;
            binomial *= (n - k) as f64 / (k + 1) as f64;
        }
        out[i] = sum;
    }
    out
}

/// Writes the points at eight parameters. An error unless all are finite.
#[inline(always)]
pub(crate) fn images_into(source: &impl Source, t: &Lane, g: &mut Lanes) -> Result<()> {
    source.points(t, g);
    // One test for all: the sum is finite only if every term is. Terms whose sum overflows are too large to fit.
    let mut all = [0.0; 8];
    for i in 0..8 {
        all[i] = g.x[i] + g.y[i];
    }
    if sum(&all).is_finite() { Ok(()) } else { Err(not_finite(source, t, g)) }
}

/// The points at eight parameters. An error unless all are finite.
#[inline(always)]
pub(crate) fn images(source: &impl Source, t: &Lane) -> Result<Lanes> {
    let mut out = Lanes::default();
    images_into(source, t, &mut out)?;
    Ok(out)
}

#[cold]
fn not_finite(source: &impl Source, t: &Lane, g: &Lanes) -> NotFinite {
    let i = (0..8).find(|&i| !(g.x[i] + g.y[i]).is_finite()).unwrap_or(0);
    NotFinite { t: t[i], at: source.place(t[i]) }
}

/// Unit tangent a little after (`side` = 1) or before (−1) a parameter at which the derivative vanishes; zero for a point.
#[doc(hidden)]
#[cold]
pub fn tangent_beside<S: Source + ?Sized>(source: &S, t: f64, side: f64) -> Vec2 {
    let mut step = ONE_SIDED_STEP;
    while step < 1.0 {
        let aside = t + side * step;
        let aside = if (0.0..=1.0).contains(&aside) { aside } else { t - side * step };
        let flip = if (aside - t) * side < 0.0 { -1.0 } else { 1.0 };
        let (_, d) = source.eval(aside);
        let speed = d.hypot();
        if speed > 0.0 && speed.is_finite() {
            // No piece uses the tangent beyond an end of the curve, so its sign does not matter.
            return d * (flip / speed);
        }
        // Five steps reach a quarter of the curve.
        step *= 30.0;
    }
    Vec2::ZERO
}

/// Maximum number of slow spots of a segment: more than the number of minima of any segment's speed.
const MAX_SLOW: usize = 4;

/// Parameters inside a segment at which it is much slower than elsewhere: cusps and near-cusps, where it turns
/// within a stretch too short for evenly spaced samples.
#[derive(Debug, Clone, Copy, Default)]
pub struct SlowSpots {
    t: [f64; MAX_SLOW],
    len: usize,
}

impl SlowSpots {
    /// The parameters.
    #[must_use]
    pub fn all(&self) -> &[f64] {
        &self.t[..self.len]
    }

    /// Adds a parameter, if there is room.
    pub fn push(&mut self, t: f64) {
        if self.len < MAX_SLOW {
            self.t[self.len] = t;
            self.len += 1;
        }
    }

    /// Maps the spots to another parametrisation.
    #[must_use]
    pub fn map(mut self, f: impl Fn(f64) -> f64) -> Self {
        for t in &mut self.t[..self.len] {
            *t = f(*t);
        }
        self
    }

    /// The spot nearest to the middle of (t0, t1), of those that are further from its ends than rounding.
    pub(crate) fn middlemost(&self, t0: f64, t1: f64) -> Option<f64> {
        let margin = 1e-6 * (t1 - t0);
        let from_middle = |t: &f64| (t - 0.5 * (t0 + t1)).abs();
        let inside = self.all().iter().copied().filter(|t| *t > t0 + margin && *t < t1 - margin);
        inside.min_by(|a, b| from_middle(a).total_cmp(&from_middle(b)))
    }

    /// Slow spots of a quadratic segment.
    #[must_use]
    pub fn of_quad(s: &QuadBez) -> Self {
        let (v, a) = (s.p1 - s.p0, (s.p2 - s.p1) - (s.p1 - s.p0));
        speed_minima(&[v, a, Vec2::ZERO])
    }

    /// Slow spots of a cubic segment.
    #[inline]
    #[must_use]
    pub fn of_cubic(s: &CubicBez) -> Self {
        let (d0, d1, d2) = (s.p1 - s.p0, s.p2 - s.p1, s.p3 - s.p2);
        // With the chord q, |c'| ≥ 3(u²d₀ + 2us·d₁ + s²d₂)·q̂ ≥ 3/2·min(d₀·q̂, d₂·q̂) if no leg of the control polygon runs
        // against q. Most curves end here. The mean of |c'|² is at most 3·size2, so 0.02 keeps |c'| above an eighth of its root.
        let q = s.p3 - s.p0;
        let least = d0.dot(q).min(d2.dot(q));
        let size2 = d0.hypot2() + d1.hypot2() + d2.hypot2();
        if d1.dot(q) >= 0.0 && least > 0.0 && least * least > 0.02 * size2 * q.hypot2() {
            return Self::default();
        }
        speed_minima(&[d0, (d1 - d0) * 2.0, d2 - d1 * 2.0 + d0])
    }

    /// Slow spots of an arc, at angles start + t·sweep, of a flat ellipse with conjugate semi-axes `a` and `b`: the ends of its long axis.
    #[must_use]
    pub fn of_arc([a, b]: [Vec2; 2], start: f64, sweep: f64) -> Self {
        // |P'|² = A + B cos 2θ + C sin 2θ is smallest opposite to the phase (B, C).
        let (aa, bb, ab) = (a.hypot2(), b.hypot2(), a.dot(b));
        let (mean, cosine, sine) = (0.5 * (aa + bb), 0.5 * (bb - aa), -ab);
        let mut out = Self::default();
        if (mean - cosine.hypot(sine)).max(0.0).sqrt() >= SLOW_SPEED * mean.sqrt() || sweep == 0.0 {
            return out;
        }
        let first = 0.5 * (-sine).atan2(-cosine);
        // Four turns to either side of angle zero, beyond every arc.
        for k in -8..=8 {
            let t = (first + f64::from(k) * std::f64::consts::PI - start) / sweep;
            if t > 0.0 && t < 1.0 {
                out.push(t);
            }
        }
        out
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bernstein_sums_are_right_in_both_halves() {
        // Coefficients k/n give the identity.
        let b: Vec<f64> = (0..=7).map(|k| f64::from(k) / 7.0).collect();
        let t = [0.0, 0.1, 0.3, 0.5, 0.6, 0.8, 0.99, 1.0];
        for (v, t) in bernstein(&b, &t).iter().zip(t) {
            assert!((v - t).abs() < 1e-14);
        }
    }

    #[test]
    fn a_cusp_is_found_and_a_round_curve_has_none() {
        // The handles cross so that the curve has a cusp in the middle.
        let found = SlowSpots::of_cubic(&CubicBez::new((0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0)));
        assert_eq!(found.all().len(), 1);
        assert!((found.all()[0] - 0.5).abs() < 1e-12);
        let round = CubicBez::new((0.0, 0.0), (55.0, 0.0), (100.0, 45.0), (100.0, 100.0));
        assert!(SlowSpots::of_cubic(&round).all().is_empty());
    }
}
