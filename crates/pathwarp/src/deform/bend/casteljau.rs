//! The generalised algorithm of de Casteljau: every step an affine map of the whole plane (or space) instead of a point on a
//! segment.
//!
//! `p[i,j] = p[i,j−1] + u·(p[i+1,j−1] − p[i,j−1]) + v·s[i,j] (+ w·t[i,j] in space)`, the s and t being the *handles* of level j
//! (equations 2 and 3). Every term with v is linear in it and stays so through the levels above: in the plane
//! F(u, v) = C(u) + v·S(u), C the Bézier curve of the control points and S the sum over the levels j of the Bézier curves of
//! degree n−j of their handles.

use crate::map::polynomial::bernstein::Scaled;
use crate::map::{RationalBezier, Real};
use kurbo::{Point, Vec2};

/// Returns one step's affine map at u: p + u₀·(q − p) + Σ uₖ·hₖ.
fn step<S: Real, const D: usize>(p: [S; D], q: [S; D], handles: &[[f64; D]], u: &[S]) -> [S; D] {
    std::array::from_fn(|i| {
        let along = p[i] + u[0] * (q[i] - p[i]);
        handles.iter().zip(&u[1..]).fold(along, |sum, (h, v)| sum + *v * S::from(h[i]))
    })
}

/// Returns the point at parameters `u` for a control polygon and handles: `handles(level, i)`, levels counted from 1.
fn eval<'a, S: Real, const D: usize>(
    row: &mut [[S; D]],
    handles: impl Fn(usize, usize) -> &'a [[f64; D]],
    u: &[S],
) -> [S; D] {
    for level in 1..row.len() {
        for i in 0..row.len() - level {
            row[i] = step(row[i], row[i + 1], handles(level, i), u);
        }
    }
    row[0]
}

/// A Bézier piece of degree up to 3 with its handles.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ribbon {
    /// The control points, two to four.
    points: Vec<Point>,
    /// The handles, level by level: n of the first, n−1 of the second ... The last levels may be omitted.
    levels: Vec<Vec<[f64; 2]>>,
}

/// Limit on control points.
const MAX_POINTS: usize = 4;

impl Ribbon {
    /// Creates a piece; `None` unless there are two to four points, and n+1−j handles on level j.
    pub(super) fn new(points: Vec<Point>, levels: &[Vec<Vec2>]) -> Option<Self> {
        let n = points.len().checked_sub(1)?;
        let fits = (2..=MAX_POINTS).contains(&points.len()) && levels.len() <= n;
        if !fits || levels.iter().enumerate().any(|(j, l)| l.len() != n - j) {
            return None;
        }
        let levels = levels.iter().map(|l| l.iter().map(|h| [h.x, h.y]).collect()).collect();
        Some(Self { points, levels })
    }

    pub(super) fn degree(&self) -> usize {
        self.points.len() - 1
    }

    /// Returns F(u, v).
    pub(super) fn at<S: Real>(&self, u: S, v: S) -> [S; 2] {
        let mut row = [[S::from(0.0); 2]; MAX_POINTS];
        for (r, p) in row.iter_mut().zip(&self.points) {
            *r = [S::from(p.x), S::from(p.y)];
        }
        // Levels without handles are free.
        let handles = |level: usize, i: usize| match self.levels.get(level - 1) {
            Some(l) => std::slice::from_ref(&l[i]),
            None => &[],
        };
        eval(&mut row[..self.points.len()], handles, &[u, v])
    }

    /// Returns S(u) at an end: 0 or 1.
    pub(super) fn side_at_end(&self, end: usize) -> Vec2 {
        let pick = |l: &Vec<[f64; 2]>| if end == 0 { l.first().copied() } else { l.last().copied() };
        self.levels.iter().filter_map(pick).fold(Vec2::ZERO, |a, [x, y]| a + Vec2::new(x, y))
    }

