//! Polynomials on [0, 1] given by their values at N Chebyshev nodes: tables, and bounds between the nodes.

use crate::sample::fma;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Number of samples with foot points, at j/17.
pub(crate) const FEET: usize = 16;

/// Coefficients are computed in fours, even and odd ones apart: the largest number of fours of one parity.
const MOST_QUARTERS: usize = 6;

/// Tables for all proofs with N nodes and P coefficients of p; see [`super::nodes`].
pub(crate) struct ChebyshevTables<const N: usize, const P: usize> {
    /// The nodes on [0, 1].
    pub(crate) tau: [f64; N],
    /// The Chebyshev polynomials of degree less than P at the nodes.
    pub(crate) t: [[f64; N]; P],
    /// Row k: contributions of the value at node k to the coefficients 0, 2, 4…, and 1, 3, 5…
    even: [[f64; N]; N],
    odd: [[f64; N]; N],
    /// 1 / cos(πd/2N).
    stretch: [f64; N],
    /// Row i: contributions of the foot point of sample i to the coefficients of p (P of the eight), by least squares.
    pub(crate) feet: [[f64; 8]; FEET],
}

/// Tables that exist once per process.
pub(crate) trait SharedTables: Sized + 'static {
    /// Returns the tables, computing them on first use.
    fn shared() -> &'static Self;
}

macro_rules! shared {
    ($($n:literal, $p:literal;)*) => {$(
        impl SharedTables for ChebyshevTables<$n, $p> {
            fn shared() -> &'static Self {
                static TABLES: OnceLock<Box<ChebyshevTables<$n, $p>>> = OnceLock::new();
                TABLES.get_or_init(|| Box::new(ChebyshevTables::new()))
            }
        }
    )*};
}

shared! {
    24, 5;
    24, 4;
    40, 5;
    48, 8;
}

impl<const N: usize, const P: usize> ChebyshevTables<N, P> {
    fn new() -> Self {
        let angle = |k: usize| PI * (k as f64 + 0.5) / N as f64;
        let part = |k: usize, d: usize| (if d == 0 { 1.0 } else { 2.0 }) / N as f64 * (d as f64 * angle(k)).cos();
        Self {
            tau: std::array::from_fn(|k| 0.5 + 0.5 * angle(k).cos()),
            t: std::array::from_fn(|j| std::array::from_fn(|k| (j as f64 * angle(k)).cos())),
            even: std::array::from_fn(|k| std::array::from_fn(|i| part(k, 2 * i))),
            odd: std::array::from_fn(|k| std::array::from_fn(|i| part(k, 2 * i + 1))),
            stretch: std::array::from_fn(|d| 1.0 / (PI * d as f64 / (2 * N) as f64).cos()),
            feet: least_squares::<P>().map(|row| std::array::from_fn(|k| if k < P { row[k] } else { 0.0 })),
        }
    }

    /// The first V Chebyshev coefficients of the function with these values.
    pub(crate) fn first<const V: usize>(&self, f: &[f64; N]) -> [f64; V] {
        let mut out = [0.0; V];
        for k in 0..N {
            for d in 0..V {
                out[d] += (if d % 2 == 0 { self.even[k][d / 2] } else { self.odd[k][d / 2] }) * f[k];
            }
        }
        out
    }

    /// A bound for a polynomial of the given degree whose values at the nodes are at most `most` in size.
    pub(crate) fn between_nodes(&self, most: f64, degree: usize) -> f64 {
        most * self.stretch[degree]
    }

    /// A bound for the length of the vector polynomial with these values at the nodes, of which `most` is the longest: the
    /// least, over d, of the theorem's bound for the part up to degree d plus the sum of the coefficients beyond.
    pub(crate) fn supremum(&self, x: &[f64; N], y: &[f64; N], most: f64, degree: usize) -> f64 {
        // Even and odd coefficients of x and y. The values at a node and at its mirror image contribute equally to the even
        // ones and oppositely to the odd ones.
        let mut c = [[[0.0; 4]; 4]; MOST_QUARTERS];
        let quarters = N / 8;
        for k in 0..N / 2 {
            let m = N - 1 - k;
            let f = [x[k] + x[m], y[k] + y[m], x[k] - x[m], y[k] - y[m]];
            let (even, odd) = (&self.even[k], &self.odd[k]);
            for q in 0..quarters {
                for i in 0..4 {
                    let (e, o) = (even[4 * q + i], odd[4 * q + i]);
                    c[q][0][i] = fma(e, f[0], c[q][0][i]);
                    c[q][1][i] = fma(e, f[1], c[q][1][i]);
                    c[q][2][i] = fma(o, f[2], c[q][2][i]);
                    c[q][3][i] = fma(o, f[3], c[q][3][i]);
                }
            }
        }
        let mut size = [0.0; N];
        for q in 0..quarters {
            let (mut even, mut odd) = ([0.0; 4], [0.0; 4]);
            for i in 0..4 {
                even[i] = fma(c[q][0][i], c[q][0][i], c[q][1][i] * c[q][1][i]).sqrt();
                odd[i] = fma(c[q][2][i], c[q][2][i], c[q][3][i] * c[q][3][i]).sqrt();
            }
            for i in 0..4 {
                size[8 * q + 2 * i] = even[i];
                size[8 * q + 2 * i + 1] = odd[i];
            }
        }
        let mut tail = 0.0;
        let mut best = f64::INFINITY;
        for d in (0..=degree).rev() {
            let limit = (most + tail) * self.stretch[d] + tail;
            if limit < best {
                best = limit;
            }
            // Coefficient d joins the tail. Once the tail alone exceeds the best bound, smaller d cannot help.
            tail += size[d];
            if tail > best {
                break;
            }
        }
        best
    }

