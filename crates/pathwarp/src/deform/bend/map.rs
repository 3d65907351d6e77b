//! The map: pieces of the skeleton side by side, and the artwork's position on them.

use crate::anchors;
use crate::error::{Error, show};
use crate::map::curves::ArcLength;
use crate::map::rational_bezier::Scaled;
use crate::map::{AffineMap, Class, Cost, Crease, Creases, Dual, Jet, Level, Map, RationalBezier, Real, bspline};
use crate::outline::{Outline, Seg, Subpath};
use crate::param::{Letter, NamedPath};
use kurbo::{Affine, CubicBez, Line, Point, QuadBez, Rect, Vec2};
use std::sync::Arc;

/// The map from the artwork to the strip: distance s = k·x + origin, height d = up·(base − y).
#[derive(Debug, Clone, Copy)]
pub(super) struct ToStrip {
    pub(super) k: f64,
    pub(super) origin: f64,
    pub(super) up: f64,
    pub(super) base: f64,
}

impl ToStrip {
    pub(super) fn s(&self, x: f64) -> f64 {
        self.k * x + self.origin
    }

    fn d(&self, y: f64) -> f64 {
        (self.base - y) * self.up
    }

    /// Returns the point on `piece`, which begins at distance `begin`.
    fn point(&self, piece: &SkeletonPiece, begin: f64, p: Point) -> Point {
        piece.point(self.s(p.x) - begin, self.d(p.y))
    }

    /// Returns the jet on `piece`, which begins at distance `begin`.
    fn jet(&self, piece: &SkeletonPiece, begin: f64, p: Point) -> Jet {
        let (at, ds, dd) = piece.jet(self.s(p.x) - begin, self.d(p.y));
        Jet { p: at, dx: ds * self.k, dy: dd * -self.up }
    }
}

/// The map: pieces side by side.
#[derive(Clone)]
pub(super) struct BendMap {
    pub(super) pieces: Vec<Arc<SkeletonPiece>>,
    pub(super) length: f64,
    pub(super) closed: bool,
    pub(super) to_strip: ToStrip,
    /// The range of x in which creases are reported.
    pub(super) reach: (f64, f64),
}

impl BendMap {
    /// Returns the piece at distance `s`, and the distance of its start.
    fn piece(&self, s: f64) -> (&Arc<SkeletonPiece>, f64) {
        let turn = if self.closed { (s / self.length).floor() * self.length } else { 0.0 };
        let i = self.pieces.partition_point(|p| p.from <= s - turn).max(1) - 1;
        (&self.pieces[i], self.pieces[i].anchor + turn)
    }

    /// Returns the point at distance `s` on the skeleton, and the unit tangent there.
    pub(super) fn stand(&self, s: f64) -> (Point, Vec2) {
        let (piece, begin) = self.piece(s);
        let (at, along, _) = piece.jet(s - begin, 0.0);
        (at, along / along.hypot())
    }

    /// Returns an affine map if the skeleton is one straight line.
    pub(super) fn simplest(&self) -> Arc<dyn Map> {
        match &self.pieces[..] {
            [only] if !self.closed => match OnPiece::new(only, only.anchor, self.to_strip).affine() {
                Some(m) => Arc::new(AffineMap(m)),
                None => Arc::new(self.clone()),
            },
            _ => Arc::new(self.clone()),
        }
    }

