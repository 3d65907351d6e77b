//! NURBS surfaces, and the Bézier patches they consist of.

use crate::settings::{Box3, grid};
use glam::{DVec3, DVec4, Vec4Swizzles as _};

/// A NURBS surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surface {
    /// Name; may be empty.
    pub name: String,
    /// Degrees in u and v, from 1 to [`MAX_DEGREE`].
    pub degree: [usize; 2],
    /// Clamped knots in u and v.
    pub knots: [Vec<f64>; 2],
    /// Control points; u runs fastest.
    pub points: Vec<DVec3>,
    /// A positive weight for each control point.
    pub weights: Vec<f64>,
    /// Closed loops of curves in the plane of u and v. A point belongs to the surface if an odd number of loops surrounds it, or if there
    /// are none.
    pub trims: Vec<Vec<TrimCurve>>,
}

/// A NURBS curve in the plane of u and v.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TrimCurve {
    /// Degree.
    pub degree: usize,
    /// Clamped knots.
    pub knots: Vec<f64>,
    /// Control points (u, v).
    pub points: Vec<[f64; 2]>,
    /// A positive weight for each control point.
    pub weights: Vec<f64>,
}

impl Surface {
    /// Makes a Bézier patch over 0..1 × 0..1 with weights 1. There must be (`degree[0]` + 1)·(`degree[1]` + 1) points.
    #[must_use]
    pub fn bezier(name: &str, degree: [usize; 2], points: Vec<DVec3>) -> Self {
        let weights = vec![1.0; points.len()];
        let knots = degree.map(single_span_knots);
        Self { name: name.to_owned(), degree, knots, points, weights, trims: Vec::new() }
    }

    /// Returns the numbers of control points in u and v.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [0, 1].map(|a| self.knots[a].len().saturating_sub(self.degree[a] + 1))
    }

    /// Returns `true` if weights differ.
    #[must_use]
    pub fn is_rational(&self) -> bool {
        self.weights.windows(2).any(|w| w[0] != w[1])
    }

    /// Returns `true` if the surface is a single Bézier patch.
    #[must_use]
    pub fn is_bezier(&self) -> bool {
        self.size() == self.degree.map(|d| d + 1)
    }

    /// Returns `true` if all rows of control points are equal up to rounding, so that the surface is a curve.
    #[must_use]
    pub fn is_curve(&self) -> bool {
        const SAME: f64 = 1e-12;
        let n = self.size()[0].max(1);
        let size = self.points.iter().fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
        self.points.chunks(n).all(|row| row.iter().zip(&self.points).all(|(p, q)| p.distance(*q) <= SAME * size))
            && self.weights.chunks(n).all(|row| row.iter().zip(&self.weights).all(|(v, w)| (v - w).abs() <= SAME * w))
    }

    /// Returns the bounding box of the control points, which contains the surface.
    #[must_use]
    pub fn bounds(&self) -> Option<Box3> {
        Box3::around(self.points.iter().copied())
    }

    /// Returns a description of the first fault in the numbers, if there is one.
    #[must_use]
    pub fn fault(&self) -> Option<String> {
        for (a, name) in ["u", "v"].into_iter().enumerate() {
            if !(1..=MAX_DEGREE).contains(&self.degree[a]) {
                return Some(format!("has degree {} in {name}; degrees are 1 to {MAX_DEGREE}", self.degree[a]));
            }
            if let Some(fault) = knot_fault(self.degree[a], &self.knots[a]) {
                return Some(format!("{fault} (in {name})"));
            }
        }
        let [nu, nv] = self.size();
        if Some(self.points.len()) != nu.checked_mul(nv) {
            return Some(format!("has {} control points; its degrees and knots take {nu} × {nv}", self.points.len()));
        }
        // The square of a larger number would overflow.
        let is_too_large = |p: &DVec3| p.abs().max_element().is_nan() || p.abs().max_element() > 1e100;
        if let Some(i) = self.points.iter().position(is_too_large) {
            return Some(format!("control point {} is not finite", i + 1));
        }
        weight_fault(&self.weights, self.points.len())
            .or_else(|| self.trims.iter().flatten().find_map(|t| t.fault().map(|f| format!("a trimming curve {f}"))))
    }

    /// Returns the Bézier patches, u fastest, and the values of u and v between them.
    #[must_use]
    pub fn pieces(&self) -> (Vec<BezierPatch>, [Vec<f64>; 2]) {
        let homogeneous: Vec<_> = self.points.iter().zip(&self.weights).map(|(p, w)| (*p * *w).extend(*w)).collect();
        pieces(self.degree, &self.knots, self.size(), &homogeneous)
    }
}

