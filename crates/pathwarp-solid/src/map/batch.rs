//! Batches of points on the processor's vector units, chosen at run time.
//!
//! The arithmetic is the same on all of them, to the last bit: products and sums are never fused.

use super::lane::{Lane, WIDTH};
use super::local::Local;
use super::tensor::Tensor;
use glam::{DMat4, DVec3};
use pulp::{Arch, Simd, WithSimd};

/// Work on points that the compiler turns into vector instructions.
pub(crate) trait Kernel {
    /// Replaces a batch of coordinates by those of the images.
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

/// Displacements by a tensor product: p + D(t).
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

/// A quotient of tensor products: N(t)/W(t).
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

/// A dilation about a point by a tensor product: O + (p − O)/δ(t).
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

/// Three curves at a coordinate, C(u) + v·S(u) + w·T(u), where u, v and w are the coordinates from `axis` on in cyclic order.
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
