//! Polynomials in three variables as tensor products, in powers of coordinates that run from −1 to 1.
//!
//! Powers of centred coordinates keep the conversion from Bernstein form accurate. At degree 10, the largest coefficient of a basis
//! function is below 3; with coordinates from 0 to 1 it would reach 10⁴.

use super::local::{Lane, Local, WIDTH};
use super::poly::Poly3;
use glam::{DMat4, DVec3};
use pathwarp::map::Real;
use pulp::{Arch, Simd, WithSimd};

/// C polynomials of the same degrees: Σ cᵢⱼₖ·xⁱyʲzᵏ.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tensor<const C: usize> {
    /// Numbers of powers along x, y and z.
    size: [usize; 3],
    /// The coefficients, with x running fastest.
    c: Vec<[f64; C]>,
}

impl<const C: usize> Tensor<C> {
    /// Converts Bernstein coefficients over [−1, 1]³, with x running fastest. The degrees are `size` − 1.
    pub(crate) fn bernstein(size: [usize; 3], mut c: Vec<[f64; C]>) -> Self {
        let strides = [1, size[0], size[0] * size[1]];
        for (n, stride) in size.iter().zip(strides) {
            let matrix = power_matrix(n - 1);
            let starts = (0..c.len()).filter(|s| (s / stride) % n == 0);
            for start in starts {
                let column: Vec<[f64; C]> = (0..*n).map(|i| c[start + i * stride]).collect();
                for (p, row) in matrix.iter().enumerate() {
                    c[start + p * stride] =
                        std::array::from_fn(|k| row.iter().zip(&column).map(|(m, v)| m * v[k]).sum());
                }
            }
        }
        Self { size, c }
    }

    /// Drops powers of x above `degree`, whose coefficients are rounding errors, from all polynomials after the first `from`.
    pub(crate) fn without(mut self, degree: usize, from: usize) -> Self {
        let n = self.size[0];
        let over = self.c.iter_mut().enumerate().filter(|(i, _)| i % n > degree);
        over.for_each(|(_, c)| c[from..].fill(0.0));
        self
    }

    /// Iterates over the terms, as powers and coefficients.
    pub(crate) fn terms(&self) -> impl Iterator<Item = ([usize; 3], &[f64; C])> {
        let [nx, ny, _] = self.size;
        self.c.iter().enumerate().map(move |(n, c)| ([n % nx, (n / nx) % ny, n / (nx * ny)], c))
    }

    /// Returns the degrees along x, y and z.
    pub(crate) fn degrees(&self) -> [usize; 3] {
        self.size.map(|n| n - 1)
    }

    /// Returns the largest sum of powers whose coefficient is not 0.
    pub(crate) fn total_degree(&self) -> usize {
        let used = self.terms().filter(|(_, c)| c.iter().any(|v| *v != 0.0));
        used.map(|(powers, _)| powers.iter().sum()).max().unwrap_or(0)
    }

    /// Substitutes polynomials for the variables.
    pub(crate) fn in_terms_of(&self, t: &[Poly3; 3]) -> [Poly3; C] {
        let powers = [0, 1, 2].map(|a| t[a].powers(self.size[a] - 1));
        let mut out = std::array::from_fn(|_| Poly3::default());
        for ([i, j, k], c) in self.terms() {
            let product = powers[0][i].times(&powers[1][j]).times(&powers[2][k]);
            for (o, c) in out.iter_mut().zip(c) {
                o.add(*c, &product);
            }
        }
        out
    }

    /// Returns the values of the polynomials, for any kind of number.
    pub(crate) fn value<S: Real>(&self, t: [S; 3]) -> [S; C] {
        let [nx, ny, _] = self.size;
        // A step of Horner's rule; the first one takes its coefficient as it is.
        let plus = |a: Option<[S; C]>, t: S, b: [S; C]| match a {
            Some(a) => Some(std::array::from_fn(|k| a[k] * t + b[k])),
            None => Some(b),
        };
        let mut z = None;
        for layer in self.c.chunks(nx * ny).rev() {
            let mut y = None;
            for row in layer.chunks(nx).rev() {
                let mut x = None;
                for c in row.iter().rev() {
                    x = plus(x, t[0], c.map(S::from));
                }
                y = plus(y, t[1], x.unwrap_or([S::from(0.0); C]));
            }
            z = plus(z, t[2], y.unwrap_or([S::from(0.0); C]));
        }
        z.unwrap_or([S::from(0.0); C])
    }

