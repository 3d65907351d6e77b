//! Linear systems with more unknowns than equations: finds the smallest change that satisfies them.

/// Eigenvalues below this fraction of the largest count as zero, as for two equations that are almost equal.
const RANK_TOLERANCE: f64 = 1e-12;

/// Returns the solution D of R·D = Δ of least squares and smallest norm, D = Rᵀ(R·Rᵀ)⁺Δ. `rows` holds the rows of R, all of one
/// length, and `want` the rows of Δ.
///
/// The pseudo-inverse comes from the eigenvectors of the small symmetric matrix R·Rᵀ (C. G. J. Jacobi's rotations); the work
/// grows with the cube of the number of rows (J. Gain, N. Dodgson, *Preserving topology under free-form deformation*, 2001).
///
/// ```
/// let change = pathwarp::solve::smallest_change(&[vec![3.0, 4.0]], &[[50.0]]);
/// assert!((change[0][0] - 6.0).abs() < 1e-12 && (change[1][0] - 8.0).abs() < 1e-12);
/// ```
#[must_use]
pub fn smallest_change<const D: usize>(rows: &[Vec<f64>], want: &[[f64; D]]) -> Vec<[f64; D]> {
    let n = rows.len();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let gram: Vec<Vec<f64>> = rows.iter().map(|a| rows.iter().map(|b| dot(a, b)).collect()).collect();
    let (values, vectors) = eigen(gram);
    let min = RANK_TOLERANCE * values.iter().fold(0.0, |a: f64, b| a.max(*b));
    // First (R·Rᵀ)⁺·Δ, then back through Rᵀ.
    let mut y = vec![[0.0; D]; n];
    for (k, value) in values.iter().enumerate().filter(|(_, v)| **v > min) {
        let part: [f64; D] =
            std::array::from_fn(|d| want.iter().zip(&vectors).map(|(w, v)| w[d] * v[k]).sum::<f64>() / value);
        for (y, v) in y.iter_mut().zip(&vectors) {
            add(y, &part, v[k]);
        }
    }
    let mut change = vec![[0.0; D]; rows.first().map_or(0, Vec::len)];
    for (row, y) in rows.iter().zip(&y) {
        for (c, r) in change.iter_mut().zip(row) {
            add(c, y, *r);
        }
    }
    change
}

/// Returns the distances |R·D − Δ|, one for each row: rounding errors, unless the rows contradict each other.
#[must_use]
pub fn misses<const D: usize>(rows: &[Vec<f64>], want: &[[f64; D]], change: &[[f64; D]]) -> Vec<f64> {
    let miss = |(row, want): (&Vec<f64>, &[f64; D])| {
        let mut reached = [0.0; D];
        row.iter().zip(change).for_each(|(r, c)| add(&mut reached, c, *r));
        reached.iter().zip(want).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    rows.iter().zip(want).map(miss).collect()
}

/// Adds k·b to a.
fn add<const D: usize>(a: &mut [f64; D], b: &[f64; D], k: f64) {
    for (a, b) in a.iter_mut().zip(b) {
        *a += k * b;
    }
}

/// Eigenvalues and eigenvectors (in columns) of a symmetric matrix, by Jacobi's rotations.
fn eigen(mut a: Vec<Vec<f64>>) -> (Vec<f64>, Vec<Vec<f64>>) {
    /// The limit on sweeps. Convergence is quadratic, so ten usually suffice.
    const MAX_SWEEPS: usize = 30;
    let n = a.len();
    let mut v: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for _ in 0..MAX_SWEEPS {
        let mut is_diagonal = true;
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q].abs() <= f64::EPSILON * (a[p][p] * a[q][q]).abs().sqrt() {
                    continue;
                }
                is_diagonal = false;
                // The rotation with tangent t, sine s and cosine c makes a[p][q] zero.
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for row in a.iter_mut().chain(&mut v) {
                    let (x, y) = (row[p], row[q]);
                    (row[p], row[q]) = (c * x - s * y, s * x + c * y);
                }
                let (above, below) = a.split_at_mut(q);
                for (x, y) in above[p].iter_mut().zip(&mut below[0]) {
                    (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
                }
            }
        }
        if is_diagonal {
            break;
        }
    }
    ((0..n).map(|i| a[i][i]).collect(), v)
}
