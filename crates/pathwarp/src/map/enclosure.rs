//! Enclosures: bounds for a formula along a piece of a curve.
//!
//! A number along a piece of a curve is a function f of a parameter τ from 0 to 1. An [`Enclosure`] holds a range of its values and
//! bounds for its Taylor coefficients |f⁽ᵏ⁾|/k! for all τ. Sums and products of functions have the sums and Cauchy products of
//! the bounds, and g ∘ f has Σ gₖ·(f₁τ + f₂τ² + …)ᵏ, with bounds gₖ for the coefficients of g on f's range (R. E. Moore, *Methods and
//! Applications of Interval Analysis*, SIAM 1979, chapter 3).

use super::real::operators;
use super::{Map, Real};
use crate::outline::Seg;
use kurbo::{Point, Rect};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The number of derivatives that are bounded.
const ORDER: usize = 6;

/// 1/k!, k from 1.
const FACTORIALS: [f64; ORDER] = [1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0];

/// A function of a parameter from 0 to 1: a range of its values, and bounds for its derivatives.
///
/// It computes like a number, so that every [`Formula`](super::Formula) runs on it. Its bounds are infinite, or NaN, where a formula has no
/// derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Enclosure {
    /// The least and the largest value.
    pub(crate) lo: f64,
    pub(crate) hi: f64,
    /// Bounds for |f⁽ᵏ⁾|/k!, k from 1.
    pub(crate) d: [f64; ORDER],
}

impl Enclosure {
    /// The number of derivatives that are bounded.
    pub(crate) const ORDER: usize = ORDER;

    /// A bound for the product of the distances of a point from six neighbouring samples, in steps; see [`resolved`](Self::resolved).
    pub(crate) const LAST_SPREAD: f64 = 4.0;

    /// Encloses v + hτ and v − hτ, for every v for which they stay at most `far` from the middle.
    pub(crate) fn sloped(middle: f64, [far, h]: [f64; 2]) -> Self {
        let mut d = [0.0; ORDER];
        d[0] = h;
        Self { lo: middle - far, hi: middle + far, d }
    }

    /// Encloses a polynomial a₀ + a₁τ + a₂τ² + a₃τ³.
    #[must_use]
    pub fn cubic([a0, a1, a2, a3]: [f64; 4]) -> Self {
        // The values lie between the Bernstein coefficients, and the derivatives between theirs.
        let b = [a0, a0 + a1 / 3.0, a0 + (2.0 * a1 + a2) / 3.0, a0 + a1 + a2 + a3];
        let mut d = [0.0; ORDER];
        d[0] = a1.abs().max((a1 + a2).abs()).max((a1 + 2.0 * a2 + 3.0 * a3).abs());
        d[1] = a2.abs().max((a2 + 3.0 * a3).abs());
        d[2] = a3.abs();
        let [lo, hi] = range(b);
        Self { lo, hi, d }
    }

    /// Encloses a + (b − a)τ.
    #[must_use]
    pub fn between(a: f64, b: f64) -> Self {
        Self::cubic([a, b - a, 0.0, 0.0])
    }

    /// The box that contains the curve.
    #[must_use]
    pub fn area([x, y]: &[Self; 2]) -> Rect {
        Rect::new(x.lo, y.lo, x.hi, y.hi)
    }

    /// The image of a curve under a map that stretches by at most `stretch` and has no features smaller than `detail`, given the image of
    /// the middle of the curve's box: by Cauchy's estimates, the map's coefficients are at most stretch·detail¹⁻ᵏ/k.
    pub(crate) fn estimated([x, y]: [Self; 2], middle: Point, stretch: f64, detail: f64) -> [Self; 2] {
        let path = Self { lo: 0.0, hi: 0.0, d: std::array::from_fn(|k| x.d[k].hypot(y.d[k])) };
        let radius = 0.5 * stretch * (x.hi - x.lo).hypot(y.hi - y.lo);
        let image = path.mapped([-radius, radius], coefficients(|k| stretch * detail.powi(1 - k) / f64::from(k)));
        [image + middle.x, image + middle.y]
    }

    /// Returns `true` if samples at `intervals` equal steps determine both coordinates of a curve: if interpolation between them is at
    /// most `tolerance` from the curve.
    #[must_use]
    pub fn resolved([x, y]: &[Self; 2], intervals: usize, tolerance: f64) -> bool {
        /// Bounds for the product of the distances of a point from k neighbouring samples, in steps. Between the middle ones it is at most
        /// 0.5, 0.25, 0.385, 0.563, 1.42 and 3.52. Near the curve's end, which counts twice as its derivative is known, the last is 3.64.
        const SPREAD: [f64; ORDER] = [0.5, 0.25, 0.385, 1.0, 2.0, Enclosure::LAST_SPREAD];
        let step = 1.0 / intervals as f64;
        let mut power = 1.0;
        let is_resolved_by_order = |k: usize| {
            power *= step;
            // Also false for NaN.
            SPREAD[k] * power * (x.d[k] + y.d[k]) <= tolerance
        };
        (0..ORDER).any(is_resolved_by_order) || (x.hi - x.lo) + (y.hi - y.lo) <= tolerance
    }

