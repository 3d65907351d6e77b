//! The Coons patch: the map of a box onto the region between four curved sides, by the formula at [`Coons`].
//!
//! With one cubic for every side this is a completed bicubic net (Koppinen, *A plane transformation from 16 control points*,
//! equation 7). With straight L and R it is the ruled map (1−v)·B(u) + v·T(u), under which verticals stay straight.
//!
//! Lines u = k and v = k through the joints of facing sides cut the box into cells. If all four pieces of a cell are polynomials
//! (lines, or Bézier curves at their own pace), the map of the cell is a bicubic net, with exact images.

use super::curves::{Pace, Side};
use super::{AffineMap, BicubicNet, Class, Crease, Creases, Jet, Level, Map};
use kurbo::{Affine, Point, Rect, Vec2};
use std::sync::Arc;

/// The map of a box onto the region between four sides, a Coons patch:
///
/// > F(u,v) = (1−v)·B(u) + v·T(u) + (1−u)·L(v) + u·R(v) − Σ corners, blended bilinearly
///
/// with B, T the bottom and top sides from left to right, L, R the left and right sides upwards, and (u,v) an affine function of
/// the source point (S. A. Coons, *Surfaces for Computer-Aided Design of Space Forms*, MIT 1967). The lines through the joints of
/// the sides are creases.
///
/// ```
/// use pathwarp::kurbo::{Affine, Line, QuadBez};
/// use pathwarp::Seg;
/// use pathwarp::map::{Coons, Map, Pace, Side, Sides};
///
/// let line = |a, b| Side::new(&[Seg::Line(Line::new(a, b))], Pace::Parameter);
/// let arch = Side::new(&[Seg::Quad(QuadBez::new((0.0, 8.0), (5.0, 14.0), (10.0, 8.0)))], Pace::Parameter);
/// let (bottom, right, left) = (line((0.0, 0.0), (10.0, 0.0)), line((10.0, 0.0), (10.0, 8.0)), line((0.0, 0.0), (0.0, 8.0)));
/// let sides = Sides { bottom: bottom.unwrap(), right: right.unwrap(), top: arch.unwrap(), left: left.unwrap() };
/// let map = Coons::new(sides, Affine::scale(0.1));
/// assert_eq!(map.point((5.0, 10.0).into()), (5.0, 11.0).into());
/// ```
#[derive(Debug, Clone)]
pub struct Coons {
    /// The affine function from the source point to (u, v).
    pre: Affine,
    cells: Arc<Cells>,
}

/// The sides, and the parameters of their joints: lines of constant u and of constant v cut the box there.
#[derive(Debug)]
struct Cells {
    sides: Sides,
    us: Vec<f64>,
    vs: Vec<f64>,
}

/// Four sides that share their end points.
#[derive(Debug, Clone)]
pub struct Sides {
    /// The bottom side, from left to right.
    pub bottom: Side,
    /// The right side, upwards.
    pub right: Side,
    /// The top side, from left to right.
    pub top: Side,
    /// The left side, upwards.
    pub left: Side,
}

/// The distance of the outer creases from the box, relative to its size, so that rounding does not split artwork that touches the
/// edge of the box. Between the edge and the crease the map deviates by the square of this.
const OUTSIDE: f64 = 1e-9;

/// Ends closer than this share of a curve's extent coincide.
const SAME: f64 = 1e-12;

/// Returns the net, as an affine map if it is one.
fn simplest(net: BicubicNet) -> Arc<dyn Map> {
    match net.class() {
        Class::Affine(m) => Arc::new(AffineMap(m)),
        _ => Arc::new(net),
    }
}

/// The indices of the pieces of the bottom, right, top and left side.
type Cell = [usize; 4];

impl Coons {
    /// The map between `sides`. `pre` takes the source to the unit square, with v upwards.
    #[must_use]
    pub fn new(sides: Sides, pre: Affine) -> Self {
        let merged = |a: &Side, b: &Side| {
            let mut all = [a.joints(), b.joints()].concat();
            all.sort_by(f64::total_cmp);
            all.dedup_by(|b, a| *b - *a <= OUTSIDE);
            all
        };
        let (us, vs) = (merged(&sides.bottom, &sides.top), merged(&sides.left, &sides.right));
        Self { pre, cells: Arc::new(Cells { sides, us, vs }) }
    }

    /// The sides.
    #[must_use]
    pub fn sides(&self) -> &Sides {
        &self.cells.sides
    }

    /// Returns this map in its simplest form: as one net or an affine map if possible.
    #[must_use]
    pub fn simplest(self) -> Arc<dyn Map> {
        match self.net([0; 4]) {
            Some(net) if self.cells.us.is_empty() && self.cells.vs.is_empty() => simplest(net),
            _ => Arc::new(self),
        }
    }

    /// The cell at (u, v).
    fn cell(&self, u: f64, v: f64) -> Cell {
        let s = self.sides();
        [s.bottom.piece(u), s.right.piece(v), s.top.piece(u), s.left.piece(v)]
    }

