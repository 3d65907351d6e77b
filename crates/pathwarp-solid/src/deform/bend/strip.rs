//! A piece of a bend: F(u, v, w) = C(u) + v·S(u) + w·T(u).

use crate::map::Poly3;
use glam::DVec3;

/// The curves C, S and T of a piece, u from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Strip {
    /// The generalised algorithm of de Casteljau: every step an affine map with the handles s and t of its level.
    Ribbon {
        /// Control points, two to four.
        points: Vec<DVec3>,
        /// Pairs s, t of handles, level by level: n of the first, n − 1 of the second … The last levels may be omitted.
        levels: Vec<Vec<[DVec3; 2]>>,
    },
    /// A straight line `from` + u·`along` whose sides turn by `angle` (radians).
    Twist { from: DVec3, along: DVec3, sides: [DVec3; 2], angle: f64 },
    /// A straight line whose sides grow to `factor` times their length.
    Taper { from: DVec3, along: DVec3, sides: [DVec3; 2], factor: f64 },
    /// A circular arc of the length of `along` that turns by `angle` (radians) towards the first side.
    Arc { from: DVec3, along: DVec3, sides: [DVec3; 2], angle: f64 },
}

/// Three curves at a parameter, with their derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stand {
    /// C, S and T.
    pub(super) at: [DVec3; 3],
    /// C', S' and T'.
    pub(super) slope: [DVec3; 3],
}

impl Strip {
    /// Bernstein coefficients of C, S and T, all of one degree; `None` if they are no polynomials.
    pub(super) fn bernstein(&self) -> Option<Vec<[f64; 9]>> {
        let curves: [Vec<Vec<DVec3>>; 3] = match self {
            Self::Ribbon { points, levels } => {
                let side = |k: usize| levels.iter().map(|l| l.iter().map(|h| h[k]).collect()).collect();
                [vec![points.clone()], side(0), side(1)]
            }
            Self::Taper { from, along, sides: [s, t], factor } => {
                let line = |p: DVec3, q: DVec3| vec![vec![p, q]];
                [line(*from, *from + *along), line(*s, *s * *factor), line(*t, *t * *factor)]
            }
            Self::Twist { .. } | Self::Arc { .. } => return None,
        };
        let n = curves[0][0].len();
        let mut out = vec![[0.0; 9]; n];
        for (k, all) in curves.into_iter().enumerate() {
            for curve in all.into_iter().map(|c| elevated(c, n)) {
                for (o, p) in out.iter_mut().zip(curve) {
                    (0..3).for_each(|a| o[3 * k + a] += p[a]);
                }
            }
        }
        Some(out)
    }

    /// C, S and T as polynomials, with a polynomial for u; `None` if they are none.
    pub(super) fn polynomials(&self, u: &Poly3) -> Option<[[Poly3; 3]; 3]> {
        match self {
            Self::Ribbon { points, levels } => {
                let side = |k: usize| {
                    let mut sum = [(); 3].map(|()| Poly3::default());
                    for handles in levels {
                        let part = bezier_polynomial(&handles.iter().map(|h| h[k]).collect::<Vec<_>>(), u);
                        sum = std::array::from_fn(|a| sum[a].plus(1.0, &part[a]));
                    }
                    sum
                };
                Some([bezier_polynomial(points, u), side(0), side(1)])
            }
            Self::Taper { from, along, sides: [s, t], factor } => {
                let line = |p: DVec3, q: DVec3| bezier_polynomial(&[p, q], u);
                Some([line(*from, *from + *along), line(*s, *s * *factor), line(*t, *t * *factor)])
            }
            Self::Twist { .. } | Self::Arc { .. } => None,
        }
    }

    /// The curves at `u`.
    pub(super) fn stand(&self, u: f64) -> Stand {
        match self {
            Self::Ribbon { points, levels } => {
                let (c, dc) = bezier(points.iter().copied(), u);
                let mut out = Stand { at: [c, DVec3::ZERO, DVec3::ZERO], slope: [dc, DVec3::ZERO, DVec3::ZERO] };
                for handles in levels {
                    for k in 0..2 {
                        let (s, ds) = bezier(handles.iter().map(|h| h[k]), u);
                        out.at[k + 1] += s;
                        out.slope[k + 1] += ds;
                    }
                }
                out
            }
            Self::Twist { from, along, sides: [s, t], angle } => {
                let (sin, cos) = (angle * u).sin_cos();
                let (side, up) = (*s * cos + *t * sin, *t * cos - *s * sin);
                Stand { at: [*from + *along * u, side, up], slope: [*along, up * *angle, -side * *angle] }
            }
            Self::Taper { from, along, sides: [s, t], factor } => {
                let k = 1.0 + (factor - 1.0) * u;
                let rate = factor - 1.0;
                Stand { at: [*from + *along * u, *s * k, *t * k], slope: [*along, *s * rate, *t * rate] }
            }
            Self::Arc { from, along, sides: [s, t], angle } => {
                let (sin, cos) = (angle * u).sin_cos();
                let (direction, radius) = (along.normalize_or_zero(), along.length() / angle);
                // 1 − cos without cancellation.
                let rise = 2.0 * (0.5 * angle * u).sin().powi(2);
                let center = *from + (direction * sin + *s * rise) * radius;
                let (tangent, side) = (direction * cos + *s * sin, *s * cos - direction * sin);
                Stand { at: [center, side, *t], slope: [tangent * along.length(), -tangent * *angle, DVec3::ZERO] }
            }
        }
    }
}