    /// Warns if the artwork folds over itself. `points` samples the outlines of letters, each with its letter, or the box of
    /// other artwork ([`edges`]). The determinant is linear in the height, so that it is worst at the highest and lowest points.
    pub(super) fn fold<'a>(&self, points: impl Iterator<Item = (Point, Option<&'a Letter>)>) -> Option<String> {
        let det = |x: f64, y: f64| self.jet(Point::new(x, y)).det() / (self.to_strip.k * self.to_strip.up);
        let mut worst: Option<(f64, Point)> = None;
        let mut over: Vec<&Letter> = Vec::new();
        for (p, letter) in points {
            let there = det(p.x, p.y);
            if there >= 0.0 {
                continue;
            }
            if worst.is_none_or(|(w, _)| there < w) {
                worst = Some((there, p));
            }
            over.extend(letter.filter(|l| over.last().is_none_or(|o| !std::ptr::eq(*o, *l))));
        }
        let (there, p) = worst?;
        let on = det(p.x, self.to_strip.base);
        // The linear determinant vanishes at the centre of curvature.
        let centre = self.to_strip.d(p.y).abs() * on / (on - there);
        let names: Vec<&str> = over.iter().map(|l| l.name.as_str()).collect();
        let (who, reaches) = match names.len() {
            0 => ("the artwork folds over itself".to_owned(), "it reaches"),
            1 => (format!("the letter {} folds over itself", listed(&names)), "it reaches"),
            _ => (format!("the letters {} fold over themselves", listed(&names)), "they reach"),
        };
        Some(format!(
            "bend: {who}, worst near {} of the skeleton, where {reaches} more than {centre:.6} away from it, beyond the centre of \
curvature; a smaller `width`, another `baseline` or a gentler bend avoids that",
            show(self.point(Point::new(p.x, self.to_strip.base)))
        ))
    }
}

/// Lists names for a message, as many as a line holds.
pub(super) fn listed(names: &[&str]) -> String {
    const SHOWN: usize = 8;
    let shown = names.iter().take(SHOWN).map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN { format!("{shown} and {} more", names.len() - SHOWN) } else { shown }
}

/// Samples the top and the bottom of a box.
pub(super) fn edges(rect: Rect) -> impl Iterator<Item = Point> {
    const SAMPLES: u32 = 1024;
    (0..=SAMPLES).flat_map(move |i| {
        let x = rect.x0 + rect.width() * (f64::from(i) + 0.5) / f64::from(SAMPLES + 1);
        [rect.y0, rect.y1].map(|y| Point::new(x, y))
    })
}

impl Map for BendMap {
    /// A jet on a curve takes less than half as long as one of a net: 7 ns on the hairpin of `tests/cli/report.rs`.
    fn cost(&self) -> Cost<'_> {
        /// Pieces to look at, which stand for all.
        const FIRST: usize = 16;
        const CURVE: f64 = 0.4;
        const SINGLY: f64 = 3.0;
        let work = self.pieces.iter().take(FIRST).map(|p| p.work()).fold(1.0, f64::max);
        Cost { jet: if work > 1.0 { SINGLY * work } else { CURVE }, ..Cost::new(work) }
    }

    fn jet(&self, p: Point) -> Jet {
        let (piece, begin) = self.piece(self.to_strip.s(p.x));
        self.to_strip.jet(piece, begin, p)
    }

    fn point(&self, p: Point) -> Point {
        let (piece, begin) = self.piece(self.to_strip.s(p.x));
        self.to_strip.point(piece, begin, p)
    }

    /// Verticals at the skeleton's joints.
    fn creases(&self, out: &mut Creases) {
        /// Limit on the turns around a closed skeleton whose joints are reported.
        const MAX_TURNS: f64 = 64.0;
        let (a, b) = (self.to_strip.s(self.reach.0), self.to_strip.s(self.reach.1));
        let turns = |s: f64| if self.closed { (s / self.length).floor() } else { 0.0 };
        let (first, last) = (turns(a), turns(b));
        if first > last || (first - last).is_nan() {
            return;
        }
        // Far out, adding one to a turn may not change it, so the turns are counted.
        for turn in (0..=(last - first).min(MAX_TURNS) as usize).map(|n| first + n as f64) {
            for s in self.pieces.iter().map(|p| p.from).filter(|s| s.is_finite()) {
                let c = self.to_strip.origin - s - turn * self.length;
                out.push(Crease::kink(Level::Line { a: self.to_strip.k, b: 0.0, c }));
            }
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let (piece, begin) = self.piece(self.to_strip.s(inside.x));
        Some(Arc::new(OnPiece::new(piece, begin, self.to_strip)))
    }

    fn detail(&self, _: Rect) -> Option<f64> {
        Some(f64::INFINITY)
    }
}

