//! Free-form deformation of degree 1×n that can be undone in closed form.
//!
//! > P(s,t) = (1−s)·P₀(t) + s·P₁(t)
//!
//! with P₀, P₁ rational Bézier curves of degree n, the rows. Their control points are free; weights make both rows monoids
//! that the same line L(t) follows, turning about the point A where the first and the last pair's lines meet (T. W. Sederberg,
//! J. Zheng, *Birational 2D free-form deformation of degree 1×n*, CAGD 2016). Then t and s of a place X have closed forms:
//!
//! > t = ℓ₀·X / (ℓ₀·X − ℓ₁·X),  s = f₀(X) / (f₀(X) − f₁(X))
//!
//! with f₀, f₁ the rows' implicit equations ([`Monoid::implicit`]); here s comes from the rows at t, which is the same number
//! with less rounding. Lines of constant t stay straight lines.
//!
//! **What fixes the weights.** Scaling ℓ₁ multiplies wᵢ by gⁱ in both rows, and changes only the pace of t; and a row's weights
//! have a common factor. Here w₀₀ = w₁₀ = 1 and w₀ₙ·w₁ₙ = 1, so that the map depends on the points alone and a rectangle
//! gives the identity.
//!
//! **B-spline rows** are cut into Bézier pieces (knot insertion), each with an A of its own. Neighbours share the line between
//! them, and its points: a piece's rows start with the weights with which the one before ends. Paces are chosen so that
//! the speeds on both sides of every joint agree in the geometric mean of both rows, and all w₀ₙ·w₁ₙ are as near 1 as
//! that allows. Across a joint the rows keep their tangents; the map has a crease there.

use super::bernstein::Scaled;
use super::monoid::{Monoid, Ray};
use super::{Class, Crease, Creases, Formula, Jet, Level, Map, Patch, RationalBezier, Real, bspline};
use crate::error::GeometryError;
use kurbo::{Point, Rect, Vec2};
use std::sync::Arc;

/// Where s and t run in the source.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rows {
    /// The rows are the left and the right side: s from left to right, t from top to bottom. Horizontals stay straight.
    LeftRight,
    /// The rows are the top and the bottom: s from top to bottom, t from left to right. Verticals stay straight.
    TopBottom,
}

/// A map of degree 1×n with a rational inverse.
#[derive(Debug, Clone, PartialEq)]
pub struct Birational {
    region: Rect,
    rows: Rows,
    pieces: Vec<Piece>,
}

/// One Bézier piece.
#[derive(Debug, Clone, PartialEq)]
struct Piece {
    rows: [Monoid; 2],
    patch: Arc<Patch>,
}

/// Nearer to a line than this share of the lattice's size counts as on it.
const ON_LINE: f64 = 1e-9;

