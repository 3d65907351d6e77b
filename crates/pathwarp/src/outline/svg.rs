//! Builds outlines from drawing commands, SVG path data and kurbo's shapes. svgtypes parses the path data; its commands become absolute
//! here.

use super::{EllipticArc, Outline, Seg, Subpath};
use crate::error::Error;
use kurbo::{Affine, BezPath, Circle, CubicBez, Ellipse, Line, PathEl, Point, QuadBez, Rect, Shape, Vec2};
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;
use std::str::FromStr;
use svgtypes::{PathParser, PathSegment};

/// SVG path data that cannot be read. The message names the position of the error.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error(transparent)]
pub struct PathDataError(svgtypes::Error);

/// Converts to an [`Error::Input`] whose `place` is `path data`.
impl From<PathDataError> for Error {
    fn from(e: PathDataError) -> Self {
        Self::input("path data", e.to_string())
    }
}

impl Outline {
    /// Reads SVG path data (the `d` attribute), with arcs kept as arcs.
    ///
    /// # Errors
    /// [`PathDataError`] for malformed data. SVG renderers draw such paths up to the error; use [`Outline::from_svg_lossy`] for that.
    pub fn from_svg(data: &str) -> Result<Self, PathDataError> {
        parse(data).map_err(|(e, _)| e)
    }

    /// Reads SVG path data up to the first error, as SVG renderers do.
    #[must_use]
    pub fn from_svg_lossy(data: &str) -> Self {
        parse(data).unwrap_or_else(|(_, valid)| valid)
    }
}

/// Reads SVG path data, with arcs kept as arcs.
impl FromStr for Outline {
    type Err = PathDataError;

    fn from_str(data: &str) -> Result<Self, PathDataError> {
        Self::from_svg(data)
    }
}

/// Writes SVG path data with absolute commands. It reads back as the same outline to the last bit, except for the radii and angles of
/// arcs, which are rounded.
///
/// ```
/// use pathwarp::Outline;
///
/// let drop: Outline = "m50 0l30 50a30 30 0 0 1-60 0z".parse()?;
/// assert_eq!(drop.to_string(), "M50,0 L80,50 A30,30 0 0 1 20,50 Z");
/// # Ok::<(), pathwarp::outline::PathDataError>(())
/// ```
impl fmt::Display for Outline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, s) in self.subpaths.iter().enumerate() {
            write!(f, "{}M{}", if i > 0 { " " } else { "" }, Pair(s.start))?;
            // `Z` draws the closing line, unless that has no length.
            let drawn =
                s.segs.len() - usize::from(s.closed && matches!(s.segs.last(), Some(Seg::Line(l)) if l.p0 != l.p1));
            for seg in &s.segs[..drawn] {
                match seg {
                    Seg::Line(l) => write!(f, " L{}", Pair(l.p1))?,
                    Seg::Quad(q) => write!(f, " Q{} {}", Pair(q.p1), Pair(q.p2))?,
                    Seg::Cubic(c) => write!(f, " C{} {} {}", Pair(c.p1), Pair(c.p2), Pair(c.p3))?,
                    // One command cannot draw a whole turn, and near it, rounding of the ends moves the centre far.
                    Seg::Arc(a) if a.sweep.abs() > 1.5 * PI => {
                        write_arc(&a.subsegment(0.0, 0.5), f)?;
                        write_arc(&a.subsegment(0.5, 1.0), f)?;
                    }
                    Seg::Arc(a) => write_arc(a, f)?,
                }
            }
            f.write_str(if s.closed { " Z" } else { "" })?;
        }
        Ok(())
    }
}

/// A point as path data: two numbers with a comma.
struct Pair(Point);

impl fmt::Display for Pair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.0.x, self.0.y)
    }
}

/// Writes an arc as a command with the radii of its ellipse, of which `a.a` and `a.b` are conjugate semi-axes.
fn write_arc(a: &EllipticArc, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let (radii, turn) = Ellipse::from_affine(Affine::new([a.a.x, a.a.y, a.b.x, a.b.y, 0.0, 0.0])).radii_and_rotation();
    let turn = if radii.x == radii.y { 0.0 } else { turn.to_degrees() };
    let [large, sweep] = [a.sweep.abs() > PI, (a.sweep > 0.0) == (a.a.cross(a.b) > 0.0)].map(u8::from);
    write!(f, " A{} {turn} {large} {sweep} {}", Pair(radii.to_point()), Pair(a.p1))
}