/// The smooth map on one piece.
struct OnPiece {
    piece: Arc<SkeletonPiece>,
    begin: f64,
    to_strip: ToStrip,
}

impl OnPiece {
    fn new(piece: &Arc<SkeletonPiece>, begin: f64, to_strip: ToStrip) -> Self {
        Self { piece: Arc::clone(piece), begin, to_strip }
    }

    fn affine(&self) -> Option<Affine> {
        let Strip::Straight { p, t, n } = &self.piece.strip else { return None };
        let ToStrip { k, up, .. } = self.to_strip;
        let at = *p + *t * (self.to_strip.s(0.0) - self.begin) + *n * self.to_strip.d(0.0);
        Some(Affine::new([t.x * k, t.y * k, -n.x * up, -n.y * up, at.x, at.y]))
    }
}

impl Map for OnPiece {
    fn cost(&self) -> Cost<'_> {
        Cost::new(self.piece.work())
    }

    fn jet(&self, p: Point) -> Jet {
        self.to_strip.jet(&self.piece, self.begin, p)
    }

    fn point(&self, p: Point) -> Point {
        self.to_strip.point(&self.piece, self.begin, p)
    }

    fn class(&self) -> Class {
        self.affine().map_or(Class::Smooth, Class::Affine)
    }

    fn detail(&self, _: Rect) -> Option<f64> {
        Some(f64::INFINITY)
    }

    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        if let Some(m) = self.affine() {
            return AffineMap(m).image(curve);
        }
        let Strip::Ribbon { ribbon, unit, table: None } = &self.piece.strip else { return None };
        let ToStrip { k, origin, up, base } = self.to_strip;
        let (length, v) = (self.piece.length, up / unit);
        let to_uv = Affine::new([k / length, 0.0, 0.0, -v, (origin - self.begin) / length, base * v]);
        Some(ribbon.image(&AffineMap(to_uv).image(curve)?))
    }
}

// One piece of a bent strip: a piece of the skeleton, and the sides that stand on it.

/// The strip along a piece of skeleton.
#[derive(Debug, Clone)]
pub(super) enum Strip {
    /// F = p + s·t + d·n.
    Straight { p: Point, t: Vec2, n: Vec2 },
    /// F = C(u(s)) + d·S with S the unit normal, blended into the mitre of a corner at the ends: linearly, or `smooth`ly where the
    /// mitre vanishes within the piece. s is the length of the offset curve at height `even`.
    Normals { spine: Spine, table: ArcLength, mitres: [Vec2; 2], even: f64, smooth: bool },
    /// The paper's polynomial F(u, v), v = d / unit; u by arc length if there is a table, else s / length.
    Ribbon { ribbon: Ribbon, unit: f64, table: Option<ArcLength> },
}

/// A piece of the skeleton and its strip.
#[derive(Debug, Clone)]
pub(super) struct SkeletonPiece {
    /// The distance from which it applies; −∞ for the first of an open skeleton.
    pub(super) from: f64,
    /// The distance of its start.
    pub(super) anchor: f64,
    /// Its length.
    pub(super) length: f64,
    pub(super) strip: Strip,
}

impl SkeletonPiece {
    /// The work of a point: an arc takes several sines and cosines, and the de Casteljau steps of a ribbon twice as long as a net.
    pub(super) fn work(&self) -> f64 {
        match &self.strip {
            Strip::Normals { spine, .. } if matches!(spine.seg, Seg::Arc(_)) => 2.0,
            Strip::Straight { .. } | Strip::Normals { .. } => 1.0,
            Strip::Ribbon { .. } => 2.0,
        }
    }