/// The same curve with `n` control points.
fn elevated(mut curve: Vec<DVec3>, n: usize) -> Vec<DVec3> {
    while curve.len() < n {
        let k = curve.len() as f64;
        let inner = (1..curve.len()).map(|i| curve[i - 1].lerp(curve[i], (k - i as f64) / k));
        curve = std::iter::once(curve[0]).chain(inner).chain(curve.last().copied()).collect();
    }
    curve
}

/// A Bézier curve as polynomials, by de Casteljau's algorithm.
fn bezier_polynomial(points: &[DVec3], u: &Poly3) -> [Poly3; 3] {
    [0, 1, 2].map(|a| {
        let mut row: Vec<Poly3> = points.iter().map(|p| Poly3::constant(p[a])).collect();
        for level in (1..row.len()).rev() {
            for i in 0..level {
                row[i] = row[i].plus(1.0, &row[i + 1].plus(-1.0, &row[i]).times(u));
            }
        }
        row.swap_remove(0)
    })
}

/// A Bézier curve of degree up to 3 and its derivative, by de Casteljau's algorithm.
fn bezier(points: impl Iterator<Item = DVec3>, u: f64) -> (DVec3, DVec3) {
    let mut row = [DVec3::ZERO; 4];
    let mut n = 0;
    for (slot, p) in row.iter_mut().zip(points) {
        *slot = p;
        n += 1;
    }
    let mut slope = DVec3::ZERO;
    for level in (1..n).rev() {
        slope = (row[1] - row[0]) * (n - 1) as f64;
        for i in 0..level {
            row[i] = row[i] + (row[i + 1] - row[i]) * u;
        }
    }
    (row[0], slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Tensor;
    use crate::map::counted::{Counted, operations};

    /// The 9, 27 and 54 products and sums of the paper's table 1, with the legs q − p given as the paper takes them, and those of the
    /// three curves of one degree that batches evaluate.
    #[test]
    fn operations_of_a_skeleton() {
        for (n, published) in [(1usize, 9), (2, 27), (3, 54)] {
            let counts = operations(|| {
                let mut row = vec![[Counted(1.0); 3]; n + 1];
                let [u, v, w] = [0.3, 0.4, 0.5].map(Counted);
                for level in 1..=n {
                    for i in 0..=n - level {
                        let leg: [Counted; 3] = std::array::from_fn(|k| Counted(row[i + 1][k].0 - row[i][k].0));
                        row[i] = std::array::from_fn(|k| row[i][k] + u * leg[k] + v * 0.5 + w * 0.25);
                    }
                }
            });
            assert_eq!(counts, [published, published, 0], "degree {n}");
            let points = (0..=n).map(|i| DVec3::new(i as f64, 1.0, 0.0)).collect();
            let ribbon = Strip::Ribbon { points, levels: vec![vec![[DVec3::Y, DVec3::Z]; n]] };
            let tensor = Tensor::bernstein([n + 1, 1, 1], ribbon.bernstein().unwrap());
            let ours = operations(|| {
                let c = tensor.value([0.3, 0.0, 0.0].map(Counted));
                let _: [Counted; 3] = std::array::from_fn(|k| c[k] + c[k + 3] * 0.4 + c[k + 6] * 0.5);
            });
            assert_eq!(ours, [9 * n + 6, 9 * n + 6, 0], "degree {n}");
        }
    }

    #[test]
    fn bezier_curves_have_their_derivatives() {
        let p = [DVec3::ZERO, DVec3::new(1.0, 2.0, 0.0), DVec3::new(3.0, -1.0, 1.0), DVec3::new(4.0, 0.0, 5.0)];
        for n in 1..=4 {
            for u in [-0.2, 0.0, 0.3, 1.0] {
                let (at, slope) = bezier(p[..n].iter().copied(), u);
                let truth: DVec3 = (0..n)
                    .map(|i| {
                        let binomial = [[1, 0, 0, 0], [1, 1, 0, 0], [1, 2, 1, 0], [1, 3, 3, 1]][n - 1][i];
                        p[i] * (f64::from(binomial) * f64::powi(u, i as i32) * f64::powi(1.0 - u, (n - 1 - i) as i32))
                    })
                    .sum();
                let h = 1e-6;
                let difference =
                    (bezier(p[..n].iter().copied(), u + h).0 - bezier(p[..n].iter().copied(), u - h).0) / (2.0 * h);
                assert!((at - truth).length() < 1e-14 && (slope - difference).length() < 1e-8, "{n} {u}");
            }
        }
    }
}
