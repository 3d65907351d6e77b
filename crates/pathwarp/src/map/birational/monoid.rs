//! Monoids: rational Bézier curves with free control points whose weights give them a point A of multiplicity n − 1.
//!
//! A line L(t) = (1−t)·ℓ₀ + t·ℓ₁ turns about A, from the line ℓ₀ through A and P₀ to the line ℓ₁ through A and Pₙ. It follows
//! the curve, L(t)·P(t) ≡ 0, if
//!
//! > wᵢ = − i (ℓ₁·Pᵢ₋₁) / ((n+1−i)(ℓ₀·Pᵢ)) · wᵢ₋₁
//!
//! (T. W. Sederberg, J. Zheng, *Birational 2D free-form deformation of degree 1×n*, CAGD 2016, theorem 2.3, where
//! ℓ₀ = A×Q₀, ℓ₁ = A×Q₁). Then t has the closed form ℓ₀·X / (ℓ₀·X − ℓ₁·X), and the curve an implicit equation with the same
//! coefficients (equation 22):
//!
//! > f(X) = ⟨w₀,…,wₙ⟩ₙ\[−ℓ₁·X, ℓ₀·X\] − ⟨h₀,…,hₙ₋₁⟩ₙ₋₁\[−ℓ₁·X, ℓ₀·X\],  hᵢ = n/(i+1)·wᵢ₊₁·(ℓ₀·Pᵢ₊₁)
//!
//! with ⟨c⟩ₙ\[α,β\] = Σ cᵢ C(n,i) αⁿ⁻ⁱ βⁱ.

use crate::map::Real;
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

    /// ℓ·X, generic over the number type.
    #[inline]
    pub(super) fn of<S: Real>(&self, x: S, y: S) -> S {
        (x - self.through.x) * self.normal.x + (y - self.through.y) * self.normal.y
    }

    /// The line through two points, scaled so that ℓ·X = |from, to, X|.
    #[must_use]
    pub(super) fn join(from: Point, to: Point) -> Self {
        let d = to - from;
        Self { through: from, normal: Vec2::new(-d.y, d.x) }
    }

    /// The same line with values scaled by `k`.
    #[must_use]
    pub(super) fn scaled(self, k: f64) -> Self {
        Self { normal: self.normal * k, ..self }
    }
}

/// A planar rational Bézier curve with an (n−1)-fold point.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Monoid {
    points: Vec<Point>,
    weights: Vec<f64>,
    h: Vec<f64>,
    first: ImplicitLine,
    last: ImplicitLine,
}

