//! Bézier triangles: artwork in a triangle follows a net of control points.
//!
//! F(u) = Σ wᵢⱼₖ Pᵢⱼₖ Bᵢⱼₖ(u) / Σ wᵢⱼₖ Bᵢⱼₖ(u), with Bᵢⱼₖ(u) = n!/(i!j!k!)·u₀ⁱu₁ʲu₂ᵏ and u the barycentric coordinates in
//! the reference triangle ABC. Pᵢⱼₖ starts at (iA + jB + kC)/n, where nothing moves. At degree 1 the map is affine, and with weights
//! projective. At degree 2 there are six points, and lines become parabolas, or with weights other rational curves. Outside a
//! triangle that the user gives, nothing moves. On a side, the map depends on that side's points alone: if they do not move, no gap
//! opens there. Outside the default triangle about the artwork's box the map continues, as strokes reach past the box.
//!
//! G. Farin, *Triangular Bernstein–Bézier patches*, CAGD 3 (1986); J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form
//! deformation*, CAGD 46 (2016), where the net is moved along rays (see `anamorph`).

mod birational;
#[cfg(test)]
mod tests;

use super::entry::{Built, ByHand, Case, Entry, Example, Info, Law, Pairs, Role};
use super::ffd::{Change, changes};
use crate::error::{Error, GeometryError};
use crate::map::{AffineMap, Class, Local, Map, Plane, Quotient};
use crate::param::{Kind, parameters};
use kurbo::{Affine, BezPath, Point, Rect, Vec2};
use std::sync::Arc;

parameters! {
    /// A Bézier triangle: the artwork in it follows a triangular net of control points.
    ///
    /// F(u) = Σ wᵢⱼₖ Pᵢⱼₖ Bᵢⱼₖ(u) / Σ wᵢⱼₖ Bᵢⱼₖ(u), u being barycentric coordinates in the reference triangle. Control point
    /// (i, j, k), i + j + k = n, starts at (iA + jB + kC)/n.
    ///
    /// ```
    /// use pathwarp::{deform::Triangle, kurbo::Point, map::Map};
    ///
    /// let bent = Triangle::new([(0.0, 0.0), (100.0, 0.0), (0.0, 100.0)]).shift([1, 1, 0], (0.0, 30.0)).build()?;
    /// assert!(bent.map.point(Point::new(25.0, 25.0)).distance(Point::new(25.0, 32.5)) < 1e-12);
    /// # Ok::<(), pathwarp::Error>(())
    /// ```
    #[derive(Debug, Clone, PartialEq)]
    pub struct Triangle(s, corners: [Point; 3]) {
        /// The triangle's corners; outside it nothing moves. Default: a triangle about the artwork, its first corner at the top, its
        /// second at the bottom left, and the map continues outside it.
        param = new("reference", Kind::Text("X,Y X,Y X,Y"));
        /// Degree of the net: control points along a side, less one.
        degree: usize = new("degree", Kind::Count).default("2").within(1.0, 10.0);
        /// Moves a control point by this much; may be given many times.
        param = new("move", Kind::Text("I,J,K:DX,DY")).repeated();
        /// Puts a control point here; may be given many times.
        param = new("at", Kind::Text("I,J,K:X,Y")).repeated();
        /// Strength with which a control point pulls the artwork towards itself, 1 by default; may be given many times.
        param = new("weight", Kind::Text("I,J,K:W")).repeated();
        /// Choose the weights of the three points between the corners such that the inverse of degree 2 is exact and fast: every place in the
        /// image then comes from one place alone.
        birational: bool = flag("birational");
        /// Let the map continue outside the triangle instead of leaving everything there in place.
        extend: bool = flag("extend");
        let changes: Vec<([usize; 3], Change)> = changes(s, |change| vec![change])?;
        let frame: Option<Rect> = Some(s.frame().rect);
    }
}

