//! Affine and projective maps as [`Map`]s: the two classes that keep straight lines. Enclosures are infinite where W may vanish.

use super::{Class, Crease, Creases, Enclosure, Homography, Jet, Level, Map, RationalBezier};
use kurbo::{Affine, Point, Vec2};
use std::sync::Arc;

/// An affine map: x' = a·x + c·y + e, y' = b·x + d·y + f (SVG's `matrix(a b c d e f)`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AffineMap(pub Affine);

impl AffineMap {
    /// The identity.
    pub const IDENTITY: Self = Self(Affine::IDENTITY);

    /// The direct similitude (rotation, uniform scale and translation, no reflection) that takes `a` to `a1` and `b` to `b1`;
    /// `None` if `a` = `b`.
    #[must_use]
    pub fn similitude(a: Point, b: Point, a1: Point, b1: Point) -> Option<Self> {
        let (v, w) = (b - a, b1 - a1);
        let n = v.hypot2();
        if n == 0.0 || !n.is_finite() {
            return None;
        }
        // The complex quotient w / v.
        let (re, im) = (v.dot(w) / n, v.cross(w) / n);
        let e = a1 - Vec2::new(re * a.x - im * a.y, im * a.x + re * a.y);
        Some(Self(Affine::new([re, im, -im, re, e.x, e.y])))
    }
}

impl Map for AffineMap {
    #[inline]
    fn jet(&self, p: Point) -> Jet {
        let [a, b, c, d, ..] = self.0.as_coeffs();
        Jet { p: self.0 * p, dx: Vec2::new(a, b), dy: Vec2::new(c, d) }
    }

    #[inline]
    fn point(&self, p: Point) -> Point {
        self.0 * p
    }

    fn class(&self) -> Class {
        Class::Affine(self.0)
    }

    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        let [a, b, c, d, e, f] = self.0.as_coeffs();
        Some(curve.mapped(|[x, y, w]| [a * x + c * y + e * w, b * x + d * y + f * w, w]))
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        let det = self.0.determinant();
        (det != 0.0 && det.is_finite()).then(|| Arc::new(Self(self.0.inverse())) as Arc<dyn Map>)
    }

    fn enclose(&self, [x, y]: [Enclosure; 2]) -> Option<[Enclosure; 2]> {
        let [a, b, c, d, e, f] = self.0.as_coeffs();
        Some([x * a + y * c + e, x * b + y * d + f])
    }
}

impl Map for Homography {
    #[inline]
    fn jet(&self, p: Point) -> Jet {
        let image = self.homogeneous(p);
        let [dx, dy] = self.slopes(image);
        Jet { p: self.point_of(image), dx, dy }
    }

    #[inline]
    fn point(&self, p: Point) -> Point {
        self.point_of(self.homogeneous(p))
    }

    fn class(&self) -> Class {
        self.as_affine().map_or(Class::Projective(*self), Class::Affine)
    }

    fn creases(&self, out: &mut Creases) {
        // The map is defined where W = a·x + b·y + c is positive.
        let [a, b, c] = self.horizon();
        if a != 0.0 || b != 0.0 {
            out.push(Crease::edge(Level::Line { a, b, c }));
        }
    }

    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        Some(curve.mapped(|v| self.times(v)))
    }

    fn denominator(&self, p: Point) -> f64 {
        self.w(p)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        self.inverted().map(|h| Arc::new(h) as Arc<dyn Map>)
    }

    fn enclose(&self, [x, y]: [Enclosure; 2]) -> Option<[Enclosure; 2]> {
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|v| self.times(v));
        let [u, v, w] = [0, 1, 2].map(|k| x * columns[0][k] + y * columns[1][k] + columns[2][k]);
        Some([u / w, v / w])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn similitude_hits_both_points_and_keeps_angles() {
        let m =
            AffineMap::similitude((1.0, 2.0).into(), (4.0, 6.0).into(), (-3.0, 0.5).into(), (2.0, 9.0).into()).unwrap();
        assert!(m.point((1.0, 2.0).into()).distance((-3.0, 0.5).into()) < 1e-14);
        assert!(m.point((4.0, 6.0).into()).distance((2.0, 9.0).into()) < 1e-14);
        let j = m.jet(Point::ORIGIN);
        assert!(j.dx.dot(j.dy).abs() < 1e-14 && (j.dx.hypot() - j.dy.hypot()).abs() < 1e-14 && j.det() > 0.0);
    }
}
