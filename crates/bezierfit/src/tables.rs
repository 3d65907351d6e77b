//! Tables of the proofs from samples, computed once per process: the basis, and the matrices that turn samples into coefficients.

use crate::sample::{CHECKED, FITTED, Lane, UNIT};
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Half of the further samples of the longer proof, in seventeenths; the others mirror them. Together with the sixteen even
/// ones, they have nearly the largest determinant in the basis that sixteen more can have.
const EXTRA: [[f64; 4]; 2] = [[0.15, 0.35, 0.62, 1.4], [2.4, 3.44, 4.54, 7.47]];
/// Coefficients of either parity of L on the fine grid.
pub(crate) const FINE: usize = 3;
/// Degree of V.
pub(crate) const CLEARING: usize = 4;
/// Lower degree of V, tried first with thirty-two samples and denominators of degree eight or more: φ may then be of higher
/// degree.
pub(crate) const CLEARING_LESS: usize = 2;
/// Largest number of free coefficients of φ, and of all but that of τ.
pub(crate) const FREE: usize = 8;
const PHI: usize = FREE + 2;

/// Tables of the proofs from samples.
pub(crate) struct SampleTables {
    /// τ, v and u of the batches.
    pub(crate) places: [[Lane; 3]; 4],
    pub(crate) few: SampleExpansion<8>,
    pub(crate) many: SampleExpansion<16>,
    /// Basis functions 0, 2, 4 and 1, 3, 5 in the left half of the fine grid.
    pub(crate) fine: [[[f64; 16]; FINE]; 2],
    /// v(1−τ), vτ, and v² times the polynomials that are orthonormal under v⁴ at the sixteen samples, in the batches.
    pub(crate) phi: [[Lane; 4]; PHI],
    /// Their products with each other and with τ, summed over the sixteen samples.
    pub(crate) products: [[f64; 3]; FREE],
    /// Their Bernstein coefficients of degree eleven, and those of τ.
    pub(crate) bernstein: [[f64; 12]; PHI],
    pub(crate) line: [f64; 12],
    /// Rows: the power coefficients of V from the values of 1/W at the sixteen samples, for degrees four and two.
    pub(crate) inverse: [[[Lane; 2]; CLEARING + 1]; 2],
}

impl SampleTables {
    pub(crate) fn shared() -> &'static Self {
        static TABLES: OnceLock<Box<SampleTables>> = OnceLock::new();
        TABLES.get_or_init(|| Box::new(Self::new()))
    }

    fn new() -> Self {
        let mirrored = |h: [f64; 4]| -> Lane { std::array::from_fn(|i| if i < 4 { h[i] } else { 17.0 - h[7 - i] }) };
        let sets = [FITTED, CHECKED, mirrored(EXTRA[0]), mirrored(EXTRA[1])];
        let places = sets.map(|s| {
            let tau = s.map(|j| j * UNIT);
            [tau, tau.map(|t| t * (1.0 - t)), tau.map(|t| 2.0 * t - 1.0)]
        });
        let basis = GegenbauerBasis::new();
        let half = std::array::from_fn(|i| basis.at(places[i / 4][0][i % 4]));
        let mut grid = (2..26).filter(|j| j % 3 != 0).map(|j| f64::from(j) / 51.0);
        let grid: [_; 16] = std::array::from_fn(|_| basis.at(grid.next().unwrap_or(0.5)));
        let (phi, products, bernstein) = phi_tables(&places);
        let power = |u: f64| -> [f64; CLEARING + 1] { std::array::from_fn(|k| u.powi(k as i32)) };
        let rows: [[f64; CLEARING + 1]; 16] = std::array::from_fn(|i| power(places[i / 8][2][i % 8]));
        let inverse = [CLEARING, CLEARING_LESS].map(|degree| {
            let gram = inverse(std::array::from_fn::<[f64; CLEARING + 1], { CLEARING + 1 }, _>(|r| {
                std::array::from_fn(|c| {
                    let dot: f64 = rows.iter().map(|p| p[r] * p[c]).sum();
                    let own = f64::from(u8::from(r == c));
                    if r.max(c) > degree { own } else { dot }
                })
            }));
            std::array::from_fn(|k| {
                let at = |i: usize| (0..=degree).map(|c| gram[k][c] * rows[i][c]).sum();
                std::array::from_fn(|b| std::array::from_fn(|i| if k > degree { 0.0 } else { at(8 * b + i) }))
            })
        });
        Self {
            places,
            few: SampleExpansion::new(&half),
            many: SampleExpansion::new(&half),
            fine: std::array::from_fn(|odd| std::array::from_fn(|k| grid.map(|b| b[2 * k + odd]))),
            phi,
            products,
            bernstein,
            line: std::array::from_fn(|j| j as f64 / 11.0),
            inverse,
        }
    }
}

