//! Control points that move along rays: the dilation δ of an anamorphic free-form deformation.
//!
//! In homogeneous coordinates with the eye O as origin, moving a point along its ray only changes the last coordinate:
//! (p, 1) → (p, δ), p̂ = p/δ. A net of control points bᵢ over a reference triangle or rectangle, each moved to bᵢ/δᵢ with weight
//! δᵢ, therefore deforms by
//!
//! > p̂ = O + (p − O)/δ(u(p)),  δ(u) = Σ δᵢ Bᵢ(u)
//!
//! (J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form deformation*, CAGD 46, 2016, equations 5 and 6). With the eye in the
//! plane of the drawing, this is a map of the plane. At degree 1 of a triangle, δ(p) = d·(p − O) + d₀ is linear, and the map is the
//! perspective collineation about O with the matrix [I 0; d d₀], whose axis is the line δ = 1.

use super::scene::Eye;
use crate::deform::triangle::{self, polygon};
use crate::map::bspline::bernstein;
use crate::map::{Plane, Quotient, powers, source_coordinates};
use kurbo::{Affine, BezPath, Point, Rect};

/// A regular net of control points in the plane of the drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reference {
    /// Corners A, B, C and degree n: points (i·A + j·B + k·C)/n with i + j + k = n.
    Triangle([Point; 3], usize),
    /// Box and degrees along x and y: points (i, j), i from the left, j from the top.
    Rectangle(Rect, [usize; 2]),
}

impl Reference {
    /// Returns the control points' numbers, in the order of [`Dilation`]'s values. A rectangle's third number is 0.
    pub(super) fn nodes(&self) -> Vec<[usize; 3]> {
        match *self {
            Self::Triangle(_, n) => triangle::indices(n),
            Self::Rectangle(_, [m, n]) => (0..=n).flat_map(|j| (0..=m).map(move |i| [i, j, 0])).collect(),
        }
    }

    /// Returns `true` if there is a control point with these numbers.
    pub(super) fn has(&self, node: [usize; 3]) -> bool {
        match *self {
            Self::Triangle(_, n) => node.iter().try_fold(0usize, |s, v| s.checked_add(*v)) == Some(n),
            Self::Rectangle(_, [m, n]) => node[0] <= m && node[1] <= n && node[2] == 0,
        }
    }

    fn index(&self, node: [usize; 3]) -> usize {
        match *self {
            Self::Triangle(..) => triangle::index(node),
            Self::Rectangle(_, [m, _]) => node[1] * (m + 1) + node[0],
        }
    }

    /// Returns the position of a control point before it is moved.
    pub(super) fn point(&self, node: [usize; 3]) -> Point {
        match *self {
            Self::Triangle(corners, _) => triangle::regular_point(corners, node),
            Self::Rectangle(r, [m, n]) => {
                let share = |k: usize, n: usize| k as f64 / n.max(1) as f64;
                Point::new(r.x0 + r.width() * share(node[0], m), r.y0 + r.height() * share(node[1], n))
            }
        }
    }

    /// Returns the corners, in order around the edge.
    pub(super) fn corners(&self) -> Vec<Point> {
        match *self {
            Self::Triangle(c, _) => c.to_vec(),
            Self::Rectangle(r, _) => {
                vec![r.origin(), Point::new(r.x1, r.y0), Point::new(r.x1, r.y1), Point::new(r.x0, r.y1)]
            }
        }
    }

    /// Returns `true` if a control point lies on side `side`, from corner `side` to the next.
    pub(super) fn on_side(&self, [i, j, k]: [usize; 3], side: usize) -> bool {
        match *self {
            Self::Triangle(..) => [k, i, j][side % 3] == 0,
            Self::Rectangle(_, [m, n]) => [j == 0, i == m, j == n, i == 0][side % 4],
        }
    }

    /// Returns the bounding box.
    pub(super) fn bounds(&self) -> Rect {
        match *self {
            Self::Triangle([a, b, c], _) => Rect::from_points(a, b).union_pt(c),
            Self::Rectangle(r, _) => r,
        }
    }

    /// Returns the values of the basis functions at `p`, in the order of [`Self::nodes`].
    pub(super) fn basis(&self, p: Point) -> Vec<f64> {
        match *self {
            Self::Triangle(corners, n) => triangle::basis(corners, n, p),
            Self::Rectangle(r, [m, n]) => {
                let (s, t) = ((p.x - r.x0) / r.width(), (p.y - r.y0) / r.height());
                let (across, down) = (bernstein(m, s), bernstein(n, t));
                down.iter().flat_map(|b| across.iter().map(move |a| a * b)).collect()
            }
        }
    }

    /// Returns the map from a point to the coordinates of the polynomials of [`Self::expanded`].
    pub(super) fn coordinates(&self) -> Affine {
        match *self {
            Self::Triangle(corners, _) => triangle::coordinates(corners),
            Self::Rectangle(r, _) => {
                let (c, scale_x, scale_y) = (r.center(), 2.0 / r.width(), 2.0 / r.height());
                Affine::new([scale_x, 0.0, 0.0, scale_y, -c.x * scale_x, -c.y * scale_y])
            }
        }
    }

