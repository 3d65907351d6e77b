//! Knots, and the Bézier patches of a NURBS surface by their polar forms.

use super::bezier::BezierPatch;
use glam::DVec4;

/// The knots of a single Bézier span.
pub(super) fn single(degree: usize, [from, to]: [f64; 2]) -> Vec<f64> {
    joined(degree, &[from, to])
}

/// Knots that join Bézier spans at these places.
pub(super) fn joined(degree: usize, breaks: &[f64]) -> Vec<f64> {
    let last = breaks.len().saturating_sub(1);
    let times = |i: usize| if i == 0 || i == last { degree + 1 } else { degree };
    breaks.iter().enumerate().flat_map(|(i, b)| std::iter::repeat_n(*b, times(i))).collect()
}

/// Says what is wrong with knots, if anything is.
pub(super) fn fault(degree: usize, knots: &[f64]) -> Option<String> {
    let n = knots.len();
    if n < 2 * (degree + 1) {
        return Some(format!("has {n} knots; degree {degree} takes {} or more", 2 * (degree + 1)));
    }
    if knots.iter().any(|k| !k.is_finite()) || knots.windows(2).any(|w| w[0] > w[1]) {
        return Some("has knots that are not in order".into());
    }
    let clamped = knots[0] == knots[degree] && knots[n - 1] == knots[n - 1 - degree];
    if !clamped || knots[0] == knots[n - 1] {
        return Some(format!(
            "has knots that are not clamped: the first and the last must be repeated {} times",
            degree + 1
        ));
    }
    let torn = knots[1..n - 1].windows(degree + 1).any(|w| w[0] == w[degree]);
    torn.then(|| {
        format!("has a knot repeated more than {degree} times, where it falls apart; store its parts one by one")
    })
}

/// The different knots.
fn breaks(knots: &[f64]) -> Vec<f64> {
    let mut out = knots.to_vec();
    out.dedup();
    out
}

/// The control points of all Bézier spans of a curve, which share their ends.
pub(super) fn bezier_row(degree: usize, knots: &[f64], points: &[DVec4]) -> Vec<DVec4> {
    let mut out = points[..1].to_vec();
    for span in degree..points.len() {
        let (from, to) = (knots[span], knots[span + 1]);
        if from < to {
            // The k-th is the polar form of the span at `from`, n − k times, and `to`, k times.
            out.extend((1..=degree).map(|k| {
                let arguments = std::iter::repeat_n(from, degree - k).chain(std::iter::repeat_n(to, k));
                polar(degree, knots, points, span, arguments)
            }));
        }
    }
    out
}

/// The polar form of a span, by de Boor's algorithm with an argument for each step.
fn polar(degree: usize, knots: &[f64], points: &[DVec4], span: usize, arguments: impl Iterator<Item = f64>) -> DVec4 {
    let mut row = points[span - degree..=span].to_vec();
    for (r, t) in arguments.enumerate() {
        for i in 0..degree - r {
            let (low, high) = (knots[span - degree + 1 + r + i], knots[span + 1 + i]);
            let a = (t - low) / (high - low);
            row[i] = row[i] * (1.0 - a) + row[i + 1] * a;
        }
    }
    row[0]
}

/// The Bézier patches of a surface, u fastest, and the values of u and v between them.
pub(super) fn pieces(
    degree: [usize; 2],
    knots: &[Vec<f64>; 2],
    [nu, _]: [usize; 2],
    points: &[DVec4],
) -> (Vec<BezierPatch>, [Vec<f64>; 2]) {
    let rows: Vec<Vec<DVec4>> = points.chunks(nu).map(|row| bezier_row(degree[0], &knots[0], row)).collect();
    let width = rows.first().map_or(0, Vec::len);
    let columns: Vec<Vec<DVec4>> = (0..width)
        .map(|i| {
            let column: Vec<DVec4> = rows.iter().map(|r| r[i]).collect();
            bezier_row(degree[1], &knots[1], &column)
        })
        .collect();
    let breaks = [breaks(&knots[0]), breaks(&knots[1])];
    let [spans_u, spans_v] = [breaks[0].len() - 1, breaks[1].len() - 1];
    let piece = |n: usize| {
        let (i, j) = (n % spans_u * degree[0], n / spans_u * degree[1]);
        let points = (0..=degree[1]).flat_map(|b| (0..=degree[0]).map(move |a| (a, b)));
        BezierPatch { degree, points: points.map(|(a, b)| columns[i + a][j + b]).collect() }
    };
    ((0..spans_u * spans_v).map(piece).collect(), breaks)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The recursion of Cox and de Boor.
    fn basis(knots: &[f64], i: usize, d: usize, x: f64) -> f64 {
        if d == 0 {
            return f64::from(u8::from(knots[i] <= x && x < knots[i + 1]));
        }
        let part = |num: f64, den: f64, b: f64| if den > 0.0 { num / den * b } else { 0.0 };
        part(x - knots[i], knots[i + d] - knots[i], basis(knots, i, d - 1, x))
            + part(knots[i + d + 1] - x, knots[i + d + 1] - knots[i + 1], basis(knots, i + 1, d - 1, x))
    }

    #[test]
    fn pieces_are_the_spline() {
        let knots =
            [vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 2.5, 4.0, 4.0, 4.0, 4.0], vec![-1.0, -1.0, -1.0, 0.5, 2.0, 2.0, 2.0]];
        let (degree, size) = ([3, 2], [7, 4]);
        let points: Vec<DVec4> = (0..28)
            .map(|i| {
                DVec4::new(f64::from((i * 37) % 11), f64::from((i * 17) % 7), f64::from(i), 1.0 + f64::from(i % 3))
            })
            .collect();
        let (pieces, breaks) = pieces(degree, &knots, size, &points);
        assert_eq!((pieces.len(), &breaks[0][..]), (6, &[0.0, 1.0, 2.5, 4.0][..]));
        for j in 0..2 {
            for i in 0..3 {
                for (a, b) in [(0.1, 0.7), (0.6, 0.2), (0.9, 0.9)] {
                    let u = breaks[0][i] + a * (breaks[0][i + 1] - breaks[0][i]);
                    let v = breaks[1][j] + b * (breaks[1][j + 1] - breaks[1][j]);
                    let mut truth = DVec4::ZERO;
                    for (n, p) in points.iter().enumerate() {
                        truth += *p * basis(&knots[0], n % 7, 3, u) * basis(&knots[1], n / 7, 2, v);
                    }
                    assert!((pieces[j * 3 + i].homogeneous(a, b)[0] - truth).length() < 1e-12, "{i} {j}");
                }
            }
        }
    }

    #[test]
    fn damage_is_found() {
        for (knots, part) in [
            (&[0.0, 0.0, 1.0][..], "takes 4"),
            (&[0.0, 0.0, 2.0, 1.0, 3.0, 3.0], "order"),
            (&[0.0, 0.0, f64::NAN, 1.0, 1.0], "order"),
            (&[0.0, 0.5, 1.0, 1.0], "clamped"),
            (&[1.0, 1.0, 1.0, 1.0], "clamped"),
            (&[0.0, 0.0, 1.0, 1.0, 2.0, 2.0], "more than 1"),
        ] {
            assert!(fault(1, knots).unwrap().contains(part), "{knots:?}: {:?}", fault(1, knots));
        }
        assert_eq!(fault(2, &joined(2, &[0.0, 1.0, 3.0])), None);
    }
}