    /// The size of the smallest feature of a curve, as a share of its parameter range: the largest r with coefficient k at most the first
    /// one times r¹⁻ᵏ.
    pub(crate) fn finest_share([x, y]: &[Self; 2]) -> f64 {
        let d = |k: usize| x.d[k] + y.d[k];
        (1..ORDER).map(|k| (d(0) / d(k)).powf(1.0 / k as f64)).fold(f64::INFINITY, f64::min)
    }

    /// The largest magnitude.
    fn max_abs(&self) -> f64 {
        self.hi.abs().max(self.lo.abs())
    }

    /// The least magnitude; 0 if the sign is not known.
    fn min_abs(&self) -> f64 {
        self.lo.max(-self.hi).max(0.0)
    }

    /// Encloses g ∘ f, given the range of g and bounds for its coefficients |g⁽ᵏ⁾|/k! on the range of f.
    #[inline(never)]
    fn mapped(&self, [lo, hi]: [f64; 2], coefficients: [f64; ORDER]) -> Self {
        let mut out = Self { lo, hi, d: [0.0; ORDER] };
        if self.d == out.d {
            return out;
        }
        // Horner's rule, with one more term at every step.
        for (step, coefficient) in coefficients.into_iter().rev().enumerate() {
            for i in (0..=step).rev() {
                out.d[i] = self.d[i] * coefficient + (0..i).map(|j| self.d[j] * out.d[i - 1 - j]).sum::<f64>();
            }
        }
        out
    }

    /// A function with a kink or a jump somewhere.
    fn broken(lo: f64, hi: f64, slope: f64) -> Self {
        let mut d = [f64::INFINITY; ORDER];
        d[0] = slope;
        Self { lo, hi, d }
    }

    /// 1/f.
    fn reciprocal(&self) -> Self {
        let most = 1.0 / self.min_abs();
        let range = if most.is_finite() { [1.0 / self.hi, 1.0 / self.lo] } else { [-most, most] };
        let mut power = most;
        let coefficient = |_| {
            power *= most;
            power
        };
        self.mapped(range, coefficients(coefficient))
    }

    /// fᵃ in a range. The coefficients are (a over k)·fᵃ⁻ᵏ.
    fn power(&self, range: [f64; 2], a: f64) -> Self {
        let mut over = 1.0;
        let mut powers = [self.min_abs(), self.max_abs()].map(|v| (v.powf(a), v));
        let coefficient = |k: i32| {
            over *= (a - f64::from(k - 1)).abs() / f64::from(k);
            powers = powers.map(|(power, v)| (power / v, v));
            if over == 0.0 { 0.0 } else { over * powers[usize::from(a >= f64::from(k))].0 }
        };
        self.mapped(range, coefficients(coefficient))
    }

    /// The sine or the cosine, with this range of values, and this range of the derivative, but for the sign.
    fn wave(&self, values: [f64; 2], derivative: [f64; 2]) -> Self {
        let [even, odd] = [values, derivative].map(|[lo, hi]| hi.max(-lo));
        let [f1, f2, f3, f4, f5, f6] = FACTORIALS;
        self.mapped(values, [odd * f1, even * f2, odd * f3, even * f4, odd * f5, even * f6])
    }

    /// The ranges of sine and cosine.
    fn ranges(&self) -> [[f64; 2]; 2] {
        /// The positions of larger angles in the circle are rounding errors.
        const FAR: f64 = 1e12;
        let is_known = self.hi - self.lo < TAU && self.max_abs() < FAR;
        if !is_known {
            return [[-1.0, 1.0]; 2];
        }
        let ((s0, c0), (s1, c1)) = (self.lo.sin_cos(), self.hi.sin_cos());
        let mut out = [range([s0, s1]), range([c0, c1])];
        let quarters = [self.lo, self.hi].map(|v| (v / FRAC_PI_2).floor() as i64);
        for quarter in quarters[0] + 1..=quarters[1] {
            // At odd multiples of a right angle the sine is 1 or −1, at even ones the cosine, and it is 1 on every other one.
            let (is_sine, is_maximum) = (quarter & 1 == 1, (quarter >> 1) & 1 == 0);
            out[usize::from(!is_sine)][usize::from(is_maximum)] = if is_maximum { 1.0 } else { -1.0 };
        }
        out
    }
}

