//! A rational tensor-product Bézier patch as a map of the plane.
//!
//! > F(s,t) = Σⱼ Σᵢ Bᵐᵢ(s) Bⁿⱼ(t) wᵢⱼ Pᵢⱼ / Σⱼ Σᵢ Bᵐᵢ(s) Bⁿⱼ(t) wᵢⱼ
//!
//! with s, t running from 0 to 1 across a box. It is evaluated in powers of u = 2s − 1 and v = 2t − 1: about the center of the box the
//! change of basis amplifies rounding errors by at most 2ᵐ·2ⁿ (3ᵐ·3ⁿ, with cancellation, in powers of s and t), and its
//! coefficients are exact. A polynomial patch is stored as the displacement F(p) − p, so that points that do not move are not
//! rounded. Horner's scheme runs on a whole batch of points.

use super::rational_bezier::{Scaled, binomials};
use super::{Class, Cost, Crease, Creases, Jet, Level, Map, Polynomials, RationalBezier};
use kurbo::{Affine, Point, Rect, Vec2};
use std::sync::Arc;

/// The number of points in a batch: two AVX registers of four, or four SSE2 registers of two.
const WIDTH: usize = 8;

/// The number of jets evaluated together: with three results for each coordinate, half as many as points fit the registers.
const JET_WIDTH: usize = WIDTH / 2;
/// Coefficients below this share of the largest are rounding noise.
const NOISE: f64 = 1e-15;

/// A rational tensor-product map of the plane.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Patch {
    /// The box over which s and t run from 0 to 1.
    pub(crate) rect: Rect,
    /// u = (x − center.x)·scale.x, v = (y − center.y)·scale.y.
    center: Point,
    scale: Vec2,
    /// The number of terms in a row: powers of u.
    width: usize,
    /// The number of rows: powers of v.
    height: usize,
    /// Coefficients, row by row: of the displacement for a polynomial patch, else of X relative to the center.
    x: Vec<f64>,
    /// Coefficients of Y, row by row, likewise.
    y: Vec<f64>,
    /// Coefficients of W; empty for a polynomial patch.
    w: Vec<f64>,
    /// `true` if the denominator may vanish inside the box.
    may_vanish: bool,
    /// `true` if the patch is used only inside its box.
    bounded: bool,
}

impl Patch {
    /// The polynomial patch over `rect` whose control points are displaced by `moves` from their regular positions: (n+1) rows of
    /// (m+1), s across, t down.
    #[must_use]
    pub(crate) fn polynomial(rect: Rect, degree: [usize; 2], moves: &[Vec2]) -> Self {
        let plane = |f: fn(&Vec2) -> f64| powers(degree, &moves.iter().map(f).collect::<Vec<_>>());
        Self::from_planes(rect, degree, plane(|v| v.x), plane(|v| v.y), Vec::new())
    }

