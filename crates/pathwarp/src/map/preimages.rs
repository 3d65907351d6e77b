//! All preimages of a point under maps whose coordinates are quotients of polynomials.
//!
//! With F = (X, Y)/W, the preimages of q are the common zeros of g₁ = X − qₓ·W and g₂ = Y − q_y·W (Sederberg, Goldman, Wang,
//! CAGD 44, 2016, equations 3 and 4), at most 2mn for degree m×n. Substituting 1/u for u takes |u| ≥ 1 to |u| ≤ 1: four squares hold the
//! plane. In each, both polynomials are subdivided in Bernstein form, whose coefficients bound them: a square on which one of them, or of
//! their combinations by the inverse Jacobian, has coefficients of one sign has no zero; one on which the Jacobian of these combinations
//! is diagonally dominant has at most one, which Newton's method finds (E. Sherbrooke, N. Patrikalakis, *Computation of the solutions of
//! nonlinear polynomial systems*, CAGD 10, 1993). Up to rounding, no preimage is missed.

use super::patch::product_of_powers;
use super::rational_bezier::binomials;
use super::{Creases, Map, NewtonInverse};
use kurbo::{Affine, Point, Rect, Vec2};
use std::cell::LazyCell;
use std::sync::Arc;

/// Preimages closer than this share of their coordinates coincide.
const SAME: f64 = 1e-7;
/// Zeros further than this from the center, in units of the polynomials' variables, count as lying at infinity.
const FAR: f64 = 1e6;
/// The width of squares that are not divided further: their zero is a point on a fold.
const NARROW: f64 = 1e-8;
/// The number of squares, far above what finitely many zeros need, after which the zeros count as infinitely many.
const MAX_SQUARES: usize = 20_000;

/// A map as X, Y and W in powers of u and v.
pub(crate) struct Polynomials {
    /// The affine function from the source point to (u, v).
    pub(crate) pre: Affine,
    /// The origin of the image: added to (X, Y)/W.
    pub(crate) origin: Point,
    /// The coefficients of uⁱvʲ as (i, j, [X, Y, W]).
    pub(crate) terms: Vec<(usize, usize, [f64; 3])>,
}

/// Two polynomials on a square, as Bernstein coefficients: rows along v of columns along u.
#[derive(Clone)]
struct Square {
    /// The ranges of u and v.
    ranges: [[f64; 2]; 2],
    /// The coefficients of g₁ and g₂.
    g: Vec<Vec<Vec2>>,
}

impl Polynomials {
    /// The points that `map`, which these polynomials describe, takes to `q`. `None` if there are infinitely many.
    pub(crate) fn preimages(&self, map: &dyn Map, q: Point) -> Option<Vec<Point>> {
        let (m, n) = self.terms.iter().fold((0, 0), |(m, n), t| (m.max(t.0), n.max(t.1)));
        let mut g = vec![vec![Vec2::ZERO; m + 1]; n + 1];
        for (i, j, [x, y, w]) in &self.terms {
            g[*j][*i] += Vec2::new(*x, *y) - (q - self.origin) * *w;
        }
        let (mut found, mut count) = (Vec::new(), 0);
        for far in [[false, false], [true, false], [false, true], [true, true]] {
            let mut g = g.clone();
            if far[0] {
                g.iter_mut().for_each(|row| row.reverse());
            }
            if far[1] {
                g.reverse();
            }
            let rows = g.iter().map(|row| bernstein(row)).collect::<Vec<_>>();
            let columns = transposed(&rows).iter().map(|column| bernstein(column)).collect::<Vec<_>>();
            let mut squares = vec![Square { ranges: [[-1.0, 1.0]; 2], g: transposed(&columns) }];
            while let Some(square) = squares.pop() {
                count += 1;
                if count > MAX_SQUARES {
                    return None;
                }
                let is_at_infinity = |k: usize| far[k] && square.ranges[k].iter().all(|c| c.abs() <= 1.0 / FAR);
                if is_at_infinity(0) || is_at_infinity(1) || square.has_no_zero() {
                    continue;
                }
                match square.only_zero(&Chart { polynomials: self, far }, map, q) {
                    Some(p) => found.push(p),
                    None if square.is_narrow() => {}
                    None => squares.extend(square.halves()),
                }
            }
        }
        let back = self.pre.inverse();
        Some(distinct(found, back * Point::ORIGIN, back.determinant().abs().sqrt()))
    }
}

