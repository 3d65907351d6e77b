//! Paths as drawn: the source geometry of every deformation.
//!
//! An [`Outline`] is a list of [`Subpath`]s, each a run of [`Seg`]s: lines, quadratic and cubic Bézier curves, and *true* elliptical
//! arcs. Read one from SVG path data with [`Outline::from_svg`], convert a [`kurbo::BezPath`] with `From`, or draw one with a
//! [`Builder`].
//!
//! [`BezPath`] has no arcs. Converting a circle to cubics before it is warped would take part of the tolerance, or many nodes.
//! Here an [`EllipticArc`] stays an arc until its image is fitted, so that the promised error is measured from the shape that was drawn.

mod arc;
pub(crate) mod marching_squares;
mod stroke;
mod svg;

use kurbo::{
    Affine, BezPath, CubicBez, Line, ParamCurve, ParamCurveDeriv, PathEl, PathSeg, Point, QuadBez, Rect, Shape, Vec2,
};

pub use arc::EllipticArc;
pub use svg::{Builder, PathDataError};

/// A connected run of segments.
#[derive(Debug, Clone, PartialEq)]
pub struct Subpath {
    /// The first point. A subpath without segments is a single point, drawn as a dot with round caps.
    pub start: Point,
    /// The segments, each starting at the end of the previous one. They include the closing line of a closed subpath, unless
    /// its length is zero.
    pub segs: Vec<Seg>,
    /// `true` for a closed subpath.
    pub closed: bool,
}

impl Subpath {
    /// Returns the anchors: the first points of all segments and, for an open subpath, the last point.
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

    /// Returns the anchors as drawing programs store them: incoming handle, anchor, outgoing handle. The handles of lines coincide with
    /// their anchors, and arcs become cubics.
    #[must_use]
    pub fn with_handles(&self) -> Vec<[Point; 3]> {
        let to_cubics = |g: &Seg| match g {
            Seg::Line(l) => vec![CubicBez::new(l.p0, l.p0, l.p1, l.p1)],
            Seg::Arc(arc) => arc.to_cubics(arc.a.hypot().max(arc.b.hypot()) * 1e-3).collect(),
            other => vec![other.to_cubic()],
        };
        let cubics: Vec<CubicBez> = self.segs.iter().flat_map(to_cubics).collect();
        let Some(last) = cubics.last() else { return vec![[self.start; 3]] };
        let mut incoming = if self.closed { last.p2 } else { cubics[0].p0 };
        let mut out = Vec::with_capacity(cubics.len() + 1);
        for c in &cubics {
            out.push([incoming, c.p0, c.p1]);
            incoming = c.p2;
        }
        if !self.closed {
            out.push([last.p2, last.p3, last.p3]);
        }
        out
    }

    /// Returns the last point.
    #[must_use]
    pub fn end(&self) -> Point {
        self.segs.last().map_or(self.start, Seg::end)
    }

    /// Returns the bounding box.
    #[must_use]
    pub fn bounding_box(&self) -> Rect {
        let point = |p: Point| Rect::from_points(p, p);
        let ends = self.segs.iter().map(Seg::end).fold(point(self.start), |b, p| b.union(point(p)));
        // Most segments lie in the box of all ends already; only the others need their extremes.
        self.segs.iter().fold(ends, |b, g| g.extend(b))
    }

    /// Returns the diagonal of the bounding box.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        self.bounding_box().size().to_vec2().hypot()
    }

    /// Returns the subpath in the opposite direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self { start: self.end(), segs: self.segs.iter().rev().map(Seg::reversed).collect(), closed: self.closed }
    }
}

/// A path as drawn: the source of every deformation.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outline {
    /// The subpaths in drawing order.
    pub subpaths: Vec<Subpath>,
}

impl Outline {
    /// Creates an open polyline through `points`, or a closed polygon.
    #[must_use]
    pub fn from_points(points: &[Point], closed: bool) -> Self {
        let Some(&start) = points.first() else { return Self::default() };
        let mut segs: Vec<Seg> = points.windows(2).map(|p| Seg::Line(Line::new(p[0], p[1]))).collect();
        let end = points.last().copied().unwrap_or(start);
        if closed && end != start {
            segs.push(Seg::Line(Line::new(end, start)));
        }
        Self { subpaths: vec![Subpath { start, segs, closed }] }
    }