    /// The rational patch over `rect` with homogeneous control points (x·w, y·w, w): (n+1) rows of (m+1), s across, t down. Equal
    /// weights give a polynomial patch.
    #[must_use]
    pub(crate) fn rational(rect: Rect, degree: [usize; 2], points: &[[f64; 3]]) -> Self {
        let (max, min) = points.iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(a, b), p| (a.max(p[2]), b.min(p[2])));
        if max - min <= 4.0 * NOISE * max {
            let displacement = |(k, p): (usize, &[f64; 3])| {
                let (i, j) = (k % (degree[0] + 1), k / (degree[0] + 1));
                Point::new(p[0] / p[2], p[1] / p[2]) - regular_point(rect, degree, i, j)
            };
            let moves: Vec<Vec2> = points.iter().enumerate().map(displacement).collect();
            return Self::polynomial(rect, degree, &moves);
        }
        let c = rect.center();
        let plane = |f: &dyn Fn(&[f64; 3]) -> f64| powers(degree, &points.iter().map(f).collect::<Vec<_>>());
        let (x, y) = (plane(&|p| p[0] - c.x * p[2]), plane(&|p| p[1] - c.y * p[2]));
        let mut out = Self::from_planes(rect, degree, x, y, plane(&|p| p[2]));
        out.may_vanish = min <= 0.0;
        out
    }

    /// The patch with these coefficients, without those that are rounding noise.
    fn from_planes(rect: Rect, degree: [usize; 2], mut x: Vec<f64>, mut y: Vec<f64>, mut w: Vec<f64>) -> Self {
        let (m, n) = (degree[0] + 1, degree[1] + 1);
        for planes in [&mut [&mut x, &mut y][..], &mut [&mut w]] {
            let size = planes.iter().flat_map(|p| p.iter()).fold(0.0, |a: f64, v| a.max(v.abs()));
            for v in planes.iter_mut().flat_map(|p| p.iter_mut()).filter(|v| v.abs() <= NOISE * size) {
                *v = 0.0;
            }
        }
        let used = |i: usize, j: usize| [&x, &y, &w].iter().any(|p| p.get(j * m + i).is_some_and(|v| *v != 0.0));
        let width = (1..m).rev().find(|&i| (0..n).any(|j| used(i, j))).unwrap_or(0) + 1;
        let height = (1..n).rev().find(|&j| (0..m).any(|i| used(i, j))).unwrap_or(0) + 1;
        let cut =
            |p: &[f64]| -> Vec<f64> { p.chunks(m).take(height).flat_map(|row| row[..width].iter().copied()).collect() };
        let (center, scale) = (rect.center(), Vec2::new(2.0 / rect.width(), 2.0 / rect.height()));
        let [x, y, w] = [&x, &y, &w].map(|p| cut(p));
        Self { rect, center, scale, width, height, x, y, w, may_vanish: false, bounded: false }
    }

    /// Marks the patch as used only inside its box.
    #[must_use]
    pub(crate) fn bounded(self) -> Self {
        Self { bounded: true, ..self }
    }

    /// Returns `true` if the denominator is constant.
    #[must_use]
    pub(crate) fn is_polynomial(&self) -> bool {
        self.w.is_empty()
    }

    /// Returns `true` if the denominator may vanish where the patch is used: with a weight that is not positive, or outside the box.
    pub(crate) fn has_edge(&self) -> bool {
        !self.is_polynomial() && (self.may_vanish || !self.bounded)
    }

    /// The coordinates (u, v) of L points.
    #[inline(always)]
    fn local<const L: usize>(&self, p: [Point; L]) -> [[f64; L]; 2] {
        let mut out = [[0.0; L]; 2];
        for i in 0..L {
            out[0][i] = (p[i].x - self.center.x) * self.scale.x;
            out[1][i] = (p[i].y - self.center.y) * self.scale.y;
        }
        out
    }

    /// The polynomial `plane` at L points. `W` is its width, or 0 for any width; the compiler unrolls known widths.
    #[inline(always)]
    fn values<const L: usize, const W: usize>(&self, plane: &[f64], [u, v]: &[[f64; L]; 2]) -> [f64; L] {
        let width = if W == 0 { self.width } else { W };
        let across = |row: &[f64]| {
            let mut r = [row[width - 1]; L];
            for k in (0..width - 1).rev() {
                for i in 0..L {
                    r[i] = r[i] * u[i] + row[k];
                }
            }
            r
        };
        let mut rows = plane.chunks_exact(width).rev();
        let mut out = rows.next().map_or([0.0; L], across);
        for row in rows {
            let r = across(row);
            for i in 0..L {
                out[i] = out[i] * v[i] + r[i];
            }
        }
        out
    }

    /// Value, ∂/∂u and ∂/∂v of `plane` at L points.
    #[inline(always)]
    fn slopes<const L: usize, const W: usize>(&self, plane: &[f64], [u, v]: &[[f64; L]; 2]) -> [[f64; L]; 3] {
        let width = if W == 0 { self.width } else { W };
        let across = |row: &[f64]| {
            let (mut r, mut d) = ([row[width - 1]; L], [0.0; L]);
            for k in (0..width - 1).rev() {
                for i in 0..L {
                    d[i] = if k + 2 == width { r[i] } else { d[i] * u[i] + r[i] };
                    r[i] = r[i] * u[i] + row[k];
                }
            }
            (r, d)
        };
        let mut rows = plane.chunks_exact(width).rev();
        let (mut out, mut du) = rows.next().map_or(([0.0; L], [0.0; L]), across);
        let mut dv = [0.0; L];
        for row in rows {
            let (r, d) = across(row);
            for i in 0..L {
                dv[i] = dv[i] * v[i] + out[i];
                out[i] = out[i] * v[i] + r[i];
                du[i] = du[i] * v[i] + d[i];
            }
        }
        [out, du, dv]
    }

    #[inline(always)]
    fn points_at<const L: usize, const W: usize>(&self, p: [Point; L]) -> [Point; L] {
        let uv = self.local(p);
        let (x, y) = (self.values::<L, W>(&self.x, &uv), self.values::<L, W>(&self.y, &uv));
        let mut out = p;
        if self.w.is_empty() {
            for i in 0..L {
                out[i] += Vec2::new(x[i], y[i]);
            }
        } else {
            let w = self.values::<L, W>(&self.w, &uv);
            for i in 0..L {
                let r = 1.0 / w[i];
                out[i] = Point::new(self.center.x + x[i] * r, self.center.y + y[i] * r);
            }
        }
        out
    }

    #[inline(always)]
    fn jets_at<const L: usize, const W: usize>(&self, p: [Point; L]) -> [Jet; L] {
        let uv = self.local(p);
        let (x, y) = (self.slopes::<L, W>(&self.x, &uv), self.slopes::<L, W>(&self.y, &uv));
        let Vec2 { x: kx, y: ky } = self.scale;
        let mut out = [Jet::default(); L];
        if self.w.is_empty() {
            for i in 0..L {
                out[i] = Jet {
                    p: p[i] + Vec2::new(x[0][i], y[0][i]),
                    dx: Vec2::new(1.0 + x[1][i] * kx, y[1][i] * kx),
                    dy: Vec2::new(x[2][i] * ky, 1.0 + y[2][i] * ky),
                };
            }
        } else {
            let w = self.slopes::<L, W>(&self.w, &uv);
            for i in 0..L {
                let r = 1.0 / w[0][i];
                let (a, b) = (x[0][i] * r, y[0][i] * r);
                out[i] = Jet {
                    p: Point::new(self.center.x + a, self.center.y + b),
                    dx: Vec2::new(x[1][i] - a * w[1][i], y[1][i] - b * w[1][i]) * (r * kx),
                    dy: Vec2::new(x[2][i] - a * w[2][i], y[2][i] - b * w[2][i]) * (r * ky),
                };
            }
        }
        out
    }

    fn batch_of_points<const W: usize>(&self, ps: &[Point], out: &mut [Point]) {
        let (from, rest) = ps.as_chunks::<WIDTH>();
        let (to, rest_out) = out.as_chunks_mut::<WIDTH>();
        for (p, o) in from.iter().zip(to) {
            *o = self.points_at::<WIDTH, W>(*p);
        }
        for (p, o) in rest.iter().zip(rest_out) {
            [*o] = self.points_at::<1, W>([*p]);
        }
    }

    fn batch_of_jets<const W: usize>(&self, ps: &[Point], out: &mut [Jet]) {
        let (from, rest) = ps.as_chunks::<JET_WIDTH>();
        let (to, rest_out) = out.as_chunks_mut::<JET_WIDTH>();
        for (p, o) in from.iter().zip(to) {
            *o = self.jets_at::<JET_WIDTH, W>(*p);
        }
        for (p, o) in rest.iter().zip(rest_out) {
            [*o] = self.jets_at::<1, W>([*p]);
        }
    }

    /// The nonzero coefficients of uⁱvʲ as (i, j, [X, Y, W]), with X and Y relative to the origin.
    fn terms(&self) -> Vec<(usize, usize, [f64; 3])> {
        let width = self.width.max(2);
        let mut all = vec![[0.0; 3]; width * self.height.max(2)];
        for j in 0..self.height {
            for i in 0..self.width {
                let k = j * self.width + i;
                let w = self.w.get(k).copied().unwrap_or(0.0);
                let c = if self.w.is_empty() { Vec2::ZERO } else { self.center.to_vec2() * w };
                all[j * width + i] = [self.x[k] + c.x, self.y[k] + c.y, w];
            }
        }
        if self.w.is_empty() {
            // Add the point itself to the displacement.
            let base = [(0, [self.center.x, self.center.y, 1.0]), (1, [1.0 / self.scale.x, 0.0, 0.0])];
            for (k, add) in base.into_iter().chain([(width, [0.0, 1.0 / self.scale.y, 0.0])]) {
                for (a, b) in all[k].iter_mut().zip(add) {
                    *a += b;
                }
            }
        }
        let numbered = all.into_iter().enumerate().map(|(k, c)| (k % width, k / width, c));
        numbered.filter(|t| t.2 != [0.0; 3]).collect()
    }
}

