//! Bicubic nets: maps of the plane given by 16 control points, by the formula at [`BicubicNet`]. They are evaluated in power form, in
//! which a completed net loses its four highest terms.

use super::rational_bezier::Scaled;
use super::{AffineMap, Class, Jet, Map, Polynomials, RationalBezier, RationalDegree};
use kurbo::{Affine, Point, Rect, Vec2};

/// Control points: four rows along v, each of four points along u.
pub type Net = [[Point; 4]; 4];

/// Computes the four inner points from the twelve outer ones by Koppinen's equation (7), so that the terms u²v², u²v³, u³v² and
/// u³v³ vanish. The result is the bilinearly blended Coons patch of the four sides.
#[must_use]
pub(crate) fn complete_net(mut p: Net) -> Net {
    let v = |r: usize, s: usize, p: &Net| p[r][s].to_vec2();
    // Each inner point follows from its nearest corner, the neighbours of that corner in its row and column, and the far sides. The four
    // formulas are mirror images of one.
    for (r, s) in [(1, 1), (1, 2), (2, 1), (2, 2)] {
        let (cr, cs) = (if r == 1 { 0 } else { 3 }, if s == 1 { 0 } else { 3 });
        let (fr, fs) = (3 - cr, 3 - cs);
        let sum = v(cr, cs, &p) * -4.0 - (v(cr, fs, &p) + v(fr, cs, &p)) * 2.0 - v(fr, fs, &p)
            + (v(r, cs, &p) + v(cr, s, &p)) * 6.0
            + (v(r, fs, &p) + v(fr, s, &p)) * 3.0;
        p[r][s] = (sum / 9.0).to_point();
    }
    p
}

/// Terms below this share of the net's size are rounding noise: sixteen terms, each off by a few units in the last place.
const NOISE: f64 = 1e-13;
/// The share of the net's distance from the origin that counts as size, because its coordinates are rounded to that: about four
/// units in the last place when multiplied by [`NOISE`].
const ROUNDING: f64 = 1e-2;

/// A bicubic map of the plane, given by 16 control points pᵣₛ:
///
/// > F(u,v) = Σᵣ Σₛ B³ₛ(u) B³ᵣ(v) pᵣₛ
///
/// with (u,v) an affine function of the source point (Koppinen, *A plane transformation from 16 control points*, equation 3).
///
/// ```
/// use pathwarp::kurbo::{Affine, Point};
/// use pathwarp::map::{BicubicNet, Map, Net};
///
/// let net: Net = std::array::from_fn(|r| std::array::from_fn(|s| Point::new(s as f64, (r + s * s) as f64)));
/// let map = BicubicNet::new(&net, Affine::scale(0.01));
/// assert_eq!(map.point((100.0, 0.0).into()), net[0][3]);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct BicubicNet {
    /// The affine function from the source point to (u, v).
    pre: Affine,
    /// `c[j][i]` is the coefficient of uⁱ vʲ.
    c: [[Vec2; 4]; 4],
    /// `true` if the terms uⁱvʲ with i, j ≥ 2 vanish.
    completed: bool,
}

impl BicubicNet {
    /// The map that takes a source point p to the point of `net` at (u, v) = `pre`·p. The control points belong to the unit
    /// square of (u, v).
    #[must_use]
    pub fn new(net: &Net, pre: Affine) -> Self {
        let mut c: [[Vec2; 4]; 4] = net.map(|row| power_form(row.map(Point::to_vec2)));
        for i in 0..4 {
            let column = power_form([c[0][i], c[1][i], c[2][i], c[3][i]]);
            for (row, value) in c.iter_mut().zip(column) {
                row[i] = value;
            }
        }
        // Terms that should vanish leave rounding noise; zero is closer to the truth.
        let size = net.iter().flatten().map(|p| (*p - net[0][0]).hypot()).fold(0.0, f64::max)
            + net.iter().flatten().map(|p| p.to_vec2().hypot()).fold(0.0, f64::max) * ROUNDING;
        for v in c.iter_mut().flatten().skip(1) {
            if v.hypot() <= NOISE * size {
                *v = Vec2::ZERO;
            }
        }
        let completed = [2, 3].iter().all(|&j| c[j][2] == Vec2::ZERO && c[j][3] == Vec2::ZERO);
        Self { pre, c, completed }
    }

    /// The map of a box, across which (u, v) run from 0 to 1.
    pub(crate) fn over(rect: Rect, net: &Net) -> Self {
        let (w, h) = (rect.width(), rect.height());
        Self::new(net, Affine::new([1.0 / w, 0.0, 0.0, 1.0 / h, -rect.x0 / w, -rect.y0 / h]))
    }

