//! Monoids: rational Bézier curves with free control points whose weights give them a point A of multiplicity n − 1.
//!
//! A line L(t) = (1−t)·ℓ₀ + t·ℓ₁ turns about A, from the line ℓ₀ through A and P₀ to the line ℓ₁ through A and Pₙ. It follows
//! the curve, L(t)·P(t) ≡ 0, if
//!
//! > wᵢ = − i (ℓ₁·Pᵢ₋₁) / ((n+1−i)(ℓ₀·Pᵢ)) · wᵢ₋₁
//!
//! (T. W. Sederberg, R. N. Goldman, X. Wang, *Birational 2D free-form deformation of degree 1×n*, CAGD 44, 2016, theorem 2.3,
//! where ℓ₀ = A×Q₀, ℓ₁ = A×Q₁). Then t has the closed form ℓ₀·X / (ℓ₀·X − ℓ₁·X), and the curve an implicit equation with the same
//! coefficients (equation 22):
//!
//! > f(X) = ⟨w₀,…,wₙ⟩ₙ\[−ℓ₁·X, ℓ₀·X\] − ⟨h₀,…,hₙ₋₁⟩ₙ₋₁\[−ℓ₁·X, ℓ₀·X\],  hᵢ = n/(i+1)·wᵢ₊₁·(ℓ₀·Pᵢ₊₁)
//!
//! with ⟨c⟩ₙ\[α,β\] = Σ cᵢ C(n,i) αⁿ⁻ⁱ βⁱ.

use super::Real;
use crate::error::GeometryError;
use kurbo::{Point, Vec2};

/// A line by its equation ℓ·X = normal·(X − through) = 0.
///
/// Stored with a point on the line, so that values near the line are not differences of large numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ImplicitLine {
    /// A point on the line.
    pub(super) through: Point,
    /// A normal, whose length is the scale of ℓ.
    pub(super) normal: Vec2,
}

impl ImplicitLine {
    /// ℓ·X.
    #[inline]
    #[must_use]
    pub(super) fn at(&self, p: Point) -> f64 {
        self.normal.dot(p - self.through)
    }

    /// ℓ·X for any number type.
    #[inline]
    pub(super) fn value_at<S: Real>(&self, x: S, y: S) -> S {
        (x - self.through.x) * self.normal.x + (y - self.through.y) * self.normal.y
    }

    /// The line through two points, scaled so that ℓ·X = |from, to, X|.
    #[must_use]
    pub(super) fn join(from: Point, to: Point) -> Self {
        let d = to - from;
        Self { through: from, normal: Vec2::new(-d.y, d.x) }
    }

    /// Returns this line with its values scaled by `k`.
    #[must_use]
    pub(super) fn scaled(self, k: f64) -> Self {
        Self { normal: self.normal * k, ..self }
    }
}

/// A planar rational Bézier curve of degree n with free control points, whose weights give it a point A of multiplicity n − 1 (T. W.
/// Sederberg, R. N. Goldman, X. Wang, *Birational 2D free-form deformation of degree 1×n*, CAGD 44, 2016, theorem 2.3).
///
/// Every line through A meets it in one more point, so that the parameter of a point and an implicit equation have closed forms.
///
/// ```
/// use pathwarp::{kurbo::Point, map::Monoid};
///
/// // The example of section 4: weights 1, 5/6, 2/3, 10/13, 8/13.
/// let points = [(0.0, 2.0), (0.0, 3.0), (2.0, 4.0), (5.0, 3.0), (5.0, 2.0)].map(Point::from);
/// let curve = Monoid::new(&points, [3.0, 0.0, 1.0], [points[0], points[4]])?;
/// assert!((curve.weights()[1] - 5.0 / 6.0).abs() < 1e-15);
/// let p = curve.point(0.3);
/// assert!((curve.parameter(p) - 0.3).abs() < 1e-14 && curve.implicit(p).abs() < 1e-10);
/// // Points with abscissae from 0 to 1: the curve is the graph of a function.
/// let graph = Monoid::graph(&[(0.0, 2.0), (0.7, 5.0), (0.8, -1.0), (1.0, 3.0)].map(Point::from))?;
/// assert!((graph.point(0.4).x - 0.4).abs() < 1e-15);
/// # Ok::<(), pathwarp::GeometryError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Monoid {
    pub(super) points: Vec<Point>,
    pub(super) weights: Vec<f64>,
    /// The coefficients h₀ … hₙ₋₁ of the implicit equation.
    pub(super) h: Vec<f64>,
    /// L at t = 0.
    pub(super) first: ImplicitLine,
    /// L at t = 1.
    pub(super) last: ImplicitLine,
}