    /// Returns F at distance `s` from the piece's start and height `d`.
    pub(super) fn point(&self, s: f64, d: f64) -> Point {
        match &self.strip {
            Strip::Straight { p, t, n } => *p + *t * s + *n * d,
            Strip::Normals { spine, table, mitres, smooth, .. } => {
                let (p, t) = spine.frame(table.parameter(s));
                p + self.side(t, mitres, *smooth, s).0 * d
            }
            Strip::Ribbon { .. } => self.jet(s, d).0,
        }
    }

    /// Returns the side at distance `s`, the normal of `t` blended into the mitres, and the derivative of the blend.
    fn side(&self, t: Vec2, [start, end]: &[Vec2; 2], smooth: bool, s: f64) -> (Vec2, Vec2) {
        let share = s / self.length;
        let (a, b) = (1.0 - share, share);
        if smooth {
            let slope = (*end * b - *start * a) * (2.0 / self.length);
            return (normal(t) + *start * (a * a) + *end * (b * b), slope);
        }
        (normal(t) + *start * a + *end * b, (*end - *start) / self.length)
    }

    /// Returns F, ∂F/∂s and ∂F/∂d at distance `s` from the piece's start and height `d`.
    pub(super) fn jet(&self, s: f64, d: f64) -> (Point, Vec2, Vec2) {
        match &self.strip {
            Strip::Straight { p, t, n } => (*p + *t * s + *n * d, *t, *n),
            Strip::Normals { spine, table, mitres, even, smooth } => {
                let MovingFrame { p, t, bend } = spine.moving(table.parameter(s));
                let (side, slope) = self.side(t, mitres, *smooth, s);
                let along = t * ((1.0 + bend * d) / (1.0 + bend * even)) + slope * d;
                (p + side * d, along, side)
            }
            Strip::Ribbon { ribbon, unit, table } => {
                let u = table.as_ref().map_or(s / self.length, |t| t.parameter(s));
                let [x, y] = ribbon.at(Dual { v: u, x: 1.0, y: 0.0 }, Dual { v: d / unit, x: 0.0, y: 1.0 });
                let slope = match table {
                    None => 1.0 / self.length,
                    Some(_) => {
                        let [x, y] = ribbon.at(Dual { v: u, x: 1.0, y: 0.0 }, Dual::from(0.0));
                        1.0 / x.x.hypot(y.x).max(f64::MIN_POSITIVE)
                    }
                };
                (Point::new(x.v, y.v), Vec2::new(x.x, y.x) * slope, Vec2::new(x.y, y.y) / *unit)
            }
        }
    }
}

/// Returns the normal that points up on the screen for a tangent to the right.
pub(super) fn normal(t: Vec2) -> Vec2 {
    Vec2::new(t.y, -t.x)
}

/// A piece of the skeleton's curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spine {
    pub(super) seg: Seg,
    /// The speed that counts as zero.
    still: f64,
}

/// The moving frame of a piece. With N the [`normal`], dT/ds = −bend·N, dN/ds = bend·T.
pub(super) struct MovingFrame {
    pub(super) p: Point,
    /// Unit tangent.
    pub(super) t: Vec2,
    /// Curvature, positive where the curve turns clockwise on the screen: away from the normal.
    pub(super) bend: f64,
}

impl Spine {
    pub(super) fn new(seg: Seg) -> Self {
        /// The speed that counts as zero, as a share of the piece's size.
        const STILL: f64 = 1e-9;
        let b = seg.bounding_box();
        Self { seg, still: STILL * (b.width() + b.height()) }
    }

    /// Returns the point and the unit tangent at a parameter.
    fn frame(&self, u: f64) -> (Point, Vec2) {
        let (_, v, speed) = self.velocity(u);
        (self.seg.eval(u), v / speed)
    }

    /// Returns the moving frame at a parameter.
    pub(super) fn moving(&self, u: f64) -> MovingFrame {
        let (at, v, speed) = self.velocity(u);
        MovingFrame { p: self.seg.eval(u), t: v / speed, bend: v.cross(second(&self.seg, at)) / speed.powi(3) }
    }

