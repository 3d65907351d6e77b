//! Quotients of polynomials of any total degree: the maps of Bézier triangles and of anamorphoses.
//!
//! > F(x, y) = (X, Y)/W,  X = Σ cᵢⱼ aⁱ bʲ, similarly Y and W,  (a, b) an affine function of (x, y)
//!
//! Polynomials are evaluated by Horner's scheme. A polynomial map is stored as the displacement F(p) − p, so that points that do not
//! move are not rounded. Substitution in Bernstein form maps a curve of degree d to one of degree d·n, where n is the total degree. A
//! map of degree one reports itself as affine or projective ([`Map::class`]).

use super::rational_bezier::Scaled;
use super::{
    AffineMap, Class, Cost, Crease, Creases, Formula, Homography, Level, Map, NewtonInverse, Polynomials,
    RationalBezier, RationalDegree, Real,
};
use kurbo::{Affine, Point, Rect};
use std::sync::Arc;

/// A map of the plane whose coordinates are quotients of polynomials with one denominator.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Quotient {
    /// The affine function from (x, y) to (a, b).
    pre: Affine,
    /// The origin of the image: added to (X, Y)/W; unused by a polynomial map.
    origin: Point,
    /// X and Y; the displacement for a polynomial map.
    x: Plane,
    y: Plane,
    /// W; empty for a polynomial map.
    w: Plane,
    /// A second condition on the domain besides W > 0: positive where the map is defined.
    guard: Option<Plane>,
    degree: usize,
    /// `true` if the map is known to have no pole in its domain of use.
    without_poles: bool,
    /// The box over which the inverse is sought.
    domain: Rect,
    /// The inverse, if it is known and is a quotient too.
    pub(crate) back: Option<Box<Self>>,
}

impl Quotient {
    /// The map p ↦ p + (x, y). `pre` takes the source point to (a, b); the inverse is sought over `domain`.
    pub(crate) fn polynomial(pre: Affine, x: Plane, y: Plane, domain: Rect) -> Self {
        let size = x.largest().max(y.largest());
        let (x, y) = (x.without_noise(size), y.without_noise(size));
        let degree = x.degree().max(y.degree()).max(1);
        let w = Plane::default();
        Self { pre, origin: Point::ORIGIN, x, y, w, guard: None, degree, without_poles: true, domain, back: None }
    }

    /// The map p ↦ `origin` + (x, y)/w.
    pub(crate) fn rational(pre: Affine, origin: Point, x: Plane, y: Plane, w: Plane, domain: Rect) -> Self {
        let size = x.largest().max(y.largest());
        let (x, y) = (x.without_noise(size), y.without_noise(size));
        let size = w.largest();
        let w = w.without_noise(size);
        if w.degree() == 0 {
            let k = 1.0 / w.coefficient(0, 0);
            let [sx, sy] = source_coordinates(pre);
            let displacement = |p: &Plane, origin: f64, source: [f64; 3]| {
                p.scaled(k).plus(-1.0, &Plane::linear(source)).plus(origin, &Plane::linear([1.0, 0.0, 0.0]))
            };
            return Self::polynomial(pre, displacement(&x, origin.x, sx), displacement(&y, origin.y, sy), domain);
        }
        let degree = x.degree().max(y.degree()).max(w.degree());
        Self { pre, origin, x, y, w, guard: None, degree, without_poles: false, domain, back: None }
    }

    /// Returns this map, known to have no pole in its domain of use.
    pub(crate) fn without_poles(self) -> Self {
        Self { without_poles: true, ..self }
    }

    /// Restricts the domain to where `guard` is positive.
    pub(crate) fn guarded(self, guard: Plane) -> Self {
        Self { guard: Some(guard), ..self }
    }

    /// Returns `true` if there is no denominator.
    #[must_use]
    pub(crate) fn is_polynomial(&self) -> bool {
        self.w.is_zero()
    }

    /// Returns a map of degree one as a matrix, about the source point at which a = b = 0, so that no digits are lost far from the origin.
    fn matrix(&self) -> Option<Homography> {
        if self.degree > 1 {
            return None;
        }
        let [a, b, c, d, ..] = self.pre.as_coeffs();
        let from = self.pre.inverse() * Point::ORIGIN;
        let row = |p: &Plane| {
            let (c0, ca, cb) = (p.coefficient(0, 0), p.coefficient(1, 0), p.coefficient(0, 1));
            [ca * a + cb * b, ca * c + cb * d, c0]
        };
        let ([mut x, mut y], w) = ([&self.x, &self.y].map(row), row(&self.w));
        if self.is_polynomial() {
            x[0] += 1.0;
            y[1] += 1.0;
            return Some(Homography::about([x, y, [0.0, 0.0, 1.0]], from, from));
        }
        Some(Homography::about([x, y, w], from, self.origin))
    }

