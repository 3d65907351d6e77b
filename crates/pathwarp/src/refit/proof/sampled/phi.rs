//! φ of the proofs from samples: the foot points as a polynomial of the parameter.

use super::tables::SampleTables;
use crate::refit::lanes::{Lane, fma, sum};
use crate::refit::limits::RANGE_ROUNDING;

/// The polynomial φ − τ: p₀, p₁, and its part v²r in the orthonormal basis.
pub(super) type Phi<const F: usize> = ([f64; 2], [f64; F]);

/// φ of degree at most `p` with the given slopes at the ends, by least squares from the foot points. `None` if it leaves
/// [0, 1].
#[inline(always)]
pub(super) fn through<const F: usize>(
    tables: &SampleTables,
    feet: [&Lane; 2],
    slopes: [f64; 2],
    p: usize,
) -> Option<Phi<F>> {
    let ends = [slopes[0] - 1.0, 1.0 - slopes[1]];
    let mut parts = [[0.0; 8]; F];
    for k in 0..F {
        let row = &tables.phi[k + 2];
        for i in 0..8 {
            parts[k][i] = fma(row[0][i], feet[0][i], row[1][i] * feet[1][i]);
        }
    }
    let mut c = [0.0; F];
    let mut b = tables.line;
    for j in 0..12 {
        b[j] = fma(tables.bernstein[0][j], ends[0], fma(tables.bernstein[1][j], ends[1], b[j]));
    }
    for k in 0..F {
        if k + 4 < p {
            let known = &tables.products[k];
            c[k] = sum(&parts[k]) - known[0] - known[1] * ends[0] - known[2] * ends[1];
        }
        for j in 0..12 {
            b[j] = fma(tables.bernstein[k + 2][j], c[k], b[j]);
        }
    }
    // The first and the last Bernstein coefficients are 0 and 1; those beside them, an eleventh of the slopes.
    let mut outside = 0.0;
    for j in 2..10 {
        let off = (b[j] - 0.5).abs();
        outside = if off > outside { off } else { outside };
    }
    let slopes_inside = slopes.iter().all(|s| (0.0..11.0).contains(s));
    (slopes_inside && outside < 0.5 - RANGE_ROUNDING && sum(&parts[0]).is_finite()).then_some((ends, c))
}