    /// Returns the [anchors](Subpath::anchors) of all subpaths.
    pub(crate) fn anchors(&self) -> Vec<Point> {
        self.subpaths.iter().flat_map(Subpath::anchors).collect()
    }

    /// Returns all segments in drawing order.
    pub fn segs(&self) -> impl Iterator<Item = &Seg> {
        self.subpaths.iter().flat_map(|s| &s.segs)
    }

    /// Returns the largest magnitude of coordinates; see [`Seg::extent`].
    #[must_use]
    pub fn extent(&self) -> f64 {
        self.segs().map(Seg::extent).fold(0.0, f64::max)
    }

    /// Returns `true` if there is nothing to draw.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.subpaths.is_empty()
    }

    /// Returns the images under all of `places` as one outline; the outline itself if `places` is empty.
    #[must_use]
    pub fn repeated(&self, places: &[Affine]) -> Self {
        if places.is_empty() {
            return self.clone();
        }
        Self { subpaths: places.iter().flat_map(|m| self.transformed(*m).subpaths).collect() }
    }

    /// Returns the exact image under an affine map.
    #[must_use]
    pub fn transformed(&self, m: Affine) -> Self {
        let segs = |s: &Subpath| s.segs.iter().map(|g| g.transformed(m)).collect();
        let image = |s: &Subpath| Subpath { start: m * s.start, segs: segs(s), closed: s.closed };
        Self { subpaths: self.subpaths.iter().map(image).collect() }
    }

    /// Returns the bounding box; `None` for an empty path.
    #[must_use]
    pub fn bounding_box(&self) -> Option<Rect> {
        let ends = self.subpaths.iter().flat_map(|s| s.segs.iter().map(Seg::end).chain([s.start]));
        let ends = ends.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))?;
        // Most segments lie in the box of all ends already; only the others need their extremes.
        Some(self.segs().fold(ends, |b, g| g.extend(b)))
    }

    /// Converts to a [`BezPath`], with cubics within `tolerance` of each arc.
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

/// A segment of a path, parametrised over [0, 1].
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

impl From<PathSeg> for Seg {
    fn from(s: PathSeg) -> Self {
        match s {
            PathSeg::Line(s) => Self::Line(s),
            PathSeg::Quad(s) => Self::Quad(s),
            PathSeg::Cubic(s) => Self::Cubic(s),
        }
    }
}

impl Seg {
    /// Returns the point at `t` in [0, 1]. The ends are exact.
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

    /// Returns the derivative with respect to `t`.
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

    /// Returns the first point.
    #[must_use]
    pub fn start(&self) -> Point {
        match self {
            Self::Line(s) => s.p0,
            Self::Quad(s) => s.p0,
            Self::Cubic(s) => s.p0,
            Self::Arc(s) => s.p0,
        }
    }

    /// Returns the last point.
    #[must_use]
    pub fn end(&self) -> Point {
        match self {
            Self::Line(s) => s.p1,
            Self::Quad(s) => s.p2,
            Self::Cubic(s) => s.p3,
            Self::Arc(s) => s.p1,
        }
    }