    /// Returns this map in its simplest form: affine, projective or a quotient.
    #[must_use]
    pub(crate) fn simplest(self) -> Arc<dyn Map> {
        match Formula::class(&self) {
            Class::Affine(m) => Arc::new(AffineMap(m)),
            Class::Projective(h) => Arc::new(h),
            _ => Arc::new(self),
        }
    }
}

/// The source coordinates x and y as linear functions of (a, b): constant, coefficients of a and of b.
pub(crate) fn source_coordinates(pre: Affine) -> [[f64; 3]; 2] {
    let [a, b, c, d, e, f] = pre.inverse().as_coeffs();
    [[e, a, c], [f, b, d]]
}

impl Formula for Quotient {
    /// The cost is proportional to the number of terms of a polynomial.
    fn cost(&self) -> Cost<'_> {
        /// The numbers of a bicubic net: sixteen terms of two coordinates.
        const NET_TERMS: f64 = 32.0;
        let terms = (self.degree + 1) * (self.degree + 2) / 2;
        Cost::new((terms as f64 / NET_TERMS).max(1.0))
    }

    #[inline]
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let [k0, k1, k2, k3, k4, k5] = self.pre.as_coeffs();
        let (a, b) = (x * k0 + y * k2 + k4, x * k1 + y * k3 + k5);
        let (u, v) = (self.x.at(a, b), self.y.at(a, b));
        if self.is_polynomial() {
            return (x + u, y + v);
        }
        let w = self.w.at(a, b);
        (u / w + self.origin.x, v / w + self.origin.y)
    }

    fn class(&self) -> Class {
        match self.matrix() {
            _ if self.is_polynomial() && self.x.is_zero() && self.y.is_zero() => Class::Affine(Affine::IDENTITY),
            Some(h) => h.as_affine().map_or(Class::Projective(h), Class::Affine),
            None => Class::Rational(RationalDegree { degree: self.degree, rational: !self.is_polynomial() }),
        }
    }

    fn creases(&self, out: &mut Creases) {
        if !self.without_poles {
            let map = self.clone();
            out.push(Crease::edge(Level::Field(Arc::new(move |p: Point| Formula::denominator(&map, p)))));
        }
        if let Some(guard) = self.guard.clone() {
            let pre = self.pre;
            out.push(Crease::edge(Level::Field(Arc::new(move |p: Point| {
                let q = pre * p;
                guard.at(q.x, q.y)
            }))));
        }
    }

    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        if let Some(h) = self.matrix() {
            return match Formula::class(self) {
                Class::Affine(m) => AffineMap(m).image(curve),
                _ => h.image(curve),
            };
        }
        let total = self.degree;
        let local = AffineMap(self.pre).image(curve)?;
        let [a, b, w] = [0, 1, 2].map(|k| local.coordinate(k).powers(total));
        let degree = curve.degree() * total;
        let along_curve = |p: &Plane| p.along_curve(&a, &b, &w, total, degree);
        let (mut x, mut y) = (along_curve(&self.x), along_curve(&self.y));
        let denominator = if self.is_polynomial() {
            // Add the point itself to the displacement.
            x.add_scaled(1.0, &curve.coordinate(0).times(&w[total - 1]));
            y.add_scaled(1.0, &curve.coordinate(1).times(&w[total - 1]));
            w[total].clone()
        } else {
            let denominator = along_curve(&self.w);
            x.add_scaled(self.origin.x, &denominator);
            y.add_scaled(self.origin.y, &denominator);
            denominator
        };
        let polynomial = self.is_polynomial() && curve.is_polynomial();
        Some(RationalBezier::from_coordinates([&x, &y, &denominator], polynomial))
    }

    fn denominator(&self, p: Point) -> f64 {
        if self.is_polynomial() {
            return 1.0;
        }
        let q = self.pre * p;
        self.w.at(q.x, q.y)
    }

    fn preimages(&self, q: Point) -> Option<Vec<Point>> {
        if let Some(back) = &self.back {
            return Some(vec![Map::point(&**back, q)]);
        }
        let [mut x, mut y, mut w] = [&self.x, &self.y, &self.w].map(Plane::clone);
        if self.is_polynomial() {
            let [sx, sy] = source_coordinates(self.pre);
            (x, y, w) =
                (x.plus(1.0, &Plane::linear(sx)), y.plus(1.0, &Plane::linear(sy)), Plane::linear([1.0, 0.0, 0.0]));
        }
        let all = [(x, [1.0, 0.0, 0.0]), (y, [0.0, 1.0, 0.0]), (w, [0.0, 0.0, 1.0])];
        let terms =
            all.iter().flat_map(|(plane, unit)| plane.terms().map(move |(i, j, c)| (i, j, unit.map(|u| u * c))));
        Polynomials { pre: self.pre, origin: self.origin, terms: terms.collect() }.preimages(self, q)
    }

    /// The inverse in closed form if that is known, by the matrix for degree one, by Newton's method over the domain otherwise.
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        if let Some(back) = &self.back {
            let forward = Self { back: None, ..self.clone() };
            return Some(Arc::new(Self { back: Some(Box::new(forward)), ..(**back).clone() }));
        }
        match Formula::class(self) {
            Class::Affine(m) => AffineMap(m).inverse(),
            Class::Projective(h) => h.inverse(),
            _ => {
                let margin = 1e-9 * (self.domain.width() + self.domain.height());
                Some(Arc::new(NewtonInverse::new(Arc::new(self.clone()), self.domain, margin, [1, 1])))
            }
        }
    }
}

