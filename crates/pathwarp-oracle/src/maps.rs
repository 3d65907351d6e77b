//! Maps of a box: a mild and a strong bicubic, a rational one, a fold and a wave.

use crate::curves::Curved;
use crate::distance::{Run, apart};
use kurbo::{Point, Vec2};
use pathwarp::map::{Class, Formula, Jet, Map, RationalDegree, Real};

/// Side length of the box of the icons and the maps.
pub const BOX: f64 = 1000.0;

/// A bicubic map of the box in the power basis: `c[i][j]` is the coefficient of uⁱvʲ, with u = x/1000, v = y/1000.
#[derive(Debug, Clone)]
pub struct Bicubic {
    pub x: [[f64; 4]; 4],
    pub y: [[f64; 4]; 4],
}

/// The change of basis from Bernstein polynomials to powers, for degree 3.
const POWER: [[f64; 4]; 4] =
    [[1.0, 0.0, 0.0, 0.0], [-3.0, 3.0, 0.0, 0.0], [3.0, -6.0, 3.0, 0.0], [-1.0, 3.0, -3.0, 1.0]];

/// The power coefficients of a net of Bernstein coefficients.
fn tensor_power(net: &[[f64; 4]; 4]) -> [[f64; 4]; 4] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            (0..4).map(|k| (0..4).map(|l| POWER[i][k] * POWER[j][l] * net[k][l]).sum::<f64>()).sum()
        })
    })
}

impl Bicubic {
    /// The map of a net of control points, of which `net[i][j]` belongs to (i/3, j/3) of the box.
    pub fn from_net(net: &[[Point; 4]; 4]) -> Self {
        Self { x: tensor_power(&net.map(|r| r.map(|p| p.x))), y: tensor_power(&net.map(|r| r.map(|p| p.y))) }
    }

    /// The net of the identity with control point (i, j) moved by `f(i, j)` user units.
    pub fn moved(f: impl Fn(usize, usize) -> (f64, f64)) -> Self {
        let net = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let (dx, dy) = f(i, j);
                Point::new(BOX * i as f64 / 3.0 + dx, BOX * j as f64 / 3.0 + dy)
            })
        });
        Self::from_net(&net)
    }

    /// A mild map: control points moved by at most 5 %.
    pub fn mild() -> Self {
        const MOVES: [[(f64, f64); 4]; 4] = [
            [(25.0, 25.0), (40.0, -50.0), (-20.0, -35.0), (-5.0, 50.0)],
            [(-20.0, 30.0), (45.0, 40.0), (45.0, 45.0), (-10.0, 50.0)],
            [(-15.0, 10.0), (50.0, -15.0), (20.0, -20.0), (-50.0, -50.0)],
            [(45.0, 15.0), (-25.0, 40.0), (-50.0, 0.0), (15.0, -30.0)],
        ];
        Self::moved(|i, j| MOVES[i][j])
    }

    /// A strong bulge with a twist, whose Jacobian determinant just touches zero.
    pub fn strong() -> Self {
        Self::moved(|i, j| {
            let (u, v) = (i as f64 / 3.0 - 0.5, j as f64 / 3.0 - 0.5);
            let is_inner = (1..3).contains(&i) && (1..3).contains(&j);
            let (bulge, twist) = if is_inner { (2.1, 1.6) } else { (-0.1, 0.0) };
            (BOX * (bulge * u - twist * v), BOX * (bulge * v + twist * u))
        })
    }

    /// The coefficients of the powers of v at `u`: of x, y, ∂x/∂u and ∂y/∂u.
    fn rows(&self, u: f64) -> [[f64; 4]; 4] {
        let f = |c: &[[f64; 4]; 4], j: usize| ((c[3][j] * u + c[2][j]) * u + c[1][j]) * u + c[0][j];
        let d = |c: &[[f64; 4]; 4], j: usize| (3.0 * c[3][j] * u + 2.0 * c[2][j]) * u + c[1][j];
        [
            std::array::from_fn(|j| f(&self.x, j)),
            std::array::from_fn(|j| f(&self.y, j)),
            std::array::from_fn(|j| d(&self.x, j)),
            std::array::from_fn(|j| d(&self.y, j)),
        ]
    }
}

/// The value of a cubic polynomial.
#[inline(always)]
fn horner(r: &[f64; 4], v: f64) -> f64 {
    ((r[3] * v + r[2]) * v + r[1]) * v + r[0]
}

/// The derivative of a cubic polynomial.
#[inline(always)]
fn slope(r: &[f64; 4], v: f64) -> f64 {
    (3.0 * r[3] * v + 2.0 * r[2]) * v + r[1]
}

impl Map for Bicubic {
    fn class(&self) -> Class {
        Class::Rational(RationalDegree::polynomial(6))
    }

