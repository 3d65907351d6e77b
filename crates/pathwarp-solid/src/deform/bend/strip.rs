//! A piece of a bend: F(u, v, w) = C(u) + v·S(u) + w·T(u).

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