    /// The terms uⁱvʲ that do not vanish, as (i, j, coefficient).
    fn terms(&self) -> impl Iterator<Item = (usize, usize, Vec2)> {
        let all = self.c.iter().enumerate().flat_map(|(j, row)| row.iter().enumerate().map(move |(i, v)| (i, j, *v)));
        all.filter(|t| t.2 != Vec2::ZERO)
    }

    /// The coefficients of the powers of v at `u`.
    #[inline]
    fn rows(&self, u: f64) -> [Vec2; 4] {
        let c = &self.c;
        let cubic = |r: &[Vec2; 4]| ((r[3] * u + r[2]) * u + r[1]) * u + r[0];
        if self.completed {
            [cubic(&c[0]), cubic(&c[1]), c[2][1] * u + c[2][0], c[3][1] * u + c[3][0]]
        } else {
            [cubic(&c[0]), cubic(&c[1]), cubic(&c[2]), cubic(&c[3])]
        }
    }
}

/// Converts the Bernstein coefficients of a cubic to power coefficients.
fn power_form(b: [Vec2; 4]) -> [Vec2; 4] {
    [b[0], (b[1] - b[0]) * 3.0, (b[2] - b[1] * 2.0 + b[0]) * 3.0, (b[3] - b[0]) - (b[2] - b[1]) * 3.0]
}

impl Map for BicubicNet {
    #[inline]
    fn jet(&self, p: Point) -> Jet {
        let Point { x: u, y: v } = self.pre * p;
        let c = &self.c;
        let r = self.rows(u);
        let slope = |r: &[Vec2; 4]| (r[3] * (3.0 * u) + r[2] * 2.0) * u + r[1];
        let value = ((r[3] * v + r[2]) * v + r[1]) * v + r[0];
        let dv = (r[3] * (3.0 * v) + r[2] * 2.0) * v + r[1];
        let du = if self.completed {
            ((c[3][1] * v + c[2][1]) * v + slope(&c[1])) * v + slope(&c[0])
        } else {
            ((slope(&c[3]) * v + slope(&c[2])) * v + slope(&c[1])) * v + slope(&c[0])
        };
        let [a, b, cc, d, ..] = self.pre.as_coeffs();
        Jet { p: value.to_point(), dx: du * a + dv * b, dy: du * cc + dv * d }
    }

    #[inline]
    fn point(&self, p: Point) -> Point {
        let Point { x: u, y: v } = self.pre * p;
        let r = self.rows(u);
        (((r[3] * v + r[2]) * v + r[1]) * v + r[0]).to_point()
    }

    fn class(&self) -> Class {
        let c = &self.c;
        let degree = self.terms().map(|(i, j, _)| i + j).max().unwrap_or(0);
        if degree <= 1 {
            let (o, u, v) = (c[0][0], c[0][1], c[1][0]);
            Class::Affine(Affine::new([u.x, u.y, v.x, v.y, o.x, o.y]) * self.pre)
        } else {
            Class::Rational(RationalDegree::polynomial(degree))
        }
    }

