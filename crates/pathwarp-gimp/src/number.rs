//! Formats coordinates.

use pathwarp::decimal::trimmed;

/// The shortest text that parses to the same number, in single precision if the number has no more, as in GIMP's files, or
/// else in double precision.
pub(crate) fn shortest(v: f64) -> String {
    let single = v as f32;
    // Adding 0.0 turns -0 into 0.
    if f64::from(single) == v { (single + 0.0).to_string() } else { (v + 0.0).to_string() }
}

/// Rounds to `decimals` and removes trailing zeros.
pub(crate) fn rounded(v: f64, decimals: u8) -> String {
    trimmed(v, usize::from(decimals))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_survive_a_round_trip() {
        for v in [0.0, 112.277_374_267_578_12, 1e7, -0.1, f64::from(f32::MIN_POSITIVE), 1.0 / 3.0, 34_002_432.0] {
            let back: f64 = shortest(v).parse().unwrap();
            assert_eq!(back as f32, v as f32);
            assert!(back == v || f64::from(v as f32) == v, "{v}");
        }
        assert_eq!(
            (shortest(f64::from(12.55f32)), rounded(2.50, 2), rounded(-0.001, 2)),
            ("12.55".into(), "2.5".into(), "0".into())
        );
    }
}
