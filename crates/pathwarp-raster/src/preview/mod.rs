//! Draws a drawing and its warped result side by side.
//!
//! Both panels show the same part of the plane at the same scale, so that a shape that did not move has the same position in
//! both. That part is the bounding box of both pages and all overlays. Where the two lie so far apart that they would be small in it,
//! each panel shows a different part. Artwork outside its page is shown on the grey around it.

mod overlay;

use crate::error::Error;
use crate::pixmap::new_pixmap;
use crate::render::draw;
use kurbo::{Affine, Rect};
use pathwarp::budget::{Budget, Limits};
use tiny_skia::{Color, FillRule, Paint, PathBuilder, Pixmap, PixmapPaint, Transform};

pub use overlay::{OverlayKind, PreviewOverlay};

/// Default length of the longer side of a panel, in pixels.
const DEFAULT_PANEL: u32 = 600;

/// The panel size at which a nominal pixel is a pixel; overlays scale with the panel.
const NOMINAL_PANEL: f32 = 600.0;

/// Minimum width and height of a panel, in nominal pixels, so that a flat drawing is still visible.
const MIN_SIDE: f64 = 48.0;

/// Space around the view within its panel, in nominal pixels.
const MARGIN: f64 = 20.0;
/// Space between the panels, in nominal pixels.
const GAP: f64 = 4.0;

/// Panels show different parts of the plane where a common one would be more than this many times as long as the longer of the two.
const MAX_COMMON: f64 = 1.5;

/// A drawing with its overlays.
#[derive(Debug, Clone)]
pub struct Panel<'a> {
    tree: &'a usvg::Tree,
    user_to_px: Affine,
    page: Rect,
    overlays: Vec<PreviewOverlay>,
    artwork: Option<Rect>,
}

impl<'a> Panel<'a> {
    /// Creates a panel that shows `tree`.
    ///
    /// The tree is in pixels of the outermost viewport; page and overlays are in root user units, the units of the `viewBox`.
    /// `user_to_px` maps the latter to the former. `page` is the page of the drawing: its `viewBox`, or the box of its `width`
    /// and `height`.
    pub fn new(tree: &'a usvg::Tree, user_to_px: Affine, page: Rect) -> Self {
        Self { tree, user_to_px, page, overlays: Vec::new(), artwork: None }
    }

    /// Adds an overlay on top of the artwork and of earlier overlays.
    #[must_use]
    pub fn with(mut self, overlay: PreviewOverlay) -> Self {
        self.overlays.push(overlay);
        self
    }

    /// Shows this area, in root user units, on the page or beyond it.
    #[must_use]
    pub fn showing(mut self, artwork: Rect) -> Self {
        self.artwork = Some(self.artwork.map_or(artwork, |a| a.union(artwork)));
        self
    }

    /// Bounding box of the page, all overlays and further areas shown, in root user units.
    fn bounds(&self) -> Rect {
        let overlays = self.overlays.iter().filter_map(PreviewOverlay::bounds);
        overlays.chain(self.artwork).fold(self.page.abs(), |a, b| a.union(b))
    }
}

/// Two panels side by side: the drawing before and after.
///
/// ```
/// use kurbo::{Affine, BezPath, Rect};
/// use pathwarp_raster::{PreviewOverlay, OverlayKind, Panel, Preview};
///
/// let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20"><path d="M5 5h30v10H5z"/></svg>"#;
/// let tree = usvg::Tree::from_str(svg, &usvg::Options::default())?;
/// let page = Rect::new(0.0, 0.0, 40.0, 20.0);
/// let base = BezPath::from_svg("M5 15H35")?;
///
/// let before = Panel::new(&tree, Affine::IDENTITY, page).with(PreviewOverlay::new(OverlayKind::Base, base));
/// let after = Panel::new(&tree, Affine::IDENTITY, page);
/// let picture = Preview::new(before, after).panel_size(300).render()?;
/// assert!(picture.width() > picture.height());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Preview<'a> {
    before: Panel<'a>,
    after: Panel<'a>,
    panel_size: u32,
}

impl<'a> Preview<'a> {
    /// Puts `before` on the left and `after` on the right.
    pub fn new(before: Panel<'a>, after: Panel<'a>) -> Self {
        Self { before, after, panel_size: DEFAULT_PANEL }
    }

    /// Sets the longer side of each panel in pixels; the default is 600.
    #[must_use]
    pub fn panel_size(mut self, pixels: u32) -> Self {
        self.panel_size = pixels;
        self
    }

    /// Draws the preview.
    ///
    /// # Errors
    /// [`Error::NoView`] when there is nothing to show; [`Error::Empty`] and [`Error::TooLarge`] for impossible sizes.
    pub fn render(&self) -> Result<Pixmap, Error> {
        self.render_within(&Limits::default())
    }