    /// Returns a parameter with the derivative and its length there: `u` itself, or one a little further in where the curve stands still.
    fn velocity(&self, u: f64) -> (f64, Vec2, f64) {
        /// How much further in.
        const ASIDE: f64 = 1e-5;
        let v = self.seg.deriv(u);
        let speed = v.hypot();
        if speed > self.still {
            return (u, v, speed);
        }
        let at = if u < 0.5 { u + ASIDE } else { u - ASIDE };
        let v = self.seg.deriv(at);
        (at, v, v.hypot())
    }
}

/// Returns the second derivative.
fn second(seg: &Seg, u: f64) -> Vec2 {
    match seg {
        Seg::Line(_) => Vec2::ZERO,
        Seg::Quad(q) => ((q.p2 - q.p1) - (q.p1 - q.p0)) * 2.0,
        Seg::Cubic(c) => {
            let (d0, d1, d2) = (c.p1 - c.p0, c.p2 - c.p1, c.p3 - c.p2);
            ((d1 - d0) * (1.0 - u) + (d2 - d1) * u) * 6.0
        }
        Seg::Arc(a) => {
            let (sin, cos) = (a.start + a.sweep * u).sin_cos();
            (a.a * cos + a.b * sin) * -(a.sweep * a.sweep)
        }
    }
}

// The generalised algorithm of de Casteljau: every step an affine map of the whole plane (or space) instead of a point on a
// segment.
//
// `p[i,j] = p[i,j−1] + u·(p[i+1,j−1] − p[i,j−1]) + v·s[i,j] (+ w·t[i,j] in space)`, the s and t being the *handles* of level j
// (equations 2 and 3). Every term with v is linear in it and stays so through the levels above: in the plane
// F(u, v) = C(u) + v·S(u), C the Bézier curve of the control points and S the sum over the levels j of the Bézier curves of
// degree n−j of their handles.

/// Returns one step's affine map at u: p + u₀·(q − p) + Σ uₖ·hₖ.
fn step<S: Real, const D: usize>(p: [S; D], q: [S; D], handles: &[[f64; D]], u: &[S]) -> [S; D] {
    std::array::from_fn(|i| {
        let along = p[i] + u[0] * (q[i] - p[i]);
        handles.iter().zip(&u[1..]).fold(along, |sum, (h, v)| sum + *v * S::from(h[i]))
    })
}

/// Returns the point at parameters `u` for a control polygon and handles: `handles(level, i)`, levels counted from 1.
fn eval<'a, S: Real, const D: usize>(
    row: &mut [[S; D]],
    handles: impl Fn(usize, usize) -> &'a [[f64; D]],
    u: &[S],
) -> [S; D] {
    for level in 1..row.len() {
        for i in 0..row.len() - level {
            row[i] = step(row[i], row[i + 1], handles(level, i), u);
        }
    }
    row[0]
}

/// A Bézier piece of degree up to 3 with its handles.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ribbon {
    /// The control points, two to four.
    points: Vec<Point>,
    /// The handles, level by level: n of the first, n−1 of the second ... The last levels may be omitted.
    levels: Vec<Vec<[f64; 2]>>,
}

/// Limit on control points.
const MAX_POINTS: usize = 4;

impl Ribbon {
    /// Creates a piece; `None` unless there are two to four points, and n+1−j handles on level j.
    pub(super) fn new(points: Vec<Point>, levels: &[Vec<Vec2>]) -> Option<Self> {
        let n = points.len().checked_sub(1)?;
        let fits = (2..=MAX_POINTS).contains(&points.len()) && levels.len() <= n;
        if !fits || levels.iter().enumerate().any(|(j, l)| l.len() != n - j) {
            return None;
        }
        let levels = levels.iter().map(|l| l.iter().map(|h| [h.x, h.y]).collect()).collect();
        Some(Self { points, levels })
    }