impl Triangle {
    /// Creates a net of degree 2 over a reference triangle. Outside the triangle nothing moves, unless the map is
    /// [extended](Self::extend).
    pub fn new(corners: [impl Into<Point>; 3]) -> Self {
        Self { frame: None, ..Self::defaults(Rect::ZERO, corners.map(Into::into)) }
    }

    /// Creates a net over a triangle about the artwork's box, with its first corner at the top and its second at the bottom left. The
    /// map continues outside.
    #[must_use]
    pub fn around(frame: Rect) -> Self {
        Self::defaults(frame, around(frame)).extend(true)
    }

    /// Sets the position of control point (i, j, k).
    #[must_use]
    pub fn place(mut self, node: [usize; 3], at: impl Into<Point>) -> Self {
        self.changes.push((node, Change::Place(at.into())));
        self
    }

    /// Moves control point (i, j, k) by a vector in user units.
    #[must_use]
    pub fn shift(mut self, node: [usize; 3], by: impl Into<Vec2>) -> Self {
        self.changes.push((node, Change::Shift(by.into())));
        self
    }

    /// Sets the weight of control point (i, j, k), above 0 and up to a million.
    #[must_use]
    pub fn weight(mut self, node: [usize; 3], weight: f64) -> Self {
        self.changes.push((node, Change::Weight(weight)));
        self
    }

    /// Builds the map. A side that tears the artwork gives a warning.
    ///
    /// # Errors
    /// [`GeometryError::Collinear`] when the triangle is flat, [`Error::Usage`] when a degree, control point or weight is out of range, or
    /// no weights make the map birational.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        let Self { corners, extend, .. } = *self;
        let mut net = TriangleNet::regular(corners, self.degree).ok_or_else(|| GeometryError::Collinear {
            path: "reference".into(),
            which: [1, 2, 3],
            points: corners.to_vec(),
        })?;
        for &(node, change) in &self.changes {
            self.change(&mut net, node, change)?;
        }
        let inverse = if self.birational { Some(self.make_birational(&mut net)?) } else { None };
        let mut built = Built::new(net.map(extend, inverse));
        if self.birational {
            let [a, b, c] = [[1, 1, 0], [1, 0, 1], [0, 1, 1]].map(|k| net.weights[index(k)]);
            built.note(format!("weights of 1,1,0, of 1,0,1 and of 0,1,1: {a:.6}, {b:.6} and {c:.6}"));
        }
        if !extend {
            let names = ["first and second", "second and third", "third and first"];
            let crosses = |k: usize| self.frame.is_none_or(|f| line_meets_box(f, corners[k], corners[(k + 1) % 3]));
            for k in (0..3).filter(|&k| !net.side_is_fixed(k) && crosses(k)) {
                built.warn(format!(
                    "the side between the {} corner meets the artwork's box and has control points moved: artwork that crosses it \
is torn apart; keep that side's points in place, choose a larger `reference`, or give `extend`",
                    names[k]
                ));
            }
        }
        built.overlay(Role::Base, polygon(&corners));
        built.overlay(Role::Cage, cage(&net));
        Ok(built)
    }

    /// Sets the weights that make a net birational; returns the inverse.
    fn make_birational(&self, net: &mut TriangleNet) -> Result<Quotient, Error> {
        let wrong = |problem: &str| Error::usage("birational", "", problem.to_owned());
        if self.degree != 2 {
            return Err(wrong("is for degree 2, whose net has six points"));
        }
        let is_corner = |node: &[usize; 3]| node.contains(&2);
        if self.changes.iter().any(|(node, change)| !is_corner(node) && matches!(change, Change::Weight(_))) {
            return Err(wrong("sets the weights of the points between the corners: give weights of corners only"));
        }
        let points: Vec<Point> = indices(2).into_iter().map(|ijk| net.point(ijk)).collect();
        let roots_of_weights = [[2, 0, 0], [0, 2, 0], [0, 0, 2]].map(|corner| net.weights[index(corner)].sqrt());
        let found = birational::birational(&points, roots_of_weights, self.corners).ok_or_else(|| {
            wrong(
                "finds no positive weights for this net: its corners lie on one line, or a point between two corners lies too far off; \
move it nearer to the side between them",
            )
        })?;
        for (node, weight) in [[1, 1, 0], [1, 0, 1], [0, 1, 1]].into_iter().zip(found.weights) {
            net.set_weight(node, weight);
        }
        Ok(found.back)
    }

    fn change(&self, net: &mut TriangleNet, node: [usize; 3], change: Change) -> Result<(), Error> {
        let ([i, j, k], degree) = (node, self.degree);
        let wrong = |problem: String| Error::usage(change.param(), format!("{i},{j},{k}"), problem);
        if node.iter().try_fold(0usize, |sum, v| sum.checked_add(*v)) != Some(degree) {
            return Err(wrong(format!("is not a control point: I, J and K must add up to {degree}, the degree")));
        }
        match change {
            Change::Place(p) => net.moves[index(node)] = p - regular_point(net.corners, node),
            Change::Shift(v) => net.shift(node, v),
            Change::Weight(w) if w > 0.0 && w <= 1e6 => net.set_weight(node, w),
            Change::Weight(_) => {
                return Err(wrong("has a weight out of range; weights are above 0 and at most a million".into()));
            }
        }
        Ok(())
    }
}

