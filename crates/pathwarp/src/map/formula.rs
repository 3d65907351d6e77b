//! The short way to write a map: one formula, any number type.

use super::{Algebra, Class, Creases, Dual, Jet, Map, RationalBezier, Real};
use kurbo::Point;
use std::sync::Arc;

/// A map given by a formula. Every `Formula` is a [`Map`]: the values come from running it on `f64`, the derivatives from
/// running it on dual numbers.
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
/// assert!((jet.det() - 1.0).abs() < 1e-15); // a shear keeps areas
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

    /// See [`Map::image_of`].
    fn image_of(&self, _curve: &RationalBezier) -> Option<RationalBezier> {
        None
    }

    /// See [`Map::algebra`].
    fn algebra(&self) -> Option<Algebra> {
        None
    }

    /// See [`Map::denominators`].
    fn denominators(&self, _x: &[f64; 8], _y: &[f64; 8]) -> [f64; 8] {
        [1.0; 8]
    }

    /// See [`Map::inverse`].
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        None
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

    fn lanes(&self, x: &mut [f64; 8], y: &mut [f64; 8]) {
        for (x, y) in x.iter_mut().zip(y) {
            (*x, *y) = self.f(*x, *y);
        }
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

    fn image_of(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        Formula::image_of(self, curve)
    }

    fn algebra(&self) -> Option<Algebra> {
        Formula::algebra(self)
    }

    fn denominators(&self, x: &[f64; 8], y: &[f64; 8]) -> [f64; 8] {
        Formula::denominators(self, x, y)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Formula::inverse(self)
    }
}