    /// Returns the values and their partial derivatives, as (value, ∂/∂x, ∂/∂y, ∂/∂z) of each polynomial.
    pub(crate) fn jet(&self, t: DVec3) -> [[f64; 4]; C] {
        let [nx, ny, _] = self.size;
        let mut z = [[0.0; 4]; C];
        for layer in self.c.chunks(nx * ny).rev() {
            let mut y = [[0.0; 3]; C];
            for row in layer.chunks(nx).rev() {
                let mut x = [[0.0; 2]; C];
                for c in row.iter().rev() {
                    x = std::array::from_fn(|k| [x[k][0] * t.x + c[k], x[k][1] * t.x + x[k][0]]);
                }
                y = std::array::from_fn(|k| {
                    [y[k][0] * t.y + x[k][0], y[k][1] * t.y + x[k][1], y[k][2] * t.y + y[k][0]]
                });
            }
            z = std::array::from_fn(|k| {
                let ([v, dx, dy, dz], [a, ax, ay]) = (z[k], y[k]);
                [v * t.z + a, dx * t.z + ax, dy * t.z + ay, dz * t.z + v]
            });
        }
        z
    }

    /// Returns the values at a batch of points. Common sizes are compiled separately, with all loops unrolled.
    #[inline(always)]
    pub(crate) fn lanes(&self, t: &[Lane; 3]) -> [Lane; C] {
        match self.size {
            [4, 4, 4] => self.horner([4; 3], t),
            [3, 3, 3] => self.horner([3; 3], t),
            [2, 2, 2] => self.horner([2; 3], t),
            [4, 2, 2] => self.horner([4, 2, 2], t),
            [3, 2, 2] => self.horner([3, 2, 2], t),
            [4, 1, 1] => self.horner([4, 1, 1], t),
            [3, 1, 1] => self.horner([3, 1, 1], t),
            [2, 1, 1] => self.horner([2, 1, 1], t),
            size => self.horner(size, t),
        }
    }

    #[inline(always)]
    fn horner(&self, [nx, ny, nz]: [usize; 3], t: &[Lane; 3]) -> [Lane; C] {
        let c = &self.c[..nx * ny * nz];
        let mut out = [[0.0; WIDTH]; C];
        for (k, out) in out.iter_mut().enumerate() {
            for layer in (0..nz).rev() {
                let mut y = [0.0; WIDTH];
                for row in (0..ny).rev() {
                    let first = (layer * ny + row) * nx;
                    let mut x = [c[first + nx - 1][k]; WIDTH];
                    for i in (0..nx - 1).rev() {
                        times_plus(&mut x, &t[0], &[c[first + i][k]; WIDTH]);
                    }
                    times_plus(&mut y, &t[1], &x);
                }
                times_plus(out, &t[2], &y);
            }
        }
        out
    }
}

/// Computes a·t + b in place.
#[inline(always)]
fn times_plus(a: &mut Lane, t: &Lane, b: &Lane) {
    for ((a, t), b) in a.iter_mut().zip(t).zip(b) {
        *a = *a * t + b;
    }
}

/// Returns the matrix from Bernstein coefficients over [−1, 1] to powers: row p holds the coefficients of tᵖ in
/// C(n,i)·(1+t)ⁱ(1−t)ⁿ⁻ⁱ/2ⁿ.
fn power_matrix(n: usize) -> Vec<Vec<f64>> {
    let mut out = vec![vec![0.0; n + 1]; n + 1];
    let mut binomial = 1.0;
    for i in 0..=n {
        let mut p = vec![binomial / 2f64.powi(i32::try_from(n).unwrap_or(0))];
        for factor in 0..n {
            let sign = if factor < i { 1.0 } else { -1.0 };
            let mut next = vec![0.0; p.len() + 1];
            for (k, v) in p.iter().enumerate() {
                next[k] += v;
                next[k + 1] += sign * v;
            }
            p = next;
        }
        for (row, v) in out.iter_mut().zip(&p) {
            row[i] = *v;
        }
        binomial *= (n - i) as f64 / (i + 1) as f64;
    }
    out
}