    pub(super) fn degree(&self) -> usize {
        self.points.len() - 1
    }

    /// Returns F(u, v).
    pub(super) fn at<S: Real>(&self, u: S, v: S) -> [S; 2] {
        let mut row = [[S::from(0.0); 2]; MAX_POINTS];
        for (r, p) in row.iter_mut().zip(&self.points) {
            *r = [S::from(p.x), S::from(p.y)];
        }
        // Levels without handles are free.
        let handles = |level: usize, i: usize| match self.levels.get(level - 1) {
            Some(l) => std::slice::from_ref(&l[i]),
            None => &[],
        };
        eval(&mut row[..self.points.len()], handles, &[u, v])
    }

    /// Returns S(u) at an end: 0 or 1.
    pub(super) fn side_at_end(&self, end: usize) -> Vec2 {
        let pick = |l: &Vec<[f64; 2]>| if end == 0 { l.first().copied() } else { l.last().copied() };
        self.levels.iter().filter_map(pick).fold(Vec2::ZERO, |a, [x, y]| a + Vec2::new(x, y))
    }

    /// Returns the exact image of a curve in (u, v), of n times its degree.
    pub(super) fn image(&self, curve: &RationalBezier) -> RationalBezier {
        let n = self.degree();
        let [u, v, w] = [0, 1, 2].map(|k| curve.coordinate(k));
        let rest = {
            let mut r = w.clone();
            r.add_scaled(-1.0, &u);
            r
        };
        // Homogeneous Bernstein terms: C(k, i)·uⁱ(w−u)^(k−i), times v for handles, times powers of w to raise the degree.
        let (up, rp, wp) = (u.powers(n), rest.powers(n), w.powers(n));
        let term = |k: usize, i: usize| up[i].times(&rp[k - i]);
        let (mut x, mut y) = (Scaled::zero(n * curve.degree()), Scaled::zero(n * curve.degree()));
        let mut add = |at: Vec2, k: usize, i: usize, t: &Scaled| {
            let c = binomial(k, i);
            x.add_scaled(at.x * c, t);
            y.add_scaled(at.y * c, t);
        };
        for (i, p) in self.points.iter().enumerate() {
            add(p.to_vec2(), n, i, &term(n, i));
        }
        for (j, level) in self.levels.iter().enumerate() {
            let k = n - j - 1;
            for (i, h) in level.iter().enumerate() {
                add(Vec2::new(h[0], h[1]), k, i, &term(k, i).times(&v).times(&wp[j]));
            }
        }
        RationalBezier::from_coordinates([&x, &y, &wp[n]], curve.is_polynomial())
    }
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64)
}

// Skeletons given as B-splines: the anchors of a path are control points.
//
// An open path is a uniform clamped B-spline, a closed one a uniform periodic one; every cell becomes a Bézier piece
// ([`bspline`]; W. Boehm, *Inserting new knots into B-spline curves*, CAD 12, 1980). Pieces meet with degree − 1 continuous
// derivatives.

