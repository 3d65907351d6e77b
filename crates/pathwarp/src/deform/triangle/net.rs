//! Bézier triangles as maps of the plane.
//!
//! > F(p) = Σ wᵢⱼₖ Pᵢⱼₖ Bⁿᵢⱼₖ(u) / Σ wᵢⱼₖ Bⁿᵢⱼₖ(u),  Bⁿᵢⱼₖ(u) = n!/(i!j!k!)·u₀ⁱ u₁ʲ u₂ᵏ,  i + j + k = n
//!
//! u are the barycentric coordinates of p in a reference triangle ABC (G. Farin, *Triangular Bernstein–Bézier patches*, CAGD
//! 3, 1986). With Pᵢⱼₖ = (iA + jB + kC)/n and equal weights nothing moves. A straight line becomes a curve of degree n
//! whatever its direction: a triangle of degree n has total degree n, a rectangle of degree n × n twice that.
//!
//! To evaluate it, the net is expanded once in powers of u₁ − ⅓ and u₂ − ⅓ by running de Casteljau's algorithm on polynomials.
//! That multiplies rounding by at most (1 + 2|u₁ − ⅓| + 2|u₂ − ⅓|)ⁿ, 3ⁿ in a corner: negligible at practical degrees.

use crate::map::polynomial::{Plane, Quotient};
use crate::map::{AffineMap, Class, Local, Map};
use kurbo::{Affine, Point, Rect, Vec2};
use std::sync::Arc;

/// The control points of a Bézier triangle with their weights.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TriangleNet {
    corners: [Point; 3],
    degree: usize,
    /// By [`index`].
    moves: Vec<Vec2>,
    weights: Vec<f64>,
}

/// Returns the index of control point (i, j, k) in a list ordered by k + j, then by k.
#[must_use]
pub(crate) fn index([_, j, k]: [usize; 3]) -> usize {
    let row = j + k;
    row * (row + 1) / 2 + k
}

/// Returns all (i, j, k) with i + j + k = n, in the order of their [`index`].
#[must_use]
pub(crate) fn indices(n: usize) -> Vec<[usize; 3]> {
    (0..=n).flat_map(|row| (0..=row).map(move |k| [n - row, row - k, k])).collect()
}

/// Returns (i·A + j·B + k·C)/n.
#[must_use]
pub(crate) fn regular_point(corners: [Point; 3], [i, j, k]: [usize; 3]) -> Point {
    let n = (i + j + k).max(1) as f64;
    let [a, b, c] = corners;
    a + (b - a) * (j as f64 / n) + (c - a) * (k as f64 / n)
}

/// Returns the map from a point to (u₁ − ⅓, u₂ − ⅓), the coordinates of [`expanded`].
pub(crate) fn coordinates([a, b, c]: [Point; 3]) -> Affine {
    let (u, v) = (b - a, c - a);
    let middle = a + (u + v) / 3.0;
    Affine::new([u.x, u.y, v.x, v.y, middle.x, middle.y]).inverse()
}

/// Returns the polynomial with these Bernstein coefficients (by [`index`]) in powers of u₁ − ⅓ and u₂ − ⅓.
pub(crate) fn expanded(n: usize, coefficients: &[f64]) -> Plane {
    const THIRD: f64 = 1.0 / 3.0;
    let mut net: Vec<Plane> = coefficients.iter().map(|c| Plane::new(vec![vec![*c]])).collect();
    for level in (0..n).rev() {
        let next = indices(level).into_iter().map(|[i, j, k]| {
            net[index([i + 1, j, k])]
                .times_linear([THIRD, -1.0, -1.0])
                .plus(1.0, &net[index([i, j + 1, k])].times_linear([THIRD, 1.0, 0.0]))
                .plus(1.0, &net[index([i, j, k + 1])].times_linear([THIRD, 0.0, 1.0]))
        });
        net = next.collect();
    }
    net.pop().unwrap_or_default()
}

/// Returns the values of all Bⁿᵢⱼₖ at `p`, by [`index`].
#[must_use]
pub(crate) fn basis(corners: [Point; 3], n: usize, p: Point) -> Vec<f64> {
    const THIRD: f64 = 1.0 / 3.0;
    let at = coordinates(corners) * p;
    let (u1, u2) = (at.x + THIRD, at.y + THIRD);
    let u0 = 1.0 - u1 - u2;
    let mut values = vec![1.0];
    for level in 1..=n {
        let before = values;
        let of = |ok: bool, ijk: [usize; 3]| if ok { before[index(ijk)] } else { 0.0 };
        let value = |[i, j, k]: [usize; 3]| {
            u0 * of(i > 0, [i.wrapping_sub(1), j, k])
                + u1 * of(j > 0, [i, j.wrapping_sub(1), k])
                + u2 * of(k > 0, [i, j, k.wrapping_sub(1)])
        };
        values = indices(level).into_iter().map(value).collect();
    }
    values
}

