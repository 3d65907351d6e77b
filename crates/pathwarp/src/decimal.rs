//! Numbers as text with a fixed number of decimals and no trailing zeros.

use kurbo::Affine;
use std::fmt::Write;

/// Formats `v` rounded to `decimals` decimals, without trailing zeros and without the sign of -0.
///
/// ```
/// use pathwarp::decimal::trimmed;
///
/// assert_eq!(trimmed(1.25, 6), "1.25");
/// assert_eq!(trimmed(100.0, 0), "100");
/// assert_eq!(trimmed(-0.001, 2), "0");
/// ```
#[must_use]
pub fn trimmed(v: f64, decimals: usize) -> String {
    let mut out = String::new();
    push_trimmed(&mut out, v, decimals);
    out
}

/// Formats numbers that belong together, such as the coordinates of a point or a box: each with `digits` significant digits, but no
/// decimals beyond those that give the largest `digits + extra_digits` digits. Numbers that are negligible beside the largest become 0.
///
/// ```
/// use pathwarp::decimal::together;
///
/// assert!(together(&[0.1 + 0.2, -7.7e-16, 40.0], 9, 3).eq(["0.3", "0", "40"]));
/// ```
pub fn together(values: &[f64], digits: i32, extra_digits: i32) -> impl Iterator<Item = String> {
    let max_decimals = decimals(values.iter().copied(), digits + extra_digits);
    values.iter().map(move |v| trimmed(*v, decimals([*v], digits).min(max_decimals)))
}

/// The number of decimals that the largest of these numbers needs for `digits` significant digits.
#[must_use]
pub fn decimals(values: impl IntoIterator<Item = f64>, digits: i32) -> usize {
    /// The largest number of decimals: more resolve nothing that can occur in a drawing.
    const MOST: i32 = 30;
    let largest = values.into_iter().map(f64::abs).filter(|v| v.is_finite()).fold(0.0, f64::max);
    let before_point = if largest > 0.0 { largest.log10().floor() as i32 + 1 } else { 0 };
    usize::try_from((digits - before_point).clamp(0, MOST)).unwrap_or(0)
}

/// Formats an affine map as `matrix(…)`: the images of both unit vectors with twelve significant digits each, the shift with twelve
/// digits of the largest number of all.
///
/// ```
/// use kurbo::Affine;
/// use pathwarp::decimal::matrix;
///
/// assert_eq!(matrix(Affine::rotate(std::f64::consts::FRAC_PI_2)), "matrix(0 1 -1 0 0 0)");
/// ```
#[must_use]
pub fn matrix(m: Affine) -> String {
    const DIGITS: i32 = 12;
    let [a, b, c, d, e, f] = m.as_coeffs();
    let format_pair =
        |pair: [f64; 2], among: &[f64]| pair.map(|v| trimmed(v, decimals(among.iter().copied(), DIGITS))).join(" ");
    let [x, y] = [[a, b], [c, d]].map(|unit| format_pair(unit, &unit));
    format!("matrix({x} {y} {})", format_pair([e, f], &[a, b, c, d, e, f]))
}

/// Returns an affine map known in single precision, with negligible coordinates set to 0: coordinates of the image of a unit vector, or of
/// the shift, that single precision cannot distinguish from 0 beside the other coordinate.
///
/// ```
/// use kurbo::Affine;
/// use pathwarp::decimal::single;
///
/// assert_eq!(single(Affine::new([-4.4e-8, 1.0, -1.0, -4.4e-8, 300.0, -8.7e-8])), Affine::new([0.0, 1.0, -1.0, 0.0, 300.0, 0.0]));
/// ```
#[must_use]
pub fn single(m: Affine) -> Affine {
    let [a, b, c, d, e, f] = m.as_coeffs();
    let cleaned = |v: f64, other: f64| if v.abs() < f64::from(f32::EPSILON) * other.abs() { 0.0 } else { v };
    Affine::new([cleaned(a, b), cleaned(b, a), cleaned(c, d), cleaned(d, c), cleaned(e, f), cleaned(f, e)])
}

/// Appends [`trimmed`] text to `out`.
pub fn push_trimmed(out: &mut String, v: f64, decimals: usize) {
    let start = out.len();
    // Writing to a String cannot fail.
    let _ = write!(out, "{v:.decimals$}");
    if out[start..].contains('.') {
        let kept = out.trim_end_matches('0').trim_end_matches('.').len();
        out.truncate(kept);
    }
    if &out[start..] == "-0" {
        out.truncate(start);
        out.push('0');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_zeros_after_the_point_are_trimmed() {
        assert_eq!(trimmed(1200.0, 3), "1200");
        assert_eq!(trimmed(1.250_000_4, 6), "1.25");
        assert_eq!(trimmed(-3.0, 2), "-3");
        assert_eq!(trimmed(-0.004, 2), "0");
        let mut out = "0.50 ".to_owned();
        push_trimmed(&mut out, 0.10, 2);
        assert_eq!(out, "0.50 0.1");
    }
}
