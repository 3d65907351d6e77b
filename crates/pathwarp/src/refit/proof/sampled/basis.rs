//! The basis of the proofs from samples, and the matrices that turn samples into coefficients.

use std::f64::consts::PI;

/// Matrices from samples to coefficients. Batches hold mirror images: the i-th and the (7−i)-th sample.
pub(super) struct SampleExpansion<const H: usize> {
    /// Row i: contributions of the sum (`odd`: difference) of the i-th sample and its mirror image to the coefficients 0, 2, 4…
    /// (1, 3, 5…).
    pub(super) even: [[f64; H]; H],
    pub(super) odd: [[f64; H]; H],
    /// A bound for the change of the first k+1 coefficients together if no sample changes by more than one.
    pub(super) noise: [[f64; 2]; H],
}

/// The functions Bₖ: their divisors.
pub(super) struct GegenbauerBasis(pub(super) [f64; GegenbauerBasis::COUNT]);

impl GegenbauerBasis {
    /// One for each of thirty-two samples.
    pub(super) const COUNT: usize = 32;

    pub(super) fn new() -> Self {
        /// Nodes; a polynomial of degree n exceeds its largest value there by 1/cos(πn/2N) at most.
        const N: usize = 512;
        let mut largest = [0.0f64; Self::COUNT];
        for i in 0..N / 2 {
            let at = Self([1.0; Self::COUNT]).at(0.5 + 0.5 * (PI * (i as f64 + 0.5) / N as f64).cos());
            for (l, v) in largest.iter_mut().zip(at) {
                *l = l.max(v.abs());
            }
        }
        Self(std::array::from_fn(|k| largest[k] / (PI * (k + 4) as f64 / (2 * N) as f64).cos()))
    }

    /// Their values at `tau`.
    pub(super) fn at(&self, tau: f64) -> [f64; Self::COUNT] {
        let (u, v) = (2.0 * tau - 1.0, tau * (1.0 - tau));
        // Gegenbauer polynomials of index 4 (DLMF 18.9.1).
        let (mut last, mut c) = (0.0, 1.0);
        std::array::from_fn(|k| {
            let out = v * v * c / self.0[k];
            let n = k as f64;
            (last, c) = (c, (2.0 * (n + 4.0) * u * c - (n + 7.0) * last) / (n + 1.0));
            out
        })
    }
}

impl<const H: usize> SampleExpansion<H> {
    /// From the basis at the first halves of the batches.
    pub(super) fn new(basis: &[[f64; GegenbauerBasis::COUNT]; 16]) -> Self {
        // A sum of mirror images is twice the even part.
        let rows = |odd: usize| -> [[f64; H]; H] {
            inverse(std::array::from_fn(|i| std::array::from_fn(|k| 2.0 * basis[i][2 * k + odd])))
        };
        let (even, odd) = (rows(0), rows(1));
        let row = |m: &[[f64; H]; H], k: usize| 2.0 * m[k].iter().map(|v| v.abs()).sum::<f64>();
        let mut noise = [[0.0; 2]; H];
        let mut all = 0.0;
        for k in 0..H {
            let e = all + row(&even, k);
            all = e + row(&odd, k);
            noise[k] = [e, all];
        }
        let turned = |m: [[f64; H]; H]| std::array::from_fn(|i| std::array::from_fn(|k| m[k][i]));
        Self { even: turned(even), odd: turned(odd), noise }
    }
}

/// The inverse of a matrix, by Gauss–Jordan elimination with pivots.
pub(super) fn inverse<const N: usize>(mut a: [[f64; N]; N]) -> [[f64; N]; N] {
    let mut b: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    for c in 0..N {
        let pivot = (c..N).max_by(|i, j| a[*i][c].abs().total_cmp(&a[*j][c].abs())).unwrap_or(c);
        a.swap(c, pivot);
        b.swap(c, pivot);
        let k = 1.0 / a[c][c];
        a[c] = a[c].map(|v| v * k);
        b[c] = b[c].map(|v| v * k);
        for r in 0..N {
            if r != c {
                let f = a[r][c];
                for j in 0..N {
                    a[r][j] -= f * a[c][j];
                    b[r][j] -= f * b[c][j];
                }
            }
        }
    }
    b
}