impl TrimCurve {
    fn fault(&self) -> Option<String> {
        if self.degree == 0 || self.degree > MAX_DEGREE {
            return Some(format!("has degree {}; degrees are 1 to {MAX_DEGREE}", self.degree));
        }
        if self.knots.len() != self.points.len() + self.degree + 1 {
            return Some(format!("has {} control points and {} knots", self.points.len(), self.knots.len()));
        }
        if self.points.iter().flatten().any(|v| !v.is_finite()) {
            return Some("has a control point that is not finite".into());
        }
        knot_fault(self.degree, &self.knots).or_else(|| weight_fault(&self.weights, self.points.len()))
    }
}

fn weight_fault(weights: &[f64], points: usize) -> Option<String> {
    if weights.len() != points {
        return Some(format!("has {} weights for {points} control points", weights.len()));
    }
    let bad = weights.iter().position(|w| !(*w > 0.0 && *w < 1e100))?;
    Some(format!("weight {} is not a positive number", bad + 1))
}

/// The highest degree of a surface, whether read or made by exact composition.
pub const MAX_DEGREE: usize = 12;

/// A rational Bézier patch over 0..1 × 0..1.
#[derive(Debug, Clone, PartialEq)]
pub struct BezierPatch {
    /// Degrees in u and v.
    pub degree: [usize; 2],
    /// Control points (x·w, y·w, z·w, w); u runs fastest.
    pub points: Vec<DVec4>,
}

impl BezierPatch {
    /// Returns the work of computing a point and its image, in evaluations of a map.
    pub(super) fn work(&self) -> usize {
        2 + (self.degree[0] + 1) * (self.degree[1] + 1) / 2
    }

    /// Returns the work of computing a point alone.
    pub(super) fn work_of_points(&self) -> f64 {
        let [m, n] = self.degree.map(|d| d as f64 + 1.0);
        1.0 + 0.025 * n * m * m
    }

    /// Returns the value in homogeneous coordinates, and its derivatives by u and v.
    #[must_use]
    pub fn homogeneous(&self, u: f64, v: f64) -> [DVec4; 3] {
        let rows = self.points.chunks(self.degree[0] + 1).map(|row| curve(row.iter().copied(), u));
        let (mut values, mut slopes) = ([DVec4::ZERO; MAX_DEGREE + 1], [DVec4::ZERO; MAX_DEGREE + 1]);
        for ((p, d), row) in values.iter_mut().zip(&mut slopes).zip(rows) {
            (*p, *d) = row;
        }
        let n = self.degree[1] + 1;
        let (value, dv) = curve(values[..n].iter().copied(), v);
        [value, curve(slopes[..n].iter().copied(), v).0, dv]
    }

    /// Returns the point at u and v.
    #[must_use]
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        let mut row = [DVec4::ZERO; MAX_DEGREE + 1];
        for (slot, points) in row.iter_mut().zip(self.points.chunks(self.degree[0] + 1)) {
            *slot = value(points, u);
        }
        let p = value(&row[..=self.degree[1]], v);
        p.xyz() / p.w
    }

    /// Returns the point at u and v, and its derivatives by u and v.
    #[must_use]
    pub fn jet(&self, u: f64, v: f64) -> [DVec3; 3] {
        let [p, du, dv] = self.homogeneous(u, v);
        let point = p.xyz() / p.w;
        [point, (du.xyz() - point * du.w) / p.w, (dv.xyz() - point * dv.w) / p.w]
    }

    /// Returns the bounding box of the control points.
    #[must_use]
    pub fn bounds(&self) -> Option<Box3> {
        Box3::around(self.points.iter().map(|p| p.xyz() / p.w))
    }
}

/// Returns a point of a Bézier curve, by the arithmetic of [`curve`].
fn value(points: &[DVec4], t: f64) -> DVec4 {
    let between = |a: DVec4, b: DVec4| a * (1.0 - t) + b * t;
    if let [a, b, c, d] = *points {
        let [p, q, r] = [between(a, b), between(b, c), between(c, d)];
        return between(between(p, q), between(q, r));
    }
    curve(points.iter().copied(), t).0
}

/// Returns a point of a Bézier curve, and the derivative. The arithmetic is symmetric, so patches with a common edge agree on it to the
/// last bit at parameters t and 1 − t.
pub(super) fn curve(points: impl Iterator<Item = DVec4>, t: f64) -> (DVec4, DVec4) {
    let mut row = [DVec4::ZERO; MAX_DEGREE + 1];
    let mut n = 0;
    for (slot, p) in row.iter_mut().zip(points) {
        *slot = p;
        n += 1;
    }
    let mut slope = DVec4::ZERO;
    for level in (1..n).rev() {
        slope = (row[1] - row[0]) * (n - 1) as f64;
        for i in 0..level {
            row[i] = row[i] * (1.0 - t) + row[i + 1] * t;
        }
    }
    (row[0], slope)
}

