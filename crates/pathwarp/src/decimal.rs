//! Numbers as text with a fixed number of decimals and no trailing zeros.

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
