//! Polynomials in Bernstein form over [0, 1], for exact images of curves.
//!
//! Coefficients are stored *scaled* (multiplied by their binomials), so that products are plain convolutions. See Farouki &
//! Rajan, *Algorithms for polynomials in Bernstein form* (1988).

/// A polynomial by its scaled Bernstein coefficients cᵢ·C(n,i).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scaled(Vec<f64>);

impl Scaled {
    /// The polynomial with these Bernstein coefficients.
    pub(crate) fn new(coefficients: impl IntoIterator<Item = f64>) -> Self {
        let c: Vec<f64> = coefficients.into_iter().collect();
        let b = binomials(c.len().saturating_sub(1));
        Self(c.into_iter().zip(b).map(|(c, b)| c * b).collect())
    }

    /// The Bernstein coefficients.
    pub(crate) fn coefficients(&self) -> Vec<f64> {
        let b = binomials(self.0.len().saturating_sub(1));
        self.0.iter().zip(b).map(|(c, b)| c / b).collect()
    }

    /// The product, whose degree is the sum of the degrees.
    pub(crate) fn times(&self, other: &Self) -> Self {
        let mut out = vec![0.0; self.0.len() + other.0.len() - 1];
        for (i, a) in self.0.iter().enumerate() {
            for (o, b) in out[i..].iter_mut().zip(&other.0) {
                *o += a * b;
            }
        }
        Self(out)
    }

    /// Adds `k` times `other`, a polynomial written with the same degree.
    pub(crate) fn add_scaled(&mut self, k: f64, other: &Self) {
        for (a, b) in self.0.iter_mut().zip(&other.0) {
            *a += k * b;
        }
    }

    /// The zero polynomial, written with degree `n`.
    pub(crate) fn zero(n: usize) -> Self {
        Self(vec![0.0; n + 1])
    }

    /// The powers 0 to `n` of the polynomial.
    pub(crate) fn powers(&self, n: usize) -> Vec<Self> {
        let mut out = vec![Self(vec![1.0])];
        for i in 0..n {
            out.push(out[i].times(self));
        }
        out
    }
}

/// C(n, 0..=n).
fn binomials(n: usize) -> Vec<f64> {
    let mut out = Vec::with_capacity(n + 1);
    let mut b = 1.0;
    for i in 0..=n {
        out.push(b);
        b = b * (n - i) as f64 / (i + 1) as f64;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(c: &[f64], t: f64) -> f64 {
        let mut row = c.to_vec();
        for n in (1..row.len()).rev() {
            for i in 0..n {
                row[i] += t * (row[i + 1] - row[i]);
            }
        }
        row[0]
    }

    #[test]
    fn products_and_sums_agree_with_values() {
        let (a, b) = ([1.0, -2.0, 3.5, 0.25], [0.5, 4.0, -1.0]);
        let product = Scaled::new(a).times(&Scaled::new(b)).coefficients();
        let cube = Scaled::new(b).powers(3)[3].coefficients();
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            assert!((value(&product, t) - value(&a, t) * value(&b, t)).abs() < 1e-14);
            assert!((value(&cube, t) - value(&b, t).powi(3)).abs() < 1e-12);
        }
    }
}
