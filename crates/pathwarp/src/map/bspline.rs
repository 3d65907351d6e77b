//! Uniform clamped B-splines over [0, 1]: knots, Greville abscissae, and conversion to Bézier form by blossoming.
//!
//! A clamped knot vector of degree d with c cells is 0 (d+1 times), 1/c, 2/c, …, 1 (d+1 times); it has d + c control points.
//! With one cell the spline is a Bézier curve. Adjacent pieces agree in d − 1 derivatives.
//!
//! The Bézier points of a cell \[a, b\] are blossom values f(a,…,a,b,…,b) (L. Ramshaw, *Blossoms are polar forms*, CAGD 6, 1989), the
//! result of inserting each knot until it has multiplicity d (W. Boehm, *Inserting new knots into B-spline curves*, CAD 12, 1980).

/// The clamped knot vector.
fn knots(degree: usize, cells: usize) -> Vec<f64> {
    let inner = (1..cells).map(|k| k as f64 / cells as f64);
    let (zeros, ones) = (std::iter::repeat_n(0.0, degree + 1), std::iter::repeat_n(1.0, degree + 1));
    zeros.chain(inner).chain(ones).collect()
}

/// The control points that make the spline the identity: the means of `degree` consecutive knots (Greville abscissae), i/n for one cell.
#[must_use]
pub fn regular(degree: usize, cells: usize) -> Vec<f64> {
    if cells == 1 {
        return (0..=degree).map(|i| i as f64 / degree as f64).collect();
    }
    let t = knots(degree, cells);
    (0..degree + cells).map(|i| t[i + 1..=i + degree].iter().sum::<f64>() / degree as f64).collect()
}

/// For each cell, the matrix that takes its `degree` + 1 control points, which start at the index of the cell, to Bézier points
/// (one row each).
#[must_use]
pub fn extraction(degree: usize, cells: usize) -> Vec<Vec<Vec<f64>>> {
    let t = knots(degree, cells);
    let bezier = |cell: usize| -> Vec<Vec<f64>> {
        let span = cell + degree;
        let (a, b) = (t[span], t[span + 1]);
        let mut rows = vec![vec![0.0; degree + 1]; degree + 1];
        for l in 0..=degree {
            // The blossom is linear in the control points: evaluate it for one unit vector at a time.
            for (k, row) in rows.iter_mut().enumerate() {
                let mut d = vec![0.0; degree + 1];
                d[l] = 1.0;
                for r in 1..=degree {
                    let u = if r <= k { b } else { a };
                    for j in (r..=degree).rev() {
                        let (lo, hi) = (t[j + span - degree], t[j + 1 + span - r]);
                        let w = (u - lo) / (hi - lo);
                        d[j] = (1.0 - w) * d[j - 1] + w * d[j];
                    }
                }
                row[l] = d[degree];
            }
        }
        rows
    };
    (0..cells).map(bezier).collect()
}

/// The Bézier pieces of a uniform spline of this degree over control points of any dimension, which share their ends: clamped with
/// `points.len()` − degree cells, or periodic with `points.len()` cells, the first of which begins at the first point (or, if the
/// degree is even, half a cell after it). The handles of a skeleton are converted in the same way as its points.
#[must_use]
pub fn pieces<const K: usize>(degree: usize, points: &[[f64; K]], closed: bool) -> Vec<Vec<[f64; K]>> {
    let n = points.len();
    // The middle cell of a long clamped spline has only uniform knots, as every cell of a periodic one.
    let cells = extraction(degree, if closed { 2 * degree - 1 } else { n - degree });
    let first = if closed { n * degree - (degree - 1) / 2 } else { 0 };
    let bezier = |i: usize| -> Vec<[f64; K]> {
        let rows = &cells[if closed { degree - 1 } else { i }];
        let sum = |row: &Vec<f64>, k: usize| (0..=degree).map(|l| row[l] * points[(first + i + l) % n][k]).sum();
        rows.iter().map(|row| std::array::from_fn(|k| sum(row, k))).collect()
    };
    let mut out: Vec<_> = (0..if closed { n } else { n - degree }).map(bezier).collect();
    // Rounding must not separate the ends at a joint.
    for i in 1 - usize::from(closed)..out.len() {
        let before = out[(i + out.len() - 1) % out.len()][degree];
        out[i][0] = before;
    }
    out
}

/// The cubic Bézier pieces of the C² spline through points of any dimension, whose parameters are these `widths` apart. An open spline has
/// one width fewer than points and no curvature at the ends; a closed one has as many widths as points.
#[must_use]
pub fn through<const K: usize>(points: &[[f64; K]], widths: &[f64], closed: bool) -> Vec<Vec<[f64; K]>> {
    /// The number of sweeps, each of which at least halves the error.
    const SWEEPS: usize = 60;
    let (n, m) = (points.len(), widths.len());
    let chord = |i: usize, k: usize| points[(i + 1) % n][k] - points[i][k];
    let mut slopes = vec![[0.0; K]; n];
    for _ in 0..SWEEPS {
        for i in 0..n {
            // The pieces before and after a point, with the points at their other ends; an end of an open spline has only one.
            let before = if closed { Some((i + n - 1) % n) } else { i.checked_sub(1) };
            let sides = [before.map(|b| (b, b)), (i < m).then_some((i, (i + 1) % n))];
            let weight: f64 = sides.iter().flatten().map(|(piece, _)| 2.0 / widths[*piece]).sum();
            slopes[i] = std::array::from_fn(|k| {
                let pull = |(piece, other): &(usize, usize)| {
                    let h = widths[*piece];
                    (3.0 * chord(*piece, k) / h - slopes[*other][k]) / h
                };
                sides.iter().flatten().map(pull).sum::<f64>() / weight
            });
        }
    }
    let piece = |i: usize| {
        let (j, third) = ((i + 1) % n, widths[i] / 3.0);
        let inner = |p: usize, width: f64| std::array::from_fn(|k| points[p][k] + width * slopes[p][k]);
        vec![points[i], inner(i, third), inner(j, -third), points[j]]
    };
    (0..m).map(piece).collect()
}