    /// Returns the segment in the opposite direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        match self {
            Self::Line(s) => Self::Line(Line::new(s.p1, s.p0)),
            Self::Quad(s) => Self::Quad(QuadBez::new(s.p2, s.p1, s.p0)),
            Self::Cubic(s) => Self::Cubic(CubicBez::new(s.p3, s.p2, s.p1, s.p0)),
            Self::Arc(s) => Self::Arc(s.reversed()),
        }
    }

    /// Returns the part of a line or Bézier curve between two parameters, which is equal to the segment for (0, 1); `None` for arcs.
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

    /// Returns the image under an affine map, exact for every kind.
    #[must_use]
    pub fn transformed(&self, m: Affine) -> Self {
        match self {
            Self::Line(s) => Self::Line(m * *s),
            Self::Quad(s) => Self::Quad(m * *s),
            Self::Cubic(s) => Self::Cubic(m * *s),
            Self::Arc(s) => Self::Arc(s.transformed(m)),
        }
    }

    /// Returns the bounding box.
    #[must_use]
    pub fn bounding_box(&self) -> Rect {
        match self {
            Self::Line(s) => s.bounding_box(),
            Self::Quad(s) => s.bounding_box(),
            Self::Cubic(s) => s.bounding_box(),
            Self::Arc(s) => s.bounding_box(),
        }
    }

    /// Extends a box that holds the ends to hold the segment. Extremes are computed only if control points lie outside.
    #[must_use]
    pub fn extend(&self, b: Rect) -> Rect {
        let holds = |p: Point| b.x0 <= p.x && p.x <= b.x1 && b.y0 <= p.y && p.y <= b.y1;
        let is_inside = match self {
            Self::Line(_) => true,
            Self::Quad(s) => holds(s.p1),
            Self::Cubic(s) => holds(s.p1) && holds(s.p2),
            Self::Arc(s) => {
                let half = s.half_size();
                holds(s.center - half) && holds(s.center + half)
            }
        };
        if is_inside { b } else { b.union(self.bounding_box()) }
    }

    /// Converts the segment to one cubic, exactly for lines, quadratics and cubics. An arc of sweep Δ becomes the cubic with its end
    /// tangents and handles of (4/3)·tan(Δ/4) times the conjugate radius (radial error 2.7e-4 of the radius for a quarter circle).
    #[must_use]
    pub fn to_cubic(&self) -> CubicBez {
        match self {
            Self::Line(s) => CubicBez::new(s.p0, s.p0.lerp(s.p1, 1.0 / 3.0), s.p0.lerp(s.p1, 2.0 / 3.0), s.p1),
            Self::Quad(s) => s.raise(),
            Self::Cubic(s) => *s,
            Self::Arc(s) => s.to_cubic(),
        }
    }

    /// Returns the largest magnitude of a control point's coordinates; for an arc, a bound by its center and conjugate semi-axes.
    #[must_use]
    pub fn extent(&self) -> f64 {
        let largest = |points: &[Point]| points.iter().fold(0.0, |max: f64, p| max.max(p.x.abs()).max(p.y.abs()));
        match self {
            Self::Line(s) => largest(&[s.p0, s.p1]),
            Self::Quad(s) => largest(&[s.p0, s.p1, s.p2]),
            Self::Cubic(s) => largest(&[s.p0, s.p1, s.p2, s.p3]),
            Self::Arc(arc) => largest(&[arc.center]) + arc.a.hypot() + arc.b.hypot(),
        }
    }

    /// Returns `true` if every coordinate is finite and below 1e100 in magnitude.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        const HUGE: f64 = 1e100;
        let is_small = |p: Point| (p.x.abs() < HUGE) & (p.y.abs() < HUGE);
        match self {
            Self::Line(s) => is_small(s.p0) & is_small(s.p1),
            Self::Quad(s) => is_small(s.p0) & is_small(s.p1) & is_small(s.p2),
            Self::Cubic(s) => is_small(s.p0) & is_small(s.p1) & is_small(s.p2) & is_small(s.p3),
            Self::Arc(s) => s.is_within(HUGE),
        }
    }
}

/// Flattens a path within `tolerance` and calls `line` with the ends of every line, in order. Open subpaths are closed by a line, as
/// SVG fills them. Some lines may have no length.
pub fn boundary(path: impl IntoIterator<Item = PathEl>, tolerance: f64, mut line: impl FnMut(Point, Point)) {
    let (mut start, mut at) = (Point::ORIGIN, Point::ORIGIN);
    kurbo::flatten(path, tolerance, |element| match element {
        PathEl::MoveTo(p) => {
            line(at, start);
            (start, at) = (p, p);
        }
        PathEl::LineTo(p) => {
            line(at, p);
            at = p;
        }
        PathEl::ClosePath => {
            line(at, start);
            at = start;
        }
        // `flatten` leaves no curves.
        PathEl::QuadTo(..) | PathEl::CurveTo(..) => {}
    });
    line(at, start);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines enclose the area of the closed path.
    #[test]
    fn subpaths_are_closed() {
        let path = BezPath::from_svg("M0,0 H10 V10 H0 M20,0 Q40,0 40,20 V0 Z").unwrap();
        let mut area = 0.0;
        boundary(path, 1e-3, |a, b| area += 0.5 * a.to_vec2().cross(b.to_vec2()));
        // A parabola leaves a third of the triangle of its control points, which runs the other way.
        assert!((area - (100.0 - 200.0 / 3.0)).abs() < 0.05, "{area}");
    }
}
