//! Polynomials in two variables in scaled Bernstein form, Σ c[i,j]·uⁱ(1−u)ᵐ⁻ⁱvʲ(1−v)ⁿ⁻ʲ, in which products are convolutions.

/// A polynomial; its coefficients are Bernstein coefficients times binomial coefficients, u fastest.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scaled {
    degree: [usize; 2],
    c: Vec<f64>,
}

/// C(n, 0) to C(n, n).
fn binomials(n: usize) -> Vec<f64> {
    let mut out = vec![1.0; n + 1];
    for k in 1..=n {
        out[k] = (out[k - 1] * (n - k + 1) as f64 / k as f64).round();
    }
    out
}

impl Scaled {
    /// A constant.
    pub(super) fn constant(v: f64) -> Self {
        Self { degree: [0, 0], c: vec![v] }
    }

    /// The zero of some degree.
    pub(super) fn zero(degree: [usize; 2]) -> Self {
        Self { degree, c: vec![0.0; (degree[0] + 1) * (degree[1] + 1)] }
    }

    /// From Bernstein coefficients.
    pub(super) fn new(degree: [usize; 2], c: impl Iterator<Item = f64>) -> Self {
        let [a, b] = degree.map(binomials);
        let factor = b.iter().flat_map(|b| a.iter().map(move |a| a * b));
        Self { degree, c: c.zip(factor).map(|(c, f)| c * f).collect() }
    }

    /// The Bernstein coefficients.
    pub(super) fn bernstein(&self) -> Vec<f64> {
        let [a, b] = self.degree.map(binomials);
        let factor = b.iter().flat_map(|b| a.iter().map(move |a| a * b));
        self.c.iter().zip(factor).map(|(c, f)| c / f).collect()
    }

    /// The product.
    pub(super) fn times(&self, other: &Self) -> Self {
        let mut out = Self::zero([0, 1].map(|a| self.degree[a] + other.degree[a]));
        let width = out.degree[0] + 1;
        for (n, p) in self.c.iter().enumerate().filter(|(_, p)| **p != 0.0) {
            let (i, j) = (n % (self.degree[0] + 1), n / (self.degree[0] + 1));
            for (l, row) in other.c.chunks(other.degree[0] + 1).enumerate() {
                let start = (j + l) * width + i;
                out.c[start..start + row.len()].iter_mut().zip(row).for_each(|(o, q)| *o += p * q);
            }
        }
        out
    }

    /// Adds `k` times a polynomial of the same degree.
    pub(super) fn add(&mut self, k: f64, other: &Self) {
        self.c.iter_mut().zip(&other.c).for_each(|(a, b)| *a += k * b);
    }

    /// The powers 0 to `n`.
    pub(super) fn powers(&self, n: usize) -> Vec<Self> {
        let mut out = vec![Self::constant(1.0)];
        for k in 0..n {
            out.push(out[k].times(self));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_products() {
        let at = |p: &Scaled, u: f64, v: f64| -> f64 {
            let [m, n] = p.degree;
            let term = |k: usize| {
                let (i, j) = (k % (m + 1), k / (m + 1));
                let side = |t: f64, i: usize, n: usize| t.powi(i as i32) * (1.0 - t).powi((n - i) as i32);
                p.c[k] * side(u, i, m) * side(v, j, n)
            };
            (0..p.c.len()).map(term).sum()
        };
        let p = Scaled::new([2, 1], [1.0, -2.0, 3.0, 0.5, 4.0, -1.0].into_iter());
        let q = Scaled::new([1, 3], (0..8).map(|i| f64::from(i * i % 5) - 1.0));
        let cube = &p.times(&q).powers(3)[3];
        for (u, v) in [(0.2, 0.9), (0.7, 0.4)] {
            assert!((at(cube, u, v) - (at(&p, u, v) * at(&q, u, v)).powi(3)).abs() < 1e-12);
        }
        let b = p.bernstein();
        assert_eq!(Scaled::new([2, 1], b.into_iter()), p);
    }
}