/// The widths of a spline through points with these distances between them: their square roots (centripetal parameters, E. T. Y. Lee,
/// *Choosing nodes in parametric curve interpolation*, CAD 21, 1989), with the sum 1.
#[must_use]
pub fn centripetal(distances: &[f64]) -> Vec<f64> {
    let sum: f64 = distances.iter().map(|d| d.sqrt()).sum();
    distances.iter().map(|d| d.sqrt() / sum).collect()
}

/// The index of the first control point with influence at `s`, and the values of the basis functions from there on.
#[must_use]
pub fn basis(degree: usize, cells: usize, s: f64) -> (usize, Vec<f64>) {
    basis_on(&extraction(degree, cells), s)
}

/// The [`basis`] of cells whose matrices are known.
pub(crate) fn basis_on(cells: &[Vec<Vec<f64>>], s: f64) -> (usize, Vec<f64>) {
    let x = s * cells.len() as f64;
    let cell = (x.max(0.0) as usize).min(cells.len() - 1);
    let rows = &cells[cell];
    let b = bernstein(rows.len() - 1, x - cell as f64);
    let value = |l: usize| rows.iter().zip(&b).map(|(row, b)| row[l] * b).sum();
    (cell, (0..rows.len()).map(value).collect())
}

/// The Bernstein polynomials of this degree at `t`, by their recursion.
pub(crate) fn bernstein(degree: usize, t: f64) -> Vec<f64> {
    let mut b = vec![1.0];
    for _ in 0..degree {
        let mut next = vec![0.0; b.len() + 1];
        for (i, v) in b.iter().enumerate() {
            next[i] += v * (1.0 - t);
            next[i + 1] += v * t;
        }
        b = next;
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The recursion of Cox and de Boor that defines B-splines.
    fn by_definition(degree: usize, cells: usize, c: &[f64], x: f64) -> f64 {
        fn basis(t: &[f64], i: usize, d: usize, x: f64) -> f64 {
            if d == 0 {
                return f64::from(u8::from(t[i] <= x && x < t[i + 1]));
            }
            let part = |num: f64, den: f64, b: f64| if den > 0.0 { num / den * b } else { 0.0 };
            part(x - t[i], t[i + d] - t[i], basis(t, i, d - 1, x))
                + part(t[i + d + 1] - x, t[i + d + 1] - t[i + 1], basis(t, i + 1, d - 1, x))
        }
        let t = knots(degree, cells);
        c.iter().enumerate().map(|(i, c)| c * basis(&t, i, degree, x)).sum()
    }

    fn bezier(c: &[f64], s: f64) -> f64 {
        let mut c = c.to_vec();
        for n in (1..c.len()).rev() {
            for i in 0..n {
                c[i] += s * (c[i + 1] - c[i]);
            }
        }
        c[0]
    }

    #[test]
    fn bezier_pieces_are_the_spline() {
        for (degree, cells) in [(1, 1), (1, 4), (2, 3), (3, 5), (5, 2), (10, 1), (4, 7)] {
            let c: Vec<f64> = (0..degree + cells).map(|i| ((i * i * 7 + 3) % 11) as f64 - 4.0).collect();
            for (cell, rows) in extraction(degree, cells).iter().enumerate() {
                let local = &c[cell..=cell + degree];
                let points: Vec<f64> =
                    rows.iter().map(|r| r.iter().zip(local).map(|(a, b)| a * b).sum::<f64>()).collect();
                for k in 0..10 {
                    let s = f64::from(k) / 10.0;
                    let x = (cell as f64 + s) / cells as f64;
                    let (a, b) = (bezier(&points, s), by_definition(degree, cells, &c, x));
                    // At a knot the recursion may use the previous cell, which has the same value.
                    assert!((a - b).abs() < 1e-12, "{degree} {cells} {cell} {s}: {a} {b}");
                }
            }
        }
    }

    #[test]
    fn regular_points_give_the_identity_and_one_cell_is_bezier() {
        for (degree, cells) in [(1, 3), (3, 4), (4, 2)] {
            let c = regular(degree, cells);
            for x in [0.0, 0.1, 0.37, 0.9] {
                assert!((by_definition(degree, cells, &c, x) - x).abs() < 1e-15);
            }
        }
        let identity = &extraction(4, 1)[0];
        for (k, row) in identity.iter().enumerate() {
            assert!(row.iter().enumerate().all(|(l, v)| *v == f64::from(u8::from(k == l))));
        }
    }
}
