//! What a preview draws on top of the artwork: cages, bases, targets, anchors and grids.
//!
//! Each kind has a colour of the Okabe-Ito palette, which people with any colour vision tell apart, and besides that a
//! line and a shape of anchor of its own. Every line lies on a wider white one, so that it is seen on any artwork. The
//! path's first anchor is larger and hollow and an arrow on the first segment points the way the path runs: with cages
//! and bases, both matter.

use super::to_f32;
use kurbo::{Affine, BezPath, ParamCurve, ParamCurveDeriv, PathEl, PathSeg, Point, Rect, Shape, Vec2};
use tiny_skia::{Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};

/// Points further out than this many pixels are not drawn; the rasterizer's numbers end there.
const FARTHEST: f64 = 1e6;

/// Sizes in nominal pixels: the white below a line, on each side; half the side or the radius of an anchor; of the
/// first anchor; half the length of the arrow.
const HALO: f32 = 1.5;
const ANCHOR: f64 = 3.6;
const FIRST_ANCHOR: f64 = 5.6;
const ARROW: f64 = 6.5;

/// What an overlay is, which decides how it looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OverlayKind {
    /// The shape a drawing is bent into: vermilion, square anchors.
    Cage,
    /// Where the drawing is taken hold of: blue, dashed, round anchors.
    Base,
    /// Where the base goes to: green, anchors standing on a corner.
    Target,
    /// Points only, the path's anchors: dark and round.
    Anchors,
    /// Guide lines without anchors: thin and grey.
    GridLines,
}

/// One path on top of a panel's artwork.
#[derive(Debug, Clone)]
pub struct Overlay {
    kind: OverlayKind,
    path: BezPath,
}

/// How a kind looks. Widths in nominal pixels.
struct Style {
    rgba: [u8; 4],
    width: f32,
    dash: Option<[f32; 2]>,
    anchors: Option<Mark>,
}

#[derive(Clone, Copy)]
enum Mark {
    Round,
    Square,
    Diamond,
}

impl OverlayKind {
    fn style(self) -> Style {
        let (rgba, width, dash, anchors) = match self {
            Self::Cage => ([0xd5, 0x5e, 0x00, 0xff], 2.2, None, Some(Mark::Square)),
            Self::Base => ([0x00, 0x72, 0xb2, 0xff], 2.2, Some([7.0, 4.5]), Some(Mark::Round)),
            Self::Target => ([0x00, 0x9e, 0x73, 0xff], 2.2, None, Some(Mark::Diamond)),
            Self::Anchors => ([0x2b, 0x2f, 0x36, 0xff], 0.0, None, Some(Mark::Round)),
            Self::GridLines => ([0x2b, 0x2f, 0x36, 0x80], 1.0, None, None),
        };
        Style { rgba, width, dash, anchors }
    }
}

impl Overlay {
    /// A path in root user units.
    pub fn new(kind: OverlayKind, path: BezPath) -> Self {
        Self { kind, path }
    }

    /// The box around the path, if it has any finite points.
    pub(super) fn bounds(&self) -> Option<Rect> {
        if self.path.elements().is_empty() || !self.path.is_finite() {
            return None;
        }
        // A lone `M` has no segments; its box is the point.
        let points = self.path.elements().iter().filter_map(PathEl::end_point);
        let anchors = points.map(|p| Rect::from_points(p, p)).reduce(|all, one| all.union(one))?;
        Some(if self.path.segments().next().is_some() { anchors.union(self.path.bounding_box()) } else { anchors })
    }