impl Monoid {
    /// The curve with these control points and the multiple point `a`, which is homogeneous, so that it may lie at infinity. The line of
    /// parameter t joins A and (1 − t)·Q₀ + t·Q₁: Q₀ and Q₁ lie on the lines from A to the first and to the last control point, and their
    /// distances from A set the speed of t (equations 9 to 12). The first weight is 1.
    ///
    /// # Errors
    /// [`GeometryError::AnchorCount`] for fewer than two points; [`GeometryError::Coincident`] if A is an end of the curve, Q₀ or Q₁;
    /// [`GeometryError::WrongSide`] for Q₀ or Q₁ (point 1 of `Q0` or `Q1`) off its line and for a control point on one of the lines, where
    /// no weight helps; [`GeometryError::NotFinite`] if a weight is not finite.
    pub fn new(points: &[Point], a: [f64; 3], q: [Point; 2]) -> Result<Self, GeometryError> {
        /// Points closer to a line than this share of the distances count as on it.
        const ON_LINE: f64 = 1e-9;
        let (path, n) = ("monoid".to_owned(), points.len());
        if n < 2 {
            return Err(GeometryError::anchor_count(&path, points, "at least 2"));
        }
        let lines = q.map(|q| ImplicitLine { through: q, normal: Vec2::new(a[1] - a[2] * q.y, a[2] * q.x - a[0]) });
        for (line, end, name, end_name, at) in
            [(lines[0], 0, "Q0", "first", q[0]), (lines[1], n - 1, "Q1", "last", q[1])]
        {
            let size = points.iter().map(|p| p.distance(at)).fold(0.0, f64::max);
            if line.normal.hypot() <= ON_LINE * (a[2] * size).abs() || line.normal == Vec2::ZERO {
                return Err(GeometryError::Coincident { path: name.to_owned(), which: [1, 1], at });
            }
            let is_on = |p: Point| line.at(p).abs() <= ON_LINE * line.normal.hypot() * size;
            let wrong = |path: &str, which: usize, at: Point, on: bool| {
                let line = [points[end], line.through];
                Err(GeometryError::WrongSide { path: path.to_owned(), which, at, end: end_name, line, on })
            };
            if !is_on(points[end]) {
                return wrong(name, 1, at, false);
            }
            if let Some(k) = (0..n).find(|k| *k != end && is_on(points[*k])) {
                return wrong(&path, k + 1, points[k], true);
            }
        }
        Self::between(points, lines[0], lines[1]).ok_or(GeometryError::NotFinite { shape: path, at: points[0] })
    }

    /// The curve that is the graph of a function of x, proportional to the parameter: A lies at infinity along y (equation 23).
    ///
    /// # Errors
    /// [`GeometryError::WrongSide`] for an inner point with the abscissa of an end, and the other errors of [`Monoid::new`]. If all inner
    /// abscissae lie between those of the ends, there is no pole.
    pub fn graph(points: &[Point]) -> Result<Self, GeometryError> {
        let end = |p: Option<&Point>| p.copied().unwrap_or_default();
        Self::new(points, [0.0, 1.0, 0.0], [end(points.first()), end(points.last())])
    }

    /// The control points.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The weights of the control points.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The point at `t`, any number; infinite at a pole.
    #[must_use]
    pub fn point(&self, t: f64) -> Point {
        let sum = |f: &dyn Fn(&Point) -> f64| {
            let c: Vec<f64> = self.points.iter().zip(&self.weights).map(|(p, w)| w * f(p)).collect();
            bernstein(&c, 1.0 - t, t)
        };
        let w = sum(&|_| 1.0);
        Point::new(sum(&|p| p.x) / w, sum(&|p| p.y) / w)
    }

    /// The parameter whose line through A contains `p` (equation 13), infinite on the line t = ∞: the inverse of [`Monoid::point`].
    #[must_use]
    pub fn parameter(&self, p: Point) -> f64 {
        let (b, a) = (self.first.at(p), self.last.at(p));
        b / (b - a)
    }

    /// The left side of the implicit equation f(x, y) = 0 (equation 22): zero on the curve and at A.
    #[must_use]
    pub fn implicit(&self, p: Point) -> f64 {
        let (alpha, beta) = (-self.last.at(p), self.first.at(p));
        bernstein(&self.weights, alpha, beta) - bernstein(&self.h, alpha, beta)
    }

    /// The curve with these control points whose line L is `first` at t = 0 and `last` at t = 1, through the first and the last
    /// control point. The lines meet in the multiple point; their scales determine the speed of t. `None` with fewer than two
    /// points, or if a weight is zero or not finite because another control point lies on `first` or `last`.
    #[must_use]
    pub(super) fn between(points: &[Point], first: ImplicitLine, last: ImplicitLine) -> Option<Self> {
        let n = points.len().checked_sub(1).filter(|n| *n > 0)?;
        let mut weights = vec![1.0];
        for i in 1..=n {
            let ratio = -(i as f64) * last.at(points[i - 1]) / ((n + 1 - i) as f64 * first.at(points[i]));
            weights.push(weights[i - 1] * ratio);
        }
        if weights.iter().any(|w| !w.is_finite() || *w == 0.0) {
            return None;
        }
        let h = (0..n).map(|i| n as f64 / (i + 1) as f64 * weights[i + 1] * first.at(points[i + 1])).collect();
        Some(Self { points: points.to_vec(), weights, h, first, last })
    }

