//! Free-form deformation of degree 1×n with a closed-form inverse, by the formula at [`Birational`].
//!
//! The control points of the rows are free. The weights make both rows monoids that are followed by the same line L(t), which turns about
//! the point A in which the lines through the first and through the last pair of control points meet (T. W. Sederberg, R. N. Goldman, X.
//! Wang, *Birational 2D free-form deformation of degree 1×n*, CAGD 44, 2016). Then t and s of a point X have closed forms:
//!
//! > t = ℓ₀·X / (ℓ₀·X − ℓ₁·X),  s = f₀(X) / (f₀(X) − f₁(X))
//!
//! with f₀, f₁ the implicit equations of the rows (`Monoid::implicit`). The code computes s from the rows at t: the same number
//! with less rounding. Lines of constant t stay straight lines.
//!
//! **Normalisation of the weights.** Scaling ℓ₁ multiplies wᵢ by gⁱ in both rows, which changes only the speed of t; a common factor of a
//! row changes nothing. Here w₀₀ = w₁₀ = 1 and w₀ₙ·w₁ₙ = 1, so that the map depends on the points alone and a rectangle gives the identity.
//!
//! **B-spline rows** are cut into Bézier pieces by knot insertion, each with a point A of its own. Adjacent pieces share the line between
//! them and its points: the rows of a piece start with the weights with which the rows of the previous piece end. Speeds are chosen so
//! that both sides of every joint agree in the geometric mean over both rows, with all w₀ₙ·w₁ₙ as near 1 as that allows. Rows
//! keep their tangents across a joint; the map has a crease there.

mod monoid;
#[cfg(test)]
mod tests;

use super::rational_bezier::{Scaled, binomials};
use super::{Class, Crease, Creases, Formula, Jet, Level, Map, Patch, RationalBezier, Real, bspline};
use crate::error::GeometryError;
use kurbo::{Point, Rect, Vec2};
use monoid::ImplicitLine;
pub use monoid::Monoid;
use std::sync::Arc;

/// The direction of the rows, which determines how s and t run in the source.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rows {
    /// The rows are the left and the right side: s from left to right, t from top to bottom. Horizontals stay straight.
    LeftRight,
    /// The rows are the top and the bottom: s from top to bottom, t from left to right. Verticals stay straight.
    TopBottom,
}

/// A rational map of degree 1×n whose inverse is rational too:
///
/// > P(s,t) = (1−s)·P₀(t) + s·P₁(t)
///
/// with P₀, P₁ rational Bézier curves of degree n through free control points, the rows. Their weights follow from the points, such that s
/// and t of a point have closed forms (T. W. Sederberg, R. N. Goldman, X. Wang, *Birational 2D free-form deformation of degree 1×n*, CAGD
/// 44, 2016). Lines of constant t stay straight. B-spline rows make one such map for each Bézier piece, with creases between them.
///
/// ```
/// use pathwarp::kurbo::{Point, Rect};
/// use pathwarp::map::{Birational, Map, Rows};
///
/// let top = [(0.0, 0.0), (50.0, -30.0), (100.0, 0.0)].map(Point::from);
/// let bottom = [(0.0, 100.0), (50.0, 90.0), (100.0, 100.0)].map(Point::from);
/// let frame = Rect::new(0.0, 0.0, 100.0, 100.0);
/// let map = Birational::new(frame, Rows::TopBottom, [&top, &bottom], None, false, ["top", "bottom"])?;
/// let p = Point::new(30.0, 40.0);
/// assert!(Map::point(&map.inverted(), map.point(p)).distance(p) < 1e-12);
/// # Ok::<(), pathwarp::GeometryError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Birational {
    region: Rect,
    rows: Rows,
    pieces: Vec<BirationalPiece>,
}

/// One Bézier piece: its rows, and the patch they span.
#[derive(Debug, Clone, PartialEq)]
struct BirationalPiece {
    rows: [Monoid; 2],
    patch: Arc<Patch>,
}