    /// A lower bound for a polynomial of the given degree from its values at the nodes, by an upper bound for its distance
    /// from their midrange.
    pub(crate) fn least(&self, f: &[f64; N], degree: usize) -> f64 {
        let lo = f.iter().copied().fold(f64::INFINITY, f64::min);
        let hi = f.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mid = 0.5 * (lo + hi);
        mid - self.supremum(&f.map(|v| v - mid), &[0.0; N], hi - mid, degree)
    }
}

/// Rows of the pseudo-inverse of `A[i][j]` = τᵢ(1−τᵢ) times the j-th Chebyshev polynomial at 2τᵢ−1: normal equations by
/// Gauss–Jordan elimination, well conditioned for sixteen samples and degree seven.
fn least_squares<const P: usize>() -> [[f64; P]; FEET] {
    let a: [[f64; P]; FEET] = std::array::from_fn(|i| {
        let tau = SAMPLES[i];
        let u: f64 = 2.0 * tau - 1.0;
        std::array::from_fn(|j| tau * (1.0 - tau) * (j as f64 * u.acos()).cos())
    });
    let mut m: [Vec<f64>; P] = std::array::from_fn(|r| {
        let square = (0..P).map(|c| (0..FEET).map(|i| a[i][r] * a[i][c]).sum());
        square.chain(a.iter().map(|row| row[r])).collect()
    });
    for c in 0..P {
        let pivot = m[c][c];
        for v in &mut m[c] {
            *v /= pivot;
        }
        let base = m[c].clone();
        for (r, row) in m.iter_mut().enumerate() {
            if r != c {
                let f = row[c];
                for (v, b) in row.iter_mut().zip(&base) {
                    *v -= f * b;
                }
            }
        }
    }
    std::array::from_fn(|i| std::array::from_fn(|k| m[k][P + i]))
}

/// Places of the samples with foot points.
pub(crate) const SAMPLES: [f64; FEET] = {
    let mut out = [0.0; FEET];
    let mut i = 0;
    while i < FEET {
        out[i] = (i as f64 + 1.0) / (FEET as f64 + 1.0);
        i += 1;
    }
    out
};

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Vec2;

    fn the_bound_holds_with<const N: usize, const P: usize>(worst: f64)
    where
        ChebyshevTables<N, P>: SharedTables,
    {
        // A polynomial of degree 9, whose maximum is found by sampling.
        let f = |t: f64| {
            let u = 2.0 * t - 1.0;
            let v = (9.0 * u.acos()).cos() * 0.01 + (4.0 * u.acos()).cos() + 0.3 * u;
            Vec2::new(v, 0.5 * v)
        };
        let t = ChebyshevTables::<N, P>::shared();
        let (x, y) = (t.tau.map(|t| f(t).x), t.tau.map(|t| f(t).y));
        let most = (0..N).map(|k| x[k].hypot(y[k])).fold(0.0, f64::max);
        let truth = (0..=10_000).map(|i| f(f64::from(i) / 10_000.0).hypot()).fold(0.0, f64::max);
        let b = t.supremum(&x, &y, most, N - 1);
        assert!(b >= truth && b < worst * truth, "{N}: {b} {truth}");
    }

    #[test]
    fn the_bound_holds_and_is_not_far_off() {
        the_bound_holds_with::<48, 8>(1.06);
        the_bound_holds_with::<40, 5>(1.1);
        the_bound_holds_with::<24, 5>(1.13);
        the_bound_holds_with::<24, 4>(1.13);
    }

    #[test]
    fn phi_goes_through_feet_it_can_represent() {
        let rows: [[f64; 8]; FEET] = least_squares();
        let want = [0.1, -0.05, 0.02, 0.0, 0.003, 0.0, 0.0, -0.001];
        let lead: Vec<f64> = (0..FEET)
            .map(|i| {
                let tau = SAMPLES[i];
                let u: f64 = 2.0 * tau - 1.0;
                tau * (1.0 - tau) * (0..8).map(|j| want[j] * (j as f64 * u.acos()).cos()).sum::<f64>()
            })
            .collect();
        for k in 0..8 {
            let got: f64 = rows.iter().zip(&lead).map(|(r, f)| r[k] * f).sum();
            assert!((got - want[k]).abs() < 1e-12);
        }
    }
}