/// Draws a closed polygon.
pub(super) fn polygon(corners: &[Point]) -> BezPath {
    let mut path = BezPath::new();
    for (i, p) in corners.iter().enumerate() {
        if i == 0 { path.move_to(*p) } else { path.line_to(*p) }
    }
    path.close_path();
    path
}

/// Returns `true` if the line between two points runs through a box or along its edge.
fn line_meets_box(r: Rect, a: Point, b: Point) -> bool {
    let rounding = 1e-9 * (r.width() + r.height());
    let r = r.inflate(rounding, rounding);
    // Clip the line's parameter range by the box's two slabs.
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (p, d, lo, hi) in [(a.x, b.x - a.x, r.x0, r.x1), (a.y, b.y - a.y, r.y0, r.y1)] {
        if d == 0.0 {
            if p <= lo || p >= hi {
                return false;
            }
        } else {
            let (t0, t1) = ((lo - p) / d, (hi - p) / d);
            from = from.max(t0.min(t1));
            to = to.min(t0.max(t1));
        }
    }
    from < to
}

/// Draws the net's lines in three directions.
fn cage(net: &TriangleNet) -> BezPath {
    let cell = |[i, j, k]: [usize; 3]| [[i, j, k], [i - 1, j + 1, k], [i - 1, j, k + 1]].map(|ijk| net.point(ijk));
    indices(net.degree).into_iter().filter(|ijk| ijk[0] > 0).flat_map(|ijk| polygon(&cell(ijk))).collect()
}

// A straight line becomes a curve of degree n whatever its direction: a triangle of degree n has total degree n, a rectangle of
// degree n × n twice that. The net is expanded once in powers of u₁ − ⅓ and u₂ − ⅓, by running de Casteljau's algorithm on polynomials.
// This multiplies rounding by at most (1 + 2|u₁ − ⅓| + 2|u₂ − ⅓|)ⁿ, which is 3ⁿ in a corner: negligible at practical degrees.

/// The control points of a Bézier triangle with their weights.
#[derive(Debug, Clone, PartialEq)]
struct TriangleNet {
    corners: [Point; 3],
    degree: usize,
    /// Displacements from the regular net, by [`index`].
    moves: Vec<Vec2>,
    weights: Vec<f64>,
}

/// Returns the index of control point (i, j, k) in a list ordered by k + j, then by k.
pub(super) fn index([_, j, k]: [usize; 3]) -> usize {
    let row = j + k;
    row * (row + 1) / 2 + k
}