impl Birational {
    /// The map of `region` to the lattice with these rows of equally many points, at least two. `spline` is the degree of uniform
    /// clamped B-spline rows; `None` makes each row one Bézier curve. With `allow_poles`, weights may be negative. `names` are
    /// the names of the rows in errors.
    ///
    /// # Errors
    /// [`GeometryError::Coincident`] or [`GeometryError::WrongSide`] if the points are not in general position: a row may meet
    /// the line through the first pair only in its first point, and the line through the last pair only in its last point.
    pub fn new(
        region: Rect,
        rows: Rows,
        points: [&[Point]; 2],
        spline: Option<usize>,
        allow_poles: bool,
        names: [&str; 2],
    ) -> Result<Self, GeometryError> {
        let count = points[0].len().min(points[1].len());
        let (degree, cells) = match spline {
            Some(d) => (d.min(count - 1), count - d.min(count - 1)),
            None => (count - 1, 1),
        };
        let mut unscaled = Vec::with_capacity(cells);
        for (k, matrix) in bspline::extraction(degree, cells).iter().enumerate() {
            let bezier = points.map(|row| {
                let point = |m: &Vec<f64>| {
                    let local = m.iter().zip(&row[k..]);
                    local.fold(Vec2::ZERO, |sum, (c, p)| sum + p.to_vec2() * *c).to_point()
                };
                matrix.iter().map(point).collect::<Vec<_>>()
            });
            let name =
                |n: &str| if cells == 1 { n.to_owned() } else { format!("{n} (Bézier piece {} of {cells})", k + 1) };
            unscaled.push(general_rows(&bezier, allow_poles, &names.map(name))?);
        }
        let not_finite = || GeometryError::NotFinite { shape: names[0].to_owned(), at: points[0][0] };
        Ok(Self::from_monoids(region, rows, normalised(unscaled).ok_or_else(not_finite)?))
    }

    /// The map with one piece for each pair of rows, whose weights are given.
    fn from_monoids(region: Rect, rows: Rows, monoids: Vec<[Monoid; 2]>) -> Self {
        let cells = monoids.len();
        let joint = |a: f64, size: f64, k: usize| a + size * (k as f64 / cells as f64);
        let piece = |(k, pair): (usize, [Monoid; 2])| {
            let homogeneous = |r: usize, j: usize| {
                let (p, w) = (pair[r].points[j], pair[r].weights[j]);
                [p.x * w, p.y * w, w]
            };
            let (n, r) = (pair[0].points.len() - 1, region);
            let (rect, degree) = match rows {
                Rows::LeftRight => {
                    (Rect::new(r.x0, joint(r.y0, r.height(), k), r.x1, joint(r.y0, r.height(), k + 1)), [1, n])
                }
                Rows::TopBottom => {
                    (Rect::new(joint(r.x0, r.width(), k), r.y0, joint(r.x0, r.width(), k + 1), r.y1), [n, 1])
                }
            };
            let point = |i: usize| match rows {
                Rows::LeftRight => homogeneous(i % 2, i / 2),
                Rows::TopBottom => homogeneous(i / (n + 1), i % (n + 1)),
            };
            let net: Vec<[f64; 3]> = (0..2 * (n + 1)).map(point).collect();
            BirationalPiece { patch: Arc::new(Patch::rational(rect, degree, &net)), rows: pair }
        };
        Self { region, rows, pieces: monoids.into_iter().enumerate().map(piece).collect() }
    }

    /// The weights of both rows of each Bézier piece.
    pub fn weights(&self) -> impl Iterator<Item = [&[f64]; 2]> {
        self.pieces.iter().map(|p| [p.rows[0].weights.as_slice(), &p.rows[1].weights])
    }

    /// The rows of each Bézier piece.
    pub fn rows(&self) -> impl Iterator<Item = &[Monoid; 2]> {
        self.pieces.iter().map(|p| &p.rows)
    }

    /// Returns the net of these points with weights kᵢ·gʲ·wᵢⱼ, all the freedom that leaves the map birational: k₁/k₀ spaces it across
    /// the rows, g along them. `None` if a row has several Bézier pieces, or if a weight is not finite and positive.
    #[must_use]
    pub fn respaced(&self, k: [f64; 2], g: f64) -> Option<Self> {
        let [BirationalPiece { rows: [a, b], .. }] = self.pieces.as_slice() else { return None };
        let pair = [a.paced(g)?.weighted(k[0]), b.paced(g)?.weighted(k[1])];
        let is_valid = |m: &Monoid| m.weights.iter().all(|w| w.is_normal());
        (k[0] > 0.0 && k[1] > 0.0 && g > 0.0 && pair.iter().all(is_valid))
            .then(|| Self::from_monoids(self.region, self.rows, vec![pair]))
    }

