//! The bend as a map. Artwork is laid on a straight strip by an affine map ([`ToStrip`]): s is the distance along the skeleton, d the
//! height above it. Each piece of the skeleton maps its part of the strip by F(s, d) = C + d·S ([`StripMap`]), with a point C of the
//! curve and its *side* S: a unit normal, or what the handles of the paper of Chang & Rockwood (named in `super`) make of it.

use crate::error::show;
use crate::map::bspline::bernstein;
use crate::map::curves::ArcLength;
use crate::map::rational_bezier::Scaled;
use crate::map::{AffineMap, Class, Cost, Crease, Creases, Dual, Jet, Level, Map, RationalBezier, Real};
use crate::outline::Seg;
use crate::param::Letter;
use kurbo::{Affine, BezPath, CubicBez, Line, Point, QuadBez, Rect, Vec2};
use std::sync::Arc;

/// The map from the artwork to the strip: s = x_scale·x + offset and d = y_scale·(baseline − y), with positive scales.
#[derive(Debug, Clone, Copy)]
pub(super) struct ToStrip {
    pub(super) x_scale: f64,
    pub(super) offset: f64,
    pub(super) y_scale: f64,
    pub(super) baseline: f64,
}

impl ToStrip {
    pub(super) fn s(&self, x: f64) -> f64 {
        self.x_scale * x + self.offset
    }

    fn d(&self, y: f64) -> f64 {
        (self.baseline - y) * self.y_scale
    }

    /// Returns the point on `piece`, which begins at distance `start`.
    fn point(&self, piece: &SkeletonPiece, start: f64, p: Point) -> Point {
        piece.point(self.s(p.x) - start, self.d(p.y))
    }

    /// Returns the jet on `piece`, which begins at distance `start`.
    fn jet(&self, piece: &SkeletonPiece, start: f64, p: Point) -> Jet {
        let (image, ds, dd) = piece.jet(self.s(p.x) - start, self.d(p.y));
        Jet { p: image, dx: ds * self.x_scale, dy: dd * -self.y_scale }
    }
}

/// The bend: the pieces of a skeleton in a row.
#[derive(Clone)]
pub(super) struct BendMap {
    pub(super) pieces: Vec<Arc<SkeletonPiece>>,
    pub(super) length: f64,
    pub(super) closed: bool,
    pub(super) to_strip: ToStrip,
    /// The range of x in which creases are reported.
    pub(super) crease_range: (f64, f64),
}

impl BendMap {
    /// Returns the piece at distance `s`, and the distance of its start. On a closed skeleton, distances go on in every turn around it.
    fn piece(&self, s: f64) -> (&Arc<SkeletonPiece>, f64) {
        let turn = if self.closed { (s / self.length).floor() * self.length } else { 0.0 };
        let i = self.pieces.partition_point(|p| p.applies_from <= s - turn).max(1) - 1;
        (&self.pieces[i], self.pieces[i].start + turn)
    }

    /// Returns the point at distance `s` on the skeleton, and the unit tangent there.
    pub(super) fn frame_at(&self, s: f64) -> (Point, Vec2) {
        let (piece, start) = self.piece(s);
        let (point, along, _) = piece.jet(s - start, 0.0);
        (point, along / along.hypot())
    }

    /// Draws the first level of de Casteljau's generalised algorithm on every piece with handles, if there are any.
    pub(super) fn first_level(&self, heights: [f64; 2]) -> Option<BezPath> {
        let ribbon = |p: &Arc<SkeletonPiece>| match &p.strip {
            StripMap::Ribbon { ribbon, .. } => ribbon.first_level(heights),
            _ => Vec::new(),
        };
        let all: BezPath = self.pieces.iter().flat_map(ribbon).flatten().collect();
        (!all.elements().is_empty()).then_some(all)
    }

    /// Returns the map, as an affine one if the skeleton is one straight line.
    pub(super) fn simplest(&self) -> Arc<dyn Map> {
        let affine = match &self.pieces[..] {
            [only] if !self.closed => OnPiece::new(only, only.start, self.to_strip).affine(),
            _ => None,
        };
        affine.map_or_else(|| Arc::new(self.clone()) as Arc<dyn Map>, |m| Arc::new(AffineMap(m)))
    }

