//! Draws lines, arrows and anchors in one style.

use super::skia;
use kurbo::{BezPath, ParamCurve, ParamCurveDeriv, PathEl, PathSeg, Point, Shape, Vec2};
use tiny_skia::{Color, FillRule, LineCap, LineJoin, Paint, Path, Pixmap, Stroke, StrokeDash, Transform};

/// Width of the white border of a line, on each side, in nominal pixels.
const HALO: f32 = 1.5;
/// Half the side or the radius of an anchor, in nominal pixels.
const ANCHOR: f64 = 3.6;
/// The same for the first anchor of a path.
const FIRST_ANCHOR: f64 = 5.6;
/// Half the length of the arrow, in nominal pixels.
const ARROW: f64 = 6.5;

/// The look of an overlay; widths are in nominal pixels.
pub(super) struct OverlayStyle {
    pub(super) rgba: [u8; 4],
    pub(super) width: f32,
    pub(super) dash: Option<[f32; 2]>,
    pub(super) anchors: Option<AnchorMark>,
}

/// The shape of an anchor.
#[derive(Clone, Copy)]
pub(super) enum AnchorMark {
    Round,
    Square,
    Diamond,
}

/// The end points of segments. A closed subpath may repeat its first point at its end; it counts once.
pub(super) fn anchors(path: &BezPath) -> Vec<Point> {
    let mut found: Vec<Point> = Vec::new();
    let mut first = 0;
    for element in path.elements() {
        match element {
            PathEl::MoveTo(p) => {
                first = found.len();
                found.push(*p);
            }
            PathEl::LineTo(p) | PathEl::QuadTo(_, p) | PathEl::CurveTo(_, _, p) => found.push(*p),
            PathEl::ClosePath => {
                if let [start, .., last] = found.get(first..).unwrap_or_default()
                    && start.distance(*last) < 1e-3
                {
                    found.pop();
                }
            }
        }
    }
    found
}

/// Draws in one style on one picture.
pub(super) struct Brush<'a> {
    pub(super) style: &'a OverlayStyle,
    /// Pixels per nominal pixel.
    pub(super) unit: f32,
    pub(super) picture: &'a mut Pixmap,
}

impl Brush<'_> {
    fn color(&self) -> Color {
        let [r, g, b, a] = self.style.rgba;
        Color::from_rgba8(r, g, b, a)
    }

    /// Draws a path on a white border.
    pub(super) fn line(&mut self, path: &BezPath) {
        if self.style.width <= 0.0 {
            return;
        }
        let Some(path) = skia::path(path) else { return };
        let opacity = f32::from(self.style.rgba[3]) / 255.0;
        if let Some(white) = Color::from_rgba(1.0, 1.0, 1.0, 0.85 * opacity) {
            self.stroke(&path, white, self.style.width + 2.0 * HALO, None);
        }
        self.stroke(&path, self.color(), self.style.width, self.style.dash);
    }

    fn stroke(&mut self, path: &Path, color: Color, width: f32, dash: Option<[f32; 2]>) {
        let dash = dash.and_then(|dash| StrokeDash::new(dash.map(|d| d * self.unit).to_vec(), 0.0));
        let stroke = Stroke {
            width: width * self.unit,
            line_cap: LineCap::Butt,
            line_join: LineJoin::Round,
            dash,
            ..Stroke::default()
        };
        self.picture.stroke_path(path, &paint(color), &stroke, Transform::identity(), None);
    }

    fn fill(&mut self, path: &Path, color: Color) {
        self.picture.fill_path(path, &paint(color), FillRule::Winding, Transform::identity(), None);
    }

    /// Draws an arrow head in the middle of the first segment that is long enough.
    pub(super) fn arrow(&mut self, path: &BezPath) {
        let size = ARROW * f64::from(self.unit);
        let Some(segment) = path.segments().find(|s| s.start().distance(s.end()) > 4.0 * size) else { return };
        let (tip, tangent) = middle(segment);
        if tangent.hypot() == 0.0 {
            return;
        }
        let ahead = tangent.normalize() * size;
        let aside = ahead.turn_90() * 0.72;
        let mut head = BezPath::new();
        head.move_to(tip + ahead);
        head.line_to(tip - ahead + aside);
        head.line_to(tip - ahead * 0.55);
        head.line_to(tip - ahead - aside);
        head.close_path();
        if let Some(head) = skia::path(&head) {
            self.stroke(&head, Color::WHITE, 2.0 * HALO, None);
            self.fill(&head, self.color());
        }
    }

    /// Draws an anchor; the first one is larger and hollow.
    pub(super) fn anchor(&mut self, mark: AnchorMark, at: Point, first: bool) {
        let radius = if first { FIRST_ANCHOR } else { ANCHOR } * f64::from(self.unit);
        let outline = |radius: f64| skia::path(&mark.outline(at, radius));
        if let (Some(halo), Some(dot)) = (outline(radius + f64::from(HALO * self.unit)), outline(radius)) {
            self.fill(&halo, Color::WHITE);
            self.fill(&dot, self.color());
        }
        if first && let Some(hole) = outline(radius * 0.5) {
            self.fill(&hole, Color::WHITE);
        }
    }
}

impl AnchorMark {
    /// The outline around `at`; all marks of the same radius have about the same area.
    fn outline(self, at: Point, radius: f64) -> BezPath {
        let corners = |reach: [Vec2; 4]| {
            let mut path = BezPath::new();
            path.move_to(at + reach[0]);
            reach[1..].iter().for_each(|r| path.line_to(at + *r));
            path.close_path();
            path
        };
        let (side, diagonal) = (radius * 0.9, radius * 1.3);
        match self {
            Self::Round => kurbo::Circle::new(at, radius).to_path(0.01),
            Self::Square => corners([(-side, -side), (side, -side), (side, side), (-side, side)].map(Vec2::from)),
            Self::Diamond => {
                corners([(0.0, -diagonal), (diagonal, 0.0), (0.0, diagonal), (-diagonal, 0.0)].map(Vec2::from))
            }
        }
    }
}

/// The point and the tangent in the middle of a segment.
fn middle(segment: PathSeg) -> (Point, Vec2) {
    let tangent = match segment {
        PathSeg::Line(line) => line.p1 - line.p0,
        PathSeg::Quad(quad) => quad.deriv().eval(0.5).to_vec2(),
        PathSeg::Cubic(cubic) => cubic.deriv().eval(0.5).to_vec2(),
    };
    (segment.eval(0.5), tangent)
}

fn paint(color: Color) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(color);
    paint
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(d: &str) -> BezPath {
        BezPath::from_svg(d).unwrap()
    }

    #[test]
    fn a_closed_path_has_its_first_anchor_once() {
        assert_eq!(anchors(&path("M0 0L9 0L9 9L0 0Z")).len(), 3);
        assert_eq!(anchors(&path("M0 0L9 0L9 9Z")).len(), 3);
        assert_eq!(anchors(&path("M0 0L9 0L0 0")).len(), 3);
        assert_eq!(anchors(&path("M0 0L9 0Z M20 0L29 0L20 0Z")).len(), 4);
        assert_eq!(anchors(&path("M5 5Z")).len(), 1);
    }
}
