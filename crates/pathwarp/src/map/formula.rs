//! The short way to write a map: one formula, generic over the number type.

use super::{Class, Cost, Creases, Jet, Map, RationalBezier};
use kurbo::{Point, Vec2};
use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::Arc;

/// A map given by a formula. Every `Formula` is a [`Map`]: its values come from running the formula on `f64`, its derivatives
/// from running it on [`Dual`] numbers.
///
/// ```
/// use pathwarp::map::{Formula, Map, Real};
///
/// struct Wave { height: f64, length: f64 }
///
/// impl Formula for Wave {
///     fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
///         (x, y + (x / self.length * std::f64::consts::TAU).sin() * self.height)
///     }
/// }
///
/// let jet = Wave { height: 3.0, length: 40.0 }.jet((10.0, 5.0).into());
/// assert_eq!(jet.p.y, 8.0);
/// assert!((jet.det() - 1.0).abs() < 1e-15); // a shear preserves areas
/// ```
pub trait Formula: Send + Sync {
    /// The image of (x, y).
    fn f<S: Real>(&self, x: S, y: S) -> (S, S);

    /// See [`Map::class`].
    fn class(&self) -> Class {
        Class::Smooth
    }

    /// See [`Map::creases`].
    fn creases(&self, _out: &mut Creases) {}

    /// See [`Map::branch`].
    fn branch(&self, _inside: Point) -> Option<Arc<dyn Map>> {
        None
    }

    /// See [`Map::image`].
    fn image(&self, _curve: &RationalBezier) -> Option<RationalBezier> {
        None
    }

    /// See [`Map::denominator`].
    fn denominator(&self, _p: Point) -> f64 {
        1.0
    }

    /// See [`Map::inverse`].
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        None
    }

    /// See [`Map::cost`].
    fn cost(&self) -> Cost<'_> {
        Cost::NET
    }
}

impl<F: Formula> Map for F {
    #[inline]
    fn jet(&self, p: Point) -> Jet {
        let (x, y) = self.f(Dual { v: p.x, x: 1.0, y: 0.0 }, Dual { v: p.y, x: 0.0, y: 1.0 });
        Jet { p: Point::new(x.v, y.v), dx: (x.x, y.x).into(), dy: (x.y, y.y).into() }
    }

    #[inline]
    fn point(&self, p: Point) -> Point {
        self.f(p.x, p.y).into()
    }

    fn class(&self) -> Class {
        Formula::class(self)
    }

    fn creases(&self, out: &mut Creases) {
        Formula::creases(self, out);
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        Formula::branch(self, inside)
    }

    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        Formula::image(self, curve)
    }

    fn denominator(&self, p: Point) -> f64 {
        Formula::denominator(self, p)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Formula::inverse(self)
    }

    fn cost(&self) -> Cost<'_> {
        Formula::cost(self)
    }
}

// The number types that a `Formula` runs on: `f64`, and dual numbers that carry both partial derivatives.
//
// A dual number is v + x·ε₁ + y·ε₂ with εᵢεⱼ = 0. Arithmetic on dual numbers computes values and applies the chain rule at
// the same time (forward-mode automatic differentiation), exact to rounding.

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

/// A map from a closure that gives the image of a point. Its derivatives are differences of values, good to nine digits or so where the map
/// varies over lengths of a hundredth of a drawing and more, and they cost eight calls each; [`from_fn_with`] takes exact ones, and a
/// [`Formula`] has them by itself. A point without an image maps to NaN.
///
/// ```
/// use pathwarp::{Outline, kurbo::Point, map, refit};
///
/// let wave = map::from_fn(|p| Point::new(p.x, p.y + (p.x / 20.0).sin() * 5.0));
/// let square = Outline::from_svg("M0,0 H100 V100 H0 Z")?;
/// let warped = refit::warp_path(&square, &wave, &refit::Options::new(0.01))?;
/// assert!(warped.report.max_error <= 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn from_fn<F: Fn(Point) -> Point + Send + Sync>(f: F) -> FromFn<F> {
    FromFn(f)
}

/// A map from a closure that gives the image of a point, and one that gives both partial derivatives there: the images of small steps along
/// x and along y.
///
/// ```
/// use pathwarp::kurbo::{Point, Vec2};
/// use pathwarp::map::{self, Map};
///
/// let square = map::from_fn_with(
///     |p| Point::new(p.x * p.x - p.y * p.y, 2.0 * p.x * p.y),
///     |p| [Vec2::new(2.0 * p.x, 2.0 * p.y), Vec2::new(-2.0 * p.y, 2.0 * p.x)],
/// );
/// assert_eq!(square.jet(Point::new(3.0, 4.0)).det(), 100.0);
/// ```
#[must_use]
pub fn from_fn_with<F, J>(f: F, jacobian: J) -> FromFnWith<F, J>
where
    F: Fn(Point) -> Point + Send + Sync,
    J: Fn(Point) -> [Vec2; 2] + Send + Sync,
{
    FromFnWith(f, jacobian)
}