    #[inline]
    fn jet(&self, p: Point) -> Jet {
        let (u, v) = (p.x * (1.0 / BOX), p.y * (1.0 / BOX));
        let [x, y, dx, dy] = self.rows(u);
        Jet {
            p: Point::new(horner(&x, v), horner(&y, v)),
            dx: Vec2::new(horner(&dx, v), horner(&dy, v)) / BOX,
            dy: Vec2::new(slope(&x, v), slope(&y, v)) / BOX,
        }
    }

    #[inline]
    fn point(&self, p: Point) -> Point {
        let (u, v) = (p.x * (1.0 / BOX), p.y * (1.0 / BOX));
        let row = |c: &[[f64; 4]; 4], j: usize| ((c[3][j] * u + c[2][j]) * u + c[1][j]) * u + c[0][j];
        let value = |c: &[[f64; 4]; 4]| ((row(c, 3) * v + row(c, 2)) * v + row(c, 1)) * v + row(c, 0);
        Point::new(value(&self.x), value(&self.y))
    }
}

/// A rational map of degree 1 in x and 3 in y: an envelope between two rational cubics.
#[derive(Clone)]
pub struct Rational {
    /// x·w, y·w and w in the power basis: `c[k][i][j]` is the coefficient of uⁱvʲ.
    pub c: [[[f64; 4]; 2]; 3],
}

impl Rational {
    /// An envelope about as large as the box, with uneven weights.
    pub fn new() -> Self {
        let points = [
            [(30.0, -20.0), (160.0, 330.0), (-120.0, 640.0), (20.0, 1010.0)],
            [(980.0, 40.0), (840.0, 300.0), (1130.0, 700.0), (1000.0, 980.0)],
        ];
        let weights = [[1.0, 1.6, 0.7, 1.0], [1.1, 0.8, 2.0, 0.9]];
        let net = |f: &dyn Fn(usize, usize) -> f64| -> [[f64; 4]; 2] {
            let rows: [[f64; 4]; 2] =
                std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|l| POWER[j][l] * f(i, l)).sum()));
            [rows[0], std::array::from_fn(|j| rows[1][j] - rows[0][j])]
        };
        Self {
            c: [
                net(&|i, j| points[i][j].0 * weights[i][j]),
                net(&|i, j| points[i][j].1 * weights[i][j]),
                net(&|i, j| weights[i][j]),
            ],
        }
    }
}

impl Default for Rational {
    fn default() -> Self {
        Self::new()
    }
}

impl Map for Rational {
    fn class(&self) -> Class {
        Class::Rational(RationalDegree::rational(4))
    }

    fn denominator(&self, p: Point) -> f64 {
        let (u, v) = (p.x * (1.0 / BOX), p.y * (1.0 / BOX));
        horner(&self.c[2][0], v) + u * horner(&self.c[2][1], v)
    }

    #[inline]
    fn jet(&self, p: Point) -> Jet {
        let (u, v) = (p.x * (1.0 / BOX), p.y * (1.0 / BOX));
        // The homogeneous coordinates with their derivatives by u and by v.
        let [(x, xu, xv), (y, yu, yv), (w, wu, wv)] = self.c.each_ref().map(|[r, s]| {
            let du = horner(s, v);
            (horner(r, v) + u * du, du, slope(r, v) + u * slope(s, v))
        });
        let k = 1.0 / w;
        let (x, y, d) = (x * k, y * k, k / BOX);
        Jet {
            p: Point::new(x, y),
            dx: Vec2::new((xu - x * wu) * d, (yu - y * wu) * d),
            dy: Vec2::new((xv - x * wv) * d, (yv - y * wv) * d),
        }
    }

    #[inline]
    fn point(&self, p: Point) -> Point {
        let (u, v) = (p.x * (1.0 / BOX), p.y * (1.0 / BOX));
        let [x, y, w] = self.c.each_ref().map(|[r, s]| horner(r, v) + u * horner(s, v));
        Point::new(x / w, y / w)
    }
}

/// A fold along x = 503.75, where the direction (1, −0.06) is in the kernel of the Jacobian.
pub struct Fold;

impl Formula for Fold {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let u = (x - 500.0) / 500.0;
        (u * u * 400.0 + y * 0.2, y + u * 30.0)
    }
}

/// A sine wave along x of the given height.
pub struct Ripple(pub f64);

impl Formula for Ripple {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x, y + (x / 150.0).sin() * self.0)
    }
}

/// The larger distance, in either direction, between the image of a path and the result. Each segment of the source has `n` samples, and
/// the result about as many in total; more where they turn sharply for a distance of `tolerance`.
pub fn distance(source: &dyn Curved, map: &dyn Map, result: &dyn Curved, n: usize, tolerance: f64) -> f64 {
    let (source, result) = (source.curves(), result.curves());
    let image = |points: &[Point], out: &mut [Point]| map.points(points, out);
    let per = (n * source.len() / result.len().max(1)).max(8);
    apart(&Run::image(&source, &image).sampled(n, tolerance), &Run::of(&result).sampled(per, tolerance)).0
}