    /// Returns the exact image of a curve in (u, v), of n times its degree.
    pub(super) fn image(&self, curve: &RationalBezier) -> RationalBezier {
        let n = self.degree();
        let coordinate = |k: usize| Scaled::new(curve.points.iter().map(|p| p[k]));
        let (u, v, w) = (coordinate(0), coordinate(1), coordinate(2));
        let rest = {
            let mut r = w.clone();
            r.add_scaled(-1.0, &u);
            r
        };
        // Homogeneous Bernstein terms: C(k, i)·uⁱ(w−u)^(k−i), times v for handles, times powers of w to raise the degree.
        let (up, rp, wp) = (u.powers(n), rest.powers(n), w.powers(n));
        let term = |k: usize, i: usize| up[i].times(&rp[k - i]);
        let (mut x, mut y) = (Scaled::zero(n * curve.degree()), Scaled::zero(n * curve.degree()));
        let mut add = |at: Vec2, k: usize, i: usize, t: &Scaled| {
            let c = binomial(k, i);
            x.add_scaled(at.x * c, t);
            y.add_scaled(at.y * c, t);
        };
        for (i, p) in self.points.iter().enumerate() {
            add(p.to_vec2(), n, i, &term(n, i));
        }
        for (j, level) in self.levels.iter().enumerate() {
            let k = n - j - 1;
            for (i, h) in level.iter().enumerate() {
                add(Vec2::new(h[0], h[1]), k, i, &term(k, i).times(&v).times(&wp[j]));
            }
        }
        let polynomial = curve.is_polynomial();
        let points = x.coefficients().into_iter().zip(y.coefficients()).zip(wp[n].coefficients());
        RationalBezier { points: points.map(|((x, y), w)| [x, y, if polynomial { 1.0 } else { w }]).collect() }
    }
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::counted::{Counted, operations};

    /// Table 1 of the paper: 9, 27 and 54 products and as many sums per point in space for degrees 1, 2 and 3. The paper takes
    /// q − p as given; computing it costs three differences a step, which Table 1 leaves out. In the plane a step is 4 and 4.
    #[test]
    fn operation_counts_are_those_of_table_1() {
        for (degree, expected) in [(1, 9), (2, 27), (3, 54)] {
            let point = |i: usize| [i as f64, 1.0, 2.0].map(Counted);
            let handles = [[0.5, 1.0, 0.0], [0.0, 0.3, 1.0]];
            let [products, sums, differences] = operations(|| {
                let mut row: Vec<_> = (0..=degree).map(point).collect();
                let _ = eval(&mut row, |_, _| &handles[..], &[0.3, 0.4, 0.5].map(Counted));
            });
            assert_eq!((products, sums, differences), (expected, expected, expected / 3), "degree {degree}");

            let levels: Vec<_> = (1..=degree).map(|j| vec![Vec2::new(1.0, 2.0); degree + 1 - j]).collect();
            let ribbon = Ribbon::new((0..=degree).map(|i| Point::new(i as f64, 1.0)).collect(), &levels).unwrap();
            let [products, ..] = operations(|| {
                let _ = ribbon.at(Counted(0.3), Counted(0.4));
            });
            assert_eq!(products, 4 * degree * (degree + 1) / 2);
        }
    }

    fn ribbon() -> Ribbon {
        let points = [(0.0, 50.0), (30.0, 0.0), (70.0, 20.0), (100.0, 60.0)].map(Point::from).to_vec();
        Ribbon::new(points, &levels()).unwrap()
    }

    fn levels() -> Vec<Vec<Vec2>> {
        vec![
            [(0.0, -40.0), (5.0, -50.0), (-8.0, -30.0)].map(Vec2::from).to_vec(),
            [(3.0, 1.0), (-2.0, 4.0)].map(Vec2::from).to_vec(),
            vec![Vec2::new(6.0, -7.0)],
        ]
    }

    /// Without handles the algorithm is de Casteljau's own; with them F is linear in v, with the stated S.
    #[test]
    fn handles_add_v_times_a_curve_of_lower_degree() {
        let r = ribbon();
        let curve = kurbo::CubicBez::new(r.points[0], r.points[1], r.points[2], r.points[3]);
        for (u, v) in [(0.0, 0.0), (0.3, 0.8), (1.0, -1.0), (1.2, 2.0)] {
            let [x, y] = r.at(u, v);
            let w = 1.0 - u;
            let l = levels();
            let side =
                (l[0][0] * w * w + l[0][1] * 2.0 * u * w + l[0][2] * u * u) + (l[1][0] * w + l[1][1] * u) + l[2][0];
            let expected = kurbo::ParamCurve::eval(&curve, u) + side * v;
            assert!(expected.distance(Point::new(x, y)) < 1e-12, "{u} {v}");
        }
        assert!((r.side_at_end(0) - Vec2::new(9.0, -46.0)).hypot() < 1e-14);
    }

    #[test]
    fn images_are_exact() {
        let r = ribbon();
        for source in [
            RationalBezier::polynomial(&[Point::new(0.1, 0.0), Point::new(0.9, 0.7)]),
            RationalBezier { points: vec![[0.1, 0.2, 1.0], [0.5, 0.1, 0.7], [0.4, 0.9, 1.3]] },
        ] {
            let image = r.image(&source);
            assert_eq!(image.degree(), 3 * source.degree());
            for i in 0..=10 {
                let t = f64::from(i) / 10.0;
                let p = source.eval(t);
                let [x, y] = r.at(p.x, p.y);
                assert!(image.eval(t).distance(Point::new(x, y)) < 1e-11, "{t}");
            }
        }
    }
}