/// The control point (i, j) of the identity.
fn regular_point(rect: Rect, degree: [usize; 2], i: usize, j: usize) -> Point {
    let at = |a: f64, size: f64, i: usize, n: usize| a + size * (i as f64 / n as f64);
    Point::new(at(rect.x0, rect.width(), i, degree[0]), at(rect.y0, rect.height(), j, degree[1]))
}

impl Map for Patch {
    /// The cost is proportional to the number of terms; a bicubic net has sixteen.
    fn cost(&self) -> Cost<'_> {
        Cost::new((self.width * self.height) as f64 / 16.0)
    }

    fn jet(&self, p: Point) -> Jet {
        match self.width {
            4 => self.jets_at::<1, 4>([p])[0],
            _ => self.jets_at::<1, 0>([p])[0],
        }
    }

    fn point(&self, p: Point) -> Point {
        match self.width {
            4 => self.points_at::<1, 4>([p])[0],
            _ => self.points_at::<1, 0>([p])[0],
        }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        match self.width {
            2 => self.batch_of_points::<2>(ps, out),
            3 => self.batch_of_points::<3>(ps, out),
            4 => self.batch_of_points::<4>(ps, out),
            _ => self.batch_of_points::<0>(ps, out),
        }
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        match self.width {
            2 => self.batch_of_jets::<2>(ps, out),
            3 => self.batch_of_jets::<3>(ps, out),
            4 => self.batch_of_jets::<4>(ps, out),
            _ => self.batch_of_jets::<0>(ps, out),
        }
    }

    fn denominator(&self, p: Point) -> f64 {
        if self.w.is_empty() { 1.0 } else { self.values::<1, 0>(&self.w, &self.local([p]))[0] }
    }

    fn class(&self) -> Class {
        let terms = self.terms();
        if !self.is_polynomial() || terms.iter().any(|(i, j, _)| i + j > 1) {
            return Class::Smooth;
        }
        if self.x.iter().chain(&self.y).all(|v| *v == 0.0) {
            return Class::Affine(Affine::IDENTITY);
        }
        let coefficient = |i: usize, j: usize| terms.iter().find(|t| (t.0, t.1) == (i, j)).map_or([0.0; 3], |t| t.2);
        let (u, v, k) = (coefficient(1, 0), coefficient(0, 1), self.scale);
        let linear = Affine::new([u[0] * k.x, u[1] * k.x, v[0] * k.y, v[1] * k.y, 0.0, 0.0]);
        let shift = self.point(self.center) - linear * self.center;
        Class::Affine(linear.then_translate(shift))
    }

    fn creases(&self, out: &mut Creases) {
        if self.has_edge() {
            let patch = self.clone();
            out.push(Crease::edge(Level::Field(Arc::new(move |p: Point| patch.denominator(p)))));
        }
    }

    /// The image of a curve of degree d has degree d·(m+n), or less if the highest terms vanish.
    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        let (c, k) = (self.center, self.scale);
        let local = |f: &dyn Fn(&[f64; 3]) -> f64| Scaled::new(curve.points.iter().map(f));
        let terms = self.terms();
        let total = terms.iter().map(|t| t.0 + t.1).max().unwrap_or(0);
        let u = local(&|p| (p[0] - c.x * p[2]) * k.x).powers(self.width.max(2) - 1);
        let v = local(&|p| (p[1] - c.y * p[2]) * k.y).powers(self.height.max(2) - 1);
        let w = local(&|p| p[2]).powers(total);
        let mut sums = [0, 1, 2].map(|_| Scaled::zero(curve.degree() * total));
        for (i, j, coefficient) in terms {
            let term = u[i].times(&v[j]).times(&w[total - i - j]);
            for (sum, c) in sums.iter_mut().zip(coefficient) {
                sum.add_scaled(c, &term);
            }
        }
        let polynomial = self.is_polynomial() && curve.is_polynomial();
        Some(RationalBezier::from_coordinates(sums.each_ref(), polynomial))
    }

    fn preimages(&self, q: Point) -> Option<Vec<Point>> {
        let pre = Affine::scale_non_uniform(self.scale.x, self.scale.y) * Affine::translate(-self.center.to_vec2());
        // Computed about the center, so that no digits are lost far from the origin.
        let mut terms = self.terms();
        let c = self.center;
        terms.iter_mut().for_each(|(_, _, [x, y, w])| (*x, *y) = (*x - c.x * *w, *y - c.y * *w));
        Polynomials { pre, origin: c, terms }.preimages(self, q)
    }

    /// The distance of control points, roughly: a polynomial of n terms turns back less than n times.
    fn detail(&self, _: Rect) -> Option<f64> {
        Some((self.rect.width() / self.width as f64).min(self.rect.height() / self.height as f64))
    }
}

// The change of basis from Bernstein polynomials to powers about the center of the parameter square.

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
    let factors = binomials(n).into_iter().map(|b| b * 0.5f64.powi(n as i32));
    factors.enumerate().map(|(i, factor)| product_of_powers(factor, i, n - i)).collect()
}

/// The coefficients of the powers of x in factor·(1 + x)ⁱ(1 − x)ʲ.
pub(super) fn product_of_powers(factor: f64, i: usize, j: usize) -> Vec<f64> {
    let mut c = vec![0.0; i + j + 1];
    c[0] = factor;
    for step in 0..i + j {
        let sign = if step < i { 1.0 } else { -1.0 };
        (1..=step + 1).rev().for_each(|k| c[k] += sign * c[k - 1]);
    }
    c
}
