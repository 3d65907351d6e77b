//! The outcome of fitting one piece.

use super::limits::{MAX_DIFFICULTY, MIN_RELATIVE_ERROR};
use super::piece::FittedPiece;

/// The outcome of fitting one piece to a stretch.
#[derive(Debug, Clone, Copy)]
pub(super) enum FitOutcome {
    /// The piece is within the tolerance.
    Fits {
        piece: FittedPiece,
        /// Proven, where a proof is wanted and possible.
        error: f64,
        /// Error at the fitted samples, to be compared with that of other pieces.
        reach: f64,
    },
    /// No piece within the tolerance was found.
    Misses {
        /// The best one, for use if the budget ends here.
        piece: FittedPiece,
        error: f64,
        /// An estimate of the error that more iterations would reach: it predicts the number of pieces.
        reach: f64,
        /// A parameter at which the image nearly stops.
        cusp: Option<f64>,
    },
}

impl FitOutcome {
    pub(super) fn fits(&self) -> bool {
        matches!(self, Self::Fits { .. })
    }

    /// The share of one piece's capacity that the stretch takes: the sixth root of error ÷ tolerance.
    pub(super) fn difficulty(&self, tolerance: f64) -> f64 {
        let (Self::Fits { reach, .. } | Self::Misses { reach, .. }) = self;
        sixth_root((reach / tolerance).clamp(MIN_RELATIVE_ERROR, MAX_DIFFICULTY))
    }
}

/// x^(1/6) to a relative 1e-4: a sixth of the exponent as a start, then two Newton steps.
fn sixth_root(x: f64) -> f64 {
    /// Five sixths of the bits of 1.0, which hold the exponent's bias.
    const BIAS: u64 = 0x3FF0_0000_0000_0000 / 6 * 5;
    let mut y = f64::from_bits(x.to_bits() / 6 + BIAS);
    for _ in 0..2 {
        let y2 = y * y;
        y = (5.0 * y + x / (y2 * y2 * y)) * (1.0 / 6.0);
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixth_roots_are_near() {
        for x in [1e-3, 0.5, 1.0, 7.0, 64.0, 2.6e5] {
            let y = sixth_root(x);
            assert!((y / f64::powf(x, 1.0 / 6.0) - 1.0).abs() < 2e-4, "{x}: {y}");
        }
    }
}
