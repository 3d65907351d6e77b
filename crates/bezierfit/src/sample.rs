//! Eight numbers side by side, with the operations that all stages of a fit share, and the sixteen samples of a piece, at j/17 of its
//! parameter: eight to fit, and eight between them to check.
//!
//! Loops run by index through several arrays at once, the form that LLVM turns into vector instructions. Comparisons are
//! written as `if a > b { a } else { b }`, which is one instruction; `f64::max` takes more, because of its rule for NaN.

use crate::limits::PEAK_FACTOR;
use kurbo::Vec2;

/// Values of eight samples, the unit of work: two AVX registers of four, or four SSE2 registers of two. (SIMD calls one value a lane.)
pub type Lane = [f64; 8];

/// Eight points, a [`Lane`] for each coordinate.
#[derive(Debug, Clone, Copy, Default)]
pub struct Lanes {
    /// First coordinates.
    pub x: Lane,
    /// Second coordinates.
    pub y: Lane,
}

/// a·b + c, by one instruction if the target has it. Elsewhere `mul_add` would be a library call.
#[inline(always)]
pub fn fma(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}

/// C(s) − (x, y) and C′(s), for the cubic C(s) = ((c₃s + c₂)s + c₁)s.
#[inline(always)]
pub(crate) fn residual_at(c: &[Vec2; 3], s: f64, x: f64, y: f64) -> (f64, f64, f64, f64) {
    let [c1, c2, c3] = c;
    (
        fma(fma(fma(c3.x, s, c2.x), s, c1.x), s, -x),
        fma(fma(fma(c3.y, s, c2.y), s, c1.y), s, -y),
        fma(fma(c3.x * 3.0, s, c2.x * 2.0), s, c1.x),
        fma(fma(c3.y * 3.0, s, c2.y * 2.0), s, c1.y),
    )
}

/// |(x, y)|², kept above zero.
#[inline(always)]
pub(crate) fn norm_squared(x: f64, y: f64) -> f64 {
    fma(x, x, fma(y, y, f64::MIN_POSITIVE))
}

/// Clamps to [0, 1]; NaN becomes 0.
#[inline(always)]
pub(crate) fn clamp_unit(s: f64) -> f64 {
    let s = if s > 0.0 { s } else { 0.0 };
    if s < 1.0 { s } else { 1.0 }
}

/// Sum, halves first, in the order in which vector registers add.
#[inline(always)]
pub(crate) fn sum(v: &Lane) -> f64 {
    let mut h = [0.0; 4];
    for i in 0..4 {
        h[i] = v[i] + v[i + 4];
    }
    (h[0] + h[2]) + (h[1] + h[3])
}

#[inline(always)]
pub(crate) fn largest(v: &Lane) -> f64 {
    let mut h = [0.0; 4];
    for i in 0..4 {
        h[i] = larger(v[i], v[i + 4]);
    }
    larger(larger(h[0], h[2]), larger(h[1], h[3]))
}

/// The larger of two numbers; `b` if either is NaN.
#[inline(always)]
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Spacing of the sixteen samples.
pub(crate) const UNIT: f64 = 1.0 / 17.0;
/// Samples that are fitted, in seventeenths; both sets are symmetric about the middle.
pub const FITTED: Lane = [1.0, 3.0, 5.0, 7.0, 10.0, 12.0, 14.0, 16.0];
/// Samples that check the fit, in seventeenths.
pub const CHECKED: Lane = [2.0, 4.0, 6.0, 8.0, 9.0, 11.0, 13.0, 15.0];
/// Samples at parameters that suit no pattern, in seventeenths: the fractional parts of multiples of the golden ratio.
pub const UNEVEN: Lane = [10.5066, 4.0132, 14.5197, 8.0263, 1.5329, 12.0395, 5.5460, 16.0526];
/// 1 if the checked sample of the same index follows the fitted one, −1 if it precedes it.
pub(crate) const SIDE: Lane = [1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0];

/// Weights that extrapolate residuals at the fitted samples to 8/17, assuming they are v²·(polynomial of degree seven) with
/// v = τ(1−τ). Reversed, the weights for 9/17. The two lie in the widest gap between fitted samples.
pub(crate) const MIDDLE: Lane = {
    let mut out = [0.0; 8];
    let mut i = 0;
    while i < 8 {
        let (at, from) = (8.0, FITTED[i]);
        let v = at * (17.0 - at) / (from * (17.0 - from));
        let mut x = v * v;
        let mut k = 0;
        while k < 8 {
            if k != i {
                x *= (at - FITTED[k]) / (from - FITTED[k]);
            }
            k += 1;
        }
        out[i] = x;
        i += 1;
    }
    out
};

