//! The number types that a formula runs on: `f64`, dual numbers that carry both partial derivatives, and
//! [enclosures](super::Enclosure).
//!
//! A dual number is v + x·ε₁ + y·ε₂ with εᵢεⱼ = 0. Arithmetic on dual numbers computes values and applies the chain rule at
//! the same time (forward-mode automatic differentiation), exact to rounding.

use super::Map;
use kurbo::Point;
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
    /// The value without derivatives, to branch on between expressions that agree where they meet. For an
    /// [`Enclosure`](super::Enclosure), the middle of its range.
    fn value(self) -> f64;
    /// √x.
    fn sqrt(self) -> Self;
    /// sin x, radians.
    fn sin(self) -> Self;
    /// cos x, radians.
    fn cos(self) -> Self;
    /// eˣ.
    fn exp(self) -> Self;
    /// The natural logarithm.
    fn ln(self) -> Self;
    /// The angle of the vector (x, self) in radians, in (−π, π].
    fn atan2(self, x: Self) -> Self;
    /// An integer power.
    fn powi(self, n: i32) -> Self;
    /// A real power of a positive number.
    fn powf(self, n: f64) -> Self;
    /// √(x² + y²).
    fn hypot(self, y: Self) -> Self;
    /// |x|; at 0 with the derivative of x.
    fn abs(self) -> Self {
        if self.value() < 0.0 { -self } else { self }
    }
    /// The smaller of two numbers.
    fn smaller(self, other: Self) -> Self {
        if self.value() <= other.value() { self } else { other }
    }
    /// 1 for positive numbers, −1 for negative ones, 0 for 0; without derivatives.
    fn sign(self) -> Self {
        let v = self.value();
        Self::from(if v == 0.0 { 0.0 } else { v.signum() })
    }
    /// The largest integer that is not larger than the number; without derivatives.
    fn floor(self) -> Self {
        Self::from(self.value().floor())
    }
    /// The image of a point under a map that is not a formula; without derivatives, unless the number type asks the map for them.
    #[doc(hidden)]
    fn image<M: Map + ?Sized>(map: &M, at: [Self; 2]) -> (Self, Self) {
        let p = map.point(Point::new(at[0].value(), at[1].value()));
        (p.x.into(), p.y.into())
    }
}

/// Implements operators of a type, one on each line.
macro_rules! operators {
    (#[$inline:meta] $type:ty: $($operator:ident $method:ident $other:ty: |$a:ident, $b:ident| $result:expr;)*) => {$(
        impl $operator<$other> for $type {
            type Output = Self;
            #[$inline]
            fn $method(self, $b: $other) -> Self {
                let $a = self;
                $result
            }
        }
    )*};
}
pub(super) use operators;

/// Implements [`Real`] for `f64` by the functions that `f64` has by the same names.
macro_rules! std_functions {
    ($($name:ident($($argument:ident: $type:ty)?);)*) => {
        impl Real for f64 {
            #[inline]
            fn value(self) -> f64 {
                self
            }
            $(#[inline]
            fn $name(self $(, $argument: $type)?) -> Self {
                self.$name($($argument)?)
            })*
        }
    };
}
std_functions! { sqrt(); sin(); cos(); exp(); ln(); atan2(x: f64); powi(n: i32); powf(n: f64); hypot(y: f64); }

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
    /// f(self), given the value and slope of f at `self`.
    #[inline]
    fn chain(self, value: f64, slope: f64) -> Self {
        if slope.is_infinite() {
            // Where both derivatives vanish, so does the result, even if the slope is infinite, as at the tip of √(x² + y²).
            let product = |d: f64| if d == 0.0 { 0.0 } else { d * slope };
            return Self { v: value, x: product(self.x), y: product(self.y) };
        }
        Self { v: value, x: self.x * slope, y: self.y * slope }
    }
}

impl From<f64> for Dual {
    #[inline]
    fn from(v: f64) -> Self {
        Self { v, x: 0.0, y: 0.0 }
    }
}

operators! { #[inline] Dual:
    Add add Self: |a, b| Self { v: a.v + b.v, x: a.x + b.x, y: a.y + b.y };
    Sub sub Self: |a, b| Self { v: a.v - b.v, x: a.x - b.x, y: a.y - b.y };
    Mul mul Self: |a, b| Self { v: a.v * b.v, x: a.x * b.v + a.v * b.x, y: a.y * b.v + a.v * b.y };
    Div div Self: |a, b| {
        let v = a.v / b.v;
        Self { v, x: (a.x - v * b.x) / b.v, y: (a.y - v * b.y) / b.v }
    };
    Add add f64: |a, b| Self { v: a.v + b, ..a };
    Sub sub f64: |a, b| Self { v: a.v - b, ..a };
    Mul mul f64: |a, b| Self { v: a.v * b, x: a.x * b, y: a.y * b };
    Div div f64: |a, b| Self { v: a.v / b, x: a.x / b, y: a.y / b };
}

impl Neg for Dual {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { v: -self.v, x: -self.x, y: -self.y }
    }
}

/// Implements functions of a dual number by their values and slopes at its value.
macro_rules! chained {
    ($($name:ident($v:ident $(, $n:ident: $type:ty)?) => $value_and_slope:expr;)*) => {$(
        #[inline]
        fn $name(self $(, $n: $type)?) -> Self {
            let $v = self.v;
            let (value, slope) = $value_and_slope;
            self.chain(value, slope)
        }
    )*};
}

impl Real for Dual {
    #[inline]
    fn value(self) -> f64 {
        self.v
    }
    fn image<M: Map + ?Sized>(map: &M, [x, y]: [Self; 2]) -> (Self, Self) {
        let jet = map.jet(Point::new(x.v, y.v));
        let (dx, dy) = (jet.push((x.x, y.x).into()), jet.push((x.y, y.y).into()));
        (Self { v: jet.p.x, x: dx.x, y: dy.x }, Self { v: jet.p.y, x: dx.y, y: dy.y })
    }
    chained! {
        sqrt(v) => { let r = v.sqrt(); (r, 0.5 / r) };
        sin(v) => (v.sin(), v.cos());
        cos(v) => (v.cos(), -v.sin());
        exp(v) => { let e = v.exp(); (e, e) };
        ln(v) => (v.ln(), 1.0 / v);
        powi(v, n: i32) => (v.powi(n), if n == 0 { 0.0 } else { f64::from(n) * v.powi(n - 1) });
        powf(v, n: f64) => (v.powf(n), if n == 0.0 { 0.0 } else { n * v.powf(n - 1.0) });
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let r2 = self.v * self.v + x.v * x.v;
        let (a, b) = (x.v / r2, -self.v / r2);
        Self { v: self.v.atan2(x.v), x: a * self.x + b * x.x, y: a * self.y + b * x.y }
    }
    #[inline]
    fn hypot(self, y: Self) -> Self {
        let r = self.v.hypot(y.v);
        // The tip of the cone has no derivative. 0 is the mean over all directions and keeps the result finite.
        let (a, b) = if r > 0.0 { (self.v / r, y.v / r) } else { (0.0, 0.0) };
        Self { v: r, x: a * self.x + b * y.x, y: a * self.y + b * y.y }
    }
}