impl Birational {
    /// The map of `region` into the lattice with these rows, which have equally many points (at least two). `spline`: the
    /// degree of uniform clamped B-spline rows. The names are the rows' in messages. With `allow_poles`, weights may be
    /// negative.
    ///
    /// # Errors
    /// [`GeometryError::Coincident`] and [`GeometryError::WrongSide`] if the points are not in constrained general position:
    /// a row must meet the first pair's line only in its first point, and the last pair's only in its last.
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
        let mut raw = Vec::with_capacity(cells);
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
            raw.push(general_rows(&bezier, allow_poles, &names.map(name))?);
        }
        let rows_of = chained(raw).ok_or(GeometryError::NotFinite { shape: names[0].to_owned(), at: points[0][0] })?;
        Ok(Self::from_monoids(region, rows, rows_of))
    }

    /// The map with one piece whose rows are given with their weights: for other normalisations than [`Birational::new`]'s.
    #[must_use]
    pub fn with_monoids(region: Rect, rows: Rows, monoids: [Monoid; 2]) -> Self {
        Self::from_monoids(region, rows, vec![monoids])
    }

    fn from_monoids(region: Rect, rows: Rows, monoids: Vec<[Monoid; 2]>) -> Self {
        let cells = monoids.len();
        let share = |a: f64, size: f64, k: usize| a + size * (k as f64 / cells as f64);
        let piece = |(k, pair): (usize, [Monoid; 2])| {
            let homogeneous = |r: usize, j: usize| {
                let (p, w) = (pair[r].points()[j], pair[r].weights()[j]);
                [p.x * w, p.y * w, w]
            };
            let n = pair[0].points().len() - 1;
            let r = region;
            let (rect, degree, net): (_, _, Vec<[f64; 3]>) = match rows {
                Rows::LeftRight => (
                    Rect::new(r.x0, share(r.y0, r.height(), k), r.x1, share(r.y0, r.height(), k + 1)),
                    [1, n],
                    (0..=n).flat_map(|j| [homogeneous(0, j), homogeneous(1, j)]).collect(),
                ),
                Rows::TopBottom => (
                    Rect::new(share(r.x0, r.width(), k), r.y0, share(r.x0, r.width(), k + 1), r.y1),
                    [n, 1],
                    [0, 1].iter().flat_map(|&s| (0..=n).map(move |j| (s, j))).map(|(s, j)| homogeneous(s, j)).collect(),
                ),
            };
            Piece { patch: Arc::new(Patch::rational(rect, degree, &net)), rows: pair }
        };
        Self { region, rows, pieces: monoids.into_iter().enumerate().map(piece).collect() }
    }

    /// The rows of each Bézier piece, with weights.
    pub fn monoids(&self) -> impl Iterator<Item = &[Monoid; 2]> {
        self.pieces.iter().map(|p| &p.rows)
    }

    /// The inverse map, in closed form.
    #[must_use]
    pub fn inverted(&self) -> BirationalInverse {
        BirationalInverse { forward: self.clone() }
    }

    fn piece(&self, p: Point) -> usize {
        let r = self.region;
        let t = match self.rows {
            Rows::LeftRight => (p.y - r.y0) / r.height(),
            Rows::TopBottom => (p.x - r.x0) / r.width(),
        };
        ((t * self.pieces.len() as f64).max(0.0) as usize).min(self.pieces.len() - 1)
    }

    fn patch(&self, p: Point) -> &Arc<Patch> {
        &self.pieces[self.piece(p)].patch
    }
}

/// The two rows as monoids with the pace left as it comes, their points checked.
fn general_rows(
    points: &[Vec<Point>; 2],
    allow_poles: bool,
    names: &[String; 2],
) -> Result<[Monoid; 2], GeometryError> {
    let n = points[0].len() - 1;
    let b = points.iter().flatten().fold(Rect::from_points(points[0][0], points[0][0]), |b, p| b.union_pt(*p));
    let size = b.width().hypot(b.height());
    let mut lines = [0, n].map(|j| Ray::join(points[0][j], points[1][j]));
    for (line, j) in lines.iter_mut().zip([0, n]) {
        let length = line.normal.hypot();
        if length <= ON_LINE * size {
            let path = format!("{} and {}", names[0], names[1]);
            return Err(GeometryError::Coincident { path, which: [j + 1, j + 1], at: points[0][j] });
        }
        // Values near 1 within the lattice: their n-th powers are to stay within range.
        *line = line.scaled(1.0 / (length * size));
    }
    let [first, last] = lines;
    let side = if first.at(points[0][n]) >= 0.0 { 1.0 } else { -1.0 };
    for (row, name) in points.iter().zip(names) {
        for (i, p) in row.iter().enumerate() {
            let off = [(i > 0, side * first.at(*p), "first"), (i < n, -side * last.at(*p), "last")];
            for (counts, d, end) in off {
                if counts && (d <= ON_LINE && !allow_poles || d.abs() <= ON_LINE) {
                    let j = if end == "first" { 0 } else { n };
                    return Err(GeometryError::WrongSide {
                        path: name.clone(),
                        which: i + 1,
                        at: *p,
                        end,
                        line: [points[0][j], points[1][j]],
                        on: d.abs() <= ON_LINE,
                    });
                }
            }
        }
    }
    let not_finite = || GeometryError::NotFinite { shape: names[0].clone(), at: points[0][0] };
    let [a, b] = points;
    let rows = Monoid::new(a, first, last).zip(Monoid::new(b, first, last));
    rows.map(|(a, b)| [a, b]).ok_or_else(not_finite)
}