    /// The jet at a source point, by the given pieces of the sides.
    fn jet_in(&self, [b, r, t, l]: Cell, p: Point) -> Jet {
        let Point { x: u, y: v } = self.pre * p;
        let s = self.sides();
        let ((b, db), (t, dt)) = (s.bottom.at_piece(b, u), s.top.at_piece(t, u));
        let ((l, dl), (r, dr)) = (s.left.at_piece(l, v), s.right.at_piece(r, v));
        let [p00, p10, p01, p11] = self.corners();
        let value = self.blend([b, r, t, l], u, v);
        let du = db * (1.0 - v) + dt * v + ((r - p10.lerp(p11, v)) - (l - p00.lerp(p01, v)));
        let dv = (t - b) + (dl - (p01 - p00)) * (1.0 - u) + (dr - (p11 - p10)) * u;
        let [a, bb, c, d, ..] = self.pre.as_coeffs();
        Jet { p: value, dx: du * a + dv * bb, dy: du * c + dv * d }
    }

    /// The value at a source point, by the given pieces of the sides.
    fn point_in(&self, [b, r, t, l]: Cell, p: Point) -> Point {
        let Point { x: u, y: v } = self.pre * p;
        let s = self.sides();
        let (b, t) = (s.bottom.point_at_piece(b, u), s.top.point_at_piece(t, u));
        let (l, r) = (s.left.point_at_piece(l, v), s.right.point_at_piece(r, v));
        self.blend([b, r, t, l], u, v)
    }

    /// F(u,v), from the points of the bottom, right, top and left side.
    fn blend(&self, [b, r, t, l]: [Point; 4], u: f64, v: f64) -> Point {
        let [p00, p10, p01, p11] = self.corners();
        // Written as a sum of differences between nearby points, which rounds less.
        b + (t - b) * v + ((l - p00.lerp(p01, v)) * (1.0 - u) + (r - p10.lerp(p11, v)) * u)
    }

    /// The corners: bottom left, bottom right, top left, top right.
    fn corners(&self) -> [Point; 4] {
        let ([a, b], [c, d]) = (self.sides().bottom.ends(), self.sides().top.ends());
        [a, b, c, d]
    }

    /// Returns `Some(true)` if verticals stay vertical, `Some(false)` if horizontals stay horizontal, because both curves of a pair run at
    /// even steps along an axis between the same ends. The inverse then has a closed form.
    fn kept_lines(&self) -> Option<bool> {
        let s = self.sides();
        let pairs = [(true, Pace::Width, &s.bottom, &s.top), (false, Pace::Height, &s.left, &s.right)];
        pairs.into_iter().find_map(|(upright, pace, a, b)| {
            let along = |p: Point| if upright { p.x } else { p.y };
            let ([a0, a1], [b0, b1]) = (a.ends().map(along), b.ends().map(along));
            let same_ends = (a0 - b0).abs().max((a1 - b1).abs()) <= SAME * (a1 - a0).abs();
            (same_ends && a.pace() == pace && b.pace() == pace).then_some(upright)
        })
    }

    /// The parameters of the creases: of u for `upright` lines, of v for level ones.
    fn crease_parameters(&self, upright: bool) -> Vec<f64> {
        let (s, cells) = (self.sides(), &self.cells);
        let (joints, pair) = if upright { (&cells.us, [&s.bottom, &s.top]) } else { (&cells.vs, [&s.left, &s.right]) };
        let smooth = pair.iter().all(|s| s.continues_smoothly());
        [joints.as_slice(), if smooth { &[] } else { &[-OUTSIDE, 1.0 + OUTSIDE] }].concat()
    }

    /// The bicubic net of a cell; `None` if one of its pieces is not polynomial.
    fn net(&self, cell: Cell) -> Option<BicubicNet> {
        let s = self.sides();
        let [b, r, t, l] = cell;
        // The range of the cell: the common range of both facing pieces.
        let range = |joints: &[f64], is_in_cell: &dyn Fn(f64) -> bool| {
            let ends = [&[0.0], joints, &[1.0]].concat();
            ends.windows(2).find(|e| is_in_cell(0.5 * (e[0] + e[1]))).map(|e| (e[0], e[1]))
        };
        let (u0, u1) = range(&self.cells.us, &|m| s.bottom.piece(m) == b && s.top.piece(m) == t)?;
        let (v0, v1) = range(&self.cells.vs, &|m| s.right.piece(m) == r && s.left.piece(m) == l)?;
        let points = |c: kurbo::CubicBez| [c.p0, c.p1, c.p2, c.p3].map(Point::to_vec2);
        let bottom = points(s.bottom.cubic(b, u0, u1)?);
        let top = points(s.top.cubic(t, u0, u1)?);
        let left = points(s.left.cubic(l, v0, v1)?);
        let right = points(s.right.cubic(r, v0, v1)?);
        let [p00, p10, p01, p11] = self.corners().map(Point::to_vec2);
        // The Bernstein coefficients of degree 3 of a linear function are its values at thirds, and every term is the product of one factor
        // in u and one in v.
        let third = |a: f64, b: f64, i: usize| a + (b - a) * i as f64 / 3.0;
        let net = std::array::from_fn(|j| {
            let v = third(v0, v1, j);
            std::array::from_fn(|i| {
                let u = third(u0, u1, i);
                let ruled: Vec2 = bottom[i] * (1.0 - v) + top[i] * v;
                let corner = (p00 * (1.0 - u) + p10 * u) * (1.0 - v) + (p01 * (1.0 - u) + p11 * u) * v;
                (ruled + (left[j] * (1.0 - u) + right[j] * u) - corner).to_point()
            })
        });
        let to_cell = Affine::scale_non_uniform(1.0 / (u1 - u0), 1.0 / (v1 - v0)) * Affine::translate((-u0, -v0));
        Some(BicubicNet::new(&net, to_cell * self.pre))
    }
}

