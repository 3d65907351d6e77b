//! The sixteen samples of a piece, at j/17 of its parameter: eight to fit, eight between them to check.

use super::lanes::{Lane, fma};

/// Spacing of the samples.
pub(super) const UNIT: f64 = 1.0 / 17.0;
/// Samples that are fitted, in seventeenths; both sets are symmetric about the middle.
pub(super) const FITTED: Lane = [1.0, 3.0, 5.0, 7.0, 10.0, 12.0, 14.0, 16.0];
/// Samples that check the fit, in seventeenths.
pub(super) const CHECKED: Lane = [2.0, 4.0, 6.0, 8.0, 9.0, 11.0, 13.0, 15.0];
/// 1 if the checked sample of the same index follows the fitted one, −1 if it precedes it.
pub(super) const SIDE: Lane = [1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0];

/// Weights that extrapolate residuals at the fitted samples to 8/17, assuming they are v²·(polynomial of degree seven) with
/// v = τ(1−τ). Reversed, the weights for 9/17. The two lie in the widest gap between fitted samples.
pub(super) const MIDDLE: Lane = {
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

/// The parameters of the samples `set` of a stretch that begins at `t0` and is `h` long.
#[inline(always)]
pub(super) fn spaced(t0: f64, h: f64, set: &Lane) -> Lane {
    let mut t = [0.0; 8];
    for i in 0..8 {
        t[i] = fma(h, set[i] * UNIT, t0);
    }
    t
}

/// Number of [`Evenly`] spaced values.
pub(super) const ALL: usize = 18;
/// One value per sample in their order along the piece, and one for either end.
pub(super) type Evenly = [f64; ALL];

/// Merges values of the fitted and the checked samples. The ends get 0 and `last`.
pub(super) fn interleaved(fitted: &Lane, checked: &Lane, last: f64) -> Evenly {
    let mut v = [0.0; ALL];
    v[ALL - 1] = last;
    for i in 0..8 {
        v[FITTED[i] as usize] = fitted[i];
        v[CHECKED[i] as usize] = checked[i];
    }
    v
}

/// Interpolates the foot points of the checked samples linearly from those of the fitted ones.
#[inline(always)]
pub(super) fn between(s: &Lane) -> Lane {
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
pub(super) fn neighbours(v: &Lane) -> Lane {
    [v[1], v[2], v[3], v[4], v[3], v[4], v[5], v[6]]
}