/// Sorts points and drops those that repeat, by their distances from the center of an area and by its size.
fn distinct(mut points: Vec<Point>, center: Point, size: f64) -> Vec<Point> {
    let mut out: Vec<Point> = Vec::new();
    points.retain(|p| p.is_finite());
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    for p in points {
        if out.iter().all(|o| o.distance(p) > SAME * (size + p.distance(center))) {
            out.push(p);
        }
    }
    out
}

/// For each point, its preimages under `map`: all of them if they are known ([`Map::preimages`]), or else those that the map's inverse and
/// Newton's method find over `area` and half its size around it. Sorted by abscissa, without points where the map is not defined.
#[must_use]
pub fn preimages(map: &Arc<dyn Map>, qs: &[Point], area: Rect) -> Vec<Vec<Point>> {
    let creases = Creases::of_map(map);
    let size = area.width() + area.height();
    let search = LazyCell::new(|| {
        let area = area.inflate(0.5 * area.width(), 0.5 * area.height());
        (NewtonInverse::over(Arc::clone(map), area, 0.0), SAME * size)
    });
    let searched = |q: Point| {
        let mut found: Vec<Point> =
            map.inverse().map(|back| back.point(q)).filter(|p| p.is_finite()).into_iter().collect();
        let (inverse, near) = &*search;
        while let Some(next) = inverse.solve_where(q, |p| found.iter().all(|f| f.distance(p) > *near)) {
            found.push(next.p);
        }
        found
    };
    let all = |q: &Point| {
        let found = distinct(map.preimages(*q).unwrap_or_else(|| searched(*q)), area.center(), size);
        found.into_iter().filter(|p| creases.defined_at(*p)).collect()
    };
    qs.iter().map(all).collect()
}

/// Returns the Bernstein coefficients over [−1, 1] of Σ cₖ·xᵏ: the ith is Σₖ cₖ·tᵢₖ / C(n, k), with Σₖ tᵢₖ·xᵏ = (1 − x)ⁿ⁻ⁱ(1 + x)ⁱ.
fn bernstein(powers: &[Vec2]) -> Vec<Vec2> {
    let n = powers.len() - 1;
    let binomials = binomials(n);
    let coefficient = |i: usize| {
        let terms = product_of_powers(1.0, i, n - i).into_iter().zip(&binomials).zip(powers);
        terms.fold(Vec2::ZERO, |sum, ((t, b), c)| sum + *c * (t / b))
    };
    (0..=n).map(coefficient).collect()
}

fn transposed(rows: &[Vec<Vec2>]) -> Vec<Vec<Vec2>> {
    (0..rows[0].len()).map(|i| rows.iter().map(|r| r[i]).collect()).collect()
}

/// Coordinates for a square of the (u, v) plane. Where `far` is `true`, 1/u or 1/v takes the place of u or v.
struct Chart<'a> {
    polynomials: &'a Polynomials,
    far: [bool; 2],
}

impl Chart<'_> {
    /// Converts coordinates of the chart to u and v, and back.
    fn convert(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [if self.far[0] { 1.0 / u } else { u }, if self.far[1] { 1.0 / v } else { v }]
    }

    /// The source point at coordinates of the chart.
    fn source(&self, at: [f64; 2]) -> Point {
        self.polynomials.pre.inverse() * Point::from(<(f64, f64)>::from(self.convert(at)))
    }

    /// Returns `true` if W exceeds its rounding error. At a base point, which is no preimage, all three polynomials vanish.
    fn is_regular(&self, at: [f64; 2]) -> bool {
        let [u, v] = self.convert(at);
        let terms = self.polynomials.terms.iter().map(|(i, j, c)| c[2] * u.powi(*i as i32) * v.powi(*j as i32));
        let (w, size) = terms.fold((0.0, 0.0), |(w, size), t| (w + t, size + f64::abs(t)));
        f64::abs(w) > 1e-6 * size
    }

    /// The chart's coordinates of a source point.
    fn coordinates(&self, p: Point) -> [f64; 2] {
        let uv = self.polynomials.pre * p;
        self.convert([uv.x, uv.y])
    }
}

impl Square {
    fn coefficients(&self) -> impl Iterator<Item = Vec2> {
        self.g.iter().flatten().copied()
    }