/// A computation on points for the processor's vector units, which are chosen at run time. Products and sums are never fused, so that
/// results are equal on all of them, to the last bit.
pub(crate) trait Kernel {
    /// Replaces a batch of points by their images.
    fn lanes(&self, p: &mut [Lane; 3]);
}

struct Run<'a, K> {
    kernel: &'a K,
    ps: &'a mut [DVec3],
}

impl<K: Kernel> WithSimd for Run<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut chunks = self.ps.chunks_exact_mut(WIDTH);
        for chunk in &mut chunks {
            run(self.kernel, chunk);
        }
        let rest = chunks.into_remainder();
        if let Some(last) = rest.last().copied() {
            let mut padded = [last; WIDTH];
            padded[..rest.len()].copy_from_slice(rest);
            run(self.kernel, &mut padded);
            rest.copy_from_slice(&padded[..rest.len()]);
        }
    }
}

#[inline(always)]
fn run<K: Kernel>(kernel: &K, chunk: &mut [DVec3]) {
    let mut p = [[0.0; WIDTH]; 3];
    for (i, q) in chunk.iter().enumerate().take(WIDTH) {
        (p[0][i], p[1][i], p[2][i]) = (q.x, q.y, q.z);
    }
    kernel.lanes(&mut p);
    for (i, q) in chunk.iter_mut().enumerate().take(WIDTH) {
        *q = DVec3::new(p[0][i], p[1][i], p[2][i]);
    }
}

/// Runs a kernel on points.
pub(crate) fn for_all<K: Kernel>(kernel: &K, ps: &mut [DVec3]) {
    Arch::new().dispatch(Run { kernel, ps });
}

/// Replaces points by their images under a matrix on (x, y, z, 1).
pub(crate) fn collineation(matrix: &DMat4, ps: &mut [DVec3]) {
    for_all(&Matrix(matrix.transpose().to_cols_array_2d()), ps);
}

/// A matrix by rows.
struct Matrix([[f64; 4]; 4]);

impl Kernel for Matrix {
    #[inline(always)]
    fn lanes(&self, p: &mut [Lane; 3]) {
        for i in 0..WIDTH {
            let [x, y, z] = [p[0][i], p[1][i], p[2][i]];
            let row = |r: &[f64; 4]| r[0] * x + r[1] * y + r[2] * z + r[3];
            let w = row(&self.0[3]);
            for (lane, r) in p.iter_mut().zip(&self.0) {
                lane[i] = row(r) / w;
            }
        }
    }
}

/// Displaces by a tensor product: p + D(t).
pub(crate) struct Displaced<'a> {
    pub(crate) local: Local,
    pub(crate) tensor: &'a Tensor<3>,
}

impl Kernel for Displaced<'_> {
    #[inline(always)]
    fn lanes(&self, p: &mut [Lane; 3]) {
        let d = self.tensor.lanes(&self.local.lanes(p));
        for (lane, d) in p.iter_mut().zip(&d) {
            for (v, d) in lane.iter_mut().zip(d) {
                *v += d;
            }
        }
    }
}

/// Divides tensor products: N(t)/W(t).
pub(crate) struct Quotient<'a> {
    pub(crate) local: Local,
    pub(crate) tensor: &'a Tensor<4>,
}

impl Kernel for Quotient<'_> {
    #[inline(always)]
    fn lanes(&self, p: &mut [Lane; 3]) {
        let n = self.tensor.lanes(&self.local.lanes(p));
        for (lane, n_k) in p.iter_mut().zip(&n) {
            for ((v, n), w) in lane.iter_mut().zip(n_k).zip(&n[3]) {
                *v = n / w;
            }
        }
    }
}