/// Sets the paces and the rows' common factors.
fn chained(raw: Vec<[Monoid; 2]>) -> Option<Vec<[Monoid; 2]>> {
    let n = raw[0][0].points().len() - 1;
    let product = |rows: &[Monoid; 2], over: usize, under: usize| -> f64 {
        rows.iter().map(|m| (m.weights()[over] / m.weights()[under]).abs().ln()).sum()
    };
    // ln g of each piece is a + x or a − x by turns; x is what brings the end weights nearest to 1.
    let mut a = vec![0.0];
    for w in raw.windows(2) {
        let next = 0.5 * (product(&w[0], n - 1, n) - product(&w[1], 1, 0)) - a[a.len() - 1];
        a.push(next);
    }
    let turn = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let ends = raw.iter().zip(&a).enumerate();
    let sum: f64 = ends.map(|(k, (rows, a))| turn(k) * (product(rows, n, 0) + 2.0 * n as f64 * a)).sum();
    let x = -sum / (2 * n * raw.len()) as f64;
    let mut factor = [1.0; 2];
    let mut out = Vec::with_capacity(raw.len());
    for (k, (rows, a)) in raw.into_iter().zip(a).enumerate() {
        let g = (a + turn(k) * x).exp();
        let [p, q] = rows;
        let pair = [p.paced(g)?.weighted(factor[0]), q.paced(g)?.weighted(factor[1])];
        factor = [0, 1].map(|r| pair[r].weights()[n]);
        out.push(pair);
    }
    Some(out)
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
            let own = self.clone();
            out.push(Crease::edge(Level::Field(Arc::new(move |p| own.patch(p).denominator(p)))));
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        (self.pieces.len() > 1).then(|| Arc::clone(self.patch(inside)) as Arc<dyn Map>)
    }

    /// A curve of degree d gives one of degree d·(1+n).
    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        match self.pieces.as_slice() {
            [one] => one.patch.image(curve),
            _ => None,
        }
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.inverted()))
    }
}

/// The inverse of a [`Birational`], in closed form.
#[derive(Debug, Clone, PartialEq)]
pub struct BirationalInverse {
    forward: Birational,
}

impl BirationalInverse {
    /// s and t of a place, by one piece's rows.
    fn parameters<S: Real>(rows: &[Monoid; 2], x: S, y: S) -> (S, S) {
        let [first, last] = rows[0].lines();
        let (alpha, beta) = (-last.of(x, y), first.of(x, y));
        // The rows' homogeneous points at t, times (α+β)ⁿ, seen from the place: opposite ends of the line through it.
        let seen = |m: &Monoid| {
            // From a point near: the sums are then not differences of large numbers.
            let o = m.points()[0];
            let (dx, dy) = (x - o.x, y - o.y);
            let n = m.points().len() - 1;
            let term = |i: usize| (m.weights()[i], m.points()[i] - o);
            let (w, d) = term(n);
            let (mut sx, mut sy, mut sw) = (S::from(w * d.x), S::from(w * d.y), S::from(w));
            // As `monoid::bernstein`, three sums in one pass.
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
        let (a, b) = (seen(&rows[0]), seen(&rows[1]));
        let (dx, dy) = (a.0 - b.0, a.1 - b.1);
        ((a.0 * dx + a.1 * dy) / (dx * dx + dy * dy), beta / (alpha + beta))
    }

    /// The piece whose image holds a place.
    fn piece(&self, p: Point) -> usize {
        let pieces = &self.forward.pieces;
        let last = pieces.len() - 1;
        if last == 0 {
            return 0;
        }
        let mut best = (f64::INFINITY, 0);
        for (k, piece) in pieces.iter().enumerate() {
            let (s, t) = Self::parameters(&piece.rows, p.x, p.y);
            let beyond = if k == 0 { 0.0 } else { -t }.max(if k == last { 0.0 } else { t - 1.0 }).max(0.0);
            // On the other side of A the denominator is negative.
            let there = self.forward.pieces[k].patch.denominator(self.source(k, s, t).into()) > 0.0;
            let cost = beyond * 1e6 + (s - 0.5).abs() + if there { 0.0 } else { 1e12 };
            if cost < best.0 {
                best = (cost, k);
            }
        }
        best.1
    }

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
        if self.forward.pieces.len() > 1 {
            // The lines between the pieces.
            for p in &self.forward.pieces[1..] {
                let l = p.rows[0].lines()[0];
                let c = -l.normal.dot(l.through.to_vec2());
                out.push(Crease::kink(Level::Line { a: l.normal.x, b: l.normal.y, c }));
            }
        }
        // Where s or t is infinite the forward denominator is too: its reciprocal passes through zero there.
        let own = self.clone();
        let level = move |q: Point| {
            let k = own.piece(q);
            let (s, t) = Self::parameters(&own.forward.pieces[k].rows, q.x, q.y);
            1.0 / own.forward.pieces[k].patch.denominator(own.source(k, s, t).into())
        };
        if !self.forward.pieces.iter().all(|p| p.patch.is_polynomial()) {
            out.push(Crease::edge(Level::Field(Arc::new(level))));
        }
    }