/// Parameters of the samples `set` in a stretch that begins at `t0` and is `h` long.
#[inline(always)]
pub fn spaced(t0: f64, h: f64, set: &Lane) -> Lane {
    let mut t = [0.0; 8];
    for i in 0..8 {
        t[i] = fma(h, set[i] * UNIT, t0);
    }
    t
}

/// Number of a piece's samples and ends.
pub(crate) const IN_ORDER: usize = 18;
/// One value for each sample and either end, in their order along the piece.
pub(crate) type InOrder = [f64; IN_ORDER];

/// Merges values of the fitted and the checked samples. The ends get the values 0 and `last`.
pub(crate) fn interleaved(fitted: &Lane, checked: &Lane, last: f64) -> InOrder {
    let mut v = [0.0; IN_ORDER];
    v[IN_ORDER - 1] = last;
    for i in 0..8 {
        v[FITTED[i] as usize] = fitted[i];
        v[CHECKED[i] as usize] = checked[i];
    }
    v
}

/// Foot points of the checked samples, interpolated linearly from those of the fitted samples.
#[inline(always)]
pub(crate) fn feet_between(s: &Lane) -> Lane {
    let third = (s[4] - s[3]) / 3.0;
    [
        0.5 * (s[0] + s[1]),
        0.5 * (s[1] + s[2]),
        0.5 * (s[2] + s[3]),
        s[3] + third,
        s[4] - third,
        0.5 * (s[4] + s[5]),
        0.5 * (s[5] + s[6]),
        0.5 * (s[6] + s[7]),
    ]
}

/// For each fitted sample, the next one towards the middle; for the two in the middle, each other.
#[inline(always)]
pub(crate) fn neighbours(v: &Lane) -> Lane {
    [v[1], v[2], v[3], v[4], v[3], v[4], v[5], v[6]]
}

/// Returns `true` if two directions are less than 60° apart.
pub(crate) fn turns_little(a: Vec2, b: Vec2) -> bool {
    let d = a.dot(b);
    d > 0.0 && 4.0 * d * d >= a.hypot2() * b.hypot2()
}

/// Height to which errors may rise beside a sample that is a local maximum; 0 at other samples.
///
/// Errors are signed by the side of the curve. A parabola through three neighbours exceeds the middle one by an eighth of
/// their second difference at most. Corners and faster oscillations rise more: `factor` times as much.
#[inline(always)]
pub(crate) fn predicted_peak([before, top, after]: [f64; 3], factor: f64) -> f64 {
    let side = 1.0f64.copysign(top);
    let (a, b, c) = (before * side, top * side, after * side);
    let peak = b + (factor / 8.0) * (2.0 * b - a - c);
    // In this form the comparisons compile to no branches.
    if (b >= a) & (b >= c) { peak } else { 0.0 }
}

/// Height to which errors may rise between a sample at the end of a smooth part, if it is a local maximum, and the next: by `factor`
/// times an eighth of their second difference.
pub(crate) fn predicted_end_peak([end, next, after]: [f64; 3], factor: f64) -> f64 {
    let side = 1.0f64.copysign(end);
    let (a, b, c) = (end * side, next * side, after * side);
    if a >= b { a + (factor / 8.0) * (2.0 * b - a - c).abs() } else { 0.0 }
}

/// Highest [`predicted_peak`] of sixteen samples.
#[inline(always)]
pub(crate) fn highest_peak(errors: &InOrder) -> f64 {
    let (mut first, mut second) = ([0.0; 8], [0.0; 8]);
    for i in 0..8 {
        first[i] = predicted_peak([errors[i], errors[i + 1], errors[i + 2]], PEAK_FACTOR);
        second[i] = predicted_peak([errors[i + 8], errors[i + 9], errors[i + 10]], PEAK_FACTOR);
    }
    larger(largest(&first), largest(&second))
}

/// Height of the extreme of the parabola through three neighbouring signed errors, if it lies between them; else 0.
pub(crate) fn parabola_extreme([a, b, c]: [f64; 3]) -> f64 {
    let (slope, bend) = (c - a, a + c - 2.0 * b);
    let is_between = slope.abs() <= 2.0 * bend.abs() && bend != 0.0;
    if is_between { (b - slope * slope / (8.0 * bend)).abs() } else { 0.0 }
}

/// Height of the parabola through three neighbours of which the middle one is the largest.
pub(crate) fn parabola_peak(a: f64, b: f64, c: f64) -> f64 {
    let bend = 2.0 * b - a - c;
    if bend > 0.0 { b + (c - a).powi(2) / (8.0 * bend) } else { b }
}