    /// A, the point in which all lines across the rows of the first piece meet, in homogeneous coordinates; at infinity for parallel lines.
    #[must_use]
    pub fn axis(&self) -> [f64; 3] {
        let Monoid { first, last, .. } = &self.pieces[0].rows[0];
        // Relative to a point on the first line, on which A lies.
        let (det, c) = (first.normal.cross(last.normal), last.at(first.through));
        let (through, along) = (first.through.to_vec2(), Vec2::new(first.normal.y, -first.normal.x));
        let size = first.normal.hypot() * last.normal.hypot();
        let w = if det.abs() <= PARALLEL * size { 0.0 } else { det };
        [along.x * c + through.x * w, along.y * c + through.y * w, w]
    }

    /// The map with one Bézier piece whose line of parameter t joins A and (1 − t)·Q₀ + t·Q₁, two points on the lines through the first
    /// and the last pair of points: these lines divide the segment from Q₀ to Q₁ evenly (equations 9 to 12).
    ///
    /// # Errors
    /// The errors of [`Monoid::new`].
    pub fn along(&self, q: [Point; 2]) -> Result<Self, GeometryError> {
        let [a, b] = &self.pieces[0].rows;
        let row = |m: &Monoid| Monoid::new(&m.points, self.axis(), q);
        Ok(Self::from_monoids(self.region, self.rows, vec![[row(a)?, row(b)?]]))
    }

    /// The largest angle in degrees by which curves along the rows turn on a line between two pieces, and the image point where they do.
    #[must_use]
    pub fn kink(&self) -> Option<(f64, Point)> {
        const SAMPLES: usize = 16;
        let turn = |w: &[BirationalPiece], n: usize| {
            let (r, share) = (w[1].patch.rect, n as f64 / SAMPLES as f64);
            let (p, along): (Point, fn(&Jet) -> Vec2) = match self.rows {
                Rows::LeftRight => (Point::new(r.x0 + r.width() * share, r.y0), |j| j.dy),
                Rows::TopBottom => (Point::new(r.x0, r.y0 + r.height() * share), |j| j.dx),
            };
            let [a, b] = [w[0].patch.jet(p), w[1].patch.jet(p)];
            let angle = along(&a).cross(along(&b)).atan2(along(&a).dot(along(&b)));
            (angle.abs().to_degrees(), b.p)
        };
        let joints = self.pieces.windows(2).flat_map(|w| (0..=SAMPLES).map(|n| turn(w, n)).collect::<Vec<_>>());
        joints.max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The inverse map, in closed form.
    #[must_use]
    pub fn inverted(&self) -> BirationalInverse {
        BirationalInverse { forward: self.clone() }
    }

    /// The patch at a source point.
    fn patch(&self, p: Point) -> &Arc<Patch> {
        let (r, pieces) = (self.region, &self.pieces);
        let t = match self.rows {
            Rows::LeftRight => (p.y - r.y0) / r.height(),
            Rows::TopBottom => (p.x - r.x0) / r.width(),
        };
        &pieces[((t * pieces.len() as f64).max(0.0) as usize).min(pieces.len() - 1)].patch
    }
}

impl Map for Birational {
    fn jet(&self, p: Point) -> Jet {
        self.patch(p).jet(p)
    }

    fn point(&self, p: Point) -> Point {
        self.patch(p).point(p)
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        if let [one] = self.pieces.as_slice() {
            one.patch.jets(ps, out);
        } else {
            ps.iter().zip(out).for_each(|(p, o)| *o = self.jet(*p));
        }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        if let [one] = self.pieces.as_slice() {
            one.patch.points(ps, out);
        } else {
            ps.iter().zip(out).for_each(|(p, o)| *o = self.point(*p));
        }
    }

    fn class(&self) -> Class {
        let first = self.pieces[0].patch.class();
        if self.pieces.iter().all(|p| p.patch.class() == first) { first } else { Class::Smooth }
    }