/// Coefficients below this share of the largest are rounding noise.
const NOISE: f64 = 4e-15;

/// A polynomial in two variables a and b, by its coefficients in rows: that of aⁱbʲ has the index `[j][i]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Plane(Vec<Vec<f64>>);

impl Plane {
    /// The polynomial with these rows of coefficients.
    pub(crate) fn new(rows: Vec<Vec<f64>>) -> Self {
        Self(rows)
    }

    /// c + ca·a + cb·b.
    pub(crate) fn linear([c, ca, cb]: [f64; 3]) -> Self {
        Self(vec![vec![c, ca], vec![cb]])
    }

    /// The value at (a, b), by Horner's scheme.
    pub(crate) fn at<S: Real>(&self, a: S, b: S) -> S {
        let row = |r: &[f64]| r.iter().rev().fold(S::from(0.0), |v, c| v * a + *c);
        self.0.iter().rev().fold(S::from(0.0), |v, r| v * b + row(r))
    }

    /// Returns self + k·other.
    pub(crate) fn plus(mut self, k: f64, other: &Self) -> Self {
        for (j, from) in other.0.iter().enumerate() {
            if self.0.len() <= j {
                self.0.push(Vec::new());
            }
            let to = &mut self.0[j];
            to.resize(to.len().max(from.len()), 0.0);
            for (t, f) in to.iter_mut().zip(from) {
                *t += k * f;
            }
        }
        self
    }

    /// k·self.
    pub(crate) fn scaled(&self, k: f64) -> Self {
        Self(self.0.iter().map(|r| r.iter().map(|c| c * k).collect()).collect())
    }

    /// The product with c + ca·a + cb·b.
    pub(crate) fn times_linear(&self, [c, ca, cb]: [f64; 3]) -> Self {
        let shifted = |di: usize, dj: usize| {
            let rows = self.0.iter().map(|r| std::iter::repeat_n(0.0, di).chain(r.iter().copied()).collect());
            Self(std::iter::repeat_n(Vec::new(), dj).chain(rows).collect())
        };
        self.scaled(c).plus(ca, &shifted(1, 0)).plus(cb, &shifted(0, 1))
    }

    /// The nonzero terms as (i, j, coefficient).
    fn terms(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let all = self.0.iter().enumerate().flat_map(|(j, r)| r.iter().enumerate().map(move |(i, c)| (i, j, *c)));
        all.filter(|t| t.2 != 0.0)
    }

    /// The total degree.
    pub(crate) fn degree(&self) -> usize {
        self.terms().map(|(i, j, _)| i + j).max().unwrap_or(0)
    }

    /// The coefficient of aⁱbʲ.
    pub(crate) fn coefficient(&self, i: usize, j: usize) -> f64 {
        self.0.get(j).and_then(|r| r.get(i)).copied().unwrap_or(0.0)
    }

    /// The largest magnitude of a coefficient.
    fn largest(&self) -> f64 {
        self.0.iter().flatten().fold(0.0, |m, c| f64::max(m, c.abs()))
    }

    /// Sets coefficients below [`NOISE`] times `size` to zero and drops trailing zeros.
    fn without_noise(mut self, size: f64) -> Self {
        for row in &mut self.0 {
            for c in row.iter_mut().filter(|c| c.abs() <= NOISE * size) {
                *c = 0.0;
            }
            let used = row.iter().rposition(|c| *c != 0.0).map_or(0, |k| k + 1);
            row.truncate(used);
        }
        let used = self.0.iter().rposition(|r| !r.is_empty()).map_or(0, |k| k + 1);
        self.0.truncate(used);
        self
    }

    /// The polynomial along a curve (a/w, b/w), multiplied by the curve's denominator to the power `total`. The slices hold powers
    /// of a, b and w.
    fn along_curve(&self, a: &[Scaled], b: &[Scaled], w: &[Scaled], total: usize, degree: usize) -> Scaled {
        let mut sum = Scaled::zero(degree);
        for (i, j, c) in self.terms() {
            sum.add_scaled(c, &a[i].times(&b[j]).times(&w[total - i - j]));
        }
        sum
    }

    /// Returns `true` if every coefficient vanishes. Exact only after [`Plane::without_noise`].
    fn is_zero(&self) -> bool {
        self.0.is_empty()
    }
}
