//! Replaces numbers out of range. No later stage can compute with them, and some would never return.

use memchr::memchr2;
use std::borrow::Cow;
use std::ops::Range;

/// Numbers from here on are out of range. Coordinates of real drawings stay below a million; from 1e12 on, adjacent
/// single-precision numbers are farther apart than a page is wide.
pub const LARGEST: f64 = 1e9;

/// Replaces a number out of range.
const REPLACEMENT: &str = "9e8";

/// Digits before the point of [`LARGEST`], the smallest number out of range.
const MIN_DIGITS: usize = 10;

/// Attributes that hold numbers and that `table.rs` lists neither as properties nor as lengths.
#[rustfmt::skip]
const CHECKED: [&str; 25] = [
    "points", "z", "viewBox", "gradientTransform", "patternTransform", "stdDeviation", "radius", "baseFrequency",
    "surfaceScale", "kernelUnitLength", "pointsAtX", "pointsAtY", "pointsAtZ", "limitingConeAngle", "kernelMatrix", "divisor",
    "bias", "k1", "k2", "k3", "k4", "pathLength", "d", "rotate", "scale",
];

/// Returns the static name of an attribute in [`CHECKED`].
pub(super) fn checked(name: &str) -> Option<&'static str> {
    CHECKED.iter().copied().find(|n| *n == name)
}

/// Brings all numbers of a text into range. Returns the new text and the first number that was out of range.
pub(super) fn in_range(value: &str) -> (Cow<'_, str>, Option<String>) {
    let found = if may_be_out_of_range(value) { out_of_range(value) } else { Vec::new() };
    let first = found.first().map(|r| value[r.clone()].to_owned());
    let mut out = Cow::Borrowed(value);
    for range in found.into_iter().rev() {
        out.to_mut().replace_range(range, REPLACEMENT);
    }
    (out, first)
}

/// Returns `false` if a text certainly holds no number out of range.
fn may_be_out_of_range(text: &str) -> bool {
    let bytes = text.as_bytes();
    let has_long_run = || {
        // A run of ten digits covers a multiple of ten.
        let samples = (0..bytes.len()).step_by(MIN_DIGITS).filter(|&i| bytes[i].is_ascii_digit());
        let mut runs = samples.map(|i| {
            let before = bytes[..i].iter().rev().take_while(|b| b.is_ascii_digit()).count();
            before + bytes[i..].iter().take_while(|b| b.is_ascii_digit()).count()
        });
        runs.any(|run| run >= MIN_DIGITS)
    };
    memchr2(b'e', b'E', bytes).is_some() || has_long_run()
}

/// Finds the numbers out of range in a text, without their signs.
fn out_of_range(text: &str) -> Vec<Range<usize>> {
    let bytes = text.as_bytes();
    let is_digit = |i: usize| bytes.get(i).is_some_and(u8::is_ascii_digit);
    let digits_end = |start: usize| (start..).find(|i| !is_digit(*i)).unwrap_or(start);
    let mut out = Vec::new();
    let mut i = 0;
    while i < bytes.len() {
        let start = i;
        if !is_digit(i) {
            i += 1;
            continue;
        }
        i = digits_end(i);
        if bytes.get(i) == Some(&b'.') {
            i = digits_end(i + 1);
        }
        if matches!(bytes.get(i), Some(b'e' | b'E')) {
            let exponent = i + 1 + usize::from(matches!(bytes.get(i + 1), Some(b'+' | b'-')));
            if is_digit(exponent) {
                i = digits_end(exponent);
            }
        }
        if text[start..i].parse().is_ok_and(|value: f64| value >= LARGEST) {
            out.push(start..i);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_out_of_range_are_found_and_others_are_not() {
        let found = |t: &str| -> Vec<String> { out_of_range(t).into_iter().map(|r| t[r].to_owned()).collect() };
        assert_eq!(found("M0 0L1e308-3.4e38H1e+9 999999999 1e8z"), ["1e308", "3.4e38", "1e+9"]);
        assert_eq!(found("M.5.1234567890123 1e-20 12345678901.5"), ["12345678901.5"]);
        for t in ["M0 0L1e308 1", "0.5 12345678901", "1234567890"] {
            assert!(may_be_out_of_range(t), "{t}");
        }
        assert!(!may_be_out_of_range("M10 20.123456L-5 1234567 z"));
        assert_eq!(in_range("M0 0L1e308,1"), ("M0 0L9e8,1".into(), Some("1e308".into())));
    }
}
