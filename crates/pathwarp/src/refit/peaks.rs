//! Predicts the largest error between samples from the errors at the samples.

use super::lanes::{larger, largest};
use super::limits::PEAK_FACTOR;
use super::samples::Evenly;

/// The height to which errors may rise beside a sample that is a local maximum; 0 at other samples.
///
/// Errors are signed by the side of the curve. A parabola through three neighbours exceeds the middle one by an eighth of
/// their second difference at most. Corners and faster oscillations rise more: `factor` times as much.
#[inline(always)]
pub(super) fn predicted_peak([before, top, after]: [f64; 3], factor: f64) -> f64 {
    let side = 1.0f64.copysign(top);
    let (a, b, c) = (before * side, top * side, after * side);
    let peak = b + (factor / 8.0) * (2.0 * b - a - c);
    // In this form the comparisons compile to no branches.
    if (b >= a) & (b >= c) { peak } else { 0.0 }
}

/// The same for a sample at the end of a smooth part: the error may rise between it and the next sample, by as much as a middle
/// sample's.
pub(super) fn predicted_end_peak([end, next, after]: [f64; 3], factor: f64) -> f64 {
    let side = 1.0f64.copysign(end);
    let (a, b, c) = (end * side, next * side, after * side);
    if a >= b { a + (factor / 8.0) * (2.0 * b - a - c).abs() } else { 0.0 }
}

/// The highest [`predicted_peak`] of sixteen samples.
#[inline(always)]
pub(super) fn highest_peak(errors: &Evenly) -> f64 {
    let (mut first, mut second) = ([0.0; 8], [0.0; 8]);
    for i in 0..8 {
        first[i] = predicted_peak([errors[i], errors[i + 1], errors[i + 2]], PEAK_FACTOR);
        second[i] = predicted_peak([errors[i + 8], errors[i + 9], errors[i + 10]], PEAK_FACTOR);
    }
    larger(largest(&first), largest(&second))
}

/// The height of the extreme of the parabola through three neighbouring errors, with signs, if it lies between them; else 0.
pub(super) fn extreme([a, b, c]: [f64; 3]) -> f64 {
    let (slope, bend) = (c - a, a + c - 2.0 * b);
    let inside = slope.abs() <= 2.0 * bend.abs() && bend != 0.0;
    if inside { (b - slope * slope / (8.0 * bend)).abs() } else { 0.0 }
}

/// The height of the parabola through three neighbours of which the middle one is the largest.
pub(super) fn parabola_peak(a: f64, b: f64, c: f64) -> f64 {
    let bend = 2.0 * b - a - c;
    if bend > 0.0 { b + (c - a).powi(2) / (8.0 * bend) } else { b }
}
