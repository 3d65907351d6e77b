//! Numbers in messages and tables: fixed decimals without trailing zeros.

use pathwarp::decimal::trimmed;

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
    fn three_figures_of_any_size() {
        assert_eq!(three_figures(0.012_345), "0.0123");
        assert_eq!(three_figures(1200.0), "1200");
    }
}