/// Dilates about a point by a tensor product: O + (p − O)/δ(t).
pub(crate) struct Radial<'a> {
    pub(crate) local: Local,
    pub(crate) eye: DVec3,
    pub(crate) tensor: &'a Tensor<1>,
}

impl Kernel for Radial<'_> {
    #[inline(always)]
    fn lanes(&self, p: &mut [Lane; 3]) {
        let [delta] = self.tensor.lanes(&self.local.lanes(p));
        for (lane, o) in p.iter_mut().zip(self.eye.to_array()) {
            for (v, d) in lane.iter_mut().zip(&delta) {
                *v = o + (*v - o) / d;
            }
        }
    }
}

/// Sweeps along curves: C(u) + v·S(u) + w·T(u), where u, v and w are the coordinates from `axis` on in cyclic order.
pub(crate) struct Swept<'a> {
    pub(crate) axis: usize,
    pub(crate) local: Local,
    /// C, S and T along x.
    pub(crate) tensor: &'a Tensor<9>,
}

impl Kernel for Swept<'_> {
    #[inline(always)]
    fn lanes(&self, p: &mut [Lane; 3]) {
        let t = self.local.lanes(p);
        let curves = self.tensor.lanes(&[t[self.axis], [0.0; WIDTH], [0.0; WIDTH]]);
        let (v, w) = (t[(self.axis + 1) % 3], t[(self.axis + 2) % 3]);
        for (k, lane) in p.iter_mut().enumerate() {
            for (i, o) in lane.iter_mut().enumerate() {
                *o = curves[k][i] + v[i] * curves[k + 3][i] + w[i] * curves[k + 6][i];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::check::{Counted, operations};

    /// Returns `rest`·p + t·q, where `rest` is 1 − t, and counts the operations.
    fn step(p: [Counted; 3], q: [Counted; 3], t: Counted, rest: Counted) -> [Counted; 3] {
        std::array::from_fn(|k| p[k] * rest + q[k] * t)
    }

    /// Counts the operations of the lattice in table 1 of the skeleton paper, which has degree n along the curve and 1 across, as the
    /// skeleton with its two handles has. A trilinear point in each of its n cells takes seven linear steps, of six products each. De
    /// Casteljau's algorithm on the n points takes n(n − 1)/2 more. That is 6·(7n + n(n − 1)/2) products and half as many sums: the table's
    /// 42, 90 and 144. Our form takes a product and a sum for each coefficient but one. The paper does not state how it counts.
    #[test]
    fn operations_of_the_lattice_beside_a_skeleton() {
        for (n, published) in [(1, 42), (2, 90), (3, 144)] {
            // u runs fastest, then v and w.
            let c: Vec<[f64; 3]> = (0..4 * (n + 1)).map(|i| [i as f64, ((7 * i) % 5) as f64, (i * i) as f64]).collect();
            let row = |k: usize| (0..=n).map(|i| c[k * (n + 1) + i].map(Counted)).collect::<Vec<_>>();
            let rows: [_; 4] = std::array::from_fn(row);
            let [u, v, w] = [0.3, 0.6, 0.8].map(|t| (Counted(t), Counted(1.0 - t)));
            let mut at = [Counted(0.0); 3];
            let counts = operations(|| {
                let cell = |i: usize| {
                    let along = |k: usize| step(rows[k][i], rows[k][i + 1], u.0, u.1);
                    let [back, front] = [0, 2].map(|k| step(along(k), along(k + 1), v.0, v.1));
                    step(back, front, w.0, w.1)
                };
                let mut points: Vec<_> = (0..n).map(cell).collect();
                while points.len() > 1 {
                    points = points.windows(2).map(|p| step(p[0], p[1], u.0, u.1)).collect();
                }
                at = points[0];
            });
            assert_eq!(counts, [published, published / 2, 0], "degree {n}");
            let tensor = Tensor::bernstein([n + 1, 2, 2], c.clone());
            let mut own = [Counted(0.0); 3];
            let ours = operations(|| own = tensor.value([u, v, w].map(|t| Counted(2.0 * t.0.0 - 1.0))));
            assert_eq!(ours, [12 * n + 9, 12 * n + 9, 0], "degree {n}");
            assert!((0..3).all(|k| (own[k].0 - at[k].0).abs() < 1e-13), "degree {n}");
        }
    }

    /// Counts the operations of a lattice of degree n along all three axes, by de Casteljau's algorithm along each axis in turn.
    #[test]
    fn operations_of_a_full_lattice() {
        for (n, algorithm) in [(1, 42), (2, 234), (3, 756)] {
            let c: Vec<[f64; 3]> = (0..(n + 1) * (n + 1) * (n + 1)).map(|i| [i as f64, 1.0, 2.0]).collect();
            let counts = operations(|| {
                let (t, rest) = (Counted(0.3), Counted(0.7));
                let bezier = |mut row: Vec<[Counted; 3]>| {
                    while row.len() > 1 {
                        row = row.windows(2).map(|p| step(p[0], p[1], t, rest)).collect();
                    }
                    row[0]
                };
                let all: Vec<[Counted; 3]> = c.iter().map(|p| p.map(Counted)).collect();
                let rows: Vec<_> = all.chunks(n + 1).map(|r| bezier(r.to_vec())).collect();
                let layers: Vec<_> = rows.chunks(n + 1).map(|r| bezier(r.to_vec())).collect();
                bezier(layers);
            });
            assert_eq!(counts, [algorithm, algorithm / 2, 0], "degree {n}");
            let tensor = Tensor::bernstein([n + 1; 3], c);
            let ours = operations(|| {
                tensor.value([0.3, 0.4, 0.5].map(Counted));
            });
            let each = 3 * ((n + 1).pow(3) - 1);
            assert_eq!(ours, [each, each, 0], "degree {n}");
        }
    }

    /// Compares with the definition Σ Bᵢ(s)Bⱼ(t)Bₖ(u), by de Casteljau's algorithm.
    #[test]
    fn values_and_derivatives_are_those_of_the_bernstein_form() {
        for size in [[2, 2, 2], [3, 3, 3], [4, 4, 4], [1, 4, 2], [11, 2, 5]] {
            let count = size.iter().product::<usize>();
            let c: Vec<[f64; 2]> =
                (0..count).map(|i| [((i * 37 + 11) % 17) as f64 - 8.0, ((i * 5) % 13) as f64]).collect();
            let tensor = Tensor::bernstein(size, c.clone());
            let slow = |t: DVec3| -> [f64; 2] {
                let bezier = |c: &[[f64; 2]], t: f64| {
                    let (mut row, s) = (c.to_vec(), 0.5 * (t + 1.0));
                    for n in (1..row.len()).rev() {
                        for i in 0..n {
                            row[i] = [0, 1].map(|k| row[i][k] + s * (row[i + 1][k] - row[i][k]));
                        }
                    }
                    row[0]
                };
                let rows: Vec<_> = c.chunks(size[0]).map(|r| bezier(r, t.x)).collect();
                let layers: Vec<_> = rows.chunks(size[1]).map(|r| bezier(r, t.y)).collect();
                bezier(&layers, t.z)
            };
            for t in [DVec3::new(0.3, -0.7, 0.1), DVec3::new(-1.0, 1.0, 0.9), DVec3::ZERO] {
                let (v, j, truth) = (tensor.value(t.to_array()), tensor.jet(t), slow(t));
                let lanes = tensor.lanes(&t.to_array().map(|v| [v; WIDTH]));
                for k in 0..2 {
                    assert!((v[k] - truth[k]).abs() < 1e-12, "{size:?} {t}: {v:?} {truth:?}");
                    assert_eq!((v[k], v[k]), (j[k][0], lanes[k][5]));
                    const H: f64 = 1e-5;
                    for (axis, e) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
                        let slope = (slow(t + e * H)[k] - slow(t - e * H)[k]) / (2.0 * H);
                        assert!((slope - j[k][axis + 1]).abs() < 1e-6, "{size:?} {t} {axis}");
                    }
                }
            }
        }
    }
}
