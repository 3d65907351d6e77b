//! Polynomials in two variables, as rows of power coefficients.

use super::bernstein::Scaled;
use crate::map::Real;

/// A coefficient this much smaller than the largest is rounding noise.
const NOISE: f64 = 4e-15;

/// A polynomial in two variables a and b.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Plane(Vec<Vec<f64>>);

impl Plane {
    /// The polynomial with coefficients `rows[j][i]` of aⁱbʲ.
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
    pub(super) fn largest(&self) -> f64 {
        self.0.iter().flatten().fold(0.0, |m, c| f64::max(m, c.abs()))
    }

    /// Sets coefficients below [`NOISE`] times `size` to zero and drops trailing zeros.
    pub(super) fn tidied(mut self, size: f64) -> Self {
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
    pub(super) fn on(&self, a: &[Scaled], b: &[Scaled], w: &[Scaled], total: usize, degree: usize) -> Scaled {
        let mut sum = Scaled::zero(degree);
        for (i, j, c) in self.terms() {
            sum.add_scaled(c, &a[i].times(&b[j]).times(&w[total - i - j]));
        }
        sum
    }
}

impl Plane {
    /// Returns `true` if every coefficient vanishes. Exact only after [`Plane::tidied`].
    pub(super) fn is_zero(&self) -> bool {
        self.0.is_empty()
    }
}