impl Monoid {
    /// The curve with these control points whose line L is `first` at t = 0 and `last` at t = 1, through the first and the last
    /// control point. The lines meet in the multiple point; their scales determine the speed of t. `None` with fewer than two
    /// points, or if a weight is zero or not finite because another control point lies on `first` or `last`.
    #[must_use]
    pub(super) fn new(points: &[Point], first: ImplicitLine, last: ImplicitLine) -> Option<Self> {
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

    /// The control points.
    #[must_use]
    pub(super) fn points(&self) -> &[Point] {
        &self.points
    }

    /// The weights.
    #[must_use]
    pub(super) fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The coefficients h₀ … hₙ₋₁ of the implicit equation.
    #[must_use]
    pub(super) fn h(&self) -> &[f64] {
        &self.h
    }

    /// The lines at t = 0 and t = 1.
    #[must_use]
    pub(super) fn lines(&self) -> [ImplicitLine; 2] {
        [self.first, self.last]
    }

    /// The same curve with weights gⁱ·wᵢ, which changes only the speed of t.
    #[must_use]
    pub(super) fn paced(&self, g: f64) -> Option<Self> {
        Self::new(&self.points, self.first, self.last.scaled(g))
    }

    /// The same curve with all weights multiplied by `k`.
    #[must_use]
    pub(super) fn weighted(mut self, k: f64) -> Self {
        self.weights.iter_mut().chain(&mut self.h).for_each(|w| *w *= k);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Monoid {
        /// As [`Monoid::new`], from the multiple point `a` and points `q0`, `q1` on the first and last line, as in the paper. `a` is
        /// homogeneous, so it may lie at infinity.
        pub(crate) fn with_axis(points: &[Point], a: [f64; 3], q0: Point, q1: Point) -> Option<Self> {
            let line = |q: Point| ImplicitLine { through: q, normal: Vec2::new(a[1] - a[2] * q.y, a[2] * q.x - a[0]) };
            Self::new(points, line(q0), line(q1))
        }

        /// The parameter whose line contains `p`; infinite on the line t = ∞.
        pub(crate) fn t(&self, p: Point) -> f64 {
            let (b, a) = (self.first.at(p), self.last.at(p));
            b / (b - a)
        }

        /// The homogeneous point (X·w, Y·w, w) at `t`.
        pub(crate) fn eval(&self, t: f64) -> [f64; 3] {
            [0, 1, 2].map(|k| {
                let c = self.points.iter().zip(&self.weights).map(|(p, w)| w * [p.x, p.y, 1.0][k]);
                bernstein(c.collect::<Vec<_>>().as_slice(), 1.0 - t, t)
            })
        }

        /// The left side of the implicit equation: zero on the curve and at its multiple point.
        pub(crate) fn implicit(&self, p: Point) -> f64 {
            let (alpha, beta) = (-self.last.at(p), self.first.at(p));
            bernstein(&self.weights, alpha, beta) - bernstein(&self.h, alpha, beta)
        }
    }

    /// ⟨c⟩ₙ\[α,β\] = Σ cᵢ C(n,i) αⁿ⁻ⁱ βⁱ, by Horner's scheme in β with running powers of α.
    fn bernstein<S: Real>(c: &[f64], alpha: S, beta: S) -> S {
        let n = c.len() - 1;
        let (mut sum, mut power, mut binomial) = (S::from(c[n]), S::from(1.0), 1.0);
        // From the last term down, without divisions: sum = Σ_{i≥k} cᵢ C(n,i) αⁿ⁻ⁱ βⁱ⁻ᵏ.
        for k in (0..n).rev() {
            power = power * alpha;
            binomial = binomial * (k + 1) as f64 / (n - k) as f64;
            sum = sum * beta + power * (c[k] * binomial);
        }
        sum
    }

    fn example() -> Monoid {
        let p = [(0.0, 2.0), (0.0, 3.0), (2.0, 4.0), (5.0, 3.0), (5.0, 2.0)].map(Point::from);
        Monoid::with_axis(&p, [3.0, 0.0, 1.0], p[0], p[4]).unwrap()
    }

    /// The paper's example in section 4.
    #[test]
    fn weights_and_equation_are_the_papers() {
        let m = example();
        let near =
            |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 4e-15 * b.abs());
        assert!(near(m.weights(), &[1.0, 5.0 / 6.0, 2.0 / 3.0, 10.0 / 13.0, 8.0 / 13.0]), "{:?}", m.weights());
        assert!(near(m.h(), &[-10.0, -40.0 / 3.0, -40.0 / 3.0, -80.0 / 13.0]), "{:?}", m.h());
        // |Q₁AX| = 2x − 2y − 6 and |AQ₀X| = −2x − 3y + 6.
        let [first, last] = m.lines();
        for p in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (7.0, -3.0)] {
            assert_eq!(-last.at(p.into()), 2.0 * p.0 - 2.0 * p.1 - 6.0);
            assert_eq!(first.at(p.into()), -2.0 * p.0 - 3.0 * p.1 + 6.0);
        }
    }

    #[test]
    fn the_equation_vanishes_on_the_curve_only() {
        let m = example();
        for i in -10..=30 {
            let t = f64::from(i) / 20.0;
            let [x, y, w] = m.eval(t);
            if w.abs() < 0.05 {
                continue;
            }
            let p = Point::new(x / w, y / w);
            let size = (1.0 + p.to_vec2().hypot()).powi(4) * 100.0;
            assert!(m.implicit(p).abs() < 1e-13 * size, "{t} {}", m.implicit(p));
            assert!((m.t(p) - t).abs() < 1e-11, "{t}");
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
        assert!(Monoid::new(&p, lines[0], lines[1]).is_none());
    }

    #[test]
    fn a_line_through_two_points() {
        let l = ImplicitLine::join(Point::new(1.0, 1.0), Point::new(3.0, 1.0));
        assert_eq!(l.at(Point::new(5.0, 1.0)), 0.0);
        assert_eq!(l.at(Point::new(1.0, 2.0)), 2.0);
    }
}
