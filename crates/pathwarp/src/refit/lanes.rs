//! Eight numbers side by side, and the few operations on them that every stage shares.
//!
//! Loops run by index through several arrays at once: the form that LLVM turns into vector instructions. Comparisons are
//! written as `if a > b { a } else { b }`, which is one instruction; `f64::max` is not, because of its rule for NaN.

use kurbo::Vec2;

/// One pass of the fit works on eight samples: two AVX registers of four, or four SSE2 registers of two.
pub(super) type Lane = crate::map::batch::Lane;

/// Eight points.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Lanes {
    pub(super) x: Lane,
    pub(super) y: Lane,
}

/// a·b + c: one instruction where the target has one; elsewhere `mul_add` would be a library call.
#[inline(always)]
pub(super) fn fma(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}

/// C(s) − (x, y) and C′(s), for the cubic C(s) = ((c₃s + c₂)s + c₁)s.
#[inline(always)]
pub(super) fn residual_at(c: &[Vec2; 3], s: f64, x: f64, y: f64) -> (f64, f64, f64, f64) {
    let [c1, c2, c3] = c;
    (
        fma(fma(fma(c3.x, s, c2.x), s, c1.x), s, -x),
        fma(fma(fma(c3.y, s, c2.y), s, c1.y), s, -y),
        fma(fma(c3.x * 3.0, s, c2.x * 2.0), s, c1.x),
        fma(fma(c3.y * 3.0, s, c2.y * 2.0), s, c1.y),
    )
}

/// |(x, y)|², never zero.
#[inline(always)]
pub(super) fn norm_squared(x: f64, y: f64) -> f64 {
    fma(x, x, fma(y, y, f64::MIN_POSITIVE))
}

/// Clamps to [0, 1]; NaN becomes 0.
#[inline(always)]
pub(super) fn clamp_unit(s: f64) -> f64 {
    let s = if s > 0.0 { s } else { 0.0 };
    if s < 1.0 { s } else { 1.0 }
}

/// The sum, halves first, in the order that vector registers add.
#[inline(always)]
pub(super) fn sum(v: &Lane) -> f64 {
    let mut h = [0.0; 4];
    for i in 0..4 {
        h[i] = v[i] + v[i + 4];
    }
    (h[0] + h[2]) + (h[1] + h[3])
}

/// The largest of eight.
#[inline(always)]
pub(super) fn largest(v: &Lane) -> f64 {
    let mut h = [0.0; 4];
    for i in 0..4 {
        h[i] = larger(v[i], v[i + 4]);
    }
    larger(larger(h[0], h[2]), larger(h[1], h[3]))
}

/// The larger of two numbers; `b` if either is NaN.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