/// Returns the path, or the error and the part of the path before it.
fn parse(data: &str) -> Result<Outline, (PathDataError, Outline)> {
    let mut b = Builder::default();
    // The handles that smooth commands reflect.
    let (mut cubic, mut quad): (Option<Point>, Option<Point>) = (None, None);
    for seg in PathParser::from(data) {
        let seg = match seg {
            Ok(seg) => seg,
            Err(e) => return Err((PathDataError(e), b.finish())),
        };
        let at = b.at();
        let point = |abs: bool, x: f64, y: f64| if abs { Point::new(x, y) } else { Point::new(at.x + x, at.y + y) };
        let (mut next_cubic, mut next_quad) = (None, None);
        match seg {
            PathSegment::MoveTo { abs, x, y } => b.move_to(point(abs, x, y)),
            PathSegment::LineTo { abs, x, y } => b.line_to(point(abs, x, y)),
            PathSegment::HorizontalLineTo { abs, x } => b.line_to(Point::new(point(abs, x, 0.0).x, at.y)),
            PathSegment::VerticalLineTo { abs, y } => b.line_to(Point::new(at.x, point(abs, 0.0, y).y)),
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                let (p2, p) = (point(abs, x2, y2), point(abs, x, y));
                b.curve_to(point(abs, x1, y1), p2, p);
                next_cubic = Some(p2);
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                let (p2, p) = (point(abs, x2, y2), point(abs, x, y));
                b.curve_to(cubic.map_or(at, |c| at + (at - c)), p2, p);
                next_cubic = Some(p2);
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => {
                let (p1, p) = (point(abs, x1, y1), point(abs, x, y));
                b.quad_to(p1, p);
                next_quad = Some(p1);
            }
            PathSegment::SmoothQuadratic { abs, x, y } => {
                let (p1, p) = (quad.map_or(at, |c| at + (at - c)), point(abs, x, y));
                b.quad_to(p1, p);
                next_quad = Some(p1);
            }
            PathSegment::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                b.arc_to(Vec2::new(rx, ry), x_axis_rotation, large_arc, sweep, point(abs, x, y));
            }
            PathSegment::ClosePath { .. } => b.close(),
        }
        (cubic, quad) = (next_cubic, next_quad);
    }
    Ok(b.finish())
}

/// Builds an [`Outline`] from drawing commands as in SVG: a drawing command after a close starts a new subpath at the start of the
/// closed one.
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

    /// Draws an SVG arc. A degenerate arc becomes a line or nothing, as specified by SVG.
    pub fn arc_to(&mut self, radii: Vec2, x_rotation_degrees: f64, large: bool, sweep: bool, p: Point) {
        match EllipticArc::from_svg(self.at, radii, x_rotation_degrees, large, sweep, p) {
            Some(arc) => self.push(Seg::Arc(arc)),
            None if p == self.at => {}
            None => self.line_to(p),
        }
    }

    /// Draws `arc`, which must start at the current point.
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

    /// Returns the current point.
    #[must_use]
    pub fn at(&self) -> Point {
        self.at
    }

    /// Returns the path.
    #[must_use]
    pub fn finish(mut self) -> Outline {
        self.done.extend(self.open.take());
        Outline { subpaths: self.done }
    }
}

impl From<BezPath> for Outline {
    fn from(path: BezPath) -> Self {
        Self::from(&path)
    }
}

impl From<Rect> for Outline {
    fn from(r: Rect) -> Self {
        Self::from_points(&[r.origin(), (r.x1, r.y0).into(), (r.x1, r.y1).into(), (r.x0, r.y1).into()], true)
    }
}

/// Draws the circle with arcs.
impl From<Circle> for Outline {
    fn from(c: Circle) -> Self {
        Self::from(Ellipse::new(c.center, (c.radius, c.radius), 0.0))
    }
}

/// Draws the ellipse with arcs.
impl From<Ellipse> for Outline {
    fn from(e: Ellipse) -> Self {
        let (radii, turn) = e.radii_and_rotation();
        let (a, b) = (Vec2::from_angle(turn) * radii.x, Vec2::from_angle(turn + FRAC_PI_2) * radii.y);
        // The ellipse has four arcs, as a circle in SVG.
        let quarter = |i: i32| EllipticArc::new(e.center(), a, b, f64::from(i) * FRAC_PI_2, FRAC_PI_2);
        let mut arcs = [0, 1, 2, 3].map(quarter);
        for i in 0..4 {
            arcs[i].p1 = arcs[(i + 1) % 4].p0;
        }
        let start = arcs[0].p0;
        Self { subpaths: vec![Subpath { start, segs: arcs.map(Seg::Arc).to_vec(), closed: true }] }
    }
}