    /// A curve of degree d gives one of degree d·(1+n): (s, t, 1) ~ (χ·f₀, β·(f₀−f₁), χ·(f₀−f₁)), χ = α + β.
    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        let [piece] = self.forward.pieces.as_slice() else { return None };
        let [first, last] = piece.rows[0].lines();
        let line = |l: Ray, k: f64| {
            let c = l.normal.dot(l.through.to_vec2());
            Scaled::new(curve.points.iter().map(|p| k * (l.normal.x * p[0] + l.normal.y * p[1] - c * p[2])))
        };
        let n = piece.rows[0].points().len() - 1;
        let (alpha, beta) = (line(last, -1.0).powers(n), line(first, 1.0).powers(n));
        let w = Scaled::new(curve.points.iter().map(|p| p[2]));
        let sum = |c: &[f64]| {
            let n = c.len() - 1;
            let mut out = Scaled::zero(n * curve.degree());
            let mut binomial = 1.0;
            for (i, c) in c.iter().enumerate() {
                out.add_scaled(c * binomial, &alpha[n - i].times(&beta[i]));
                binomial = binomial * (n - i) as f64 / (i + 1) as f64;
            }
            out
        };
        let implicit = |m: &Monoid| {
            let mut f = sum(m.weights());
            f.add_scaled(-1.0, &sum(m.h()).times(&w));
            f
        };
        let (f0, f1) = (implicit(&piece.rows[0]), implicit(&piece.rows[1]));
        let mut difference = f0.clone();
        difference.add_scaled(-1.0, &f1);
        let mut chi = alpha[1].clone();
        chi.add_scaled(1.0, &beta[1]);
        let terms = [chi.times(&f0), beta[1].times(&difference), chi.times(&difference)];
        let [s, t, w] = terms.map(|c| c.coefficients());
        let r = self.forward.region;
        let point = |((s, t), w): ((f64, f64), f64)| {
            let (x, y) = if self.forward.rows == Rows::LeftRight { (s, t) } else { (t, s) };
            [x * r.width() + r.x0 * w, y * r.height() + r.y0 * w, w]
        };
        Some(RationalBezier { points: s.into_iter().zip(t).zip(w).map(point).collect() })
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        if self.forward.pieces.len() == 1 {
            return None;
        }
        let k = self.piece(inside);
        let one = Birational {
            region: self.forward.pieces[k].patch.rect(),
            rows: self.forward.rows,
            pieces: vec![self.forward.pieces[k].clone()],
        };
        Some(Arc::new(one.inverted()))
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.forward.clone()))
    }
}
