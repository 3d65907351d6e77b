//! The short way to write a map: one formula, generic over the number type.

use super::{Class, Creases, Dual, Jet, Map, RationalBezier, Real};
use crate::map::Cost;
use kurbo::Point;
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
