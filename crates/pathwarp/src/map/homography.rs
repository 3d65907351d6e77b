//! Projective maps of the plane as 3×3 matrices. [`projective`](super::projective) makes them [`Map`](super::Map)s.

use kurbo::{Affine, Point, Vec2};

/// A projective map (collineation): (x, y) ↦ to + (X/W, Y/W) with (X, Y, W) = M·(x − from, 1).
///
/// The matrix acts on coordinates relative to a point near the artwork, so that no digits are lost where coordinates are large.
///
/// The map is defined where W > 0, on one side of its horizon W = 0. Artwork that crosses the horizon is an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Homography {
    /// The matrix, row by row.
    m: [[f64; 3]; 3],
    from: Point,
    to: Point,
}

impl Homography {
    /// The map with this matrix, row by row: (X, Y, W) = M·(x, y, 1).
    #[must_use]
    pub const fn new(m: [[f64; 3]; 3]) -> Self {
        Self { m, from: Point::ORIGIN, to: Point::ORIGIN }
    }

    /// The map (x, y) ↦ to + (X/W, Y/W) with (X, Y, W) = M·(x − from, 1).
    #[must_use]
    pub(crate) const fn about(m: [[f64; 3]; 3], from: Point, to: Point) -> Self {
        Self { m, from, to }
    }

    /// The projective map that takes four points to four points, in order. `None` if three points of either quadrilateral lie
    /// on a line, or if one is convex and the other is not: the horizon would run between the points.
    #[must_use]
    pub fn from_points(from: [Point; 4], to: [Point; 4]) -> Option<Self> {
        // By way of a projective basis, which needs no convexity: the matrix whose columns are three of the points, scaled so
        // that their sum is the fourth.
        let basis = |q: [Point; 4]| -> Option<[[f64; 3]; 3]> {
            let q = q.map(|p| p - q[0]);
            let m = [[q[0].x, q[1].x, q[3].x], [q[0].y, q[1].y, q[3].y], [1.0, 1.0, 1.0]];
            let k = mul_vec(&inverse(&m)?, [q[2].x, q[2].y, 1.0]);
            Some(m.map(|row| [row[0] * k[0], row[1] * k[1], row[2] * k[2]]))
        };
        let m = mul(&basis(to)?, &inverse(&basis(from)?)?);
        let m = m.map(|row| row.map(|v| v / m[2][2]));
        let out = Self { m, from: from[0], to: to[0] }.without_noise(from);
        let positive = from.iter().all(|p| out.w(*p) > 0.0);
        (positive && m.iter().flatten().all(|v| v.is_finite())).then_some(out)
    }

    /// Sets the perspective part to zero if it is rounding noise over `at`, so that parallelograms give affine maps.
    fn without_noise(mut self, at: [Point; 4]) -> Self {
        /// The rounding error of the two 3×3 solves, with a margin.
        const NOISE: f64 = 1e-13;
        let varies = at.iter().map(|p| (self.m[2][0] * (p.x - at[0].x) + self.m[2][1] * (p.y - at[0].y)).abs());
        if varies.fold(0.0, f64::max) < NOISE {
            let w = self.w(at[0]);
            self.m = self.m.map(|row| row.map(|v| v / w));
            self.m[2] = [0.0, 0.0, 1.0];
        }
        self
    }

    /// The homogeneous image of `p`, about `to`.
    #[inline]
    pub(super) fn homogeneous(&self, p: Point) -> [f64; 3] {
        let v = p - self.from;
        self.m.map(|row| row[0] * v.x + row[1] * v.y + row[2])
    }

    /// The point with this homogeneous image about `to`.
    #[inline]
    pub(super) fn point_of(&self, [x, y, w]: [f64; 3]) -> Point {
        let r = 1.0 / w;
        self.to + Vec2::new(x * r, y * r)
    }

    /// The denominator W at `p`.
    #[inline]
    #[must_use]
    pub fn w(&self, p: Point) -> f64 {
        self.homogeneous(p)[2]
    }

    /// The coefficients of W = a·x + b·y + c.
    pub(super) fn horizon(&self) -> [f64; 3] {
        let [a, b, c] = self.m[2];
        [a, b, c - a * self.from.x - b * self.from.y]
    }

    /// The derivatives by x and y where the homogeneous image is `[x, y, w]`.
    #[inline]
    pub(super) fn slopes(&self, [x, y, w]: [f64; 3]) -> [Vec2; 2] {
        let (m, r) = (&self.m, 1.0 / w);
        [0, 1].map(|k| Vec2::new((m[0][k] - x * r * m[2][k]) * r, (m[1][k] - y * r * m[2][k]) * r))
    }

