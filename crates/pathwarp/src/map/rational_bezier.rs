//! Rational Bézier curves of any degree in homogeneous coordinates: the exact images on which error bounds are proved.

use super::{Creases, Map};
use crate::outline::{EllipticArc, Seg};
use kurbo::Point;

/// A rational Bézier curve: control points (x·w, y·w, w). Polynomial curves have every w = 1.
#[derive(Debug, Clone, PartialEq)]
pub struct RationalBezier {
    /// The homogeneous control points, one more than the degree.
    pub points: Vec<[f64; 3]>,
}

impl RationalBezier {
    /// The polynomial curve with these control points.
    #[must_use]
    pub fn polynomial(points: &[Point]) -> Self {
        Self { points: points.iter().map(|p| [p.x, p.y, 1.0]).collect() }
    }

    /// The exact form of a path segment: degree 1, 2 or 3 for lines and Bézier curves. An arc of up to 0.9 of a half turn is a
    /// rational quadratic; `None` for longer arcs, whose middle weight is near zero or negative.
    #[must_use]
    pub fn from_seg(seg: &Seg) -> Option<Self> {
        Some(match seg {
            Seg::Line(s) => Self::polynomial(&[s.p0, s.p1]),
            Seg::Quad(s) => Self::polynomial(&[s.p0, s.p1, s.p2]),
            Seg::Cubic(s) => Self::polynomial(&[s.p0, s.p1, s.p2, s.p3]),
            Seg::Arc(s) => return Self::from_arc(s),
        })
    }

    /// An arc as a rational quadratic with middle weight cos(Δ/2), where Δ is its sweep. Its parameter is not proportional to the angle.
    fn from_arc(arc: &EllipticArc) -> Option<Self> {
        /// The middle weight is 0 at a half turn, and badly conditioned just below it.
        const MAX_SWEEP: f64 = 0.9 * std::f64::consts::PI;
        if arc.sweep.abs() > MAX_SWEEP {
            return None;
        }
        let half = arc.sweep / 2.0;
        let w = half.cos();
        let (s, c) = (arc.start + half).sin_cos();
        // The intersection of the end tangents, times w: w·(c + (a cos μ + b sin μ)/w), μ the middle angle.
        let m = arc.center.to_vec2() * w + arc.a * c + arc.b * s;
        Some(Self { points: vec![[arc.p0.x, arc.p0.y, 1.0], [m.x, m.y, w], [arc.p1.x, arc.p1.y, 1.0]] })
    }

    /// The curve with these homogeneous coordinates. If it is `polynomial`, its weights are 1 but for rounding, and are set to 1.
    pub(crate) fn from_coordinates([x, y, w]: [&Scaled; 3], polynomial: bool) -> Self {
        let points = x.coefficients().into_iter().zip(y.coefficients()).zip(w.coefficients());
        Self { points: points.map(|((x, y), w)| [x, y, if polynomial { 1.0 } else { w }]).collect() }
    }

    /// A homogeneous coordinate: 0 for x·w, 1 for y·w, 2 for w.
    pub(crate) fn coordinate(&self, k: usize) -> Scaled {
        Scaled::new(self.points.iter().map(|p| p[k]))
    }

    /// The control points, whose convex hull holds the curve; `None` if a weight is not positive.
    #[must_use]
    pub fn hull(&self) -> Option<Vec<Point>> {
        self.points.iter().map(|[x, y, w]| (*w > 0.0).then(|| Point::new(x / w, y / w))).collect()
    }

