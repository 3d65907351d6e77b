//! Maps from one formula, generic over the number type, and from closures.

use super::{Class, Cost, Creases, Dual, Enclosure, Jet, Map, RationalBezier, Real, estimated};
use kurbo::{Point, Rect, Vec2};
use std::fmt;
use std::sync::Arc;

/// A map given by a formula. Every `Formula` is a [`Map`]: its values come from running the formula on `f64`, its derivatives
/// from running it on [`Dual`] numbers, and [bounds between samples](Map::enclose) from running it on an [`Enclosure`].
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

    /// See [`Map::preimages`].
    fn preimages(&self, _q: Point) -> Option<Vec<Point>> {
        None
    }

    /// See [`Map::cost`].
    #[doc(hidden)]
    fn cost(&self) -> Cost<'_> {
        Cost::NET
    }

    /// See [`Map::detail`]. For formulas with wide enclosures, because they subtract nearly equal numbers.
    fn detail(&self, _area: Rect) -> Option<f64> {
        None
    }

    /// See [`Map::jet`]. Pointers to maps are formulas too, which forward this method and those below to their map.
    #[doc(hidden)]
    #[inline]
    fn dual(&self, p: Point) -> Jet {
        let (x, y) = self.f(Dual { v: p.x, x: 1.0, y: 0.0 }, Dual { v: p.y, x: 0.0, y: 1.0 });
        Jet { p: Point::new(x.v, y.v), dx: (x.x, y.x).into(), dy: (x.y, y.y).into() }
    }

    #[doc(hidden)]
    #[inline]
    fn value(&self, p: Point) -> Point {
        self.f(p.x, p.y).into()
    }

    #[doc(hidden)]
    #[inline]
    fn duals(&self, ps: &[Point], out: &mut [Jet]) {
        ps.iter().zip(out).for_each(|(p, o)| *o = self.dual(*p));
    }

    #[doc(hidden)]
    #[inline]
    fn values(&self, ps: &[Point], out: &mut [Point]) {
        ps.iter().zip(out).for_each(|(p, o)| *o = self.value(*p));
    }

    #[doc(hidden)]
    fn enclosed(&self, along: [Enclosure; 2]) -> Option<[Enclosure; 2]>
    where
        Self: Sized,
    {
        let area = Enclosure::area(&along);
        let [x, y] = along;
        Some(Formula::detail(self, area).map_or_else(|| self.f(x, y).into(), |d| estimated(self, along, area, d)))
    }
}

impl<F: Formula> Map for F {
    #[inline]
    fn jet(&self, p: Point) -> Jet {
        self.dual(p)
    }

    #[inline]
    fn point(&self, p: Point) -> Point {
        self.value(p)
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        self.duals(ps, out);
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        self.values(ps, out);
    }

    fn enclose(&self, along: [Enclosure; 2]) -> Option<[Enclosure; 2]> {
        self.enclosed(along)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Formula::inverse(self)
    }

    fn cost(&self) -> Cost<'_> {
        Formula::cost(self)
    }

    forward_common!(self => Formula, self);
}

/// A map from a closure that returns the image of a point, or NaN where there is none. Its derivatives are differences of values, which
/// cost eight calls each and have about nine digits where, in a drawing of 1000 units, the map varies over 10 units and more.
/// [`from_fn_with`] takes exact derivatives, and a [`Formula`] computes them.
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

/// The step of the differences at the origin. It grows with the square root of the coordinates, a compromise between their rounding and
/// the map's bends.
const STEP: f64 = 1.0 / 4096.0;

impl<F: Fn(Point) -> Point + Send + Sync> FromFn<F> {
    /// The derivative along the unit vector `axis`: fourth-order central differences, or second-order one-sided ones where the map is
    /// undefined on the other side.
    fn slope(&self, p: Point, image: Point, axis: Vec2) -> Vec2 {
        let growth = p.x.abs().max(p.y.abs()).max(1.0).sqrt();
        // A power of two, so that the steps are exact.
        let h = STEP * 2f64.powi(growth.log2().ceil() as i32);
        let difference = |k: f64| (self.0)(p + axis * (k * h)) - image;
        let (before, after) = (difference(-1.0), difference(1.0));
        let central = (8.0 * (after - before) - (difference(2.0) - difference(-2.0))) / (12.0 * h);
        if central.is_finite() {
            return central;
        }
        let one_sided = [4.0 * after - difference(2.0), difference(-2.0) - 4.0 * before].map(|v| v / (2.0 * h));
        one_sided.into_iter().find(|s| s.is_finite()).unwrap_or((after - before) / (2.0 * h))
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
        let Self(f, jacobian) = self;
        let [dx, dy] = jacobian(p);
        Jet { p: f(p), dx, dy }
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