    /// Draws the overlay; `unit` is the number of pixels in a nominal pixel.
    pub(super) fn draw(&self, to_panel: Affine, unit: f32, picture: &mut Pixmap) {
        let path = to_panel * &self.path;
        let drawable = |p: Point| p.x.abs() < FARTHEST && p.y.abs() < FARTHEST;
        if !path.control_points().all(drawable) {
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

/// All control points, on the curve or off it.
trait ControlPoints {
    fn control_points(&self) -> impl Iterator<Item = Point>;
}

impl ControlPoints for BezPath {
    fn control_points(&self) -> impl Iterator<Item = Point> {
        self.elements().iter().flat_map(|element| match *element {
            PathEl::MoveTo(p) | PathEl::LineTo(p) => vec![p],
            PathEl::QuadTo(p, q) => vec![p, q],
            PathEl::CurveTo(p, q, r) => vec![p, q, r],
            PathEl::ClosePath => Vec::new(),
        })
    }
}

/// The points where segments meet, each once: a closed subpath may name its first point again at its end.
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
    style: &'a Style,
    unit: f32,
    picture: &'a mut Pixmap,
}

impl Brush<'_> {
    fn color(&self) -> Color {
        let [r, g, b, a] = self.style.rgba;
        Color::from_rgba8(r, g, b, a)
    }

    fn line(&mut self, path: &BezPath) {
        if self.style.width <= 0.0 {
            return;
        }
        let Some(path) = skia(path) else { return };
        let faint = f32::from(self.style.rgba[3]) / 255.0;
        if let Some(white) = Color::from_rgba(1.0, 1.0, 1.0, 0.85 * faint) {
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

    /// An arrow head in the middle of the first segment that is long enough to carry it.
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
        if let Some(head) = skia(&head) {
            self.stroke(&head, Color::WHITE, 2.0 * HALO, None);
            self.fill(&head, self.color());
        }
    }

    fn anchor(&mut self, mark: Mark, at: Point, first: bool) {
        let radius = if first { FIRST_ANCHOR } else { ANCHOR } * f64::from(self.unit);
        let outline = |radius: f64| skia(&mark.outline(at, radius));
        if let (Some(halo), Some(dot)) = (outline(radius + f64::from(HALO * self.unit)), outline(radius)) {
            self.fill(&halo, Color::WHITE);
            self.fill(&dot, self.color());
        }
        if first && let Some(hole) = outline(radius * 0.5) {
            self.fill(&hole, Color::WHITE);
        }
    }
}

impl Mark {
    /// The mark around `at`; the three have about the same area for the same radius.
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

/// The path as the rasterizer takes it; `None` when there is nothing to draw.
fn skia(path: &BezPath) -> Option<Path> {
    let mut builder = PathBuilder::new();
    let xy = |p: Point| (to_f32(p.x), to_f32(p.y));
    for element in path.elements() {
        match *element {
            PathEl::MoveTo(p) => {
                let (x, y) = xy(p);
                builder.move_to(x, y);
            }
            PathEl::LineTo(p) => {
                let (x, y) = xy(p);
                builder.line_to(x, y);
            }
            PathEl::QuadTo(p, q) => {
                let ((px, py), (qx, qy)) = (xy(p), xy(q));
                builder.quad_to(px, py, qx, qy);
            }
            PathEl::CurveTo(p, q, r) => {
                let ((px, py), (qx, qy), (rx, ry)) = (xy(p), xy(q), xy(r));
                builder.cubic_to(px, py, qx, qy, rx, ry);
            }
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
        Overlay::new(kind, path(d)).draw(Affine::IDENTITY, 1.0, &mut picture);
        picture
    }

    #[test]
    fn a_closed_path_names_its_first_anchor_once() {
        assert_eq!(anchors(&path("M0 0L9 0L9 9L0 0Z")).len(), 3);
        assert_eq!(anchors(&path("M0 0L9 0L9 9Z")).len(), 3);
        assert_eq!(anchors(&path("M0 0L9 0L0 0")).len(), 3);
        assert_eq!(anchors(&path("M0 0L9 0Z M20 0L29 0L20 0Z")).len(), 4);
        assert_eq!(anchors(&path("M5 5Z")).len(), 1);
    }

    #[test]
    fn bounds_hold_curves_and_lone_points() {
        let bounds = |d| Overlay::new(OverlayKind::Anchors, path(d)).bounds();
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
    fn out_of_reach_is_left_out() {
        for d in ["M0 0L1e30 0", "M0 0C1e9 0 5 5 9 9"] {
            assert!(drawn(OverlayKind::Cage, d).pixels().iter().all(|p| p.alpha() == 0), "{d}");
        }
    }
}