    /// The degree.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.points.len().saturating_sub(1)
    }

    /// Returns `true` if all weights are 1.
    #[must_use]
    pub fn is_polynomial(&self) -> bool {
        self.points.iter().all(|p| p[2] == 1.0)
    }

    /// The point at `t`, by de Casteljau's algorithm on the homogeneous points.
    #[must_use]
    pub fn eval(&self, t: f64) -> Point {
        let mut row = self.points.clone();
        for n in (1..row.len()).rev() {
            for i in 0..n {
                let next = row[i + 1];
                for (a, b) in row[i].iter_mut().zip(next) {
                    *a += t * (b - *a);
                }
            }
        }
        row.first().map_or(Point::ORIGIN, |p| Point::new(p[0] / p[2], p[1] / p[2]))
    }

    /// Returns this curve with as few control points as its homogeneous coordinates allow: a degree that was raised is lowered again.
    #[must_use]
    pub fn reduced(mut self) -> Self {
        /// The rounding error of the leading coefficient, as a share of its terms.
        const NOISE: f64 = 1e-13;
        while self.points.len() > 2 {
            let n = self.points.len() - 1;
            let sign = |i: usize| if (n - i).is_multiple_of(2) { 1.0 } else { -1.0 };
            let vanishes = |k: usize| {
                let terms = binomials(n).into_iter().zip(&self.points).map(|(b, p)| b * p[k]);
                let (sum, size) = terms.enumerate().fold((0.0, 0.0), |(s, a), (i, t)| (s + sign(i) * t, a + t.abs()));
                f64::abs(sum) <= NOISE * size
            };
            if !(0..3).all(vanishes) {
                break;
            }
            // From Pᵢ = (i·P̂ᵢ₋₁ + (n − i)·P̂ᵢ)/n, with P̂ of the lower degree. Each half is computed from its end, where that is stable.
            let (p, mut low) = (&self.points, vec![[0.0; 3]; n]);
            for k in 0..3 {
                for i in 0..n.div_ceil(2) {
                    let before = if i > 0 { low[i - 1][k] } else { 0.0 };
                    low[i][k] = (n as f64 * p[i][k] - i as f64 * before) / (n - i) as f64;
                }
                for i in (n.div_ceil(2)..n).rev() {
                    let after = if i + 1 < n { low[i + 1][k] } else { 0.0 };
                    low[i][k] = (n as f64 * p[i + 1][k] - (n - 1 - i) as f64 * after) / (i + 1) as f64;
                }
            }
            self.points = low;
        }
        self
    }

    /// This curve written with degree `n`, if that is higher than its degree.
    #[must_use]
    pub fn raised(&self, n: usize) -> Self {
        let mut points = self.points.clone();
        while !points.is_empty() && points.len() <= n {
            let d = points.len();
            let between = |i: usize, k: usize| {
                let t = i as f64 / d as f64;
                let before = if i > 0 { t * points[i - 1][k] } else { 0.0 };
                before + if i < d { (1.0 - t) * points[i][k] } else { 0.0 }
            };
            points = (0..=d).map(|i| [0, 1, 2].map(|k| between(i, k))).collect();
        }
        Self { points }
    }

    /// The curve whose homogeneous control points are `f` of these: the exact image for linear `f`.
    #[must_use]
    pub fn mapped(&self, f: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        Self { points: self.points.iter().map(|p| f(*p)).collect() }
    }
}

/// The exact image of a segment, of the lowest degree that its coordinates allow: one curve for each part between the creases of the map
/// and, of an arc, between its quarters. `None` if a part has no such image ([`Map::image`]).
///
/// ```
/// use pathwarp::kurbo::{Line, Rect, Vec2};
/// use pathwarp::map::{Lattice, LatticeMap, exact_images};
/// use pathwarp::outline::Seg;
///
/// let mut lattice = Lattice::regular(Rect::new(0.0, 0.0, 1.0, 1.0), [3, 2], [1, 1]);
/// lattice.shift(1, 1, Vec2::new(0.1, 0.3));
/// let upright = Seg::Line(Line::new((0.6, 0.0), (0.6, 1.0)));
/// let images = exact_images(&LatticeMap::new(&lattice, true), &upright).unwrap_or_default();
/// assert_eq!(images[0].degree(), 2); // the lattice's degree along the line
/// ```
#[must_use]
pub fn exact_images(map: &dyn Map, seg: &Seg) -> Option<Vec<RationalBezier>> {
    // Quarters of an arc are short enough for one quadratic each.
    let quarters = if matches!(seg, Seg::Arc(_)) { vec![0.25, 0.5, 0.75] } else { Vec::new() };
    let mut cuts = [vec![0.0, 1.0], quarters, Creases::of_map(map).splits(seg)].concat();
    cuts.sort_by(f64::total_cmp);
    let image = |w: &[f64]| {
        // `Seg::part` has no parts of arcs. A crease at a quarter gives a part of length 0.
        let part = match seg {
            Seg::Arc(arc) => Seg::Arc(arc.subsegment(w[0], w[1])),
            _ => seg.part(w[0], w[1])?,
        };
        let (curve, branch) = (RationalBezier::from_seg(&part)?, map.branch(part.eval(0.5)));
        Some(branch.as_deref().map_or_else(|| map.image(&curve), |m| m.image(&curve))?.reduced())
    };
    cuts.windows(2).map(image).collect()
}