impl TriangleNet {
    /// Creates the net of the identity; `None` if the corners lie on one line.
    #[must_use]
    pub(crate) fn regular(corners: [Point; 3], degree: usize) -> Option<Self> {
        let [a, b, c] = corners;
        let area = (b - a).cross(c - a);
        let size = (b - a).hypot2().max((c - a).hypot2());
        let count = (degree + 1) * (degree + 2) / 2;
        (area.is_finite() && area.abs() > 1e-12 * size).then(|| Self {
            corners,
            degree,
            moves: vec![Vec2::ZERO; count],
            weights: vec![1.0; count],
        })
    }

    /// Returns the degree.
    #[must_use]
    pub(crate) fn degree(&self) -> usize {
        self.degree
    }

    /// Returns control point (i, j, k).
    #[must_use]
    pub(crate) fn point(&self, ijk: [usize; 3]) -> Point {
        regular_point(self.corners, ijk) + self.moves[index(ijk)]
    }

    /// Puts control point (i, j, k) at `p`.
    pub(crate) fn place(&mut self, ijk: [usize; 3], p: Point) {
        self.moves[index(ijk)] = p - regular_point(self.corners, ijk);
    }

    /// Moves control point (i, j, k) by `v`.
    pub(crate) fn shift(&mut self, ijk: [usize; 3], v: Vec2) {
        self.moves[index(ijk)] += v;
    }

    /// Sets the weight of control point (i, j, k).
    pub(crate) fn set_weight(&mut self, ijk: [usize; 3], w: f64) {
        self.weights[index(ijk)] = w;
    }

    /// Returns `true` if no control point of side 0 (AB), 1 (BC) or 2 (CA) moves.
    #[must_use]
    pub(crate) fn side_is_fixed(&self, side: usize) -> bool {
        let size = self.corners.iter().fold(0.0, |m, p| f64::max(m, p.x.abs() + p.y.abs()));
        let on: Vec<usize> =
            indices(self.degree).into_iter().filter(|ijk| ijk[(side + 2) % 3] == 0).map(index).collect();
        on.iter().all(|&k| self.moves[k].hypot() <= 1e-12 * size && self.weights[k] == self.weights[on[0]])
    }

    /// Returns the map. Outside the triangle it is the identity or, if `extended`, the continued polynomials.
    #[must_use]
    pub(crate) fn map(&self, extended: bool) -> Arc<dyn Map> {
        let pre = coordinates(self.corners);
        let [a, b, c] = self.corners;
        let bounds = Rect::from_points(a, b).union_pt(c);
        let plane = |f: &dyn Fn(usize, [usize; 3]) -> f64| {
            let all: Vec<f64> = indices(self.degree).into_iter().enumerate().map(|(at, ijk)| f(at, ijk)).collect();
            expanded(self.degree, &all)
        };
        let domain = if extended { bounds.inflate(0.5 * bounds.width(), 0.5 * bounds.height()) } else { bounds };
        let whole = if self.weights.iter().all(|w| *w == self.weights[0]) {
            let (x, y) = (plane(&|at, _| self.moves[at].x), plane(&|at, _| self.moves[at].y));
            Quotient::polynomial(pre, x, y, domain)
        } else {
            let origin = bounds.center();
            let x = plane(&|at, ijk| (self.point(ijk).x - origin.x) * self.weights[at]);
            let y = plane(&|at, ijk| (self.point(ijk).y - origin.y) * self.weights[at]);
            Quotient::rational(pre, origin, x, y, plane(&|at, _| self.weights[at]), domain)
        };
        if extended {
            return whole.simplest();
        }
        let sound = self.weights.iter().all(|w| *w > 0.0);
        let whole: Arc<dyn Map> = if sound { Arc::new(whole.without_poles()) } else { Arc::new(whole) };
        if whole.class() == Class::Affine(Affine::IDENTITY) {
            return Arc::new(AffineMap::IDENTITY);
        }
        Arc::new(Local::new(&self.corners, whole))
    }
}
