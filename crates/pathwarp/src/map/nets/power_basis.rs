//! The change of basis from Bernstein polynomials to powers about the center of the parameter square.

/// Converts Bernstein coefficients over (s, t), row by row, to coefficients of powers of u = 2s − 1 and v = 2t − 1.
pub(crate) fn powers(degree: [usize; 2], b: &[f64]) -> Vec<f64> {
    let (m, n) = (degree[0] + 1, degree[1] + 1);
    let (across, down) = (centered(degree[0]), centered(degree[1]));
    let mut rows = vec![0.0; m * n];
    for (to, from) in rows.chunks_mut(m).zip(b.chunks(m)) {
        for (k, v) in to.iter_mut().enumerate() {
            *v = from.iter().enumerate().map(|(i, c)| across[i][k] * c).sum();
        }
    }
    let mut out = vec![0.0; m * n];
    for (l, to) in out.chunks_mut(m).enumerate() {
        for (k, v) in to.iter_mut().enumerate() {
            *v = (0..n).map(|j| down[j][l] * rows[j * m + k]).sum();
        }
    }
    out
}

/// The coefficients of uᵏ in each Bⁿᵢ((1+u)/2) = C(n,i)·(1+u)ⁱ(1−u)ⁿ⁻ⁱ/2ⁿ, which are exact binary fractions.
fn centered(n: usize) -> Vec<Vec<f64>> {
    let mut binomial = 1.0;
    (0..=n)
        .map(|i| {
            let mut c = vec![0.0; n + 1];
            c[0] = binomial * 0.5f64.powi(n as i32);
            binomial = binomial * (n - i) as f64 / (i + 1) as f64;
            for step in 0..n {
                let sign = if step < i { 1.0 } else { -1.0 };
                for k in (1..=step + 1).rev() {
                    c[k] += sign * c[k - 1];
                }
            }
            c
        })
        .collect()
}