    /// Returns a warning if the artwork folds over itself. `points` are samples of the outlines of letters, each with its letter, or of the
    /// box of other artwork ([`box_samples`]); those of a letter follow one another. The determinant is linear in the height, and so
    /// least at the highest or lowest points.
    pub(super) fn fold_warning<'a>(&self, points: impl Iterator<Item = (Point, Option<&'a Letter>)>) -> Option<String> {
        // The determinant ∂F/∂s × ∂F/∂d: 1 + κd along unit normals.
        let det = |x: f64, y: f64| self.jet(Point::new(x, y)).det() / (self.to_strip.x_scale * self.to_strip.y_scale);
        let mut worst: Option<(f64, Point)> = None;
        let mut folded: Vec<&Letter> = Vec::new();
        for (p, letter) in points {
            let here = det(p.x, p.y);
            if here >= 0.0 {
                continue;
            }
            if worst.is_none_or(|(least, _)| here < least) {
                worst = Some((here, p));
            }
            folded.extend(letter.filter(|l| folded.last().is_none_or(|f| !std::ptr::eq(*f, *l))));
        }
        let (least, p) = worst?;
        let on_skeleton = det(p.x, self.to_strip.baseline);
        let names: Vec<&str> = folded.iter().map(|l| l.name.as_str()).collect();
        let (who, reaches) = match names.len() {
            0 => ("the artwork folds over itself".to_owned(), "it reaches"),
            1 => (format!("the letter {} folds over itself", list_names(&names)), "it reaches"),
            _ => (format!("the letters {} fold over themselves", list_names(&names)), "they reach"),
        };
        let why = if on_skeleton > 0.0 {
            // The linear determinant vanishes at the centre of curvature.
            let radius = self.to_strip.d(p.y).abs() * on_skeleton / (on_skeleton - least);
            format!("{reaches} more than {radius:.6} away from it, beyond the centre of curvature")
        } else {
            "what lies on the skeleton is turned over already".to_owned()
        };
        Some(format!(
            "bend: {who}, worst near {} of the skeleton, where {why}; a smaller `width`, another `baseline` or a gentler \
bend avoids that",
            show(self.point(Point::new(p.x, self.to_strip.baseline)))
        ))
    }
}

/// Lists the first names for a message.
pub(super) fn list_names(names: &[&str]) -> String {
    const SHOWN: usize = 8;
    let shown = names.iter().take(SHOWN).map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN { format!("{shown} and {} more", names.len() - SHOWN) } else { shown }
}

/// Samples the top and the bottom of a box.
pub(super) fn box_samples(rect: Rect) -> impl Iterator<Item = Point> {
    const SAMPLES: u32 = 1024;
    (0..=SAMPLES).flat_map(move |i| {
        let x = rect.x0 + rect.width() * (f64::from(i) + 0.5) / f64::from(SAMPLES + 1);
        [rect.y0, rect.y1].map(|y| Point::new(x, y))
    })
}

impl Map for BendMap {
    /// A jet on a curve takes less than half as long as one of a bicubic net, the unit of work.
    fn cost(&self) -> Cost<'_> {
        /// Number of pieces whose largest work is taken for all.
        const FIRST: usize = 16;
        const CURVE: f64 = 0.4;
        const SINGLY: f64 = 3.0; // Jets take longer one by one than in a batch.
        let work = self.pieces.iter().take(FIRST).map(|p| p.work()).fold(1.0, f64::max);
        Cost { jet: if work > 1.0 { SINGLY * work } else { CURVE }, ..Cost::new(work) }
    }

    fn jet(&self, p: Point) -> Jet {
        let (piece, start) = self.piece(self.to_strip.s(p.x));
        self.to_strip.jet(piece, start, p)
    }

    fn point(&self, p: Point) -> Point {
        let (piece, start) = self.piece(self.to_strip.s(p.x));
        self.to_strip.point(piece, start, p)
    }

    /// Adds the verticals at the skeleton's joints.
    fn creases(&self, out: &mut Creases) {
        /// Limit on the turns around a closed skeleton whose joints are reported.
        const MAX_TURNS: f64 = 64.0;
        let (a, b) = (self.to_strip.s(self.crease_range.0), self.to_strip.s(self.crease_range.1));
        let turns = |s: f64| if self.closed { (s / self.length).floor() } else { 0.0 };
        let (first, last) = (turns(a), turns(b));
        if first > last || (first - last).is_nan() {
            return;
        }
        // Far out, adding one to a turn may not change it, so the turns are counted.
        for turn in (0..=(last - first).min(MAX_TURNS) as usize).map(|n| first + n as f64) {
            for s in self.pieces.iter().map(|p| p.applies_from).filter(|s| s.is_finite()) {
                let c = self.to_strip.offset - s - turn * self.length;
                out.push(Crease::kink(Level::Line { a: self.to_strip.x_scale, b: 0.0, c }));
            }
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        let (piece, start) = self.piece(self.to_strip.s(inside.x));
        Some(Arc::new(OnPiece::new(piece, start, self.to_strip)))
    }

    fn detail(&self, _: Rect) -> Option<f64> {
        Some(f64::INFINITY) // Between creases, every piece is one simple curve.
    }
}