/// Returns the spline of this degree, 1 to 3, over the anchors of `path`.
pub(super) fn through(path: &NamedPath, degree: usize) -> Result<NamedPath, Error> {
    let sub = anchors::only_subpath(path, "a single connected run of them")?;
    let points = sub.anchors();
    let min = if sub.closed { 3 } else { degree + 1 };
    if points.len() < min {
        let problem = format!("needs at least {min} anchors; the skeleton has {}", points.len());
        return Err(Error::usage("spline", degree.to_string(), problem));
    }
    let mut pieces: Vec<Vec<Point>> = if sub.closed {
        // The middle cell of a long clamped spline has only uniform knots. The first piece begins near the first anchor.
        let uniform = &bspline::extraction(degree, 2 * degree - 1)[degree - 1];
        let n = points.len();
        let first = n - (degree - 1) / 2;
        (0..n).map(|i| bezier(uniform, &|l| points[(first + i + l) % n])).collect()
    } else {
        let cells = bspline::extraction(degree, points.len() - degree);
        cells.iter().enumerate().map(|(i, rows)| bezier(rows, &|l| points[i + l])).collect()
    };
    // Rounding must not separate the ends at a joint.
    for i in 1..pieces.len() {
        pieces[i][0] = pieces[i - 1][degree];
    }
    if sub.closed {
        let (start, last) = (pieces[0][0], pieces.len() - 1);
        pieces[last][degree] = start;
    }
    let segs = pieces.iter().filter_map(|p| match p[..] {
        [a, b] => Some(Seg::Line(Line::new(a, b))),
        [a, b, c] => Some(Seg::Quad(QuadBez::new(a, b, c))),
        [a, b, c, d] => Some(Seg::Cubic(CubicBez::new(a, b, c, d))),
        _ => None,
    });
    let spline = Subpath { start: pieces[0][0], segs: segs.collect(), closed: sub.closed };
    Ok(NamedPath { name: path.name.clone(), outline: Outline { subpaths: vec![spline] } })
}

