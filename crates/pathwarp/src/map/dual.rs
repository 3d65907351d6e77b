//! The number types that a [`Formula`](super::Formula) runs on: `f64`, and dual numbers that carry both partial derivatives.
//!
//! A dual number is v + x·ε₁ + y·ε₂ with εᵢεⱼ = 0. Arithmetic on dual numbers computes values and applies the chain rule at
//! the same time (forward-mode automatic differentiation), exact to rounding.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number, or a type that computes like one.
pub trait Real:
    Copy
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + From<f64>
{
    /// The value without derivatives, to branch on.
    fn value(self) -> f64;
    /// √x.
    #[must_use]
    fn sqrt(self) -> Self;
    /// sin x, radians.
    #[must_use]
    fn sin(self) -> Self;
    /// cos x, radians.
    #[must_use]
    fn cos(self) -> Self;
    /// eˣ.
    #[must_use]
    fn exp(self) -> Self;
    /// Natural logarithm.
    #[must_use]
    fn ln(self) -> Self;
    /// The angle of the vector (x, self) in radians, in (−π, π].
    #[must_use]
    fn atan2(self, x: Self) -> Self;
    /// An integer power.
    #[must_use]
    fn powi(self, n: i32) -> Self;
    /// A real power of a positive number.
    #[must_use]
    fn powf(self, n: f64) -> Self;
    /// √(x² + y²).
    #[must_use]
    fn hypot(self, y: Self) -> Self;
    /// |x|; at 0 the derivative of +x.
    #[must_use]
    fn abs(self) -> Self {
        if self.value() < 0.0 { -self } else { self }
    }
}

impl Real for f64 {
    #[inline]
    fn value(self) -> f64 {
        self
    }
    #[inline]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    #[inline]
    fn sin(self) -> Self {
        self.sin()
    }
    #[inline]
    fn cos(self) -> Self {
        self.cos()
    }
    #[inline]
    fn exp(self) -> Self {
        self.exp()
    }
    #[inline]
    fn ln(self) -> Self {
        self.ln()
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        self.atan2(x)
    }
    #[inline]
    fn powi(self, n: i32) -> Self {
        self.powi(n)
    }
    #[inline]
    fn powf(self, n: f64) -> Self {
        self.powf(n)
    }
    #[inline]
    fn hypot(self, y: Self) -> Self {
        self.hypot(y)
    }
}

/// A number with its derivatives with respect to x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual {
    /// The value.
    pub v: f64,
    /// ∂/∂x.
    pub x: f64,
    /// ∂/∂y.
    pub y: f64,
}

impl Dual {
    /// f(self), given the value and slope of f there.
    #[inline]
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { v: value, x: self.x * slope, y: self.y * slope }
    }
}

impl From<f64> for Dual {
    #[inline]
    fn from(v: f64) -> Self {
        Self { v, x: 0.0, y: 0.0 }
    }
}

impl Add for Dual {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self { v: self.v + o.v, x: self.x + o.x, y: self.y + o.y }
    }
}

impl Sub for Dual {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self { v: self.v - o.v, x: self.x - o.x, y: self.y - o.y }
    }
}

impl Mul for Dual {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        Self { v: self.v * o.v, x: self.x * o.v + self.v * o.x, y: self.y * o.v + self.v * o.y }
    }
}

impl Div for Dual {
    type Output = Self;
    #[inline]
    fn div(self, o: Self) -> Self {
        let v = self.v / o.v;
        Self { v, x: (self.x - v * o.x) / o.v, y: (self.y - v * o.y) / o.v }
    }
}

impl Neg for Dual {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { v: -self.v, x: -self.x, y: -self.y }
    }
}

impl Add<f64> for Dual {
    type Output = Self;
    #[inline]
    fn add(self, o: f64) -> Self {
        Self { v: self.v + o, ..self }
    }
}

impl Sub<f64> for Dual {
    type Output = Self;
    #[inline]
    fn sub(self, o: f64) -> Self {
        Self { v: self.v - o, ..self }
    }
}

impl Mul<f64> for Dual {
    type Output = Self;
    #[inline]
    fn mul(self, o: f64) -> Self {
        Self { v: self.v * o, x: self.x * o, y: self.y * o }
    }
}

impl Div<f64> for Dual {
    type Output = Self;
    #[inline]
    fn div(self, o: f64) -> Self {
        Self { v: self.v / o, x: self.x / o, y: self.y / o }
    }
}

impl Real for Dual {
    #[inline]
    fn value(self) -> f64 {
        self.v
    }
    #[inline]
    fn sqrt(self) -> Self {
        let r = self.v.sqrt();
        self.chain(r, 0.5 / r)
    }
    #[inline]
    fn sin(self) -> Self {
        let (s, c) = self.v.sin_cos();
        self.chain(s, c)
    }
    #[inline]
    fn cos(self) -> Self {
        let (s, c) = self.v.sin_cos();
        self.chain(c, -s)
    }
    #[inline]
    fn exp(self) -> Self {
        let e = self.v.exp();
        self.chain(e, e)
    }
    #[inline]
    fn ln(self) -> Self {
        self.chain(self.v.ln(), 1.0 / self.v)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let r2 = self.v * self.v + x.v * x.v;
        let (a, b) = (x.v / r2, -self.v / r2);
        Self { v: self.v.atan2(x.v), x: a * self.x + b * x.x, y: a * self.y + b * x.y }
    }
    #[inline]
    fn powi(self, n: i32) -> Self {
        self.chain(self.v.powi(n), if n == 0 { 0.0 } else { f64::from(n) * self.v.powi(n - 1) })
    }
    #[inline]
    fn powf(self, n: f64) -> Self {
        self.chain(self.v.powf(n), if n == 0.0 { 0.0 } else { n * self.v.powf(n - 1.0) })
    }
    #[inline]
    fn hypot(self, o: Self) -> Self {
        let r = self.v.hypot(o.v);
        // The tip of the cone has no derivative. 0 is the mean over all directions and keeps the result finite.
        let (a, b) = if r > 0.0 { (self.v / r, o.v / r) } else { (0.0, 0.0) };
        Self { v: r, x: a * self.x + b * o.x, y: a * self.y + b * o.y }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares the derivative of every operation with central differences.
    #[test]
    fn derivatives_agree_with_differences() {
        fn all<S: Real>(x: S, y: S) -> [S; 14] {
            [
                x + y * 2.0,
                x - y / 3.0,
                x * y,
                x / y,
                -x,
                (x * x + y).sqrt(),
                (x * y).sin(),
                (x - y).cos(),
                (x / y).exp(),
                (x + y).ln(),
                y.atan2(x),
                (x + 1.0).powi(3) - S::from(2.0),
                (x * y).powf(1.7),
                x.hypot(y) + (x - y).abs(),
            ]
        }
        let (x, y, h) = (0.8, 1.7, 1e-6);
        let d = all(Dual { v: x, x: 1.0, y: 0.0 }, Dual { v: y, x: 0.0, y: 1.0 });
        let (xp, xm, yp, ym) = (all(x + h, y), all(x - h, y), all(x, y + h), all(x, y - h));
        for i in 0..d.len() {
            assert_eq!(d[i].v, all(x, y)[i], "value {i}");
            assert!((d[i].x - (xp[i] - xm[i]) / (2.0 * h)).abs() < 1e-8, "d/dx {i}");
            assert!((d[i].y - (yp[i] - ym[i]) / (2.0 * h)).abs() < 1e-8, "d/dy {i}");
        }
    }
}