    /// The inverse of the mean Jacobian, as two rows, and `true` if the Jacobian of the combinations with it is diagonally dominant.
    fn straightened(&self) -> Option<([Vec2; 2], bool)> {
        let (m, n) = ((self.g[0].len() - 1) as f64, (self.g.len() - 1) as f64);
        let across = |k: f64, g: &[Vec<Vec2>]| {
            g.iter().flat_map(|r| r.windows(2)).map(|w| (w[1] - w[0]) * k).collect::<Vec<Vec2>>()
        };
        let slopes = [across(m, &self.g), across(n, &transposed(&self.g))];
        let [du, dv] = slopes.each_ref().map(|s| s.iter().fold(Vec2::ZERO, |a, b| a + *b) / s.len() as f64);
        let det = du.cross(dv);
        let rows = [Vec2::new(dv.y, -dv.x) / det, Vec2::new(-du.y, du.x) / det];
        let is_dominant = |k: usize| {
            let least = slopes[k].iter().map(|s| rows[k].dot(*s)).fold(f64::INFINITY, f64::min);
            slopes[1 - k].iter().all(|s| rows[k].dot(*s).abs() < least)
        };
        (rows[0].is_finite() && rows[1].is_finite()).then(|| (rows, is_dominant(0) && is_dominant(1)))
    }

    /// Returns `true` if a polynomial, or a combination by the inverse Jacobian, has coefficients of one sign.
    fn has_no_zero(&self) -> bool {
        /// The rounding error of the coefficients, as a share of the largest.
        const NOISE: f64 = 1e-14;
        let one_sign = |row: Vec2| {
            let noise =
                NOISE * self.coefficients().map(|g| (row.x * g.x).abs() + (row.y * g.y).abs()).fold(0.0, f64::max);
            self.coefficients().all(|g| row.dot(g) > noise) || self.coefficients().all(|g| row.dot(g) < -noise)
        };
        one_sign(Vec2::new(1.0, 0.0))
            || one_sign(Vec2::new(0.0, 1.0))
            || self.straightened().is_some_and(|(rows, _)| rows.into_iter().any(one_sign))
    }

    /// The zero in the square, if it can have only one and Newton's method finds it, or if it is too narrow to be divided.
    fn only_zero(&self, chart: &Chart<'_>, map: &dyn Map, q: Point) -> Option<Point> {
        const MAX_STEPS: usize = 40;
        const ROUNDING: f64 = 1e-9;
        let center = self.ranges.map(|[a, b]| 0.5 * (a + b));
        if self.is_narrow() {
            return Some(chart.source(center)).filter(|_| chart.is_regular(center));
        }
        if !self.straightened()?.1 {
            return None;
        }
        let (mut p, mut last) = (chart.source(center), f64::INFINITY);
        for _ in 0..MAX_STEPS {
            let jet = map.jet(p);
            let step = jet.inverted(p).push(q - jet.p);
            if !(step.is_finite() && (step.hypot() < last || last == f64::INFINITY)) {
                break;
            }
            (p, last) = (p + step, step.hypot());
        }
        let at = chart.coordinates(p);
        let is_in_range = |k: usize| {
            let [from, to] = self.ranges[k];
            at[k] >= from - ROUNDING && at[k] <= to + ROUNDING
        };
        (last <= ROUNDING * (p.to_vec2().hypot() + 1.0) && is_in_range(0) && is_in_range(1)).then_some(p)
    }

    fn is_narrow(&self) -> bool {
        self.ranges.iter().all(|[a, b]| b - a < NARROW)
    }