    /// Returns the polynomial with these values at the control points.
    fn expanded(&self, values: &[f64]) -> Plane {
        match *self {
            Self::Triangle(_, n) => triangle::expanded(n, values),
            Self::Rectangle(_, degree) => {
                let powers = powers(degree, values);
                Plane::new(powers.chunks(degree[0] + 1).map(<[f64]>::to_vec).collect())
            }
        }
    }
}

/// δ over a reference, given at the control points.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Dilation {
    /// The net.
    pub(super) reference: Reference,
    values: Vec<f64>,
}

impl Dilation {
    /// Creates δ = 1, with which nothing moves.
    pub(super) fn none(reference: Reference) -> Self {
        Self { reference, values: vec![1.0; reference.nodes().len()] }
    }

    /// Returns δ of a control point.
    pub(super) fn delta_of(&self, node: [usize; 3]) -> f64 {
        self.values[self.reference.index(node)]
    }

    /// Moves a control point to 1/`delta` times its distance from the eye.
    pub(super) fn set(&mut self, node: [usize; 3], delta: f64) {
        let k = self.reference.index(node);
        self.values[k] = delta;
    }

    /// Returns δ at a point.
    pub(super) fn delta_at(&self, p: Point) -> f64 {
        self.reference.basis(p).iter().zip(&self.values).map(|(b, d)| b * d).sum()
    }

    /// Moves one control point so that the point `p` goes to 1/`delta` times its distance: δᵢ grows by (δ − δ(p))/Bᵢ(p). It is the one
    /// with the largest Bᵢ(p) among those that are not `held`, and its numbers are returned; `None` if no Bᵢ(p) is large enough.
    pub(super) fn prescribe(&mut self, p: Point, delta: f64, held: impl Fn([usize; 3]) -> bool) -> Option<[usize; 3]> {
        /// Least value of the basis function, below which a control point would have to move too far.
        const MIN_BASIS: f64 = 1e-6;
        let all = self.reference.nodes().into_iter().zip(self.reference.basis(p));
        let free = all.filter(|(node, _)| !held(*node));
        let (node, b) = free.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, b)| *b > MIN_BASIS)?;
        self.set(node, self.delta_of(node) + (delta - self.delta_at(p)) / b);
        Some(node)
    }

    /// Returns `true` if no control point of a side moves.
    pub(super) fn side_is_fixed(&self, side: usize) -> bool {
        let mut nodes = self.reference.nodes().into_iter().filter(|node| self.reference.on_side(*node, side));
        nodes.all(|node| (self.delta_of(node) - 1.0).abs() <= 1e-12)
    }

    /// Returns the polynomial δ, with the map from a point to its coordinates.
    pub(super) fn plane(&self) -> (Affine, Plane) {
        (self.reference.coordinates(), self.reference.expanded(&self.values))
    }

    /// Returns the region in which the inverse is sought: the reference with a margin of half its size.
    pub(super) fn domain(&self) -> Rect {
        let r = self.reference.bounds();
        r.inflate(0.5 * r.width(), 0.5 * r.height())
    }

    /// Returns the map of the plane for an eye in that plane. If `bounded`, it is used only inside the reference.
    pub(super) fn about(&self, eye: Eye, bounded: bool) -> Quotient {
        let (to_coordinates, delta) = self.plane();
        let minus = |p: Plane, constant: f64| p.plus(-constant, &Plane::linear([1.0, 0.0, 0.0]));
        let eye = match eye {
            Eye::At(eye, _) => eye,
            Eye::Infinite([x, y, _]) => {
                let shift = minus(delta, 1.0);
                return Quotient::polynomial(to_coordinates, shift.scaled(x), shift.scaled(y), self.domain());
            }
        };
        let [x, y] = source_coordinates(to_coordinates).map(Plane::linear);
        let domain = if bounded { self.reference.bounds() } else { self.domain() };
        let q = Quotient::rational(to_coordinates, eye, minus(x, eye.x), minus(y, eye.y), delta, domain);
        // If all δ are positive, there is no pole inside the reference.
        if bounded && self.values.iter().all(|d| *d > 0.0) { q.without_poles() } else { q }
    }

    /// Draws the net's lines. `image` takes every control point and its δ to a point.
    pub(super) fn lines(&self, image: impl Fn(Point, f64) -> Point) -> BezPath {
        let point = |node: [usize; 3]| image(self.reference.point(node), self.delta_of(node));
        let mut path = BezPath::new();
        for [i, j, k] in self.reference.nodes() {
            match self.reference {
                Reference::Triangle(..) if i > 0 => {
                    path.extend(polygon(&[[i, j, k], [i - 1, j + 1, k], [i - 1, j, k + 1]].map(point)));
                }
                Reference::Rectangle(_, [m, n]) if i < m && j < n => {
                    path.extend(polygon(&[[i, j, 0], [i + 1, j, 0], [i + 1, j + 1, 0], [i, j + 1, 0]].map(point)));
                }
                _ => {}
            }
        }
        path
    }
}
