//! The source geometry: subpaths of lines, quadratics, cubics and *true* elliptical arcs.
//!
//! kurbo's [`BezPath`] has no arcs. Turning a circle into cubics before warping it would spend part of the tolerance, or many
//! nodes, before the warp begins; here an arc stays an arc until its image is fitted, so the promised error counts from the
//! shape that was drawn.

mod arc;
mod svg;

pub use arc::EllipticArc;

use kurbo::{Affine, BezPath, CubicBez, Line, ParamCurve, ParamCurveDeriv, PathEl, Point, QuadBez, Rect, Shape, Vec2};

/// One smooth piece of a path, parametrised over [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Seg {
    /// A straight line.
    Line(Line),
    /// A quadratic Bézier curve.
    Quad(QuadBez),
    /// A cubic Bézier curve.
    Cubic(CubicBez),
    /// An arc of an ellipse.
    Arc(EllipticArc),
}

impl Seg {
    /// The point at `t` in [0, 1]. The ends are exact.
    #[inline]
    #[must_use]
    pub fn eval(&self, t: f64) -> Point {
        match self {
            Self::Line(s) => s.eval(t),
            Self::Quad(s) => s.eval(t),
            Self::Cubic(s) => s.eval(t),
            Self::Arc(s) => s.eval(t),
        }
    }

    /// The derivative with respect to `t`.
    #[inline]
    #[must_use]
    pub fn deriv(&self, t: f64) -> Vec2 {
        match self {
            Self::Line(s) => s.p1 - s.p0,
            Self::Quad(s) => s.deriv().eval(t).to_vec2(),
            Self::Cubic(s) => s.deriv().eval(t).to_vec2(),
            Self::Arc(s) => s.deriv(t),
        }
    }

    /// First point.
    #[must_use]
    pub fn start(&self) -> Point {
        match self {
            Self::Line(s) => s.p0,
            Self::Quad(s) => s.p0,
            Self::Cubic(s) => s.p0,
            Self::Arc(s) => s.p0,
        }
    }

    /// Last point.
    #[must_use]
    pub fn end(&self) -> Point {
        match self {
            Self::Line(s) => s.p1,
            Self::Quad(s) => s.p2,
            Self::Cubic(s) => s.p3,
            Self::Arc(s) => s.p1,
        }
    }

    /// The same piece run backwards.
    #[must_use]
    pub fn reversed(&self) -> Self {
        match self {
            Self::Line(s) => Self::Line(Line::new(s.p1, s.p0)),
            Self::Quad(s) => Self::Quad(QuadBez::new(s.p2, s.p1, s.p0)),
            Self::Cubic(s) => Self::Cubic(CubicBez::new(s.p3, s.p2, s.p1, s.p0)),
            Self::Arc(s) => Self::Arc(s.reversed()),
        }
    }

    /// The stretch between two parameters of a Bézier piece, exact, the whole unchanged; `None` for arcs.
    #[must_use]
    pub fn part(&self, t0: f64, t1: f64) -> Option<Self> {
        let whole = t0 == 0.0 && t1 == 1.0;
        match self {
            Self::Arc(_) => None,
            _ if whole => Some(*self),
            Self::Line(s) => Some(Self::Line(s.subsegment(t0..t1))),
            Self::Quad(s) => Some(Self::Quad(s.subsegment(t0..t1))),
            Self::Cubic(s) => Some(Self::Cubic(s.subsegment(t0..t1))),
        }
    }

    /// The image under an affine map, exact for every kind.
    #[must_use]
    pub fn transformed(&self, m: Affine) -> Self {
        match self {
            Self::Line(s) => Self::Line(m * *s),
            Self::Quad(s) => Self::Quad(m * *s),
            Self::Cubic(s) => Self::Cubic(m * *s),
            Self::Arc(s) => Self::Arc(s.transformed(m)),
        }
    }

    /// The smallest box with sides along the axes that holds the piece.
    #[must_use]
    pub fn bounding_box(&self) -> Rect {
        match self {
            Self::Line(s) => s.bounding_box(),
            Self::Quad(s) => s.bounding_box(),
            Self::Cubic(s) => s.bounding_box(),
            Self::Arc(s) => s.bounding_box(),
        }
    }

    /// The piece as one cubic: exact for lines, quadratics and cubics; for an arc, the cubic with the arc's end tangents and
    /// handles (4/3)·tan(Δ/4) of its conjugate radius (radial error 2.7e-4 of the radius for a quarter circle).
    #[must_use]
    pub fn to_cubic(&self) -> CubicBez {
        match self {
            Self::Line(s) => CubicBez::new(s.p0, s.p0.lerp(s.p1, 1.0 / 3.0), s.p0.lerp(s.p1, 2.0 / 3.0), s.p1),
            Self::Quad(s) => s.raise(),
            Self::Cubic(s) => *s,
            Self::Arc(s) => s.to_cubic(),
        }
    }