    /// Draws the preview, within limits.
    ///
    /// # Errors
    /// [`Error::TooMuch`] when drawing takes more than the limits allow, and any [`Error`] of [`Preview::render`].
    pub fn render_within(&self, limits: &Limits) -> Result<Pixmap, Error> {
        let views = self.views();
        let layout = PanelLayout::new(views[0], self.panel_size)?;
        let budget = Budget::new(*limits);
        let mut picture = new_pixmap(2.0 * layout.width + layout.gap, layout.height, limits)?;
        picture.fill(Color::from_rgba8(0xc4, 0xc8, 0xcf, 0xff));
        let second = layout.width + layout.gap;
        for (panel, view, left) in [(&self.before, views[0], 0.0), (&self.after, views[1], second)] {
            let drawn = PanelLayout::new(view, self.panel_size)?.draw(panel, &budget)?;
            #[expect(clippy::cast_possible_truncation, reason = "within the picture")]
            let left = left as i32;
            picture.draw_pixmap(left, 0, drawn.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
        }
        Ok(picture)
    }

    /// The parts of the plane that the panels show, of the same size.
    fn views(&self) -> [Rect; 2] {
        let bounds = [self.before.bounds(), self.after.bounds()];
        let both = bounds[0].union(bounds[1]);
        let size = bounds[0].size().max(bounds[1].size());
        if both.width() <= MAX_COMMON * size.width && both.height() <= MAX_COMMON * size.height {
            return [both; 2];
        }
        bounds.map(|b| Rect::from_center_size(b.center(), size))
    }
}

/// The layout of a panel. Sizes are whole numbers of pixels.
struct PanelLayout {
    width: f64,
    height: f64,
    gap: f64,
    /// Maps root user units to pixels of the panel.
    to_panel: Affine,
    /// Pixels per nominal pixel.
    unit: f32,
}

impl PanelLayout {
    fn new(view: Rect, panel_size: u32) -> Result<Self, Error> {
        if !view.is_finite() {
            return Err(Error::NoView("the page or an overlay is not finite"));
        }
        let longer = view.width().max(view.height());
        if longer <= 0.0 {
            return Err(Error::NoView("the page and the overlays have no extent"));
        }
        if panel_size == 0 {
            return Err(Error::Empty { width: 0, height: 0 });
        }
        #[expect(clippy::cast_precision_loss, reason = "panels are far smaller")]
        let unit = panel_size as f32 / NOMINAL_PANEL;
        let nominal = f64::from(unit);
        let margin = MARGIN * nominal;
        let scale = (f64::from(panel_size) - 2.0 * margin) / longer;
        let side = |length: f64| (length * scale + 2.0 * margin).max(MIN_SIDE * nominal).round().max(1.0);
        let (width, height) = (side(view.width()), side(view.height()));
        let centre = kurbo::Vec2::new(width / 2.0, height / 2.0);
        let to_panel = Affine::translate(centre) * Affine::scale(scale) * Affine::translate(-view.center().to_vec2());
        Ok(Self { width, height, gap: (GAP * nominal).round().max(1.0), to_panel, unit })
    }

    fn draw(&self, panel: &Panel<'_>, budget: &Budget) -> Result<Pixmap, Error> {
        let determinant = panel.user_to_px.determinant();
        if !determinant.is_finite() || determinant == 0.0 {
            return Err(Error::NoView("the map from user units to pixels is singular"));
        }
        let mut picture = new_pixmap(self.width, self.height, &budget.limits())?;
        picture.fill(Color::from_rgba8(0xec, 0xee, 0xf1, 0xff));
        self.draw_page(panel.page, &mut picture);
        let tree_to_panel = overlay::transform(self.to_panel * panel.user_to_px.inverse());
        draw(panel.tree, tree_to_panel, &mut picture, budget)?;
        for overlay in &panel.overlays {
            overlay.draw(self.to_panel, self.unit, &mut picture);
        }
        Ok(picture)
    }

