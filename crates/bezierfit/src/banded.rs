//! Banded systems of linear equations.

use std::ops::{Add, Div, Mul, Sub, SubAssign};

/// Right sides: numbers, or vectors for several systems at once.
pub(crate) trait Right:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + SubAssign + Mul<f64, Output = Self> + Div<f64, Output = Self>
{
}

impl Right for f64 {}
impl Right for kurbo::Vec2 {}

/// Solves a symmetric positive definite system by L·D·Lᵀ. `band[i][d]` is the entry in row i and column i + d. `None` if it is not definite
/// even with 1e-13 of the largest diagonal entry added to the diagonal, which is rounding.
pub(crate) fn solve_banded<const BAND: usize, V: Right>(mut band: Vec<[f64; BAND]>, mut x: Vec<V>) -> Option<Vec<V>> {
    let n = x.len();
    let most = band.iter().map(|b| b[0]).fold(0.0, f64::max);
    for i in 0..n {
        let pivot = band[i][0] + 1e-13 * most;
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        band[i][0] = pivot;
        for d in 1..BAND.min(n - i) {
            let factor = band[i][d] / pivot;
            for e in d..BAND.min(n - i) {
                band[i + d][e - d] -= factor * band[i][e];
            }
            let right = x[i];
            x[i + d] -= right * factor;
        }
    }
    for i in (0..n).rev() {
        let sum = (1..BAND.min(n - i)).map(|d| x[i + d] * band[i][d]).fold(V::default(), |a, b| a + b);
        x[i] = (x[i] - sum) / band[i][0];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn banded_systems_are_solved() {
        const BAND: usize = 6;
        let mut band = vec![[0.0; BAND]; 9];
        for (i, b) in band.iter_mut().enumerate() {
            *b = [10.0 + i as f64, 1.0, -2.0, 0.5, 0.25, 0.1];
        }
        let want: Vec<f64> = (0..9).map(|i| f64::from(i) - 3.5).collect();
        let entry = |i: usize, j: usize| if j - i < BAND { band[i][j - i] } else { 0.0 };
        let right: Vec<f64> = (0..9).map(|i| (0..9).map(|j| entry(i.min(j), i.max(j)) * want[j]).sum()).collect();
        for (x, want) in solve_banded(band.clone(), right).unwrap().iter().zip(want) {
            assert!((x - want).abs() < 1e-9);
        }
    }
}
