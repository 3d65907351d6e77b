//! Affine transforms: usvg's in f64, comparison up to f32 rounding, and measures.

use pathwarp::kurbo::Affine;

/// Converts usvg's transform to f64.
pub(crate) fn affine(t: usvg::Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}

/// Returns `true` if `m` is finite and can be inverted.
pub(crate) fn is_invertible(m: Affine) -> bool {
    m.is_finite() && m.determinant() != 0.0 && m.inverse().is_finite()
}

/// Returns the largest factor by which `m` stretches a length: the larger singular value.
pub(crate) fn stretch(m: Affine) -> f64 {
    let [a, b, c, d, ..] = m.as_coeffs();
    let (s, t) = ((a + d).hypot(b - c), (a - d).hypot(b + c));
    (s + t) / 2.0
}

/// Returns `true` if the transforms agree up to f32 rounding of a short product.
pub(crate) fn is_near(a: Affine, b: Affine) -> bool {
    let (a, b) = (a.as_coeffs(), b.as_coeffs());
    let linear = a[..4].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let shift = a[4].abs().max(a[5].abs()).max(linear);
    (0..4).all(|i| (a[i] - b[i]).abs() <= 1e-6 * linear) && (4..6).all(|i| (a[i] - b[i]).abs() <= 1e-6 * shift)
}

/// Removes the translation.
pub(crate) fn linear_part(m: Affine) -> Affine {
    let [a, b, c, d, ..] = m.as_coeffs();
    Affine::new([a, b, c, d, 0.0, 0.0])
}

/// Bit pattern, for use as a key.
pub(crate) fn bits(m: Affine) -> [u64; 6] {
    m.as_coeffs().map(f64::to_bits)
}

/// Bit pattern in f32, for use as a key.
pub(crate) fn f32_bits(m: Affine) -> [u32; 6] {
    // Adding zero maps -0 to 0.
    m.as_coeffs().map(|v| (v as f32 + 0.0).to_bits())
}
