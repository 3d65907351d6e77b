//! SVG path data to an outline: svgtypes reads the commands, and this module makes them absolute.

use super::{Builder, Outline};
use crate::error::Error;
use kurbo::{Point, Vec2};
use svgtypes::{PathParser, PathSegment};

/// SVG path data that cannot be read. The message names the position of the error.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error(transparent)]
pub struct PathDataError(svgtypes::Error);

/// Path data without a name, as in a program: [`Error::Input`] with `path data` for its place.
impl From<PathDataError> for Error {
    fn from(e: PathDataError) -> Self {
        Self::input("path data", e.to_string())
    }
}

impl Outline {
    /// Reads SVG path data (the `d` attribute), with arcs kept as arcs.
    ///
    /// # Errors
    /// The data is malformed. SVG renderers draw such paths up to the error; use [`Outline::from_svg_lossy`] for that.
    pub fn from_svg(data: &str) -> Result<Self, PathDataError> {
        parse(data).map_err(|(e, _)| e)
    }

    /// Reads SVG path data up to the first error, as SVG renderers do.
    #[must_use]
    pub fn from_svg_lossy(data: &str) -> Self {
        parse(data).unwrap_or_else(|(_, sound)| sound)
    }
}

/// The path, or the error and the part before it.
fn parse(data: &str) -> Result<Outline, (PathDataError, Outline)> {
    let mut b = Builder::default();
    // The handles that smooth commands reflect.
    let mut cubic: Option<Point> = None;
    let mut quad: Option<Point> = None;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Seg;

    /// An independent reference: the simplifier of svgtypes, which makes everything absolute and converts arcs to curves.
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
}