impl Outline {
    /// Converts a shape of kurbo. Lines, rectangles, paths and circles are exact, others become curves within `tolerance` of them.
    ///
    /// ```
    /// use pathwarp::{Outline, kurbo::{Circle, RoundedRect}};
    ///
    /// let button = Outline::from_shape(&RoundedRect::new(0.0, 0.0, 90.0, 30.0, 8.0), 0.01);
    /// assert_eq!(button.bounding_box().map(|b| (b.width(), b.height())), Some((90.0, 30.0)));
    /// assert_eq!(Outline::from_shape(&Circle::new((0.0, 0.0), 3.0), 0.01), Circle::new((0.0, 0.0), 3.0).into());
    /// ```
    #[must_use]
    pub fn from_shape(shape: &impl Shape, tolerance: f64) -> Self {
        match (shape.as_circle(), shape.as_rect()) {
            (Some(circle), _) => circle.into(),
            (_, Some(rect)) => rect.into(),
            _ => shape.to_path(tolerance).into(),
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares paths with an independent reference, the simplifier of svgtypes, which makes commands absolute and converts arcs to curves.
    #[test]
    fn agrees_with_the_simplified_form() {
        let d =
            "m1 2 3 4h5v-6H7V8c1 1 2 2 3 0s2 2 3 0 1-1 2 0q1 1 2 0t3 0 2 1zl4 4M20,20C1,2 3,4 5,6S7,8 9,10Q1 1 2 2T5 5";
        let ours: Vec<Point> = parse(d).unwrap().segs().filter(|s| !is_closing(s)).map(Seg::end).collect();
        let mut theirs = Vec::new();
        for s in svgtypes::SimplifyingPathParser::from(d) {
            use svgtypes::SimplePathSegment as S;
            match s.unwrap() {
                S::LineTo { x, y } | S::CurveTo { x, y, .. } | S::Quadratic { x, y, .. } => {
                    theirs.push(Point::new(x, y));
                }
                S::MoveTo { .. } | S::ClosePath => {}
            }
        }
        assert_eq!(ours.len(), theirs.len());
        for (a, b) in ours.iter().zip(&theirs) {
            assert!(a.distance(*b) < 1e-12, "{a:?} {b:?}");
        }
    }

    /// Arcs of every kind, also mirrored and sheared, read back as the same curves; everything else is the same to the last bit.
    #[test]
    fn what_is_written_reads_back() {
        let rest = "M0.1,2 L3,4e-7 Q5,6 7,8 C1,2 3,4 5,6 Z M9,9 M1,1 L1,1 Z M0,0 L5,0 L5,5 Z";
        let outline: Outline = rest.parse().unwrap();
        assert_eq!(outline.to_string().parse(), Ok(outline));
        let arcs = "M80,50 A30,20 15 1 1 20,50 A30,30 0 0 1 80,51 A40,40 0 0 0 20,50 Z";
        let ring = Outline::from(Circle::new((3.0, 4.0), 5.0));
        for outline in [Outline::from_svg(arcs).unwrap(), ring] {
            for m in [[1.0, 0.0, 0.0, 1.0, 0.0, 0.0], [2.0, 0.3, -0.4, -1.0, 7.0, 1.0], [0.0, 1.0, 1.0, 0.0, 0.0, 0.0]]
            {
                let moved = outline.transformed(Affine::new(m));
                let back: Outline = moved.to_string().parse().unwrap();
                let length = |o: &Outline| {
                    o.to_bez_path(1e-7).segments().map(|s| kurbo::ParamCurveArclen::arclen(&s, 1e-7)).sum::<f64>()
                };
                assert!((length(&moved) - length(&back)).abs() < 1e-4, "{moved}");
                let (path, middles) = (back.to_bez_path(1e-7), moved.segs().map(|s| s.eval(0.3)));
                for p in middles {
                    let off = path.segments().map(|s| kurbo::ParamCurveNearest::nearest(&s, p, 1e-9).distance_sq);
                    assert!(off.fold(f64::INFINITY, f64::min) < 1e-12, "{moved}");
                }
            }
        }
    }

    fn is_closing(s: &Seg) -> bool {
        s.end() == Point::new(1.0, 2.0)
    }

    #[test]
    fn smooth_commands_mirror_the_last_handle_and_only_of_their_own_kind() {
        let o = parse("M0 0C0 1 1 1 1 0S2-1 2 0T4 0").unwrap();
        let segs: Vec<_> = o.segs().collect();
        assert!(matches!(segs[1], Seg::Cubic(c) if c.p1 == Point::new(1.0, -1.0)));
        assert!(matches!(segs[2], Seg::Quad(q) if q.p1 == Point::new(2.0, 0.0)));
    }

    #[test]
    fn errors_name_the_position_and_lossy_reading_keeps_the_valid_part() {
        let e = Outline::from_svg("M0 0 L10 10 L5 x").unwrap_err().to_string();
        assert!(e.contains("position 16"), "{e}");
        assert_eq!(Outline::from_svg_lossy("M0 0 L10 10 L5 x").segs().count(), 1);
    }

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
}