/// Bounds for the coefficients of each order, from 1.
fn coefficients(mut bound: impl FnMut(i32) -> f64) -> [f64; ORDER] {
    std::array::from_fn(|k| bound(k as i32 + 1))
}

/// The least and the largest value.
fn range<const N: usize>(values: [f64; N]) -> [f64; 2] {
    [values.into_iter().fold(values[0], f64::min), values.into_iter().fold(values[0], f64::max)]
}

/// The coordinates of a segment between two parameters.
pub(crate) fn enclose_segment(seg: &Seg, [from, to]: [f64; 2]) -> [Enclosure; 2] {
    if let Seg::Arc(a) = seg {
        let angle = Enclosure::between(a.start + from * a.sweep, a.start + to * a.sweep);
        let (sin, cos) = (angle.sin(), angle.cos());
        return [cos * a.a.x + sin * a.b.x + a.center.x, cos * a.a.y + sin * a.b.y + a.center.y];
    }
    // Only arcs have no parts.
    let c = seg.part(from, to).unwrap_or(*seg).to_cubic();
    let (d0, d1, d2) = ((c.p1 - c.p0) * 3.0, (c.p2 - c.p1) * 3.0, (c.p3 - c.p2) * 3.0);
    let (a2, a3) = (d1 - d0, (d2 - d1 * 2.0 + d0) / 3.0);
    [[c.p0.x, d0.x, a2.x, a3.x], [c.p0.y, d0.y, a2.y, a3.y]].map(Enclosure::cubic)
}

impl From<f64> for Enclosure {
    fn from(v: f64) -> Self {
        Self { lo: v, hi: v, d: [0.0; ORDER] }
    }
}

// Not inlined: the code would be repeated in every formula.
operators! { #[inline(never)] Enclosure:
    Add add Self: |a, b| Self { lo: a.lo + b.lo, hi: a.hi + b.hi, d: std::array::from_fn(|k| a.d[k] + b.d[k]) };
    Sub sub Self: |a, b| a + -b;
    Mul mul Self: |a, b| {
        let [lo, hi] = range([a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi]);
        let (max_a, max_b) = (a.max_abs(), b.max_abs());
        let mixed = |k: usize| (0..k).map(|j| a.d[j] * b.d[k - 1 - j]).sum::<f64>();
        Self { lo, hi, d: std::array::from_fn(|k| max_a * b.d[k] + a.d[k] * max_b + mixed(k)) }
    };
    Div div Self: |a, b| Mul::mul(a, b.reciprocal());
    Add add f64: |a, b| Self { lo: a.lo + b, hi: a.hi + b, ..a };
    Sub sub f64: |a, b| a + -b;
    Mul mul f64: |a, b| {
        let [lo, hi] = range([a.lo * b, a.hi * b]);
        Self { lo, hi, d: a.d.map(|d| d * b.abs()) }
    };
    Div div f64: |a, b| a * (1.0 / b);
}

impl Neg for Enclosure {
    type Output = Self;
    fn neg(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo, ..self }
    }
}

impl Real for Enclosure {
    /// The middle of the range.
    fn value(self) -> f64 {
        0.5 * (self.lo + self.hi)
    }