    /// Whether every number in it is finite and below 1e100 in size.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        const HUGE: f64 = 1e100;
        let ok = |p: Point| (p.x.abs() < HUGE) & (p.y.abs() < HUGE);
        match self {
            Self::Line(s) => ok(s.p0) & ok(s.p1),
            Self::Quad(s) => ok(s.p0) & ok(s.p1) & ok(s.p2),
            Self::Cubic(s) => ok(s.p0) & ok(s.p1) & ok(s.p2) & ok(s.p3),
            Self::Arc(s) => s.is_finite(HUGE),
        }
    }
}

/// A connected run of pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct Subpath {
    /// Where it starts (also when it has no pieces: a lone point draws a dot under round caps).
    pub start: Point,
    /// The pieces, each starting where the one before ends. A closed subpath's closing line is one of them unless its length
    /// is zero.
    pub segs: Vec<Seg>,
    /// Whether it is closed.
    pub closed: bool,
}

impl Subpath {
    /// The anchors: the points where pieces start, and for an open subpath the last point.
    #[must_use]
    pub fn anchors(&self) -> Vec<Point> {
        let mut out: Vec<Point> = self.segs.iter().map(Seg::start).collect();
        if out.is_empty() {
            out.push(self.start);
        } else if !self.closed {
            out.extend(self.segs.last().map(Seg::end));
        }
        out
    }

    /// Last point.
    #[must_use]
    pub fn end(&self) -> Point {
        self.segs.last().map_or(self.start, Seg::end)
    }

    /// The same curve run backwards.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self { start: self.end(), segs: self.segs.iter().rev().map(Seg::reversed).collect(), closed: self.closed }
    }
}

/// A path as drawn: the source of every deformation.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outline {
    /// Its connected runs, in drawing order.
    pub subpaths: Vec<Subpath>,
}

impl Outline {
    /// Reads SVG path data (the `d` attribute), arcs kept as arcs.
    ///
    /// # Errors
    /// Says where the data stops making sense. SVG renderers draw such paths up to the error; use [`Outline::from_svg_lossy`]
    /// for that.
    pub fn from_svg(data: &str) -> Result<Self, String> {
        svg::parse(data).map_err(|(e, _)| e)
    }

    /// Reads SVG path data up to the first error, as SVG renderers do.
    #[must_use]
    pub fn from_svg_lossy(data: &str) -> Self {
        svg::parse(data).unwrap_or_else(|(_, sound)| sound)
    }

    /// An open polyline through `points`, or a closed polygon.
    #[must_use]
    pub fn from_points(points: &[Point], closed: bool) -> Self {
        let Some(&start) = points.first() else { return Self::default() };
        let mut b = Builder::default();
        b.move_to(start);
        for &p in &points[1..] {
            b.line_to(p);
        }
        if closed {
            b.close();
        }
        b.finish()
    }

    /// All pieces in drawing order.
    pub fn segs(&self) -> impl Iterator<Item = &Seg> {
        self.subpaths.iter().flat_map(|s| &s.segs)
    }

    /// Whether there is nothing to draw.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.subpaths.is_empty()
    }

    /// The outline at every one of these places, as one; as it is if there are none.
    #[must_use]
    pub fn repeated(&self, places: &[Affine]) -> Self {
        if places.is_empty() {
            return self.clone();
        }
        Self { subpaths: places.iter().flat_map(|m| self.transformed(*m).subpaths).collect() }
    }

    /// The image under an affine map, exact.
    #[must_use]
    pub fn transformed(&self, m: Affine) -> Self {
        let subpaths = self
            .subpaths
            .iter()
            .map(|s| Subpath {
                start: m * s.start,
                segs: s.segs.iter().map(|g| g.transformed(m)).collect(),
                closed: s.closed,
            })
            .collect();
        Self { subpaths }
    }

    /// The smallest box with sides along the axes that holds the path; `None` for an empty one.
    #[must_use]
    pub fn bounding_box(&self) -> Option<Rect> {
        let mut all: Option<Rect> = None;
        for s in &self.subpaths {
            let mut b = Rect::from_points(s.start, s.start);
            for g in &s.segs {
                b = b.union(g.bounding_box());
            }
            all = Some(all.map_or(b, |a| a.union(b)));
        }
        all
    }

    /// As a [`BezPath`], each arc as cubics that stay within `tolerance` of it.
    #[must_use]
    pub fn to_bez_path(&self, tolerance: f64) -> BezPath {
        let mut out = BezPath::new();
        for s in &self.subpaths {
            out.move_to(s.start);
            let closing = s.closed && matches!(s.segs.last(), Some(Seg::Line(_)));
            let drawn = s.segs.len() - usize::from(closing);
            for g in &s.segs[..drawn] {
                match g {
                    Seg::Line(l) => out.line_to(l.p1),
                    Seg::Quad(q) => out.quad_to(q.p1, q.p2),
                    Seg::Cubic(c) => out.curve_to(c.p1, c.p2, c.p3),
                    Seg::Arc(a) => {
                        for c in a.to_cubics(tolerance) {
                            out.curve_to(c.p1, c.p2, c.p3);
                        }
                    }
                }
            }
            if s.closed {
                out.close_path();
            }
        }
        out
    }
}

