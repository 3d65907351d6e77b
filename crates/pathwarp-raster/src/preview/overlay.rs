//! Overlays on the artwork of a preview: cages, bases, targets, anchors and grids.
//!
//! Each kind has a colour from the Okabe-Ito palette, which is safe for any colour vision, and a distinct line and shape of
//! anchor. Every line has a white border, so that it is visible on any artwork. The first anchor of a path is larger and hollow,
//! and an arrow on the first segment shows the direction of the path: both matter for cages and bases.

use kurbo::{Affine, BezPath, ParamCurve, ParamCurveDeriv, PathEl, PathSeg, Point, Rect, Shape, Vec2};
use tiny_skia::{Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};

/// Largest coordinate that the rasterizer can handle, in pixels. Paths that exceed it are not drawn.
const MAX_COORDINATE: f64 = 1e6;

/// The role of an overlay, which sets its look.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OverlayKind {
    /// The shape that a drawing is bent into: vermilion, square anchors.
    Cage,
    /// The reference points of the drawing: blue, dashed, round anchors.
    Base,
    /// The images of the reference points: green, diamond anchors.
    Target,
    /// The anchors of a path without its lines: dark and round.
    Anchors,
    /// Guide lines without anchors: thin and grey.
    GridLines,
}

/// A path on top of the artwork of a panel.
#[derive(Debug, Clone)]
pub struct PreviewOverlay {
    kind: OverlayKind,
    path: BezPath,
}

impl OverlayKind {
    fn style(self) -> OverlayStyle {
        let (rgba, width, dash, anchors) = match self {
            Self::Cage => ([0xd5, 0x5e, 0x00, 0xff], 2.2, None, Some(AnchorMark::Square)),
            Self::Base => ([0x00, 0x72, 0xb2, 0xff], 2.2, Some([7.0, 4.5]), Some(AnchorMark::Round)),
            Self::Target => ([0x00, 0x9e, 0x73, 0xff], 2.2, None, Some(AnchorMark::Diamond)),
            Self::Anchors => ([0x2b, 0x2f, 0x36, 0xff], 0.0, None, Some(AnchorMark::Round)),
            Self::GridLines => ([0x2b, 0x2f, 0x36, 0x80], 1.0, None, None),
        };
        OverlayStyle { rgba, width, dash, anchors }
    }
}

impl PreviewOverlay {
    /// Creates an overlay of a path in root user units.
    pub fn new(kind: OverlayKind, path: BezPath) -> Self {
        Self { kind, path }
    }

    /// Bounding box of the path; `None` if it is empty or not finite.
    pub(super) fn bounds(&self) -> Option<Rect> {
        if self.path.elements().is_empty() || !self.path.is_finite() {
            return None;
        }
        // A single `M` has no segments; its box is the point.
        let points = self.path.elements().iter().filter_map(PathEl::end_point);
        let anchors = points.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))?;
        Some(if self.path.segments().next().is_some() { anchors.union(self.path.bounding_box()) } else { anchors })
    }

    /// Draws the overlay; `unit` is the number of pixels per nominal pixel.
    pub(super) fn draw(&self, to_panel: Affine, unit: f32, picture: &mut Pixmap) {
        let path = to_panel * &self.path;
        let bounds = path.control_box();
        let is_near = [bounds.x0, bounds.y0, bounds.x1, bounds.y1].iter().all(|v| v.abs() < MAX_COORDINATE);
        if !path.is_finite() || !is_near {
            return;
        }
        let style = self.kind.style();
        let mut brush = Brush { style: &style, unit, picture };
        brush.line(&path);
        if let Some(mark) = style.anchors {
            if style.width > 0.0 {
                brush.arrow(&path);
            }
            for (i, anchor) in anchors(&path).into_iter().enumerate().rev() {
                brush.anchor(mark, anchor, i == 0);
            }
        }
    }
}

/// Width of the white border of a line, on each side, in nominal pixels.
const HALO: f32 = 1.5;
/// Half the side or the radius of an anchor, in nominal pixels.
const ANCHOR: f64 = 3.6;
/// Half the side or the radius of the first anchor of a path, in nominal pixels.
const FIRST_ANCHOR: f64 = 5.6;
/// Half the length of the arrow, in nominal pixels.
const ARROW: f64 = 6.5;

/// The look of an overlay; widths are in nominal pixels.
struct OverlayStyle {
    rgba: [u8; 4],
    /// Width of lines; 0 for none.
    width: f32,
    /// Lengths of a dash and of the gap after it.
    dash: Option<[f32; 2]>,
    anchors: Option<AnchorMark>,
}

/// The shape of an anchor.
#[derive(Clone, Copy)]
enum AnchorMark {
    Round,
    Square,
    Diamond,
}

/// Lists the end points of segments. If a closed subpath repeats its first point at its end, the point counts once.
fn anchors(path: &BezPath) -> Vec<Point> {
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
struct Brush<'a> {
    style: &'a OverlayStyle,
    /// Pixels per nominal pixel.
    unit: f32,
    picture: &'a mut Pixmap,
}