    fn image<M: Map + ?Sized>(map: &M, at: [Self; 2]) -> (Self, Self) {
        let unknown = || Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY, d: [f64::INFINITY; ORDER] };
        map.enclose(at).unwrap_or_else(|| [unknown(), unknown()]).into()
    }

    fn sqrt(self) -> Self {
        self.powf(0.5)
    }

    fn sin(self) -> Self {
        let [sin, cos] = self.ranges();
        self.wave(sin, cos)
    }

    fn cos(self) -> Self {
        let [sin, cos] = self.ranges();
        self.wave(cos, sin)
    }

    fn exp(self) -> Self {
        let most = self.hi.exp();
        self.mapped([self.lo.exp(), most], FACTORIALS.map(|f| most * f))
    }

    fn ln(self) -> Self {
        let least = self.lo.max(0.0);
        self.mapped([least.ln(), self.hi.ln()], coefficients(|k| 1.0 / (f64::from(k) * least.powi(k))))
    }

    /// The angle from the middle's direction is an arctangent, whose coefficients are at most 1/k.
    fn atan2(self, x: Self) -> Self {
        let middle = self.value().atan2(x.value());
        let (sin, cos) = middle.sin_cos();
        let (ahead, aside) = (x * cos + self * sin, self * cos - x * sin);
        if ahead.lo > 0.0 {
            let slope = aside / ahead;
            slope.mapped([slope.lo.atan(), slope.hi.atan()], coefficients(|k| 1.0 / f64::from(k))) + middle
        } else {
            Self::broken(-PI, PI, f64::INFINITY)
        }
    }

    fn powi(self, n: i32) -> Self {
        if n < 0 {
            return self.powi(-n).reciprocal();
        }
        let ends = if n % 2 == 0 { [self.min_abs(), self.max_abs()] } else { [self.lo, self.hi] };
        self.power(ends.map(|v| v.powi(n)), f64::from(n))
    }

    fn powf(self, a: f64) -> Self {
        self.power(range([self.lo.max(0.0).powf(a), self.hi.powf(a)]), a)
    }

    fn hypot(self, y: Self) -> Self {
        (self.powi(2) + y.powi(2)).sqrt()
    }

    fn abs(self) -> Self {
        -self.smaller(-self)
    }

    fn smaller(self, o: Self) -> Self {
        if self.hi <= o.lo {
            self
        } else if o.hi <= self.lo {
            o
        } else {
            Self::broken(self.lo.min(o.lo), self.hi.min(o.hi), self.d[0].max(o.d[0]))
        }
    }

    fn sign(self) -> Self {
        if self.min_abs() > 0.0 { Self::from(self.hi.signum()) } else { Self::broken(-1.0, 1.0, f64::INFINITY) }
    }

    fn floor(self) -> Self {
        let (lo, hi) = (self.lo.floor(), self.hi.floor());
        if lo == hi { Self::from(lo) } else { Self::broken(lo, hi, f64::INFINITY) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Dual;

    /// Formulas of all operations, along the line x = 0.3 + w·τ, y = 1.7 − 2w·τ.
    fn all<S: Real>(x: S, y: S) -> [S; 16] {
        [
            x * y - x / y,
            (x * 9.0).sin() * (y * 7.0).cos(),
            (x * -4.0).exp() + y,
            (x * y + 1.0).ln(),
            (x + y).sqrt(),
            (x - 1.0).powi(4),
            (y - 0.5).powi(-3),
            (x + 2.0).powf(-1.3),
            (y - 1.0).atan2(x - 0.4),
            (x - 0.7).hypot(y - 1.1),
            (x - 0.5).abs() * y,
            x.smaller(y - 0.9),
            (x * x + y * y) / (x + 3.0),
            ((x - 0.6) * 3.0).sin().exp(),
            (x * 2.0).floor() + y,
            (y - 1.3).sign() - x * 0.5,
        ]
    }

    /// Values and slopes at many parameters are within the enclosure; so are differences of order 2 to 6, which are means of derivatives.
    #[test]
    fn enclosures_hold() {
        for w in [1e-3, 0.02, 0.1, 0.4, 1.2] {
            let along = [Enclosure::between(0.3, 0.3 + w), Enclosure::between(1.7, 1.7 - 2.0 * w)];
            let bounds = all(along[0], along[1]);
            let at =
                |t: f64| all(Dual { v: 0.3 + w * t, x: w, y: 0.0 }, Dual { v: 1.7 - 2.0 * w * t, x: -2.0 * w, y: 0.0 });
            const N: usize = 24;
            let samples: Vec<[Dual; 16]> = (0..=N).map(|i| at(i as f64 / N as f64)).collect();
            for (f, e) in bounds.iter().enumerate() {
                for s in &samples {
                    if s[f].v.is_nan() {
                        continue;
                    }
                    assert!(s[f].v >= e.lo - 1e-12 && s[f].v <= e.hi + 1e-12, "{f} {w}: {:?} {e:?}", s[f]);
                    let within = s[f].x.abs() <= e.d[0] + 1e-12;
                    assert!(within || e.d[0].is_nan(), "{f} {w}: {:?} {e:?}", s[f]);
                }
                let mut difference: Vec<f64> = samples.iter().map(|s| s[f].v).collect();
                let mut scale = 1.0;
                for k in 1..=ORDER {
                    difference = difference.windows(2).map(|v| v[1] - v[0]).collect();
                    scale *= N as f64 / k as f64;
                    let most = difference.iter().fold(0.0, |m: f64, d| m.max(d.abs())) * scale;
                    let bound = e.d[k - 1] * (1.0 + 1e-9) + 1e-12 * scale;
                    assert!(most <= bound || bound.is_nan(), "{f} {w} {k}: {most} {e:?}");
                }
            }
        }
    }

    /// A wave is resolved by forty samples for each period, but not by seventeen samples of many periods.
    #[test]
    fn samples_resolve_a_wave_where_they_show_it() {
        let wave = |n: f64| {
            let x = Enclosure::between(0.0, 1.0);
            [x, (x * (n * TAU)).sin() * 5.0]
        };
        for n in [17.0, 34.0, 100.0] {
            assert!(!Enclosure::resolved(&wave(n), 17, 0.1), "{n}");
            assert!(Enclosure::resolved(&wave(n), 40 * n as usize, 0.1), "{n}");
        }
        assert!(Enclosure::resolved(&wave(1.0), 17, 0.1));
    }
}