    fn creases(&self, out: &mut Creases) {
        let (r, count) = (self.region, self.pieces.len());
        for k in 1..count {
            let share = k as f64 / count as f64;
            out.push(Crease::kink(match self.rows {
                Rows::LeftRight => Level::Line { a: 0.0, b: 1.0, c: -(r.y0 + share * r.height()) },
                Rows::TopBottom => Level::Line { a: 1.0, b: 0.0, c: -(r.x0 + share * r.width()) },
            }));
        }
        if self.pieces.iter().any(|p| p.patch.has_edge()) {
            let map = self.clone();
            out.push(Crease::edge(Level::Field(Arc::new(move |p: Point| map.patch(p).denominator(p)))));
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        (self.pieces.len() > 1).then(|| Arc::clone(self.patch(inside)) as Arc<dyn Map>)
    }

    fn detail(&self, _: Rect) -> Option<f64> {
        Some(f64::INFINITY)
    }

    /// The image of a curve of degree d has degree d·(1+n).
    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        match self.pieces.as_slice() {
            [one] => one.patch.image(curve),
            _ => None,
        }
    }

    /// One preimage in each piece that reaches to the point's line.
    fn preimages(&self, q: Point) -> Option<Vec<Point>> {
        /// Rounding of t: points on the line between two pieces count in both.
        const NEAR: f64 = 1e-9;
        let (back, last) = (self.inverted(), self.pieces.len() - 1);
        let found = |k: usize| {
            let (s, t) = BirationalInverse::parameters(&self.pieces[k].rows, q.x, q.y);
            let is_in_piece = (t >= -NEAR || k == 0) && (t <= 1.0 + NEAR || k == last);
            is_in_piece.then(|| Point::from(back.source(k, s, t)))
        };
        Some((0..=last).filter_map(found).collect())
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.inverted()))
    }
}

/// The cost of a candidate piece for the distance of t outside [0, 1], relative to the distance of s from the middle.
const OUTSIDE_COST: f64 = 1e6;
/// The cost of a candidate piece in which the point lies on the far side of A.
const BEHIND_COST: f64 = 1e12;

/// The inverse of a [`Birational`], in closed form.
#[derive(Debug, Clone, PartialEq)]
pub struct BirationalInverse {
    forward: Birational,
}

impl BirationalInverse {
    /// The parameters (s, t) of a point by the rows of one piece.
    fn parameters<S: Real>(rows: &[Monoid; 2], x: S, y: S) -> (S, S) {
        let (alpha, beta) = (-rows[0].last.value_at(x, y), rows[0].first.value_at(x, y));
        // The homogeneous points of the rows at t, times (α+β)ⁿ, relative to (x, y). They lie at opposite ends of a line through (x, y).
        let relative = |m: &Monoid| {
            // Relative to a control point, so that the sums are not differences of large numbers.
            let o = m.points[0];
            let (dx, dy) = (x - o.x, y - o.y);
            let n = m.points.len() - 1;
            let term = |i: usize| (m.weights[i], m.points[i] - o);
            let (w, d) = term(n);
            let (mut sx, mut sy, mut sw) = (S::from(w * d.x), S::from(w * d.y), S::from(w));
            // Σ cᵢ C(n,i) αⁿ⁻ⁱ βⁱ for three sets of c, by Horner's scheme in β with running powers of α.
            let (mut power, mut binomial) = (S::from(1.0), 1.0);
            for i in (0..n).rev() {
                power = power * alpha;
                binomial = binomial * (i + 1) as f64 / (n - i) as f64;
                let (w, d) = term(i);
                let share = power * (w * binomial);
                (sx, sy, sw) = (sx * beta + share * d.x, sy * beta + share * d.y, sw * beta + share);
            }
            (sx - sw * dx, sy - sw * dy)
        };
        let (a, b) = (relative(&rows[0]), relative(&rows[1]));
        let (dx, dy) = (a.0 - b.0, a.1 - b.1);
        ((a.0 * dx + a.1 * dy) / (dx * dx + dy * dy), beta / (alpha + beta))
    }

    /// The index of the piece whose image contains a point.
    fn piece(&self, p: Point) -> usize {
        let pieces = &self.forward.pieces;
        let last = pieces.len() - 1;
        if last == 0 {
            return 0;
        }
        let mut best = (f64::INFINITY, 0);
        for (k, piece) in pieces.iter().enumerate() {
            let (s, t) = Self::parameters(&piece.rows, p.x, p.y);
            let outside = if k == 0 { 0.0 } else { -t }.max(if k == last { 0.0 } else { t - 1.0 }).max(0.0);
            // The denominator is negative on the far side of A.
            let in_front = piece.patch.denominator(self.source(k, s, t).into()) > 0.0;
            let cost = outside * OUTSIDE_COST + (s - 0.5).abs() + if in_front { 0.0 } else { BEHIND_COST };
            if cost < best.0 {
                best = (cost, k);
            }
        }
        best.1
    }