// Polynomials in Bernstein form over [0, 1], for exact images of curves.
//
// Coefficients are stored *scaled* (multiplied by their binomials), so that products are plain convolutions (R. T. Farouki,
// V. T. Rajan, *Algorithms for polynomials in Bernstein form*, CAGD 5, 1988).

/// A polynomial by its scaled Bernstein coefficients cᵢ·C(n,i).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scaled(Vec<f64>);

impl Scaled {
    /// The polynomial with these Bernstein coefficients.
    pub(crate) fn new(coefficients: impl IntoIterator<Item = f64>) -> Self {
        let c: Vec<f64> = coefficients.into_iter().collect();
        let b = binomials(c.len().saturating_sub(1));
        Self(c.into_iter().zip(b).map(|(c, b)| c * b).collect())
    }

    /// The Bernstein coefficients.
    pub(crate) fn coefficients(&self) -> Vec<f64> {
        let b = binomials(self.0.len().saturating_sub(1));
        self.0.iter().zip(b).map(|(c, b)| c / b).collect()
    }

    /// The product, whose degree is the sum of the degrees.
    pub(crate) fn times(&self, other: &Self) -> Self {
        let mut out = vec![0.0; self.0.len() + other.0.len() - 1];
        for (i, a) in self.0.iter().enumerate() {
            for (o, b) in out[i..].iter_mut().zip(&other.0) {
                *o += a * b;
            }
        }
        Self(out)
    }

    /// Adds `k` times `other`, a polynomial written with the same degree.
    pub(crate) fn add_scaled(&mut self, k: f64, other: &Self) {
        for (a, b) in self.0.iter_mut().zip(&other.0) {
            *a += k * b;
        }
    }

    /// The zero polynomial, written with degree `n`.
    pub(crate) fn zero(n: usize) -> Self {
        Self(vec![0.0; n + 1])
    }

    /// The powers 0 to `n` of the polynomial.
    pub(crate) fn powers(&self, n: usize) -> Vec<Self> {
        let mut out = vec![Self(vec![1.0])];
        for i in 0..n {
            out.push(out[i].times(self));
        }
        out
    }
}

/// The binomials C(n, k) for k from 0 to n.
pub(super) fn binomials(n: usize) -> Vec<f64> {
    let mut out = Vec::with_capacity(n + 1);
    let mut b = 1.0;
    for i in 0..=n {
        out.push(b);
        b = b * (n - i) as f64 / (i + 1) as f64;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(c: &[f64], t: f64) -> f64 {
        let mut row = c.to_vec();
        for n in (1..row.len()).rev() {
            for i in 0..n {
                row[i] += t * (row[i + 1] - row[i]);
            }
        }
        row[0]
    }

    #[test]
    fn products_and_sums_agree_with_values() {
        let (a, b) = ([1.0, -2.0, 3.5, 0.25], [0.5, 4.0, -1.0]);
        let product = Scaled::new(a).times(&Scaled::new(b)).coefficients();
        let cube = Scaled::new(b).powers(3)[3].coefficients();
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            assert!((value(&product, t) - value(&a, t) * value(&b, t)).abs() < 1e-14);
            assert!((value(&cube, t) - value(&b, t).powi(3)).abs() < 1e-12);
        }
    }
}