/// A polynomial in two variables in scaled Bernstein form, Σ c[i,j]·uⁱ(1−u)ᵐ⁻ⁱvʲ(1−v)ⁿ⁻ʲ, in which products are convolutions. The
/// coefficients are Bernstein coefficients times binomial coefficients, u fastest.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scaled {
    degree: [usize; 2],
    c: Vec<f64>,
}

/// Returns C(n, 0) to C(n, n).
fn binomials(n: usize) -> Vec<f64> {
    let mut out = vec![1.0; n + 1];
    for k in 1..=n {
        out[k] = (out[k - 1] * (n - k + 1) as f64 / k as f64).round();
    }
    out
}

impl Scaled {
    fn constant(v: f64) -> Self {
        Self { degree: [0, 0], c: vec![v] }
    }

    /// Makes the zero polynomial, with this degree.
    pub(super) fn zero(degree: [usize; 2]) -> Self {
        Self { degree, c: vec![0.0; (degree[0] + 1) * (degree[1] + 1)] }
    }

    /// Makes the polynomial with these Bernstein coefficients.
    pub(super) fn new(degree: [usize; 2], c: impl Iterator<Item = f64>) -> Self {
        let [a, b] = degree.map(binomials);
        let factor = b.iter().flat_map(|b| a.iter().map(move |a| a * b));
        Self { degree, c: c.zip(factor).map(|(c, f)| c * f).collect() }
    }

    /// Returns the Bernstein coefficients.
    pub(super) fn bernstein(&self) -> Vec<f64> {
        let [a, b] = self.degree.map(binomials);
        let factor = b.iter().flat_map(|b| a.iter().map(move |a| a * b));
        self.c.iter().zip(factor).map(|(c, f)| c / f).collect()
    }

    pub(super) fn times(&self, other: &Self) -> Self {
        let mut out = Self::zero([0, 1].map(|a| self.degree[a] + other.degree[a]));
        let width = out.degree[0] + 1;
        for (n, p) in self.c.iter().enumerate().filter(|(_, p)| **p != 0.0) {
            let (i, j) = (n % (self.degree[0] + 1), n / (self.degree[0] + 1));
            for (l, row) in other.c.chunks(other.degree[0] + 1).enumerate() {
                let start = (j + l) * width + i;
                out.c[start..start + row.len()].iter_mut().zip(row).for_each(|(o, q)| *o += p * q);
            }
        }
        out
    }

    /// Adds `k` times a polynomial of equal degree.
    pub(super) fn add(&mut self, k: f64, other: &Self) {
        self.c.iter_mut().zip(&other.c).for_each(|(a, b)| *a += k * b);
    }

    /// Returns the powers from 0 to `n`.
    pub(super) fn powers(&self, n: usize) -> Vec<Self> {
        let mut out = vec![Self::constant(1.0)];
        for k in 0..n {
            out.push(out[k].times(self));
        }
        out
    }
}

/// Returns the knots of a single Bézier span over 0..1.
pub(super) fn single_span_knots(degree: usize) -> Vec<f64> {
    bezier_knots(degree, &[0.0, 1.0])
}

/// Returns the knots of Bézier spans joined at these parameters.
pub(super) fn bezier_knots(degree: usize, breaks: &[f64]) -> Vec<f64> {
    let last = breaks.len().saturating_sub(1);
    let times = |i: usize| if i == 0 || i == last { degree + 1 } else { degree };
    breaks.iter().enumerate().flat_map(|(i, b)| std::iter::repeat_n(*b, times(i))).collect()
}

/// Returns a description of the first fault in the knots, if there is one.
fn knot_fault(degree: usize, knots: &[f64]) -> Option<String> {
    let n = knots.len();
    if n < 2 * (degree + 1) {
        return Some(format!("has {n} knots; degree {degree} takes {} or more", 2 * (degree + 1)));
    }
    if knots.iter().any(|k| !k.is_finite()) || knots.windows(2).any(|w| w[0] > w[1]) {
        return Some("has knots that are not in order".into());
    }
    let is_clamped = knots[0] == knots[degree] && knots[n - 1] == knots[n - 1 - degree];
    if !is_clamped || knots[0] == knots[n - 1] {
        let times = degree + 1;
        return Some(format!("has knots that are not clamped: the first and the last must be repeated {times} times"));
    }
    let is_torn = knots[1..n - 1].windows(degree + 1).any(|w| w[0] == w[degree]);
    let torn =
        || format!("has a knot repeated more than {degree} times, where it falls apart; store its parts one by one");
    is_torn.then(torn)
}