    /// The source point at (s, t) of a piece.
    fn source<S: Real>(&self, piece: usize, s: S, t: S) -> (S, S) {
        let r = self.forward.region;
        let t = (t + piece as f64) / self.forward.pieces.len() as f64;
        match self.forward.rows {
            Rows::LeftRight => (s * r.width() + r.x0, t * r.height() + r.y0),
            Rows::TopBottom => (t * r.width() + r.x0, s * r.height() + r.y0),
        }
    }
}

impl Formula for BirationalInverse {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let k = self.piece(Point::new(x.value(), y.value()));
        let (s, t) = Self::parameters(&self.forward.pieces[k].rows, x, y);
        self.source(k, s, t)
    }

    fn class(&self) -> Class {
        match Map::class(&self.forward) {
            Class::Affine(m) => Class::Affine(m.inverse()),
            _ => Class::Smooth,
        }
    }

    fn creases(&self, out: &mut Creases) {
        // The lines between pieces are creases.
        for p in &self.forward.pieces[1..] {
            let l = p.rows[0].first;
            let c = -l.normal.dot(l.through.to_vec2());
            out.push(Crease::kink(Level::Line { a: l.normal.x, b: l.normal.y, c }));
        }
        // The forward denominator is infinite where s or t is; its reciprocal changes sign there.
        let inverse = self.clone();
        let level = move |q: Point| {
            let k = inverse.piece(q);
            let (s, t) = Self::parameters(&inverse.forward.pieces[k].rows, q.x, q.y);
            1.0 / inverse.forward.pieces[k].patch.denominator(inverse.source(k, s, t).into())
        };
        if !self.forward.pieces.iter().all(|p| p.patch.is_polynomial()) {
            out.push(Crease::edge(Level::Field(Arc::new(level))));
        }
    }

    /// The image of a curve of degree d has degree d·(1+n): (s, t, 1) ~ (χ·f₀, β·(f₀−f₁), χ·(f₀−f₁)), χ = α + β.
    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        let [piece] = self.forward.pieces.as_slice() else { return None };
        let line = |l: ImplicitLine, k: f64| {
            let c = l.normal.dot(l.through.to_vec2());
            Scaled::new(curve.points.iter().map(|p| k * (l.normal.x * p[0] + l.normal.y * p[1] - c * p[2])))
        };
        let n = piece.rows[0].points.len() - 1;
        let (alpha, beta) = (line(piece.rows[0].last, -1.0).powers(n), line(piece.rows[0].first, 1.0).powers(n));
        let w = curve.coordinate(2);
        let sum = |c: &[f64]| {
            let n = c.len() - 1;
            let mut out = Scaled::zero(n * curve.degree());
            for (i, (c, binomial)) in c.iter().zip(binomials(n)).enumerate() {
                out.add_scaled(c * binomial, &alpha[n - i].times(&beta[i]));
            }
            out
        };
        let implicit = |m: &Monoid| {
            let mut f = sum(&m.weights);
            f.add_scaled(-1.0, &sum(&m.h).times(&w));
            f
        };
        let (f0, f1) = (implicit(&piece.rows[0]), implicit(&piece.rows[1]));
        let mut difference = f0.clone();
        difference.add_scaled(-1.0, &f1);
        let mut chi = alpha[1].clone();
        chi.add_scaled(1.0, &beta[1]);
        let terms = [chi.times(&f0), beta[1].times(&difference), chi.times(&difference)];
        let r = self.forward.region;
        Some(RationalBezier::from_coordinates(terms.each_ref(), false).mapped(|[s, t, w]| {
            let (x, y) = if self.forward.rows == Rows::LeftRight { (s, t) } else { (t, s) };
            [x * r.width() + r.x0 * w, y * r.height() + r.y0 * w, w]
        }))
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        if self.forward.pieces.len() == 1 {
            return None;
        }
        let piece = self.forward.pieces[self.piece(inside)].clone();
        let one = Birational { region: piece.patch.rect, rows: self.forward.rows, pieces: vec![piece] };
        Some(Arc::new(one.inverted()))
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.forward.clone()))
    }
}