    /// Returns this curve with weights gⁱ·wᵢ, which changes only the speed of t.
    #[must_use]
    pub(super) fn paced(&self, g: f64) -> Option<Self> {
        Self::between(&self.points, self.first, self.last.scaled(g))
    }

    /// Returns this curve with all weights multiplied by `k`.
    #[must_use]
    pub(super) fn weighted(mut self, k: f64) -> Self {
        self.weights.iter_mut().chain(&mut self.h).for_each(|w| *w *= k);
        self
    }
}

/// ⟨c⟩ₙ\[α,β\] = Σ cᵢ C(n,i) αⁿ⁻ⁱ βⁱ, by Horner's scheme in β with running powers of α.
fn bernstein(c: &[f64], alpha: f64, beta: f64) -> f64 {
    let n = c.len() - 1;
    let (mut sum, mut power, mut binomial) = (c[n], 1.0, 1.0);
    // From the last term down, without divisions: sum = Σ_{i≥k} cᵢ C(n,i) αⁿ⁻ⁱ βⁱ⁻ᵏ.
    for k in (0..n).rev() {
        power *= alpha;
        binomial = binomial * (k + 1) as f64 / (n - k) as f64;
        sum = sum * beta + power * (c[k] * binomial);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Monoid {
        let p = [(0.0, 2.0), (0.0, 3.0), (2.0, 4.0), (5.0, 3.0), (5.0, 2.0)].map(Point::from);
        Monoid::new(&p, [3.0, 0.0, 1.0], [p[0], p[4]]).unwrap()
    }

    /// The paper's example in section 4.
    #[test]
    fn weights_and_equation_are_the_papers() {
        let m = example();
        let near =
            |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 4e-15 * b.abs());
        assert!(near(&m.weights, &[1.0, 5.0 / 6.0, 2.0 / 3.0, 10.0 / 13.0, 8.0 / 13.0]), "{:?}", m.weights);
        assert!(near(&m.h, &[-10.0, -40.0 / 3.0, -40.0 / 3.0, -80.0 / 13.0]), "{:?}", m.h);
        // |Q₁AX| = 2x − 2y − 6 and |AQ₀X| = −2x − 3y + 6.
        for p in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (7.0, -3.0)] {
            assert_eq!(-m.last.at(p.into()), 2.0 * p.0 - 2.0 * p.1 - 6.0);
            assert_eq!(m.first.at(p.into()), -2.0 * p.0 - 3.0 * p.1 + 6.0);
        }
    }

    #[test]
    fn the_equation_vanishes_on_the_curve_only() {
        let m = example();
        for i in -10..=30 {
            let t = f64::from(i) / 20.0;
            let p = m.point(t);
            if p.to_vec2().hypot() > 100.0 {
                continue;
            }
            let size = (1.0 + p.to_vec2().hypot()).powi(4) * 100.0;
            assert!(m.implicit(p).abs() < 1e-13 * size, "{t} {}", m.implicit(p));
            assert!((m.parameter(p) - t).abs() < 1e-11, "{t}");
            assert!(m.implicit(p + Vec2::new(0.3, 0.1)).abs() > 1e-3);
        }
        assert!(m.implicit((3.0, 0.0).into()).abs() < 1e-12, "the triple point lies on it");
    }

    #[test]
    fn the_sum_is_the_definition() {
        let c = [2.0, -1.0, 0.5, 3.0];
        let (a, b) = (0.7, -1.3);
        let by_hand = c[0] * a * a * a + 3.0 * c[1] * a * a * b + 3.0 * c[2] * a * b * b + c[3] * b * b * b;
        assert!((bernstein(&c, a, b) - by_hand).abs() < 1e-14);
    }

    #[test]
    fn a_point_on_an_end_line_has_no_weight() {
        let p = [(0.0, 0.0), (0.5, 0.0), (1.0, 1.0)].map(Point::from);
        let lines = [
            ImplicitLine::join((0.0, 0.0).into(), (1.0, 0.0).into()),
            ImplicitLine::join((0.0, 1.0).into(), (1.0, 1.0).into()),
        ];
        assert!(Monoid::between(&p, lines[0], lines[1]).is_none());
    }

    #[test]
    fn a_line_through_two_points() {
        let l = ImplicitLine::join(Point::new(1.0, 1.0), Point::new(3.0, 1.0));
        assert_eq!(l.at(Point::new(5.0, 1.0)), 0.0);
        assert_eq!(l.at(Point::new(1.0, 2.0)), 2.0);
    }
}
