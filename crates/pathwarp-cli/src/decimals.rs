//! Numbers in messages and tables: fixed decimals without trailing zeros.

/// Formats `v` with at most `decimals` decimals, without trailing zeros.
pub(crate) fn trimmed(v: f64, decimals: usize) -> String {
    let text = format!("{v:.decimals$}");
    if decimals == 0 { text } else { text.trim_end_matches('0').trim_end_matches('.').to_owned() }
}

/// Formats a positive number with three significant figures.
pub(crate) fn three_figures(v: f64) -> String {
    /// No page is so small that more would matter.
    const MOST_DECIMALS: f64 = 12.0;
    trimmed(v, (2.0 - v.log10().floor()).clamp(0.0, MOST_DECIMALS) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_go_only_behind_the_point() {
        assert_eq!(trimmed(100.0, 0), "100");
        assert_eq!(trimmed(1.250_000_4, 6), "1.25");
        assert_eq!(trimmed(-3.0, 2), "-3");
        assert_eq!(three_figures(0.012_345), "0.0123");
        assert_eq!(three_figures(1200.0), "1200");
    }
}