/// Returns Bézier points: a cell's matrix times its control points.
fn bezier(rows: &[Vec<f64>], control: &dyn Fn(usize) -> Point) -> Vec<Point> {
    let sum = |row: &Vec<f64>| row.iter().enumerate().fold(Vec2::ZERO, |s, (l, c)| s + control(l).to_vec2() * *c);
    rows.iter().map(|row| sum(row).to_point()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{Counted, operations};

    /// Table 1 of the paper: 9, 27 and 54 products and as many sums per point in space for degrees 1, 2 and 3. The paper takes
    /// q − p as given; computing it costs three differences a step, which Table 1 leaves out. In the plane a step is 4 and 4.
    #[test]
    fn operation_counts_are_those_of_table_1() {
        for (degree, expected) in [(1, 9), (2, 27), (3, 54)] {
            let point = |i: usize| [i as f64, 1.0, 2.0].map(Counted);
            let handles = [[0.5, 1.0, 0.0], [0.0, 0.3, 1.0]];
            let [products, sums, differences] = operations(|| {
                let mut row: Vec<_> = (0..=degree).map(point).collect();
                let _ = eval(&mut row, |_, _| &handles[..], &[0.3, 0.4, 0.5].map(Counted));
            });
            assert_eq!((products, sums, differences), (expected, expected, expected / 3), "degree {degree}");

            let levels: Vec<_> = (1..=degree).map(|j| vec![Vec2::new(1.0, 2.0); degree + 1 - j]).collect();
            let ribbon = Ribbon::new((0..=degree).map(|i| Point::new(i as f64, 1.0)).collect(), &levels).unwrap();
            let [products, ..] = operations(|| {
                let _ = ribbon.at(Counted(0.3), Counted(0.4));
            });
            assert_eq!(products, 4 * degree * (degree + 1) / 2);
        }
    }

    fn ribbon() -> Ribbon {
        let points = [(0.0, 50.0), (30.0, 0.0), (70.0, 20.0), (100.0, 60.0)].map(Point::from).to_vec();
        Ribbon::new(points, &levels()).unwrap()
    }

    fn levels() -> Vec<Vec<Vec2>> {
        vec![
            [(0.0, -40.0), (5.0, -50.0), (-8.0, -30.0)].map(Vec2::from).to_vec(),
            [(3.0, 1.0), (-2.0, 4.0)].map(Vec2::from).to_vec(),
            vec![Vec2::new(6.0, -7.0)],
        ]
    }

    /// Without handles the algorithm is de Casteljau's own; with them F is linear in v, with the stated S.
    #[test]
    fn handles_add_v_times_a_curve_of_lower_degree() {
        let r = ribbon();
        let curve = CubicBez::new(r.points[0], r.points[1], r.points[2], r.points[3]);
        for (u, v) in [(0.0, 0.0), (0.3, 0.8), (1.0, -1.0), (1.2, 2.0)] {
            let [x, y] = r.at(u, v);
            let w = 1.0 - u;
            let l = levels();
            let side =
                (l[0][0] * w * w + l[0][1] * 2.0 * u * w + l[0][2] * u * u) + (l[1][0] * w + l[1][1] * u) + l[2][0];
            let expected = kurbo::ParamCurve::eval(&curve, u) + side * v;
            assert!(expected.distance(Point::new(x, y)) < 1e-12, "{u} {v}");
        }
        assert!((r.side_at_end(0) - Vec2::new(9.0, -46.0)).hypot() < 1e-14);
    }

    #[test]
    fn images_are_exact() {
        let r = ribbon();
        for source in [
            RationalBezier::polynomial(&[Point::new(0.1, 0.0), Point::new(0.9, 0.7)]),
            RationalBezier { points: vec![[0.1, 0.2, 1.0], [0.5, 0.1, 0.7], [0.4, 0.9, 1.3]] },
        ] {
            let image = r.image(&source);
            assert_eq!(image.degree(), 3 * source.degree());
            for i in 0..=10 {
                let t = f64::from(i) / 10.0;
                let p = source.eval(t);
                let [x, y] = r.at(p.x, p.y);
                assert!(image.eval(t).distance(Point::new(x, y)) < 1e-11, "{t}");
            }
        }
    }

    fn spline(d: &str, degree: usize) -> Result<Subpath, Error> {
        let path = NamedPath { name: d.into(), outline: Outline::from_svg(d).unwrap() };
        Ok(through(&path, degree)?.outline.subpaths.remove(0))
    }

    /// Against the textbook's values at the knots, with all continuous derivatives.
    #[test]
    fn pieces_are_the_spline() {
        let p = [(0.0, 0.0), (10.0, 30.0), (50.0, 20.0), (60.0, -10.0), (20.0, -40.0)].map(Point::from);
        let v = |i: usize| p[i % 5].to_vec2();
        let near = |a: Point, b: Vec2| a.distance(b.to_point()) < 1e-12;
        let closed = "M0,0 L10,30 50,20 60,-10 20,-40 Z";
        let cubic = spline(closed, 3).unwrap();
        let quadratic = spline(closed, 2).unwrap();
        assert!(cubic.closed && cubic.segs.len() == 5 && quadratic.segs.len() == 5);
        for i in 0..5 {
            assert!(near(cubic.segs[i].start(), (v(i + 4) + 4.0 * v(i) + v(i + 1)) / 6.0));
            assert!(near(quadratic.segs[i].start(), (v(i) + v(i + 1)) / 2.0));
            assert_eq!(cubic.segs[i].end(), cubic.segs[(i + 1) % 5].start());
        }
        let open = spline("M0,0 L10,30 50,20 60,-10 20,-40", 3).unwrap();
        assert!(!open.closed && open.segs.len() == 2 && open.start == p[0] && open.segs[1].end() == p[4]);
        for (s, a, b) in [(&cubic, 0, 1), (&cubic, 2, 3), (&cubic, 4, 0), (&open, 0, 1)] {
            let (a, b) = (s.segs[a].to_cubic(), s.segs[b].to_cubic());
            let off = |a: Vec2, b: Vec2| (a - b).hypot();
            // The second derivative of the open one jumps nowhere either: its inner knot is simple and its cells equally wide.
            assert!(off(a.p3 - a.p2, b.p1 - b.p0) < 1e-12);
            assert!(off((a.p3 - a.p2) - (a.p2 - a.p1), (b.p2 - b.p1) - (b.p1 - b.p0)) < 1e-12);
        }
    }

    #[test]
    fn too_few_points_are_an_error() {
        for (d, degree) in [("M0,0 L5,5 Z", 2), ("M0,0 L9,0", 2)] {
            assert!(spline(d, degree).is_err(), "{d}");
        }
        assert!(spline("M0,0 L1,1 5,0", 3).err().unwrap().to_string().contains("at least 4 anchors"));
    }
}
