//! D from its samples: coefficients in the basis, and the bound that follows from them.

use super::basis::SampleExpansion;
use super::phi::Phi;
use super::tables::{CLEARING, CLEARING_LESS, FINE, SampleTables};
use crate::refit::candidate::Candidate;
use crate::refit::lanes::{Lane, Lanes, fma, largest, sum};

/// Degrees d of L that are tried.
const TRIED: [usize; 4] = [2, 4, 6, 8];
/// K(d): the largest value on [0, 1] of v²·(polynomial of degree d) that is at most one at j/17. From linear programs at 640
/// Chebyshev nodes, times 1/cos(π(d+4)/1280) for the maximum between those (Ehlich and Zeller), rounded up.
pub(super) const GROWTH: [f64; 9] = [1.0070, 1.0150, 1.0401, 1.0740, 1.0929, 1.2209, 1.2271, 1.3326, 1.3958];
/// K for the fine grid j/51 from 2 to 49, for d = 5.
pub(super) const FINE_GROWTH: f64 = 1.0215;

/// D at the places of batch `b`, and the largest square of its length.
#[inline(never)]
pub(super) fn difference<const F: usize>(
    tables: &SampleTables,
    b: usize,
    c: &Candidate,
    (ends, phi): &Phi<F>,
    g: &Lanes,
    out: &mut Lanes,
) -> f64 {
    let mut f = tables.places[b][0];
    if F > 0 {
        for i in 0..8 {
            f[i] = fma(tables.phi[0][b][i], ends[0], fma(tables.phi[1][b][i], ends[1], f[i]));
        }
        for k in 0..F {
            for i in 0..8 {
                f[i] = fma(tables.phi[k + 2][b][i], phi[k], f[i]);
            }
        }
    }
    let [c1, c2, c3] = c.frame.power(c.a, c.b);
    let mut squares = [0.0; 8];
    for i in 0..8 {
        let t = f[i];
        let x = g.x[i] - fma(fma(c3.x, t, c2.x), t, c1.x) * t;
        let y = g.y[i] - fma(fma(c3.y, t, c2.y), t, c1.y) * t;
        (out.x[i], out.y[i]) = (x, y);
        squares[i] = fma(x, x, y * y);
    }
    largest(&squares)
}

/// Replaces the values of W by those of VW, and returns the largest |VW − 1| of the first twenty-four.
#[inline(never)]
pub(super) fn clear(tables: &SampleTables, w: &mut [Lane; 4], degree: usize) -> f64 {
    let inverse = &tables.inverse[usize::from(degree == CLEARING_LESS)];
    let mut parts = [[0.0; 8]; CLEARING + 1];
    for b in 0..2 {
        for i in 0..8 {
            let v = 1.0 / w[b][i];
            for k in 0..=CLEARING {
                parts[k][i] = fma(inverse[k][b][i], v, parts[k][i]);
            }
        }
    }
    let v = parts.map(|p| sum(&p));
    let mut most = [0.0; 8];
    for b in 0..4 {
        for i in 0..8 {
            let u = tables.places[b][2][i];
            w[b][i] *= fma(fma(fma(fma(v[4], u, v[3]), u, v[2]), u, v[1]), u, v[0]);
            let off = (w[b][i] - 1.0).abs();
            most[i] = if b < 3 && off > most[i] { off } else { most[i] };
        }
    }
    largest(&most)
}

/// The coefficients of D: even ones of x and y, odd ones of x and y.
#[inline(never)]
pub(super) fn coefficients<const B: usize, const H: usize>(
    e: &SampleExpansion<H>,
    d: &[Lanes; B],
    c: &mut [[f64; H]; 4],
) {
    let mut folded = [[0.0; H]; 4];
    for b in 0..B {
        for i in 0..4 {
            let (x, y, mx, my) = (d[b].x[i], d[b].y[i], d[b].x[7 - i], d[b].y[7 - i]);
            let k = 4 * b + i;
            (folded[0][k], folded[1][k], folded[2][k], folded[3][k]) = (x + mx, y + my, x - mx, y - my);
        }
    }
    let mut sums = [[0.0; H]; 4];
    for i in 0..H {
        let (even, odd) = (&e.even[i], &e.odd[i]);
        let [ex, ey, ox, oy] = [folded[0][i], folded[1][i], folded[2][i], folded[3][i]];
        for k in 0..H {
            sums[0][k] = fma(even[k], ex, sums[0][k]);
            sums[1][k] = fma(even[k], ey, sums[1][k]);
            sums[2][k] = fma(odd[k], ox, sums[2][k]);
            sums[3][k] = fma(odd[k], oy, sums[3][k]);
        }
    }
    *c = sums;
}

/// The largest value of L, coefficients 0 to 5, on the fine grid without the samples.
#[inline(never)]
fn on_fine_grid<const H: usize>(tables: &SampleTables, c: &[[f64; H]; 4]) -> f64 {
    let [even, odd] = &tables.fine;
    let mut all = [0.0; 8];
    for b in [0, 8] {
        for i in 0..8 {
            let at = |m: &[[f64; 16]; FINE], c: &[f64; H]| {
                fma(m[0][b + i], c[0], fma(m[1][b + i], c[1], m[2][b + i] * c[2]))
            };
            let (ex, ey, ox, oy) = (at(even, &c[0]), at(even, &c[1]), at(odd, &c[2]), at(odd, &c[3]));
            let square = |x: f64, y: f64| fma(x, x, y * y);
            // The larger of the two mirror images.
            let (l, r) = (square(ex + ox, ey + oy), square(ex - ox, ey - oy));
            let m = if l > r { l } else { r };
            all[i] = if m > all[i] { m } else { all[i] };
        }
    }
    largest(&all).sqrt()
}

/// The bound for |D| from its coefficients and its largest sample. Evaluates the fine grid only if that may bring the bound
/// down to `enough`.
#[inline(always)]
pub(super) fn supremum<const H: usize>(tables: &SampleTables, c: &[[f64; H]; 4], most: f64, enough: f64) -> f64 {
    let (mut even, mut odd) = ([0.0; H], [0.0; H]);
    for k in 0..H {
        even[k] = fma(c[0][k], c[0][k], c[1][k] * c[1][k]).sqrt();
        odd[k] = fma(c[2][k], c[2][k], c[3][k] * c[3][k]).sqrt();
    }
    // Everything beyond the tried degrees.
    let mut tail = 0.0;
    for k in TRIED.len() + 1..H {
        tail += even[k] + odd[k];
    }
    let mut best = f64::INFINITY;
    let mut fine = 0.0;
    for j in (0..TRIED.len()).rev() {
        // The even coefficient of degree d is not in the tail; the odd one after it is.
        let d = TRIED[j];
        tail += odd[d / 2];
        let limit = fma(GROWTH[d], most + tail, tail);
        best = if limit < best { limit } else { best };
        tail += even[d / 2];
        fine = if d / 2 == FINE { tail } else { fine };
    }
    if best > enough && most + fine <= enough {
        let at = on_fine_grid(tables, c);
        let largest = if at > most + fine { at } else { most + fine };
        let limit = fma(FINE_GROWTH, largest, fine);
        best = if limit < best { limit } else { best };
    }
    best
}