/// The smooth map on one piece.
struct OnPiece {
    piece: Arc<SkeletonPiece>,
    start: f64,
    to_strip: ToStrip,
}

impl OnPiece {
    fn new(piece: &Arc<SkeletonPiece>, start: f64, to_strip: ToStrip) -> Self {
        Self { piece: Arc::clone(piece), start, to_strip }
    }

    fn affine(&self) -> Option<Affine> {
        let StripMap::Straight { p, t, n } = &self.piece.strip else { return None };
        let ToStrip { x_scale, y_scale, .. } = self.to_strip;
        let origin = *p + *t * (self.to_strip.s(0.0) - self.start) + *n * self.to_strip.d(0.0);
        Some(Affine::new([t.x * x_scale, t.y * x_scale, -n.x * y_scale, -n.y * y_scale, origin.x, origin.y]))
    }
}

impl Map for OnPiece {
    fn cost(&self) -> Cost<'_> {
        Cost::new(self.piece.work())
    }

    fn jet(&self, p: Point) -> Jet {
        self.to_strip.jet(&self.piece, self.start, p)
    }

    fn point(&self, p: Point) -> Point {
        self.to_strip.point(&self.piece, self.start, p)
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
        let StripMap::Ribbon { ribbon, unit, table: None } = &self.piece.strip else { return None };
        let ToStrip { x_scale, offset, y_scale, baseline } = self.to_strip;
        let (length, v) = (self.piece.length, y_scale / unit);
        let to_uv = Affine::new([x_scale / length, 0.0, 0.0, -v, (offset - self.start) / length, baseline * v]);
        Some(ribbon.image(&AffineMap(to_uv).image(curve)?))
    }
}

/// The map F(s, d) of the strip along a piece, where s counts from the piece's start.
#[derive(Debug, Clone)]
pub(super) enum StripMap {
    /// F = p + s·t + d·n with the unit tangent t.
    Straight { p: Point, t: Vec2, n: Vec2 },
    /// F = C(u(s)) + d·S, where S is the unit normal plus shares of `mitres`, the differences between the mitres at the two ends and the
    /// normals there. A share falls to 0 at the other end: linearly, or quadratically if `smooth`, so that a straight side can follow.
    /// s is the length of the offset curve at height `even_height`, and `table` inverts it.
    Normals { spine: Spine, table: ArcLength, mitres: [Vec2; 2], even_height: f64, smooth: bool },
    /// The paper's polynomial F(u, v) with v = d / unit. u comes from the arc length by `table`, or without one is s / length.
    Ribbon { ribbon: Ribbon, unit: f64, table: Option<ArcLength> },
}

/// A piece of the skeleton and the map of its strip.
#[derive(Debug, Clone)]
pub(super) struct SkeletonPiece {
    /// The distance along the skeleton from which the piece applies; −∞ for the first piece of an open skeleton.
    pub(super) applies_from: f64,
    /// The distance of its start.
    pub(super) start: f64,
    pub(super) length: f64,
    pub(super) strip: StripMap,
}

impl SkeletonPiece {
    /// Returns the work of a point, in points of a bicubic net. An arc takes several sines and cosines; the de Casteljau steps of a ribbon
    /// take twice as long as a net.
    pub(super) fn work(&self) -> f64 {
        match &self.strip {
            StripMap::Normals { spine, .. } if matches!(spine.curve, Curve::Seg(Seg::Arc(_)) | Curve::Bezier(_)) => 2.0,
            StripMap::Straight { .. } | StripMap::Normals { .. } => 1.0,
            StripMap::Ribbon { .. } => 2.0,
        }
    }