impl Brush<'_> {
    fn color(&self) -> Color {
        let [r, g, b, a] = self.style.rgba;
        Color::from_rgba8(r, g, b, a)
    }

    /// Draws a path on a white border.
    fn line(&mut self, path: &BezPath) {
        if self.style.width <= 0.0 {
            return;
        }
        let Some(path) = skia_path(path) else { return };
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
    fn arrow(&mut self, path: &BezPath) {
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
        if let Some(head) = skia_path(&head) {
            self.stroke(&head, Color::WHITE, 2.0 * HALO, None);
            self.fill(&head, self.color());
        }
    }

    /// Draws an anchor; the first one is larger and hollow.
    fn anchor(&mut self, mark: AnchorMark, center: Point, is_first: bool) {
        let radius = if is_first { FIRST_ANCHOR } else { ANCHOR } * f64::from(self.unit);
        let outline = |radius: f64| skia_path(&mark.outline(center, radius));
        if let (Some(halo), Some(dot)) = (outline(radius + f64::from(HALO * self.unit)), outline(radius)) {
            self.fill(&halo, Color::WHITE);
            self.fill(&dot, self.color());
        }
        if is_first && let Some(hole) = outline(radius * 0.5) {
            self.fill(&hole, Color::WHITE);
        }
    }
}

impl AnchorMark {
    /// The outline around a point. All marks of the same radius have about the same area.
    fn outline(self, center: Point, radius: f64) -> BezPath {
        let polygon = |corners: [(f64, f64); 4]| {
            let mut path = BezPath::new();
            path.move_to(center + Vec2::from(corners[0]));
            corners[1..].iter().for_each(|c| path.line_to(center + Vec2::from(*c)));
            path.close_path();
            path
        };
        let (side, diagonal) = (radius * 0.9, radius * 1.3);
        match self {
            Self::Round => kurbo::Circle::new(center, radius).to_path(0.01),
            Self::Square => polygon([(-side, -side), (side, -side), (side, side), (-side, side)]),
            Self::Diamond => polygon([(0.0, -diagonal), (diagonal, 0.0), (0.0, diagonal), (-diagonal, 0.0)]),
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

/// A paint of one colour, with smooth edges.
fn paint(color: Color) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(color);
    paint
}

/// Rounds to the precision of the renderer.
#[expect(clippy::cast_possible_truncation, reason = "pixels need no more")]
pub(super) fn to_f32(x: f64) -> f32 {
    x as f32
}

pub(super) fn transform(affine: Affine) -> Transform {
    let [sx, ky, kx, sy, tx, ty] = affine.as_coeffs().map(to_f32);
    Transform::from_row(sx, ky, kx, sy, tx, ty)
}

/// Converts a path; `None` if there is nothing to draw.
fn skia_path(path: &BezPath) -> Option<Path> {
    let mut builder = PathBuilder::new();
    let (x, y) = (|p: Point| to_f32(p.x), |p: Point| to_f32(p.y));
    for element in path.elements() {
        match *element {
            PathEl::MoveTo(p) => builder.move_to(x(p), y(p)),
            PathEl::LineTo(p) => builder.line_to(x(p), y(p)),
            PathEl::QuadTo(p, q) => builder.quad_to(x(p), y(p), x(q), y(q)),
            PathEl::CurveTo(p, q, r) => builder.cubic_to(x(p), y(p), x(q), y(q), x(r), y(r)),
            PathEl::ClosePath => builder.close(),
        }
    }
    builder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(d: &str) -> BezPath {
        BezPath::from_svg(d).unwrap()
    }

    fn drawn(kind: OverlayKind, d: &str) -> Pixmap {
        let mut picture = Pixmap::new(60, 60).unwrap();
        PreviewOverlay::new(kind, path(d)).draw(Affine::IDENTITY, 1.0, &mut picture);
        picture
    }

    #[test]
    fn bounds_include_curves_and_single_points() {
        let bounds = |d| PreviewOverlay::new(OverlayKind::Anchors, path(d)).bounds();
        assert_eq!(bounds("M3 4"), Some(Rect::new(3.0, 4.0, 3.0, 4.0)));
        assert_eq!(bounds("M0 0Q10 20 20 0"), Some(Rect::new(0.0, 0.0, 20.0, 10.0)));
        assert_eq!(bounds(""), None);
    }

    #[test]
    fn the_first_anchor_is_hollow_the_others_are_not() {
        for kind in [OverlayKind::Cage, OverlayKind::Base, OverlayKind::Target, OverlayKind::Anchors] {
            let picture = drawn(kind, "M10 10L50 10L50 50");
            let centre = |x, y| picture.pixel(x, y).map(|p| (p.red(), p.green(), p.blue())).unwrap();
            let [r, g, b, _] = kind.style().rgba;
            assert_eq!(centre(10, 10), (255, 255, 255), "{kind:?}");
            assert_eq!(centre(50, 10), (r, g, b), "{kind:?}");
            assert_eq!(centre(50, 50), (r, g, b), "{kind:?}");
        }
    }

    #[test]
    fn grid_lines_are_faint_and_have_no_anchors() {
        let picture = drawn(OverlayKind::GridLines, "M10 30H50");
        let touched = picture.pixels().iter().filter(|p| p.alpha() > 0).count();
        assert!((40..=40 * 5).contains(&touched), "{touched}");
        assert!(picture.pixels().iter().all(|p| p.alpha() < 255));
    }

    #[test]
    fn paths_out_of_range_are_not_drawn() {
        for d in ["M0 0L1e30 0", "M0 0C1e9 0 5 5 9 9"] {
            assert!(drawn(OverlayKind::Cage, d).pixels().iter().all(|p| p.alpha() == 0), "{d}");
        }
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
