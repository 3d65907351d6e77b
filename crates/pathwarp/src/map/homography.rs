//! Projective maps of the plane as 3×3 matrices. [`projective`](super::projective) makes them [`Map`](super::Map)s.

use kurbo::{Affine, Point, Vec2};

/// A projective map (collineation): (x, y) ↦ (X/W, Y/W) with (X, Y, W) = M·(x, y, 1).
///
/// Defined where W > 0, on one side of its horizon W = 0. Artwork that crosses the horizon is an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Homography {
    /// The matrix, row by row.
    pub m: [[f64; 3]; 3],
}

impl Homography {
    /// The projective map that takes the corners (0,0), (1,0), (1,1), (0,1) of the unit square to `q`, in order, with W > 0 on
    /// all four. `None` if three of the points lie on a line, or if the quadrilateral is not convex: the horizon would cut the
    /// square.
    ///
    /// Solved as in Heckbert, *Fundamentals of Texture Mapping and Image Warping* (1989), §2.2.3. A parallelogram gives an
    /// exactly affine map.
    #[must_use]
    pub fn from_unit_square(q: [Point; 4]) -> Option<Self> {
        let s = (q[0] - q[1]) + (q[2] - q[3]);
        let (d1, d2) = (q[1] - q[2], q[3] - q[2]);
        let det = d1.cross(d2);
        let (g, h) = if s == Vec2::ZERO { (0.0, 0.0) } else { (s.cross(d2) / det, d1.cross(s) / det) };
        let (a, b) = ((q[1] - q[0]) + q[1].to_vec2() * g, (q[3] - q[0]) + q[3].to_vec2() * h);
        let m = [[a.x, b.x, q[0].x], [a.y, b.y, q[0].y], [g, h, 1.0]];
        let out = Self { m };
        let positive = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].iter().all(|&c| out.w(c.into()) > 0.0);
        (positive && det != 0.0 && m.iter().flatten().all(|v| v.is_finite())).then_some(out)
    }

    /// The projective map that takes four points to four points, in order. `None` if three points of either quadrilateral lie
    /// on a line, or if one is convex and the other is not: the horizon would run between the points.
    #[must_use]
    pub fn from_points(from: [Point; 4], to: [Point; 4]) -> Option<Self> {
        // Through a projective basis, which needs no convexity: the matrix whose columns are three of the points, scaled so
        // that their sum is the fourth.
        let basis = |q: [Point; 4]| -> Option<[[f64; 3]; 3]> {
            let m = [[q[0].x, q[1].x, q[3].x], [q[0].y, q[1].y, q[3].y], [1.0, 1.0, 1.0]];
            let k = mul_vec(&inverse(&m)?, [q[2].x, q[2].y, 1.0]);
            Some(m.map(|row| [row[0] * k[0], row[1] * k[1], row[2] * k[2]]))
        };
        let mut m = mul(&basis(to)?, &inverse(&basis(from)?)?);
        let scale = m[2][0] * from[0].x + m[2][1] * from[0].y + m[2][2];
        m = m.map(|row| row.map(|v| v / scale));
        let out = Self { m }.tidied(from);
        let positive = from.iter().all(|p| out.w(*p) > 0.0);
        (positive && m.iter().flatten().all(|v| v.is_finite())).then_some(out)
    }

    /// Sets the perspective part to zero if it is rounding noise over `at`, so that parallelograms give affine maps.
    fn tidied(mut self, at: [Point; 4]) -> Self {
        /// Rounding error of the two 3×3 solves, with a margin.
        const NOISE: f64 = 1e-13;
        let varies = at.iter().map(|p| (self.m[2][0] * (p.x - at[0].x) + self.m[2][1] * (p.y - at[0].y)).abs());
        if varies.fold(0.0, f64::max) < NOISE {
            let w = self.w(at[0]);
            self.m = self.m.map(|row| row.map(|v| v / w));
            self.m[2] = [0.0, 0.0, 1.0];
        }
        self
    }

    /// The denominator W at `p`.
    #[inline]
    #[must_use]
    pub fn w(&self, p: Point) -> f64 {
        self.m[2][0] * p.x + self.m[2][1] * p.y + self.m[2][2]
    }

    /// `self ∘ first`.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        Self { m: mul(&self.m, &first.m) }
    }

    /// The same map as an affine one, if it is affine.
    #[must_use]
    pub fn as_affine(&self) -> Option<Affine> {
        let [[a, c, e], [b, d, f], [g, h, w]] = self.m;
        (g == 0.0 && h == 0.0 && w != 0.0).then(|| Affine::new([a / w, b / w, c / w, d / w, e / w, f / w]))
    }

    /// The inverse map; `None` if the matrix is singular.
    #[must_use]
    pub fn inverted(&self) -> Option<Self> {
        inverse(&self.m).map(|m| Self { m })
    }

    /// The matrix times a homogeneous point.
    pub(super) fn times(&self, v: [f64; 3]) -> [f64; 3] {
        mul_vec(&self.m, v)
    }
}

impl From<Affine> for Homography {
    fn from(m: Affine) -> Self {
        let [a, b, c, d, e, f] = m.as_coeffs();
        Self { m: [[a, c, e], [b, d, f], [0.0, 0.0, 1.0]] }
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
        for h in [Homography::from_unit_square(TRAPEZOID).unwrap(), Homography::from_points(SQUARE, TRAPEZOID).unwrap()]
        {
            for (a, b) in SQUARE.iter().zip(TRAPEZOID) {
                assert!(h.point(*a).distance(b) < 1e-12);
            }
            let back = h.inverted().unwrap();
            assert!(back.point(h.point((0.3, 0.7).into())).distance((0.3, 0.7).into()) < 1e-13);
        }
    }

    #[test]
    fn parallelograms_are_affine_and_bow_ties_refused() {
        let q = [Point::new(1.1, 2.3), Point::new(7.7, 3.1), Point::new(9.0, 8.2), Point::new(2.4, 7.4)];
        let h = Homography::from_points(SQUARE, q).unwrap();
        assert!(matches!(h.class(), Class::Affine(_)), "{h:?}");
        let dented = [Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(0.2, 0.2), Point::new(0.0, 1.0)];
        assert!(Homography::from_unit_square(dented).is_none());
        assert!(Homography::from_points(SQUARE, dented).is_none());
        let line = [Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(2.0, 0.0), Point::new(0.0, 1.0)];
        assert!(Homography::from_points(SQUARE, line).is_none() && Homography::from_unit_square(line).is_none());
    }

    #[test]
    fn the_derivative_is_the_difference_quotient() {
        let h = Homography::from_unit_square(TRAPEZOID).unwrap();
        let (p, e) = (Point::new(0.4, 0.6), 1e-6);
        let j = h.jet(p);
        let dx = (h.point((p.x + e, p.y).into()) - h.point((p.x - e, p.y).into())) / (2.0 * e);
        let dy = (h.point((p.x, p.y + e).into()) - h.point((p.x, p.y - e).into())) / (2.0 * e);
        assert!((dx - j.dx).hypot() < 1e-7 && (dy - j.dy).hypot() < 1e-7);
    }
}