// The weights of the rows: checks for general position, and the normalisation over all pieces.

/// End lines whose directions differ by less than this are parallel.
const PARALLEL: f64 = 1e-14;
/// Points closer to a line than this share of the lattice's size count as on it.
const ON_LINE: f64 = 1e-9;

/// The two rows as monoids, with the speed of t still arbitrary. Checks that the points are in general position.
fn general_rows(
    points: &[Vec<Point>; 2],
    allow_poles: bool,
    names: &[String; 2],
) -> Result<[Monoid; 2], GeometryError> {
    let n = points[0].len() - 1;
    let b = points.iter().flatten().fold(Rect::from_points(points[0][0], points[0][0]), |b, p| b.union_pt(*p));
    let size = b.width().hypot(b.height());
    let mut lines = [0, n].map(|j| ImplicitLine::join(points[0][j], points[1][j]));
    for (line, j) in lines.iter_mut().zip([0, n]) {
        let length = line.normal.hypot();
        if length <= ON_LINE * size {
            let path = format!("{} and {}", names[0], names[1]);
            return Err(GeometryError::Coincident { path, which: [j + 1, j + 1], at: points[0][j] });
        }
        // Scale to values near 1 within the lattice, so that n-th powers stay in range.
        *line = line.scaled(1.0 / (length * size));
    }
    let [first, last] = lines;
    let side = if first.at(points[0][n]) >= 0.0 { 1.0 } else { -1.0 };
    for (row, name) in points.iter().zip(names) {
        for (i, p) in row.iter().enumerate() {
            let distances = [(i > 0, side * first.at(*p), "first"), (i < n, -side * last.at(*p), "last")];
            for (is_off_end, d, end) in distances {
                if is_off_end && ((d <= ON_LINE && !allow_poles) || d.abs() <= ON_LINE) {
                    let (path, which, at, on) = (name.clone(), i + 1, *p, d.abs() <= ON_LINE);
                    let line = points.each_ref().map(|row| row[if end == "first" { 0 } else { n }]);
                    return Err(GeometryError::WrongSide { path, which, at, end, line, on });
                }
            }
        }
    }
    let not_finite = || GeometryError::NotFinite { shape: names[0].clone(), at: points[0][0] };
    let [a, b] = points;
    let rows = Monoid::between(a, first, last).zip(Monoid::between(b, first, last));
    rows.map(|(a, b)| [a, b]).ok_or_else(not_finite)
}

/// Normalises the speeds and the common factors of the rows, piece after piece. `None` if a weight is zero or not finite.
fn normalised(pieces: Vec<[Monoid; 2]>) -> Option<Vec<[Monoid; 2]>> {
    let n = pieces[0][0].points.len() - 1;
    // ln |w₀ᵢ·w₁ᵢ / (w₀ⱼ·w₁ⱼ)|.
    let log_ratio = |rows: &[Monoid; 2], i: usize, j: usize| -> f64 {
        rows.iter().map(|m| (m.weights[i] / m.weights[j]).abs().ln()).sum()
    };
    // ln g is alternately a + x and a − x; x brings the end weights as close to 1 as possible.
    let mut a = vec![0.0];
    for w in pieces.windows(2) {
        let next = 0.5 * (log_ratio(&w[0], n - 1, n) - log_ratio(&w[1], 1, 0)) - a[a.len() - 1];
        a.push(next);
    }
    let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let ends = pieces.iter().zip(&a).enumerate();
    let sum: f64 = ends.map(|(k, (rows, a))| sign(k) * (log_ratio(rows, n, 0) + 2.0 * n as f64 * a)).sum();
    let x = -sum / (2 * n * pieces.len()) as f64;
    let mut factor = [1.0; 2];
    let mut out = Vec::with_capacity(pieces.len());
    for (k, ([p, q], a)) in pieces.into_iter().zip(a).enumerate() {
        let g = (a + sign(k) * x).exp();
        let pair = [p.paced(g)?.weighted(factor[0]), q.paced(g)?.weighted(factor[1])];
        factor = [0, 1].map(|r| pair[r].weights[n]);
        out.push(pair);
    }
    Some(out)
}
