//! Overlays on the artwork of a preview: cages, bases, targets, anchors and grids.
//!
//! Each kind has a colour from the Okabe-Ito palette, which is safe for any colour vision, and a distinct line and shape of
//! anchor. Every line has a white border, so that it is visible on any artwork. The first anchor of a path is larger and hollow,
//! and an arrow on the first segment shows the direction of the path: both matter for cages and bases.

use super::brush::{AnchorMark, Brush, OverlayStyle, anchors};
use kurbo::{Affine, BezPath, PathEl, Point, Rect, Shape};
use tiny_skia::Pixmap;

/// Largest coordinate that the rasterizer can handle, in pixels. Paths beyond it are not drawn.
const FARTHEST: f64 = 1e6;

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
        let drawable = |p: Point| p.x.abs() < FARTHEST && p.y.abs() < FARTHEST;
        if !control_points(&path).all(drawable) {
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

/// All control points, on the curve and off it.
fn control_points(path: &BezPath) -> impl Iterator<Item = Point> {
    path.elements().iter().flat_map(|element| match *element {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => vec![p],
        PathEl::QuadTo(p, q) => vec![p, q],
        PathEl::CurveTo(p, q, r) => vec![p, q, r],
        PathEl::ClosePath => Vec::new(),
    })
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
}