    /// The composition `self ∘ first`.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        let v = first.to - self.from;
        let shift = [[1.0, 0.0, v.x], [0.0, 1.0, v.y], [0.0, 0.0, 1.0]];
        Self { m: mul(&mul(&self.m, &shift), &first.m), from: first.from, to: self.to }
    }

    /// The composition `m ∘ self`.
    #[must_use]
    pub(crate) fn then_affine(&self, m: Affine) -> Self {
        let [a, b, c, d, ..] = m.as_coeffs();
        Self { m: mul(&[[a, c, 0.0], [b, d, 0.0], [0.0, 0.0, 1.0]], &self.m), from: self.from, to: m * self.to }
    }

    /// The composition `self ∘ m` with an invertible `m`.
    #[must_use]
    pub(crate) fn after_affine(&self, m: Affine) -> Self {
        let from = m.inverse() * self.from;
        if !from.is_finite() {
            return self.after(&m.into());
        }
        let ([a, b, c, d, ..], v) = (m.as_coeffs(), m * from - self.from);
        Self { m: mul(&self.m, &[[a, c, v.x], [b, d, v.y], [0.0, 0.0, 1.0]]), from, to: self.to }
    }

    /// Returns this map as an affine one, if it is affine.
    #[must_use]
    pub(crate) fn as_affine(&self) -> Option<Affine> {
        let [[a, c, e], [b, d, f], [g, h, w]] = self.m;
        (g == 0.0 && h == 0.0 && w != 0.0).then(|| {
            let [a, b, c, d, e, f] = [a, b, c, d, e, f].map(|v| v / w);
            let at = self.to + Vec2::new(e, f);
            let back = Vec2::new(a * self.from.x + c * self.from.y, b * self.from.x + d * self.from.y);
            Affine::new([a, b, c, d, at.x - back.x, at.y - back.y])
        })
    }

    /// The inverse map; `None` if the matrix is singular.
    #[must_use]
    pub fn inverted(&self) -> Option<Self> {
        inverse(&self.m).map(|m| Self { m, from: self.to, to: self.from })
    }

    /// The homogeneous image of a homogeneous point.
    pub(super) fn times(&self, [x, y, w]: [f64; 3]) -> [f64; 3] {
        let [x, y, w] = mul_vec(&self.m, [x - self.from.x * w, y - self.from.y * w, w]);
        [x + self.to.x * w, y + self.to.y * w, w]
    }
}

impl From<Affine> for Homography {
    fn from(m: Affine) -> Self {
        let [a, b, c, d, e, f] = m.as_coeffs();
        Self::new([[a, c, e], [b, d, f], [0.0, 0.0, 1.0]])
    }
}

fn mul(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn mul_vec(a: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|k| a[i][k] * v[k]).sum())
}

/// The inverse by the adjugate: accurate enough for 3×3, and it keeps exact zeros.
fn inverse(m: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let c = |i: usize, j: usize| {
        let (r, s) = ((i + 1) % 3, (i + 2) % 3);
        let (p, q) = ((j + 1) % 3, (j + 2) % 3);
        m[r][p] * m[s][q] - m[r][q] * m[s][p]
    };
    let det: f64 = (0..3).map(|j| m[0][j] * c(0, j)).sum();
    let out: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| c(j, i) / det));
    (det != 0.0 && out.iter().flatten().all(|v| v.is_finite())).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Class, Map};

    const SQUARE: [Point; 4] = [Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(1.0, 1.0), Point::new(0.0, 1.0)];
    const TRAPEZOID: [Point; 4] =
        [Point::new(-3.0, 8.0), Point::new(14.0, 9.0), Point::new(9.0, -2.0), Point::new(1.0, 0.5)];

    #[test]
    fn corners_land_on_corners() {
        let h = Homography::from_points(SQUARE, TRAPEZOID).unwrap();
        for (a, b) in SQUARE.iter().zip(TRAPEZOID) {
            assert!(h.point(*a).distance(b) < 1e-12);
        }
        let back = h.inverted().unwrap();
        assert!(back.point(h.point((0.3, 0.7).into())).distance((0.3, 0.7).into()) < 1e-13);
    }

    #[test]
    fn parallelograms_are_affine_and_bow_ties_refused() {
        let q = [Point::new(1.1, 2.3), Point::new(7.7, 3.1), Point::new(9.0, 8.2), Point::new(2.4, 7.4)];
        let h = Homography::from_points(SQUARE, q).unwrap();
        assert!(matches!(h.class(), Class::Affine(_)), "{h:?}");
        let dented = [Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(0.2, 0.2), Point::new(0.0, 1.0)];
        assert!(Homography::from_points(SQUARE, dented).is_none());
        let line = [Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(2.0, 0.0), Point::new(0.0, 1.0)];
        assert!(Homography::from_points(SQUARE, line).is_none());
    }

    #[test]
    fn the_derivative_is_the_difference_quotient() {
        let h = Homography::from_points(SQUARE, TRAPEZOID).unwrap();
        let (p, e) = (Point::new(0.4, 0.6), 1e-6);
        let j = h.jet(p);
        let dx = (h.point((p.x + e, p.y).into()) - h.point((p.x - e, p.y).into())) / (2.0 * e);
        let dy = (h.point((p.x, p.y + e).into()) - h.point((p.x, p.y - e).into())) / (2.0 * e);
        assert!((dx - j.dx).hypot() < 1e-7 && (dy - j.dy).hypot() < 1e-7);
    }

    /// Far from the origin, at 3.67e7, a map, its inverse and a chain are as exact as near it, up to the rounding of the coordinates.
    #[test]
    fn far_from_the_origin_no_digits_are_lost() {
        let far = Vec2::new(3.67e7, -1.2e8);
        let (near, there) =
            (TRAPEZOID.map(|p| p + Vec2::new(3.0, 4.0)), TRAPEZOID.map(|p| p + Vec2::new(3.0, 4.0) + far));
        let square = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)].map(Point::from);
        let small = Homography::from_points(square, near).unwrap();
        let large = Homography::from_points(square.map(|p| p + far), there).unwrap();
        let chain = |h: &Homography, by: Vec2| {
            let m = Affine::translate(by) * Affine::new([0.9, 0.3, -0.2, 1.1, 5.0, 6.0]) * Affine::translate(-by);
            h.after(h).then_affine(m).after_affine(m)
        };
        let back = [small.inverted().unwrap(), large.inverted().unwrap()];
        for i in 0..100 {
            let p = Point::new(f64::from(i % 10), f64::from(i / 10));
            for (a, b) in [(small, large), (back[0], back[1]), (chain(&small, Vec2::ZERO), chain(&large, far))] {
                let (q, r) = (a.point(p), b.point(p + far));
                assert!((r - far).distance(q) < 1e-6, "{p:?}: {q:?} {r:?}");
            }
        }
    }
}