impl Map for Coons {
    fn jet(&self, p: Point) -> Jet {
        let q = self.pre * p;
        self.jet_in(self.cell(q.x, q.y), p)
    }

    fn point(&self, p: Point) -> Point {
        let q = self.pre * p;
        self.point_in(self.cell(q.x, q.y), p)
    }

    fn creases(&self, out: &mut Creases) {
        let [a, b, c, d, e, f] = self.pre.as_coeffs();
        for u in self.crease_parameters(true) {
            out.push(Crease::kink(Level::Line { a, b: c, c: e - u }));
        }
        for v in self.crease_parameters(false) {
            out.push(Crease::kink(Level::Line { a: b, b: d, c: f - v }));
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let q = self.pre * inside;
        let cell = self.cell(q.x, q.y);
        Some(match self.net(cell) {
            Some(net) => simplest(net),
            None => Arc::new(CellMap { whole: self.clone(), cell }),
        })
    }

    fn detail(&self, _: Rect) -> Option<f64> {
        Some(f64::INFINITY)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        let upright = self.kept_lines()?;
        Some(Arc::new(AxisInverse { whole: self.clone(), upright, cell: None }))
    }
}

/// The inverse of a map that keeps verticals, (x, y) ↦ (u, (y − b(u)) / (t(u) − b(u))), or horizontals, with x and y exchanged.
struct AxisInverse {
    whole: Coons,
    /// `true` if verticals are kept.
    upright: bool,
    /// The cell of a branch; `None` for the whole inverse.
    cell: Option<Cell>,
}

impl AxisInverse {
    /// The range of x, or of y, over which u, or v, runs from 0 to 1.
    fn range(&self) -> [f64; 2] {
        let s = self.whole.sides();
        if self.upright { s.bottom.ends().map(|p| p.x) } else { s.left.ends().map(|p| p.y) }
    }

    /// The parameter of the kept line through a point: u, or v.
    fn parameter(&self, q: Point) -> f64 {
        let [a, b] = self.range();
        ((if self.upright { q.x } else { q.y }) - a) / (b - a)
    }

    /// The cell on the kept line of a parameter.
    fn cell(&self, parameter: f64) -> Cell {
        let s = self.whole.sides();
        let piece = |side: &Side, is_along: bool| if is_along { side.piece(parameter) } else { 0 };
        let up = self.upright;
        self.cell
            .unwrap_or_else(|| [piece(&s.bottom, up), piece(&s.right, !up), piece(&s.top, up), piece(&s.left, !up)])
    }
}

impl Map for AxisInverse {
    fn jet(&self, q: Point) -> Jet {
        let k = self.parameter(q);
        let cell = self.cell(k);
        let (s, [b, r, t, l]) = (self.whole.sides(), cell);
        let uv = if self.upright {
            let (from, to) = (s.bottom.point_at_piece(b, k).y, s.top.point_at_piece(t, k).y);
            Point::new(k, (q.y - from) / (to - from))
        } else {
            let (from, to) = (s.left.point_at_piece(l, k).x, s.right.point_at_piece(r, k).x);
            Point::new((q.x - from) / (to - from), k)
        };
        let p = self.whole.pre.inverse() * uv;
        self.whole.jet_in(cell, p).inverted(p)
    }

    fn creases(&self, out: &mut Creases) {
        let ([from, to], (a, b)) = (self.range(), if self.upright { (1.0, 0.0) } else { (0.0, 1.0) });
        for k in self.whole.crease_parameters(self.upright) {
            out.push(Crease::kink(Level::Line { a, b, c: -(from + k * (to - from)) }));
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let cell = Some(self.cell(self.parameter(inside)));
        Some(Arc::new(Self { whole: self.whole.clone(), upright: self.upright, cell }))
    }

    fn detail(&self, _: Rect) -> Option<f64> {
        Some(f64::INFINITY)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.whole.clone()))
    }
}

/// The smooth map of one cell, continued beyond it.
struct CellMap {
    whole: Coons,
    cell: Cell,
}

impl Map for CellMap {
    fn jet(&self, p: Point) -> Jet {
        self.whole.jet_in(self.cell, p)
    }

    fn point(&self, p: Point) -> Point {
        self.whole.point_in(self.cell, p)
    }

    fn detail(&self, _: Rect) -> Option<f64> {
        Some(f64::INFINITY)
    }
}