/// Returns all (i, j, k) with i + j + k = n, in the order of their [`index`].
pub(super) fn indices(n: usize) -> Vec<[usize; 3]> {
    (0..=n).flat_map(|row| (0..=row).map(move |k| [n - row, row - k, k])).collect()
}

/// Returns (i·A + j·B + k·C)/n.
pub(super) fn regular_point(corners: [Point; 3], [i, j, k]: [usize; 3]) -> Point {
    let n = (i + j + k).max(1) as f64;
    let [a, b, c] = corners;
    a + (b - a) * (j as f64 / n) + (c - a) * (k as f64 / n)
}

/// Returns the map from a point to (u₁ − ⅓, u₂ − ⅓), the coordinates of [`expanded`].
pub(super) fn coordinates([a, b, c]: [Point; 3]) -> Affine {
    let (u, v) = (b - a, c - a);
    let middle = a + (u + v) / 3.0;
    Affine::new([u.x, u.y, v.x, v.y, middle.x, middle.y]).inverse()
}

/// Returns the polynomial with these Bernstein coefficients (by [`index`]) in powers of u₁ − ⅓ and u₂ − ⅓.
pub(super) fn expanded(n: usize, coefficients: &[f64]) -> Plane {
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
pub(super) fn basis(corners: [Point; 3], n: usize, p: Point) -> Vec<f64> {
    const THIRD: f64 = 1.0 / 3.0;
    let at = coordinates(corners) * p;
    let (u1, u2) = (at.x + THIRD, at.y + THIRD);
    let u0 = 1.0 - u1 - u2;
    let mut values = vec![1.0];
    // Bⁿᵢⱼₖ = u₀Bⁿ⁻¹ᵢ₋₁ⱼₖ + u₁Bⁿ⁻¹ᵢⱼ₋₁ₖ + u₂Bⁿ⁻¹ᵢⱼₖ₋₁, without terms of negative index.
    for level in 1..=n {
        let lower = values;
        let term = |exists: bool, ijk: [usize; 3]| if exists { lower[index(ijk)] } else { 0.0 };
        let value = |[i, j, k]: [usize; 3]| {
            u0 * term(i > 0, [i.wrapping_sub(1), j, k])
                + u1 * term(j > 0, [i, j.wrapping_sub(1), k])
                + u2 * term(k > 0, [i, j, k.wrapping_sub(1)])
        };
        values = indices(level).into_iter().map(value).collect();
    }
    values
}

impl TriangleNet {
    /// Creates the net of the identity; `None` if the corners lie on one line.
    fn regular(corners: [Point; 3], degree: usize) -> Option<Self> {
        let [a, b, c] = corners;
        let area = (b - a).cross(c - a);
        let size = (b - a).hypot2().max((c - a).hypot2());
        let count = (degree + 1) * (degree + 2) / 2;
        let (moves, weights) = (vec![Vec2::ZERO; count], vec![1.0; count]);
        (area.is_finite() && area.abs() > 1e-12 * size).then_some(Self { corners, degree, moves, weights })
    }

    /// Returns control point (i, j, k).
    fn point(&self, ijk: [usize; 3]) -> Point {
        regular_point(self.corners, ijk) + self.moves[index(ijk)]
    }

    /// Moves control point (i, j, k) by `v`.
    fn shift(&mut self, ijk: [usize; 3], v: Vec2) {
        self.moves[index(ijk)] += v;
    }

    /// Sets the weight of control point (i, j, k).
    fn set_weight(&mut self, ijk: [usize; 3], w: f64) {
        self.weights[index(ijk)] = w;
    }

    /// Returns `true` if no control point of side 0 (AB), 1 (BC) or 2 (CA) moves.
    fn side_is_fixed(&self, side: usize) -> bool {
        let size = self.corners.iter().fold(0.0, |m, p| f64::max(m, p.x.abs() + p.y.abs()));
        // On the side between two corners, the index that belongs to the third corner is 0.
        let nodes: Vec<usize> =
            indices(self.degree).into_iter().filter(|ijk| ijk[(side + 2) % 3] == 0).map(index).collect();
        nodes.iter().all(|&k| self.moves[k].hypot() <= 1e-12 * size && self.weights[k] == self.weights[nodes[0]])
    }

    /// Returns the map: outside the triangle the identity or, if `extended`, continued. Without an `inverse`, that is sought in `domain`.
    fn map(&self, extended: bool, inverse: Option<Quotient>) -> Arc<dyn Map> {
        let to_coordinates = coordinates(self.corners);
        let [a, b, c] = self.corners;
        let bounds = Rect::from_points(a, b).union_pt(c);
        // The polynomial with these Bernstein coefficients, given by `f(index, [i, j, k])`.
        let plane = |f: &dyn Fn(usize, [usize; 3]) -> f64| {
            let all: Vec<f64> = indices(self.degree).into_iter().enumerate().map(|(at, ijk)| f(at, ijk)).collect();
            expanded(self.degree, &all)
        };
        let domain = if extended { bounds.inflate(0.5 * bounds.width(), 0.5 * bounds.height()) } else { bounds };
        let mut whole = if self.weights.iter().all(|w| *w == self.weights[0]) {
            let (x, y) = (plane(&|at, _| self.moves[at].x), plane(&|at, _| self.moves[at].y));
            Quotient::polynomial(to_coordinates, x, y, domain)
        } else {
            let origin = bounds.center();
            let x = plane(&|at, ijk| (self.point(ijk).x - origin.x) * self.weights[at]);
            let y = plane(&|at, ijk| (self.point(ijk).y - origin.y) * self.weights[at]);
            Quotient::rational(to_coordinates, origin, x, y, plane(&|at, _| self.weights[at]), domain)
        };
        whole.back = inverse.map(Box::new);
        if extended {
            return whole.simplest();
        }
        // With positive weights, the denominator is positive in the triangle.
        let has_no_poles = self.weights.iter().all(|w| *w > 0.0);
        let whole: Arc<dyn Map> = if has_no_poles { Arc::new(whole.without_poles()) } else { Arc::new(whole) };
        if whole.class() == Class::Affine(Affine::IDENTITY) {
            return Arc::new(AffineMap::IDENTITY);
        }
        Arc::new(Local::new(&self.corners, whole))
    }
}

static INFO: Info = Info::new("triangle", "pull artwork about by a triangular net of control points")
    .group("Lattices and nets")
    .by_hand(ByHand {
        label: Some("Triangle net"),
        neutral: &[("degree", "2")],
        ..ByHand::NONE
    })
    .about("Lays a triangle over the artwork, with control points along its sides and inside it, and lets the artwork follow \
them. Degree 1 has the three corners; degree 2 the middles of the sides too; degree 3 one more in the middle. The higher \
the degree, the more local each point's pull. A triangle bends less stiffly than a rectangular net of the same degree, and treats \
all directions alike.\n\nA control point is named by three numbers I,J,K that add up to the degree: how near it lies to the first, \
second and third corner. 2,0,0 is the first corner of a triangle of degree 2, 0,1,1 the middle of the side opposite.\n\nOutside an \
explicit triangle (--reference) nothing moves, unless --extend is given. Where a side's control points stay in their places, inside \
and outside join without a gap; otherwise there is a warning.")
    .source("G. Farin, Triangular Bernstein-Bézier patches, CAGD 3, 1986; J. Sánchez-Reyes, J. M. Chacón, Anamorphic Free-Form \
Deformation, CAGD 46, 2016; for --birational: T. W. Sederberg, R. N. Goldman, X. Wang, Birational 2D free-form deformation of degree 1xn, CAGD 44, 2016")
    .params(Triangle::PARAMS)
    .demo(&[("move", "0,1,1:10,15"), ("weight", "1,1,0:2")])
    .examples(&[
        Example {
            what: "Pull the bottom down in the middle",
            command: "triangle samples/lettering.svg --move 0,1,1:0,60% -o out.svg",
        },
        Example {
            what: "Push out one spot of a badge; its surroundings stay",
            command: "triangle samples/badge.svg --reference '50%,5% 5%,80% 95%,80%' --degree 3 --move 1,1,1:0,-20% -o out.svg",
        },
        Example {
            what: "The same with an inverse that needs no search",
            command: "triangle samples/lettering.svg --move 0,1,1:0,60% --birational -o out.svg",
        },
        Example {
            what: "Two of the six points moved",
            command: "triangle samples/grid.svg --move 1,1,0:-30%,30% --move 1,0,1:30%,30% -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[]),
        Law::Identity(&[("degree", "7"), ("reference", "0,0 90,10 20,80"), ("extend", "true")]),
        Law::Identity(&[("weight", "1,0,1:1"), ("move", "1,0,1:0,0")]),
        Law::KeepsLines(&[("degree", "1"), ("move", "1,0,0:10,-20"), ("weight", "0,1,0:1.5"), ("extend", "true")]),
        Law::Area(&[("degree", "1"), ("reference", "0,0 100,0 0,100"), ("at", "0,1,0:200,0"), ("extend", "true")], 2.0),
    ])
    .cases(&[
        // The middle of a side: a quarter of its ends and half of its middle point.
        Case { args: SIX, at: (50.0, 0.0), to: (50.0, 15.0), tolerance: 1e-12 },
        // u = (½, ¼, ¼): B110 = 2·½·¼ = ¼ of the shift.
        Case { args: SIX, at: (25.0, 25.0), to: (25.0, 32.5), tolerance: 1e-12 },
        Case { args: SIX, at: (90.0, 90.0), to: (90.0, 90.0), tolerance: 0.0 },
        // Beyond the triangle, continued: u = (−½, ¾, ¾), B110 = −¾.
        Case {
            args: &[("reference", "0,0 100,0 0,100"), ("move", "1,1,0:0,30"), ("extend", "true")],
            at: (75.0, 75.0),
            to: (75.0, 52.5),
            tolerance: 1e-12,
        },
        // Below the box of the artwork, about which the triangle lies: u = (−0.05, 0.525, 0.525), B011 = 2·0.525².
        Case { args: &[("move", "0,1,1:0,10")], at: (50.0, 110.0), to: (50.0, 115.5125), tolerance: 1e-12 },
        // Weights draw along the sides: (¼·0 + ½·2·50 + ¼·100)/(¼ + 1 + ¼) = 50; at u = (¾, ¼, 0) it is
        // (2·⅜·50 + 100/16)/(9/16 + ¾ + 1/16) = 43.75/1.375.
        Case {
            args: &[("reference", "0,0 100,0 0,100"), ("weight", "1,1,0:2")],
            at: (25.0, 0.0),
            to: (43.75 / 1.375, 0.0),
            tolerance: 1e-12,
        },
    ]);

const SIX: Pairs = &[("reference", "0,0 100,0 0,100"), ("move", "1,1,0:0,30")];

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| {
    let Some(text) = s.texts("reference").pop() else {
        return Triangle::read(s, around(s.frame().rect))?.extend(true).build();
    };
    let corners = s.points_in("reference", text)?.try_into().map_err(|p: Vec<Point>| {
        Error::usage("reference", text, format!("has {} points; a triangle has three", p.len()))
    })?;
    Triangle::read(s, corners)?.build()
});

/// Returns a triangle about a box, twice as wide and twice as high.
fn around(frame: Rect) -> [Point; 3] {
    let half = frame.width() / 2.0;
    [
        Point::new(frame.center().x, frame.y0 - frame.height()),
        Point::new(frame.x0 - half, frame.y1),
        Point::new(frame.x1 + half, frame.y1),
    ]
}
