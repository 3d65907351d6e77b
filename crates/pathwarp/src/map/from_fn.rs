//! Maps from closures.

use super::{Jet, Map};
use kurbo::{Point, Vec2};
use std::fmt;

/// A map from a closure that gives the image of a point. Its derivatives are differences of values, good to nine digits or so where the map
/// varies over lengths of a hundredth of a drawing and more, and they cost eight calls each; [`from_fn_with`] takes exact ones, and a
/// [`Formula`](super::Formula) has them by itself. A point without image maps to NaN.
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

/// Step of the differences at the origin. It grows with the root of the coordinates, so that neither their rounding nor the map's bends
/// count for much.
const STEP: f64 = 1.0 / 4096.0;

impl<F: Fn(Point) -> Point + Send + Sync> FromFn<F> {
    /// The derivative along `way`: of fourth order from both sides, or of second order from one where the map has no value on the other.
    fn slope(&self, p: Point, image: Point, way: Vec2) -> Vec2 {
        let size = p.x.abs().max(p.y.abs()).max(1.0).sqrt();
        // A power of two, so that the steps are exact.
        let h = STEP * 2f64.powi(size.log2().ceil() as i32);
        let at = |k: f64| (self.0)(p + way * (k * h)) - image;
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
        let [dx, dy] = [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0)].map(|way| self.slope(p, image, way));
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