    /// The two halves across the longer side.
    fn halves(self) -> [Self; 2] {
        let [w, h] = self.ranges.map(|[a, b]| b - a);
        let k = usize::from(h > w);
        let [a, b] = self.ranges[k];
        let middle = 0.5 * (a + b);
        let rows = if k == 0 { self.g } else { transposed(&self.g) };
        let (mut first, mut second) = (Vec::new(), Vec::new());
        for mut row in rows {
            // In de Casteljau's triangle, the left side is the first half, the right side the second.
            let mut left = vec![row[0]];
            for n in (1..row.len()).rev() {
                (0..n).for_each(|i| row[i] = (row[i] + row[i + 1]) * 0.5);
                left.push(row[0]);
            }
            first.push(left);
            second.push(row);
        }
        [(first, [a, middle]), (second, [middle, b])].map(|(rows, range)| {
            let mut ranges = self.ranges;
            ranges[k] = range;
            Self { ranges, g: if k == 0 { rows } else { transposed(&rows) } }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Lattice, LatticeMap};

    /// Pseudo-random numbers in [-1, 1).
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
        (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Equation 2, by de Casteljau's algorithm over the control points in rows.
    fn by_definition(points: &[Vec<Point>], s: f64, t: f64) -> Point {
        fn casteljau(mut row: Vec<Point>, t: f64) -> Point {
            while row.len() > 1 {
                row = row.windows(2).map(|w| w[0].lerp(w[1], t)).collect();
            }
            row[0]
        }
        casteljau(points.iter().map(|row| casteljau(row.clone(), s)).collect(), t)
    }

    /// A polynomial map of degree m×n takes 2mn complex points to each point, and complex preimages come in pairs.
    #[test]
    fn every_preimage_is_one_the_known_one_is_among_them_and_their_number_is_even() {
        let mut state = 5;
        for k in 0..400 {
            let (m, n) = (1 + k % 3, 1 + k / 3 % 3);
            let mut lattice = Lattice::regular(Rect::new(0.0, 0.0, 1.0, 1.0), [m, n], [1, 1]);
            let mut points = vec![vec![Point::ZERO; m + 1]; n + 1];
            for (j, row) in points.iter_mut().enumerate() {
                for (i, p) in row.iter_mut().enumerate() {
                    *p = Point::new(2.0 * random(&mut state), 2.0 * random(&mut state));
                    lattice.place(i, j, *p);
                }
            }
            let p = Point::new(2.0 * random(&mut state), 2.0 * random(&mut state));
            let q = by_definition(&points, p.x, p.y);
            let found = LatticeMap::new(&lattice, true).preimages(q).unwrap();
            assert!(found.iter().any(|f| f.distance(p) < 1e-8), "{k}: {p:?} {found:?}");
            assert_eq!(found.len() % 2, 0, "{k}: {m}x{n} {p:?} {found:?}");
            assert!(found.len() <= 2 * m * n);
            for f in found {
                let size = 1.0 + f.to_vec2().hypot().powi((m + n) as i32);
                assert!(by_definition(&points, f.x, f.y).distance(q) < 1e-9 * size, "{k}: {f:?}");
            }
        }
    }

    /// The map (x² + y², x·y): four points satisfy x² + y² = 5, x·y = 2; on the fold x = y two preimages meet.
    #[test]
    fn folds_and_whole_curves() {
        let map = super::super::from_fn(|p| Point::new(p.x * p.x + p.y * p.y, p.x * p.y));
        let terms =
            vec![(2, 0, [1.0, 0.0, 0.0]), (0, 2, [1.0, 0.0, 0.0]), (1, 1, [0.0, 1.0, 0.0]), (0, 0, [0.0, 0.0, 1.0])];
        let squares = Polynomials { pre: Affine::IDENTITY, origin: Point::ZERO, terms };
        let found = squares.preimages(&map, Point::new(5.0, 2.0)).unwrap();
        let expected = [(-2.0, -1.0), (-1.0, -2.0), (1.0, 2.0), (2.0, 1.0)].map(Point::from);
        assert_eq!(found.len(), 4);
        assert!(found.iter().zip(expected).all(|(f, e)| f.distance(e) < 1e-9), "{found:?}");
        let fold = squares.preimages(&map, Point::new(2.0, 1.0)).unwrap();
        assert_eq!(fold.len(), 2, "{fold:?}");
        assert!(fold[1].distance(Point::new(1.0, 1.0)) < 1e-6, "{fold:?}");
        // A line that shrinks to a point has infinitely many preimages.
        let terms = vec![(1, 0, [1.0, 0.0, 0.0]), (1, 1, [0.0, 1.0, 0.0]), (0, 0, [0.0, 0.0, 1.0])];
        let pinch = Polynomials { pre: Affine::IDENTITY, origin: Point::ZERO, terms };
        let map = super::super::from_fn(|p| Point::new(p.x, p.x * p.y));
        assert_eq!(pinch.preimages(&map, Point::ZERO), None);
        assert_eq!(pinch.preimages(&map, Point::new(2.0, 1.0)).unwrap(), [Point::new(2.0, 0.5)]);
    }
}