    /// Draws the white page with a soft shadow to the lower right.
    fn draw_page(&self, page: Rect, picture: &mut Pixmap) {
        let sheet = self.to_panel.transform_rect_bbox(page);
        for (offset, color) in
            [(2.5, Color::from_rgba8(0, 0, 0, 14)), (1.2, Color::from_rgba8(0, 0, 0, 26)), (0.0, Color::WHITE)]
        {
            let shifted = sheet + kurbo::Vec2::new(offset, offset) * f64::from(self.unit);
            let [left, top, right, bottom] = [shifted.x0, shifted.y0, shifted.x1, shifted.y1].map(overlay::to_f32);
            if let Some(rect) = tiny_skia::Rect::from_ltrb(left, top, right, bottom) {
                let mut paint = Paint::default();
                paint.set_color(color);
                let path = PathBuilder::from_rect(rect);
                picture.fill_path(&path, &paint, FillRule::Winding, Transform::identity(), None);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::BezPath;

    const PAGE: Rect = Rect::new(0.0, 0.0, 100.0, 50.0);

    fn tree() -> usvg::Tree {
        let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100" viewBox="0 0 100 50">
            <path fill="#00f" d="M0 0h50v50H0z"/></svg>"##;
        usvg::Tree::from_str(svg, &usvg::Options::default()).unwrap()
    }

    fn rgb(picture: &Pixmap, x: u32, y: u32) -> [u8; 3] {
        picture.pixel(x, y).map(|p| [p.red(), p.green(), p.blue()]).unwrap()
    }

    #[test]
    fn panels_share_scale_and_position() {
        let tree = tree();
        let panel = || Panel::new(&tree, Affine::scale(2.0), PAGE);
        let picture = Preview::new(panel(), panel()).render().unwrap();
        assert_eq!((picture.width(), picture.height()), (600 + 4 + 600, 320));
        for left in [0, 604] {
            assert_eq!(rgb(&picture, left + 150, 160), [0, 0, 255], "artwork");
            assert_eq!(rgb(&picture, left + 450, 160), [255, 255, 255], "page");
            assert_eq!(rgb(&picture, left + 5, 5), [0xec, 0xee, 0xf1], "around the page");
        }
    }

    #[test]
    fn an_overlay_widens_both_panels_and_is_drawn_in_one() {
        let tree = tree();
        let panel = || Panel::new(&tree, Affine::scale(2.0), PAGE);
        let cage = BezPath::from_svg("M0 0H200V50H0Z").unwrap();
        let before = panel().with(PreviewOverlay::new(OverlayKind::Cage, cage));
        let picture = Preview::new(before, panel()).render().unwrap();
        assert_eq!((picture.width(), picture.height()), (1204, 180));
        // The cage's right side is 20 px from the left panel's edge.
        let edge = rgb(&picture, 580, 60);
        assert!(edge[0] > edge[2] + 100, "{edge:?}");
        assert_eq!(rgb(&picture, 604 + 580, 60), [0xec, 0xee, 0xf1]);
    }

    #[test]
    fn a_result_far_away_is_shown_at_the_same_scale() {
        let tree = tree();
        let panel = |x: f64, y: f64| {
            let to_px = Affine::scale(2.0) * Affine::translate((-x, -y));
            Panel::new(&tree, to_px, PAGE + kurbo::Vec2::new(x, y))
        };
        let stayed = Preview::new(panel(0.0, 0.0), panel(0.0, 0.0)).render().unwrap();
        for (x, y) in [(1000.0, 0.0), (0.0, -90.0), (-80.0, 3000.0)] {
            let moved = Preview::new(panel(0.0, 0.0), panel(x, y)).render().unwrap();
            assert!(moved.data() == stayed.data(), "{x} {y}");
        }
        // A result that is near stays in one view with the drawing.
        let near = Preview::new(panel(0.0, 0.0), panel(40.0, 0.0)).render().unwrap();
        assert_eq!(rgb(&near, 604 + 20 + 80, near.height() / 2), [0xec, 0xee, 0xf1]);
        // Both have room for the larger one.
        let large = panel(1000.0, 0.0).showing(Rect::new(900.0, 0.0, 1100.0, 50.0));
        let picture = Preview::new(panel(0.0, 0.0), large).render().unwrap();
        assert_eq!((picture.width(), picture.height()), (1204, 180));
        assert_eq!(rgb(&picture, 300 - 70, 90), [0, 0, 255]);
    }

    #[test]
    fn panels_scale_with_everything_on_them() {
        let tree = tree();
        let panel = || Panel::new(&tree, Affine::scale(2.0), PAGE);
        let picture = Preview::new(panel(), panel()).panel_size(1200).render().unwrap();
        assert_eq!((picture.width(), picture.height()), (1200 + 8 + 1200, 640));
    }

    #[test]
    fn empty_and_infinite_views_are_errors() {
        let tree = tree();
        let page = |rect| Panel::new(&tree, Affine::IDENTITY, rect);
        let no_view = |preview: Preview<'_>| matches!(preview.render(), Err(Error::NoView(_)));
        assert!(no_view(Preview::new(page(Rect::ZERO), page(Rect::ZERO))));
        let endless = Rect::new(0.0, 0.0, f64::INFINITY, 1.0);
        assert!(no_view(Preview::new(page(endless), page(PAGE))));
        let flat = Panel::new(&tree, Affine::scale(0.0), PAGE);
        assert!(no_view(Preview::new(flat, page(PAGE))));
        let huge = Preview::new(page(PAGE), page(PAGE)).panel_size(u32::MAX).render();
        assert!(matches!(huge, Err(Error::TooLarge { .. })));
        assert!(Preview::new(page(PAGE), page(PAGE)).panel_size(0).render().is_err());
        assert!(Preview::new(page(PAGE), page(PAGE)).panel_size(1).render().is_ok());
    }
}