/// Returns the distinct knots.
fn breaks(knots: &[f64]) -> Vec<f64> {
    let mut out = knots.to_vec();
    out.dedup();
    out
}

/// Returns the control points of the Bézier spans of a curve; neighbouring spans share an end point.
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

/// Returns the polar form of a span, by de Boor's algorithm with a different argument in each step.
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

/// Returns the Bézier patches of a surface, u fastest, and the values of u and v between them.
fn pieces(
    degree: [usize; 2],
    knots: &[Vec<f64>; 2],
    [nu, _]: [usize; 2],
    points: &[DVec4],
) -> (Vec<BezierPatch>, [Vec<f64>; 2]) {
    let rows: Vec<Vec<DVec4>> = points.chunks(nu).map(|row| bezier_row(degree[0], &knots[0], row)).collect();
    let width = rows.first().map_or(0, Vec::len);
    let column = |i: usize| bezier_row(degree[1], &knots[1], &rows.iter().map(|r| r[i]).collect::<Vec<_>>());
    let columns: Vec<Vec<DVec4>> = (0..width).map(column).collect();
    let breaks = [breaks(&knots[0]), breaks(&knots[1])];
    let [spans_u, spans_v] = [breaks[0].len() - 1, breaks[1].len() - 1];
    let piece = |n: usize| {
        let (i, j) = ((n % spans_u) * degree[0], (n / spans_u) * degree[1]);
        let points = grid([degree[0] + 1, degree[1] + 1, 1]).map(|[a, b, _]| columns[i + a][j + b]);
        BezierPatch { degree, points: points.collect() }
    };
    ((0..spans_u * spans_v).map(piece).collect(), breaks)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of a cylinder: the circle is exact to the last bits, and derivatives agree with difference quotients.
    #[test]
    fn a_quarter_of_a_cylinder() {
        let h = 0.5f64.sqrt();
        let ring = [(1.0, 0.0, 1.0), (1.0, 1.0, h), (0.0, 1.0, 1.0)];
        let points = [0.0, 5.0].iter().flat_map(|z| ring.map(|(x, y, w)| DVec4::new(x * w, y * w, z * w, w)));
        let patch = BezierPatch { degree: [2, 1], points: points.collect() };
        for (u, v) in [(0.0, 0.0), (0.3, 0.6), (0.5, 0.1), (0.9, 1.0)] {
            let [p, du, dv] = patch.jet(u, v);
            assert!((p.x.hypot(p.y) - 1.0).abs() < 1e-15 && (p.z - 5.0 * v).abs() < 1e-14);
            const H: f64 = 1e-6;
            let by_u = (patch.point(u + H, v) - patch.point(u - H, v)) / (2.0 * H);
            assert!((du - by_u).length() < 1e-8 && (dv - DVec3::Z * 5.0).length() < 1e-13);
        }
    }

    #[test]
    fn products_are_products() {
        let at = |p: &Scaled, u: f64, v: f64| -> f64 {
            let [m, n] = p.degree;
            let term = |k: usize| {
                let (i, j) = (k % (m + 1), k / (m + 1));
                let side = |t: f64, i: usize, n: usize| t.powi(i as i32) * (1.0 - t).powi((n - i) as i32);
                p.c[k] * side(u, i, m) * side(v, j, n)
            };
            (0..p.c.len()).map(term).sum()
        };
        let p = Scaled::new([2, 1], [1.0, -2.0, 3.0, 0.5, 4.0, -1.0].into_iter());
        let q = Scaled::new([1, 3], (0..8).map(|i| f64::from(i * i % 5) - 1.0));
        let cube = &p.times(&q).powers(3)[3];
        for (u, v) in [(0.2, 0.9), (0.7, 0.4)] {
            assert!((at(cube, u, v) - (at(&p, u, v) * at(&q, u, v)).powi(3)).abs() < 1e-12);
        }
        let b = p.bernstein();
        assert_eq!(Scaled::new([2, 1], b.into_iter()), p);
    }

    /// Returns a B-spline's value, by the recursion of Cox and de Boor.
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
            assert!(knot_fault(1, knots).unwrap().contains(part), "{knots:?}: {:?}", knot_fault(1, knots));
        }
        assert_eq!(knot_fault(2, &bezier_knots(2, &[0.0, 1.0, 3.0])), None);
    }
}