/// See [`SampleTables`].
type PhiTables = ([[Lane; 4]; PHI], [[f64; 3]; FREE], [[f64; 12]; PHI]);

fn phi_tables(places: &[[Lane; 3]; 4]) -> PhiTables {
    let tau = |i: usize| places[i / 8][0][i % 8];
    let v = |t: f64| t * (1.0 - t);
    // Values at the samples, then at the nodes from which the Bernstein coefficients are interpolated.
    const AT: usize = 32 + 12;
    let at: [f64; AT] = std::array::from_fn(|i| if i < 32 { tau(i) } else { (i - 32) as f64 / 11.0 });
    let dot = |a: &[f64; AT], b: &[f64; AT]| -> f64 { (0..16).map(|i| a[i] * b[i]).sum() };
    let mut q = [[0.0; AT]; PHI];
    q[0] = at.map(|t| v(t) * (1.0 - t));
    q[1] = at.map(|t| v(t) * t);
    for k in 2..PHI {
        let last = q[k - 1];
        let mut next =
            if k == 2 { at.map(|t| v(t) * v(t)) } else { std::array::from_fn(|i| (2.0 * at[i] - 1.0) * last[i]) };
        // Gram–Schmidt, twice because of rounding.
        for _ in 0..2 {
            for base in &q[2..k] {
                let f = dot(&next, base);
                next = std::array::from_fn(|i| next[i] - f * base[i]);
            }
        }
        let size = dot(&next, &next).sqrt();
        q[k] = next.map(|v| v / size);
    }
    let choose = |j: usize| (0..j).fold(1.0, |c, i| c * (11 - i) as f64 / (i + 1) as f64);
    let collocation: [[f64; 12]; 12] = std::array::from_fn(|i| {
        let t = at[32 + i];
        std::array::from_fn(|j| choose(j) * t.powi(j as i32) * (1.0 - t).powi(11 - j as i32))
    });
    let solved = inverse(collocation);
    (
        q.map(|q| std::array::from_fn(|b| std::array::from_fn(|i| q[8 * b + i]))),
        std::array::from_fn(|k| [dot(&q[k + 2], &at), dot(&q[k + 2], &q[0]), dot(&q[k + 2], &q[1])]),
        q.map(|q| std::array::from_fn(|j| (0..12).map(|i| solved[j][i] * q[32 + i]).sum())),
    )
}

/// Matrices from samples to coefficients. Batches hold mirror images: the i-th and the (7−i)-th sample.
pub(crate) struct SampleExpansion<const H: usize> {
    /// Row i: contributions of the sum (`odd`: difference) of the i-th sample and its mirror image to the coefficients 0, 2, 4…
    /// (1, 3, 5…).
    pub(crate) even: [[f64; H]; H],
    pub(crate) odd: [[f64; H]; H],
    /// A bound for the change of the first k+1 coefficients together if no sample changes by more than one.
    pub(crate) noise: [[f64; 2]; H],
}

/// The functions Bₖ: their divisors.
pub(crate) struct GegenbauerBasis(pub(crate) [f64; GegenbauerBasis::COUNT]);

impl GegenbauerBasis {
    /// One for each of thirty-two samples.
    pub(crate) const COUNT: usize = 32;

    pub(crate) fn new() -> Self {
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
    pub(crate) fn at(&self, tau: f64) -> [f64; Self::COUNT] {
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
    pub(crate) fn new(basis: &[[f64; GegenbauerBasis::COUNT]; 16]) -> Self {
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
pub(crate) fn inverse<const N: usize>(mut a: [[f64; N]; N]) -> [[f64; N]; N] {
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