    /// Returns F at distance `s` from the piece's start and height `d`.
    pub(super) fn point(&self, s: f64, d: f64) -> Point {
        match &self.strip {
            StripMap::Straight { p, t, n } => *p + *t * s + *n * d,
            StripMap::Normals { spine, table, mitres, smooth, .. } => {
                let (p, t) = spine.frame(table.parameter(s));
                p + self.side(t, mitres, *smooth, s).0 * d
            }
            StripMap::Ribbon { .. } => self.jet(s, d).0,
        }
    }

    /// Returns the side S at distance `s`, the normal of `t` plus the shares of the mitres, and the derivative of these shares.
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
            StripMap::Straight { p, t, n } => (*p + *t * s + *n * d, *t, *n),
            StripMap::Normals { spine, table, mitres, even_height, smooth } => {
                let MovingFrame { p, t, curvature } = spine.moving_frame(table.parameter(s));
                let (side, slope) = self.side(t, mitres, *smooth, s);
                let along = t * ((1.0 + curvature * d) / (1.0 + curvature * even_height)) + slope * d;
                (p + side * d, along, side)
            }
            StripMap::Ribbon { ribbon, unit, table } => {
                let u = table.as_ref().map_or(s / self.length, |t| t.parameter(s));
                let [x, y] = ribbon.eval(Dual { v: u, x: 1.0, y: 0.0 }, Dual { v: d / unit, x: 0.0, y: 1.0 });
                let slope = match table {
                    None => 1.0 / self.length,
                    Some(_) => {
                        let [x, y] = ribbon.eval(Dual { v: u, x: 1.0, y: 0.0 }, Dual::from(0.0));
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

/// A segment of a path, or a Bézier curve of a higher degree.
#[derive(Debug, Clone)]
pub(super) enum Curve {
    Seg(Seg),
    Bezier(Arc<[Point]>),
}

impl Curve {
    pub(super) fn bezier(points: Vec<Point>) -> Self {
        match points[..] {
            [a, b] => Self::Seg(Seg::Line(Line::new(a, b))),
            [a, b, c] => Self::Seg(Seg::Quad(QuadBez::new(a, b, c))),
            [a, b, c, d] => Self::Seg(Seg::Cubic(CubicBez::new(a, b, c, d))),
            _ => Self::Bezier(points.into()),
        }
    }

    /// Returns the control points; for an arc, those of a cubic near it.
    pub(super) fn points(&self) -> Vec<Point> {
        match self {
            Self::Seg(Seg::Line(s)) => vec![s.p0, s.p1],
            Self::Seg(Seg::Quad(s)) => vec![s.p0, s.p1, s.p2],
            Self::Seg(other) => {
                let c = other.to_cubic();
                vec![c.p0, c.p1, c.p2, c.p3]
            }
            Self::Bezier(points) => points.to_vec(),
        }
    }

    pub(super) fn eval(&self, u: f64) -> Point {
        match self {
            Self::Seg(s) => s.eval(u),
            Self::Bezier(points) => derivative(points, u, 0).to_point(),
        }
    }

    pub(super) fn deriv(&self, u: f64) -> Vec2 {
        match self {
            Self::Seg(s) => s.deriv(u),
            Self::Bezier(points) => derivative(points, u, 1),
        }
    }

    /// Returns the second derivative.
    fn second(&self, u: f64) -> Vec2 {
        match self {
            Self::Seg(Seg::Line(_)) => Vec2::ZERO,
            Self::Seg(Seg::Arc(a)) => {
                let (sin, cos) = (a.start + a.sweep * u).sin_cos();
                (a.a * cos + a.b * sin) * -(a.sweep * a.sweep)
            }
            Self::Seg(Seg::Quad(q)) => ((q.p2 - q.p1) - (q.p1 - q.p0)) * 2.0,
            Self::Seg(Seg::Cubic(c)) => {
                let (d0, d1, d2) = (c.p1 - c.p0, c.p2 - c.p1, c.p3 - c.p2);
                ((d1 - d0) * (1.0 - u) + (d2 - d1) * u) * 6.0
            }
            Self::Bezier(points) => derivative(points, u, 2),
        }
    }

    pub(super) fn reversed(&self) -> Self {
        match self {
            Self::Seg(s) => Self::Seg(s.reversed()),
            Self::Bezier(points) => Self::Bezier(points.iter().rev().copied().collect()),
        }
    }

    /// Returns segments for a preview; for a curve of higher degree, eight cubics with its points and tangents at their ends.
    pub(super) fn segs(&self) -> Vec<Seg> {
        if let Self::Seg(s) = self {
            return vec![*s];
        }
        let end = |i: u32| (self.eval(f64::from(i) / 8.0), self.deriv(f64::from(i) / 8.0) / 24.0);
        let cubic = |((a, da), (b, db))| Seg::Cubic(CubicBez::new(a, a + da, b - db, b));
        (0..8).map(|i| cubic((end(i), end(i + 1)))).collect()
    }
}

fn polyline(points: impl Iterator<Item = Point>) -> BezPath {
    let mut out = BezPath::new();
    points.enumerate().for_each(|(i, p)| if i == 0 { out.move_to(p) } else { out.line_to(p) });
    out
}

/// Returns a derivative of this order of a Bézier curve.
fn derivative(points: &[Point], u: f64, order: usize) -> Vec2 {
    let (mut row, mut factor) = (points.iter().map(|p| p.to_vec2()).collect::<Vec<_>>(), 1.0);
    for _ in 0..order {
        factor *= (row.len() - 1) as f64;
        row = row.windows(2).map(|p| p[1] - p[0]).collect();
    }
    row.iter().zip(bernstein(row.len() - 1, u)).fold(Vec2::ZERO, |sum, (p, b)| sum + *p * (b * factor))
}

/// A piece of the skeleton's curve.
#[derive(Debug, Clone)]
pub(super) struct Spine {
    pub(super) curve: Curve,
    /// A lower speed |C′(u)| counts as zero.
    min_speed: f64,
}

/// The moving frame of a piece. With T the tangent and N its [`normal`], dT/ds = −κN, dN/ds = κT.
pub(super) struct MovingFrame {
    pub(super) p: Point,
    /// Unit tangent.
    pub(super) t: Vec2,
    /// Curvature, positive where the curve turns clockwise on the screen: away from the normal.
    pub(super) curvature: f64,
}

impl Spine {
    pub(super) fn new(curve: Curve) -> Self {
        /// Minimum speed as a share of the piece's size.
        const MIN_SPEED: f64 = 1e-9;
        let b = match &curve {
            Curve::Seg(seg) => seg.bounding_box(),
            Curve::Bezier(points) => points.iter().fold(Rect::from_points(points[0], points[0]), |r, p| r.union_pt(*p)),
        };
        Self { curve, min_speed: MIN_SPEED * (b.width() + b.height()) }
    }

    /// Returns the point and the unit tangent at a parameter.
    fn frame(&self, u: f64) -> (Point, Vec2) {
        let (_, v, speed) = self.velocity(u);
        (self.curve.eval(u), v / speed)
    }

    /// Returns the moving frame at a parameter.
    pub(super) fn moving_frame(&self, u: f64) -> MovingFrame {
        let (inside, v, speed) = self.velocity(u);
        let curvature = v.cross(self.curve.second(inside)) / speed.powi(3);
        MovingFrame { p: self.curve.eval(u), t: v / speed, curvature }
    }

    /// Returns a parameter, and the derivative there with its length. It is `u`, or a little further inside if the speed vanishes.
    fn velocity(&self, u: f64) -> (f64, Vec2, f64) {
        /// Distance from `u` to the other parameter.
        const STEP_INSIDE: f64 = 1e-5;
        let v = self.curve.deriv(u);
        if v.hypot() > self.min_speed {
            return (u, v, v.hypot());
        }
        let inside = if u < 0.5 { u + STEP_INSIDE } else { u - STEP_INSIDE };
        let v = self.curve.deriv(inside);
        (inside, v, v.hypot())
    }
}

// The generalised algorithm of de Casteljau, in which every step is an affine map of the whole plane (or space) instead of a point on
// a segment:
//
// `p[i,j] = p[i,j−1] + u·(p[i+1,j−1] − p[i,j−1]) + v·s[i,j] (+ w·t[i,j] in space)`, where s and t are the *handles* of level j
// (the paper's equations 2 and 3). Terms with v stay linear in v through all levels: in the plane F(u, v) = C(u) + v·S(u), where C is
// the Bézier curve of the control points, and S is the sum, over the levels j, of the Bézier curves of degree n−j of their handles.

/// Returns the image of u = (u, v) or (u, v, w) under the affine map of one step: p + u₀·(q − p) + Σ uₖ·hₖ.
fn affine_step<S: Real, const D: usize>(p: [S; D], q: [S; D], handles: &[[f64; D]], u: &[S]) -> [S; D] {
    std::array::from_fn(|i| {
        let along = p[i] + u[0] * (q[i] - p[i]);
        handles.iter().zip(&u[1..]).fold(along, |sum, (h, v)| sum + *v * S::from(h[i]))
    })
}

/// Returns the point at parameters `u` for a control polygon and handles, given by `handles(level, i)` with levels from 1.
fn de_casteljau<'a, S: Real, const D: usize>(
    row: &mut [[S; D]],
    handles: impl Fn(usize, usize) -> &'a [[f64; D]],
    u: &[S],
) -> [S; D] {
    for level in 1..row.len() {
        for i in 0..row.len() - level {
            row[i] = affine_step(row[i], row[i + 1], handles(level, i), u);
        }
    }
    row[0]
}

/// A Bézier piece with its handles.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ribbon {
    points: Vec<Point>,
    /// Handles s at the control points p, which stand for the maps p + v·s; or none.
    at_points: Vec<[f64; 2]>,
    /// The handles by levels: n on the first, n−1 on the second, and so on. The last levels may be omitted.
    levels: Vec<Vec<[f64; 2]>>,
}

/// The highest degree of a skeleton's pieces.
pub(super) const MAX_DEGREE: usize = 10;

impl Ribbon {
    /// Creates a piece; `None` unless there are n+1−j handles on level j.
    pub(super) fn new(points: Vec<Point>, levels: &[Vec<Vec2>]) -> Option<Self> {
        let n = points.len().checked_sub(1)?;
        let fits = (1..=MAX_DEGREE).contains(&n) && levels.len() <= n;
        if !fits || levels.iter().enumerate().any(|(j, l)| l.len() != n - j) {
            return None;
        }
        let levels = levels.iter().map(|l| l.iter().map(|h| [h.x, h.y]).collect()).collect();
        Some(Self { points, at_points: Vec::new(), levels })
    }

    /// Creates a piece with a handle at each of its points.
    pub(super) fn with_handles_at_points(points: Vec<Point>, handles: &[Vec2]) -> Self {
        Self { points, at_points: handles.iter().map(|h| [h.x, h.y]).collect(), levels: Vec::new() }
    }

    /// Returns F(u, v).
    pub(super) fn eval<S: Real>(&self, u: S, v: S) -> [S; 2] {
        let mut row = [[S::from(0.0); 2]; MAX_DEGREE + 1];
        for (r, p) in row.iter_mut().zip(&self.points) {
            *r = [S::from(p.x), S::from(p.y)];
        }
        for (r, h) in row.iter_mut().zip(&self.at_points) {
            *r = [r[0] + v * S::from(h[0]), r[1] + v * S::from(h[1])];
        }
        // Levels without handles cost nothing.
        let handles = |level: usize, i: usize| match self.levels.get(level - 1) {
            Some(l) => std::slice::from_ref(&l[i]),
            None => &[],
        };
        de_casteljau(&mut row[..self.points.len()], handles, &[u, v])
    }

    /// Returns S(u) at an end: 0 or 1.
    pub(super) fn side_at_end(&self, end: usize) -> Vec2 {
        let pick = |l: &Vec<[f64; 2]>| if end == 0 { l.first().copied() } else { l.last().copied() };
        let all = self.levels.iter().chain([&self.at_points]);
        all.filter_map(pick).fold(Vec2::ZERO, |a, [x, y]| a + Vec2::new(x, y))
    }

    /// Draws the first level of the algorithm, which takes artwork between two heights to every side of the control polygon, as in
    /// the paper's figure 1c: the polygon, and the quadrangles between the handles of both ends.
    pub(super) fn first_level(&self, heights: [f64; 2]) -> Vec<BezPath> {
        let handle = |leg: usize, end: usize| {
            let [x, y] =
                self.at_points.get(leg + end).or(self.levels.first().and_then(|l| l.get(leg))).unwrap_or(&[0.0; 2]);
            Vec2::new(*x, *y)
        };
        let quad = |(i, p): (usize, &[Point])| {
            let corner = |end: usize, v: f64| p[end] + handle(i, end) * v;
            let [a, b] = heights;
            polyline([corner(0, a), corner(0, b), corner(1, b), corner(1, a), corner(0, a)].into_iter())
        };
        let polygon = polyline(self.points.iter().copied());
        self.points.windows(2).enumerate().map(quad).chain([polygon]).collect()
    }

    /// Returns the exact image of a curve in (u, v). Its degree is n times that of the curve, or n + 1 times with handles at the points.
    pub(super) fn image(&self, curve: &RationalBezier) -> RationalBezier {
        let n = self.points.len() - 1;
        let degree = n + usize::from(!self.at_points.is_empty());
        let [u, v, w] = [0, 1, 2].map(|k| curve.coordinate(k));
        let mut rest = w.clone();
        rest.add_scaled(-1.0, &u);
        // Homogeneous Bernstein terms: C(k, i)·uⁱ(w−u)^(k−i), times v for handles, times powers of w to raise the degree.
        let (u_powers, rest_powers, w_powers) = (u.powers(n), rest.powers(n), w.powers(degree));
        let (mut x, mut y) = (Scaled::zero(degree * curve.degree()), Scaled::zero(degree * curve.degree()));
        let mut add = |[px, py]: [f64; 2], k: usize, i: usize, factor: &Scaled| {
            let (c, term) = (binomial(k, i), u_powers[i].times(&rest_powers[k - i]).times(factor));
            x.add_scaled(px * c, &term);
            y.add_scaled(py * c, &term);
        };
        for (i, p) in self.points.iter().enumerate() {
            add([p.x, p.y], n, i, &w_powers[degree - n]);
        }
        // The terms of S have degree n for handles at points, and n − j for the handles of level j.
        for (j, level) in [&self.at_points].into_iter().chain(&self.levels).enumerate() {
            for (i, h) in level.iter().enumerate() {
                add(*h, n - j, i, &v.times(&w_powers[degree + j - n - 1]));
            }
        }
        RationalBezier::from_coordinates([&x, &y, &w_powers[degree]], curve.is_polynomial())
    }
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{Counted, operations};

    /// Table 1 of the paper: 9, 27 and 54 products and as many sums per point in space for degrees 1, 2 and 3. The paper takes
    /// q − p as given, and omits its three differences per step. In the plane, a step takes 4 products and 4 sums.
    #[test]
    fn operation_counts_are_those_of_table_1() {
        for (degree, expected) in [(1, 9), (2, 27), (3, 54)] {
            let point = |i: usize| [i as f64, 1.0, 2.0].map(Counted);
            let handles = [[0.5, 1.0, 0.0], [0.0, 0.3, 1.0]];
            let [products, sums, differences] = operations(|| {
                let mut row: Vec<_> = (0..=degree).map(point).collect();
                let _ = de_casteljau(&mut row, |_, _| &handles[..], &[0.3, 0.4, 0.5].map(Counted));
            });
            assert_eq!((products, sums, differences), (expected, expected, expected / 3), "degree {degree}");

            let levels: Vec<_> = (1..=degree).map(|j| vec![Vec2::new(1.0, 2.0); degree + 1 - j]).collect();
            let ribbon = Ribbon::new((0..=degree).map(|i| Point::new(i as f64, 1.0)).collect(), &levels).unwrap();
            let [products, ..] = operations(|| {
                let _ = ribbon.eval(Counted(0.3), Counted(0.4));
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

    /// Without handles the algorithm is de Casteljau's; with handles F is linear in v, with the stated S.
    #[test]
    fn handles_add_v_times_a_curve_of_lower_degree() {
        let r = ribbon();
        let curve = CubicBez::new(r.points[0], r.points[1], r.points[2], r.points[3]);
        for (u, v) in [(0.0, 0.0), (0.3, 0.8), (1.0, -1.0), (1.2, 2.0)] {
            let [x, y] = r.eval(u, v);
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
                let [x, y] = r.eval(p.x, p.y);
                assert!(image.eval(t).distance(Point::new(x, y)) < 1e-11, "{t}");
            }
        }
    }
}