impl From<&BezPath> for Outline {
    fn from(path: &BezPath) -> Self {
        let mut b = Builder::default();
        for el in path {
            match el {
                PathEl::MoveTo(p) => b.move_to(p),
                PathEl::LineTo(p) => b.line_to(p),
                PathEl::QuadTo(p1, p2) => b.quad_to(p1, p2),
                PathEl::CurveTo(p1, p2, p3) => b.curve_to(p1, p2, p3),
                PathEl::ClosePath => b.close(),
            }
        }
        b.finish()
    }
}

/// Builds an [`Outline`] from drawing commands with the meaning they have in SVG: a drawing command after a close starts a new
/// subpath at the closed one's start.
#[derive(Debug, Default)]
pub struct Builder {
    done: Vec<Subpath>,
    open: Option<Subpath>,
    at: Point,
}

impl Builder {
    /// Starts a subpath.
    pub fn move_to(&mut self, p: Point) {
        self.done.extend(self.open.take());
        self.open = Some(Subpath { start: p, segs: Vec::new(), closed: false });
        self.at = p;
    }

    fn push(&mut self, seg: Seg) {
        let start = self.at;
        self.at = seg.end();
        self.open.get_or_insert_with(|| Subpath { start, segs: Vec::new(), closed: false }).segs.push(seg);
    }

    /// Draws a line.
    pub fn line_to(&mut self, p: Point) {
        self.push(Seg::Line(Line::new(self.at, p)));
    }

    /// Draws a quadratic.
    pub fn quad_to(&mut self, p1: Point, p2: Point) {
        self.push(Seg::Quad(QuadBez::new(self.at, p1, p2)));
    }

    /// Draws a cubic.
    pub fn curve_to(&mut self, p1: Point, p2: Point, p3: Point) {
        self.push(Seg::Cubic(CubicBez::new(self.at, p1, p2, p3)));
    }

    /// Draws an SVG arc; a degenerate one becomes a line or nothing, as the SVG specification says.
    pub fn arc_to(&mut self, radii: Vec2, x_rotation_degrees: f64, large: bool, sweep: bool, p: Point) {
        match EllipticArc::from_svg(self.at, radii, x_rotation_degrees, large, sweep, p) {
            Some(arc) => self.push(Seg::Arc(arc)),
            None if p == self.at => {}
            None => self.line_to(p),
        }
    }

    /// Draws `arc`, which must start where the pen is.
    pub fn arc(&mut self, arc: EllipticArc) {
        self.push(Seg::Arc(arc));
    }

    /// Closes the subpath.
    pub fn close(&mut self) {
        if let Some(mut s) = self.open.take() {
            if s.end() != s.start {
                s.segs.push(Seg::Line(Line::new(s.end(), s.start)));
            }
            s.closed = true;
            self.at = s.start;
            self.done.push(s);
        }
    }

    /// Where the pen is.
    #[must_use]
    pub fn at(&self) -> Point {
        self.at
    }

    /// The path.
    #[must_use]
    pub fn finish(mut self) -> Outline {
        self.done.extend(self.open.take());
        Outline { subpaths: self.done }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closing_adds_the_missing_line_and_no_other() {
        let o = Outline::from_svg("M0 0H10V10H0Z M20 20 L30 20 L30 30 L20 20 Z").unwrap();
        assert_eq!(o.subpaths[0].segs.len(), 4);
        assert_eq!(o.subpaths[1].segs.len(), 3);
        assert_eq!(o.subpaths[0].anchors().len(), 4);
    }

    #[test]
    fn drawing_after_a_close_starts_at_the_closed_start() {
        let o = Outline::from_svg("M5 5 h10 v10 z l-5 -5").unwrap();
        assert_eq!(o.subpaths.len(), 2);
        assert_eq!(o.subpaths[1].start, Point::new(5.0, 5.0));
        assert_eq!(o.subpaths[1].end(), Point::new(0.0, 0.0));
    }

    #[test]
    fn an_error_names_the_place_and_lossy_keeps_what_was_sound() {
        let e = Outline::from_svg("M0 0 L10 10 L5 x").unwrap_err();
        assert!(e.contains("position 16"), "{e}");
        assert_eq!(Outline::from_svg_lossy("M0 0 L10 10 L5 x").segs().count(), 1);
    }
}