/// The map of [`from_fn`].
#[derive(Clone, Copy)]
pub struct FromFn<F>(F);

/// The map of [`from_fn_with`].
#[derive(Clone, Copy)]
pub struct FromFnWith<F, J>(F, J);

impl<F> fmt::Debug for FromFn<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FromFn").finish_non_exhaustive()
    }
}

impl<F, J> fmt::Debug for FromFnWith<F, J> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FromFnWith").finish_non_exhaustive()
    }
}

/// Step of the differences at the origin. It grows with the square root of the coordinates, a compromise between their rounding and the
/// map's bends.
const STEP: f64 = 1.0 / 4096.0;

impl<F: Fn(Point) -> Point + Send + Sync> FromFn<F> {
    /// The derivative along the unit vector `axis`: fourth-order central differences, or second-order ones to one side where the map has no
    /// value on the other.
    fn slope(&self, p: Point, image: Point, axis: Vec2) -> Vec2 {
        let size = p.x.abs().max(p.y.abs()).max(1.0).sqrt();
        // A power of two, so that the steps are exact.
        let h = STEP * 2f64.powi(size.log2().ceil() as i32);
        let at = |k: f64| (self.0)(p + axis * (k * h)) - image;
        let (before, after) = (at(-1.0), at(1.0));
        let both = (8.0 * (after - before) - (at(2.0) - at(-2.0))) / (12.0 * h);
        if both.is_finite() {
            return both;
        }
        let sides = [(4.0 * after - at(2.0)) / (2.0 * h), (at(-2.0) - 4.0 * before) / (2.0 * h)];
        sides.into_iter().find(|s| s.is_finite()).unwrap_or((after - before) / (2.0 * h))
    }
}

impl<F: Fn(Point) -> Point + Send + Sync> Map for FromFn<F> {
    fn jet(&self, p: Point) -> Jet {
        let image = (self.0)(p);
        if !image.is_finite() {
            return Jet::UNDEFINED;
        }
        let [dx, dy] = [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0)].map(|axis| self.slope(p, image, axis));
        Jet { p: image, dx, dy }
    }

    fn point(&self, p: Point) -> Point {
        (self.0)(p)
    }
}

impl<F, J> Map for FromFnWith<F, J>
where
    F: Fn(Point) -> Point + Send + Sync,
    J: Fn(Point) -> [Vec2; 2] + Send + Sync,
{
    fn jet(&self, p: Point) -> Jet {
        let [dx, dy] = (self.1)(p);
        Jet { p: (self.0)(p), dx, dy }
    }

    fn point(&self, p: Point) -> Point {
        (self.0)(p)
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

    /// Derivatives of a wave of length 60, near the origin and far away.
    #[test]
    fn differences_are_derivatives() {
        let map = from_fn(|p| Point::new(p.x + (p.y / 10.0).sin(), p.y * (p.x / 10.0).cos()));
        for p in [(0.0, 0.0), (3.0, -7.0), (900.0, 400.0), (-2e4, 1e4)] {
            let p = Point::from(p);
            let j = map.jet(p);
            let dx = Vec2::new(1.0, -p.y * (p.x / 10.0).sin() / 10.0);
            let dy = Vec2::new((p.y / 10.0).cos() / 10.0, (p.x / 10.0).cos());
            let scale = 1.0 + p.y.abs();
            assert!((j.dx - dx).hypot() < 1e-9 * scale && (j.dy - dy).hypot() < 1e-9 * scale, "{p:?}: {j:?}");
        }
    }

    #[test]
    fn beside_the_edge_of_the_domain_one_side_counts() {
        let root = from_fn(|p| Point::new(p.x, (p.y - 1.0).sqrt().powi(3)));
        assert_eq!(root.jet(Point::new(0.0, 1.0)).dx, Vec2::new(1.0, 0.0));
        assert!((root.jet(Point::new(0.0, 1.0005)).dy.y - 1.5 * 0.0005f64.sqrt()).abs() < 0.05);
        assert!(!root.jet(Point::new(0.0, 0.5)).is_finite());
    }
}
