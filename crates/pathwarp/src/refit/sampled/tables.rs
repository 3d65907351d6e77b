//! What the proofs from samples know beforehand: bases, and what turns samples into coefficients. Worked out once.

use super::super::samples::{CHECKED, FITTED, UNIT};
use super::super::source::Lane;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Half of the further samples of the longer proof, in seventeenths; the others mirror them. With the sixteen even ones they have
/// nearly the largest determinant in the basis that sixteen more can have.
const EXTRA: [[f64; 4]; 2] = [[0.15, 0.35, 0.62, 1.4], [2.4, 3.44, 4.54, 7.47]];
/// Coefficients of L on the fine grid, of either parity.
pub(super) const FINE: usize = 3;
/// Degree of V, and with thirty-two samples of denominators of degree eight and more, where that lets φ have one more.
pub(super) const V: usize = 4;
pub(super) const LESS: usize = 2;
/// Free coefficients of φ at most, and all but the one of τ.
pub(super) const FREE: usize = 8;
const PHI: usize = FREE + 2;

/// Samples in a batch are mirror images: the i-th and the (7−i)-th.
pub(super) struct Expansion<const H: usize> {
    /// Row i: what the sum (the difference) of the i-th sample and its mirror image contributes to the coefficients 0, 2, 4…
    /// (1, 3, 5…).
    pub(super) even: [[f64; H]; H],
    pub(super) odd: [[f64; H]; H],
    /// How much the first k+1 coefficients together change at most if no sample changes by more than one.
    pub(super) noise: [[f64; 2]; H],
}

pub(super) struct Tables {
    /// τ, v and u of the batches.
    pub(super) places: [[Lane; 3]; 4],
    pub(super) few: Expansion<8>,
    pub(super) many: Expansion<16>,
    /// Basis functions 0, 2, 4 and 1, 3, 5 in the left half of the fine grid.
    pub(super) fine: [[[f64; 16]; FINE]; 2],
    /// v(1−τ), vτ, and v² times the polynomials that are orthonormal under v⁴ at the sixteen samples, in the batches.
    pub(super) phi: [[Lane; 4]; PHI],
    /// Their products with each other and with τ, summed over the sixteen samples.
    pub(super) products: [[f64; 3]; FREE],
    /// Their Bernstein coefficients, and those of τ.
    pub(super) bernstein: [[f64; 12]; PHI],
    pub(super) line: [f64; 12],
    /// Rows: the power coefficients of V from the values at the sixteen samples; and of one of degree two.
    pub(super) inverse: [[[Lane; 2]; V + 1]; 2],
}

impl Tables {
    pub(super) fn shared() -> &'static Self {
        static TABLES: OnceLock<Box<Tables>> = OnceLock::new();
        TABLES.get_or_init(|| Box::new(Self::new()))
    }

    fn new() -> Self {
        let mirrored = |h: [f64; 4]| -> Lane { std::array::from_fn(|i| if i < 4 { h[i] } else { 17.0 - h[7 - i] }) };
        let sets = [FITTED, CHECKED, mirrored(EXTRA[0]), mirrored(EXTRA[1])];
        let places = sets.map(|s| {
            let tau = s.map(|j| j * UNIT);
            [tau, tau.map(|t| t * (1.0 - t)), tau.map(|t| 2.0 * t - 1.0)]
        });
        let basis = Basis::new();
        let half = std::array::from_fn(|i| basis.at(places[i / 4][0][i % 4]));
        let mut grid = (2..26).filter(|j| j % 3 != 0).map(|j| f64::from(j) / 51.0);
        let grid: [_; 16] = std::array::from_fn(|_| basis.at(grid.next().unwrap_or(0.5)));
        let (phi, products, bernstein) = phi_tables(&places);
        let power = |u: f64| -> [f64; V + 1] { std::array::from_fn(|k| u.powi(k as i32)) };
        let rows: [[f64; V + 1]; 16] = std::array::from_fn(|i| power(places[i / 8][2][i % 8]));
        let inverse = [V, LESS].map(|degree| {
            let gram = inverse(std::array::from_fn::<[f64; V + 1], { V + 1 }, _>(|r| {
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
            few: Expansion::new(&half),
            many: Expansion::new(&half),
            fine: std::array::from_fn(|odd| std::array::from_fn(|k| grid.map(|b| b[2 * k + odd]))),
            phi,
            products,
            bernstein,
            line: std::array::from_fn(|j| j as f64 / 11.0),
            inverse,
        }
    }
}

/// See [`Tables`].
type PhiTables = ([[Lane; 4]; PHI], [[f64; 3]; FREE], [[f64; 12]; PHI]);

fn phi_tables(places: &[[Lane; 3]; 4]) -> PhiTables {
    let tau = |i: usize| places[i / 8][0][i % 8];
    let v = |t: f64| t * (1.0 - t);
    // Values at the samples first, then where the Bernstein coefficients are found from.
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
        // Twice, as rounding spoils the first time.
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

/// The functions Bₖ: what each is divided by.
pub(super) struct Basis(pub(super) [f64; Basis::MOST]);

impl Basis {
    /// As many as there are samples at most.
    pub(super) const MOST: usize = 32;

    fn new() -> Self {
        /// Nodes; a polynomial of degree n exceeds its largest value there by 1/cos(πn/2N) at most.
        const N: usize = 512;
        let mut largest = [0.0f64; Self::MOST];
        for i in 0..N / 2 {
            let at = Self([1.0; Self::MOST]).at(0.5 + 0.5 * (PI * (i as f64 + 0.5) / N as f64).cos());
            for (l, v) in largest.iter_mut().zip(at) {
                *l = l.max(v.abs());
            }
        }
        Self(std::array::from_fn(|k| largest[k] / (PI * (k + 4) as f64 / (2 * N) as f64).cos()))
    }

    /// Their values.
    pub(super) fn at(&self, tau: f64) -> [f64; Self::MOST] {
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

impl<const H: usize> Expansion<H> {
    /// From the values of the basis at the first halves of the batches.
    fn new(basis: &[[f64; Basis::MOST]; 16]) -> Self {
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
fn inverse<const N: usize>(mut a: [[f64; N]; N]) -> [[f64; N]; N] {
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
