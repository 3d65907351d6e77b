//! Drawing commands to an outline.

use super::{EllipticArc, Outline, Seg, Subpath};
use kurbo::{BezPath, Circle, CubicBez, Ellipse, Line, PathEl, Point, QuadBez, Rect, Shape, Vec2};
use std::f64::consts::FRAC_PI_2;

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

    /// The current point.
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

/// Arcs stay arcs.
impl From<Circle> for Outline {
    fn from(c: Circle) -> Self {
        Self::from(Ellipse::new(c.center, (c.radius, c.radius), 0.0))
    }
}

/// Arcs stay arcs.
impl From<Ellipse> for Outline {
    fn from(e: Ellipse) -> Self {
        let (radii, turn) = e.radii_and_rotation();
        let (a, b) = (Vec2::from_angle(turn) * radii.x, Vec2::from_angle(turn + FRAC_PI_2) * radii.y);
        // Quarters, as for a circle of SVG.
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
    /// A shape of kurbo. Lines, rectangles, paths and circles are taken as they are, others as curves within `tolerance` of them.
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