    /// The image of a curve of degree n has degree 4n for a completed net (each term has degree 3 in one variable and 1 in the
    /// other) and 6n for a general net, or less if terms vanish.
    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        let curve = AffineMap(self.pre).image(curve)?;
        let total = self.terms().map(|(i, j, _)| i + j).max().unwrap_or(0);
        let (u, v, w) =
            (curve.coordinate(0).powers(3), curve.coordinate(1).powers(3), curve.coordinate(2).powers(total));
        let degree = curve.degree() * total;
        let (mut x, mut y) = (Scaled::zero(degree), Scaled::zero(degree));
        for (i, j, c) in self.terms() {
            let term = u[i].times(&v[j]).times(&w[total - i - j]);
            x.add_scaled(c.x, &term);
            y.add_scaled(c.y, &term);
        }
        Some(RationalBezier::from_coordinates([&x, &y, &w[total]], curve.is_polynomial()))
    }

    fn preimages(&self, q: Point) -> Option<Vec<Point>> {
        let origin = self.c[0][0].to_point();
        let terms = self.terms().map(|(i, j, c)| (i, j, [c.x, c.y, 0.0])).filter(|t| t.0 + t.1 > 0);
        Polynomials { pre: self.pre, origin, terms: terms.chain([(0, 0, [0.0, 0.0, 1.0])]).collect() }
            .preimages(self, q)
    }

    fn detail(&self, _: Rect) -> Option<f64> {
        Some(f64::INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::{EllipticArc, Seg};
    use kurbo::{CubicBez, ParamCurve};

    const BENT: Net = {
        const fn p(x: f64, y: f64) -> Point {
            Point::new(x, y)
        }
        [
            [p(0.0, 90.0), p(30.0, 110.0), p(60.0, 70.0), p(100.0, 95.0)],
            [p(-10.0, 60.0), p(31.0, 70.0), p(66.0, 52.0), p(105.0, 60.0)],
            [p(5.0, 35.0), p(35.0, 20.0), p(60.0, 31.0), p(90.0, 30.0)],
            [p(0.0, 0.0), p(30.0, -25.0), p(70.0, 10.0), p(110.0, 5.0)],
        ]
    };

    /// De Casteljau's algorithm, straight from the definition.
    fn by_definition(net: &Net, u: f64, v: f64) -> Point {
        let column = net.map(|r| CubicBez::new(r[0], r[1], r[2], r[3]).eval(u));
        CubicBez::new(column[0], column[1], column[2], column[3]).eval(v)
    }

    /// The paper's equation (7), copied term by term.
    #[test]
    fn completion_is_equation_7() {
        let p = BENT;
        let v = |r: usize, s: usize| p[r][s].to_vec2();
        let q = complete_net(p);
        let near = |a: Point, b: Vec2| (a.to_vec2() * 9.0 - b).hypot() < 1e-12;
        assert!(near(
            q[1][1],
            v(0, 0) * -4.0 - (v(0, 3) + v(3, 0)) * 2.0 - v(3, 3)
                + (v(1, 0) + v(0, 1)) * 6.0
                + (v(1, 3) + v(3, 1)) * 3.0
        ));
        assert!(near(
            q[1][2],
            v(0, 3) * -4.0 - (v(0, 0) + v(3, 3)) * 2.0 - v(3, 0)
                + (v(1, 3) + v(0, 2)) * 6.0
                + (v(1, 0) + v(3, 2)) * 3.0
        ));
        assert!(near(
            q[2][1],
            v(3, 0) * -4.0 - (v(0, 0) + v(3, 3)) * 2.0 - v(0, 3)
                + (v(2, 0) + v(3, 1)) * 6.0
                + (v(2, 3) + v(0, 1)) * 3.0
        ));
        assert!(near(
            q[2][2],
            v(3, 3) * -4.0 - (v(0, 3) + v(3, 0)) * 2.0 - v(0, 0)
                + (v(2, 3) + v(3, 2)) * 6.0
                + (v(2, 0) + v(0, 2)) * 3.0
        ));
    }

    #[test]
    fn agrees_with_the_definition_and_completed_nets_lose_their_high_terms() {
        for net in [BENT, complete_net(BENT)] {
            let m = BicubicNet::new(&net, Affine::IDENTITY);
            for i in -2..=12 {
                for j in -2..=12 {
                    let (u, v) = (f64::from(i) / 10.0, f64::from(j) / 10.0);
                    assert!(m.point(Point::new(u, v)).distance(by_definition(&net, u, v)) < 1e-11);
                }
            }
        }
        assert!(BicubicNet::new(&complete_net(BENT), Affine::IDENTITY).completed);
        assert!(!BicubicNet::new(&BENT, Affine::IDENTITY).completed);
    }

    #[test]
    fn exact_images_have_the_stated_degree_and_the_right_points() {
        let pre = Affine::new([0.01, 0.002, -0.001, -0.01, 0.0, 1.0]);
        let cubic = Seg::Cubic(CubicBez::new((10.0, 10.0), (90.0, 0.0), (80.0, 70.0), (20.0, 60.0)));
        let arc =
            Seg::Arc(EllipticArc::new(Point::new(40.0, 50.0), Vec2::new(30.0, 0.0), Vec2::new(3.0, 20.0), 0.4, 1.9));
        for (net, seg, degree) in
            [(complete_net(BENT), cubic, 12), (BENT, cubic, 18), (complete_net(BENT), arc, 8), (BENT, arc, 12)]
        {
            let m = BicubicNet::new(&net, pre);
            let source = RationalBezier::from_seg(&seg).unwrap();
            let image = m.image(&source).unwrap();
            assert_eq!(image.degree(), degree);
            for i in 0..=20 {
                let t = f64::from(i) / 20.0;
                assert!(image.eval(t).distance(m.point(source.eval(t))) < 1e-10, "{degree} {t}");
            }
        }
    }

    #[test]
    fn a_straight_net_is_affine() {
        let third = |i: usize| 10.0 + 20.0 * i as f64 / 3.0;
        let net: Net = std::array::from_fn(|r| std::array::from_fn(|s| Point::new(third(s), -third(r))));
        assert!(matches!(BicubicNet::new(&net, Affine::IDENTITY).class(), Class::Affine(_)));
        assert!(matches!(BicubicNet::new(&BENT, Affine::IDENTITY).class(), Class::Rational(_)));
    }
}
