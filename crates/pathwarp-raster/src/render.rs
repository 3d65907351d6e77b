//! Renders a resolved SVG tree at a chosen size.

use crate::error::Error;
use crate::load;
use crate::pixmap::new_pixmap;
use pathwarp::budget::{Budget, Limits};
use std::panic::{AssertUnwindSafe, catch_unwind};
use tiny_skia::{Color, Pixmap, Transform};
use usvg::{Group, Node};

/// Excess over a whole number of pixels that does not add another row.
///
/// Sizes in physical units (`210mm`) carry rounding errors, and a row covered to a thousandth would only show a faint line.
const ROUNDING_SLACK: f64 = 1e-3;

/// The size of a picture. It always keeps the aspect ratio of the drawing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum Size {
    /// One pixel per CSS pixel of the drawing's `width` and `height`.
    #[default]
    Native,
    /// A width in pixels.
    Width(u32),
    /// A height in pixels.
    Height(u32),
    /// A factor on the native size.
    Scale(f32),
}

/// Options for rendering a drawing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RenderOptions {
    /// The size of the picture.
    pub size: Size,
    /// Colour behind the drawing; `None` for transparent.
    pub background: Option<Color>,
}

impl RenderOptions {
    /// Renders `tree` with these options and the default limits.
    ///
    /// # Errors
    /// Any [`Error`] of [`RenderOptions::render_within`].
    pub fn render(&self, tree: &usvg::Tree) -> Result<Pixmap, Error> {
        self.render_within(tree, &Limits::default())
    }

    /// Renders `tree` with these options.
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::BadScale`] and [`Error::TooLarge`] for impossible sizes; [`Error::TooMuch`] when drawing exceeds the
    /// limits; [`Error::TooFar`], [`Error::Octaves`] and [`Error::Renderer`] for drawings that the renderer cannot handle.
    pub fn render_within(&self, tree: &usvg::Tree, limits: &Limits) -> Result<Pixmap, Error> {
        self.render_counted(tree, &Budget::new(*limits))
    }

    /// Renders `tree` with these options, and charges the work to `budget`, which several drawings may share.
    ///
    /// # Errors
    /// Any [`Error`] of [`RenderOptions::render_within`].
    pub fn render_counted(&self, tree: &usvg::Tree, budget: &Budget) -> Result<Pixmap, Error> {
        let native = (f64::from(tree.size().width()), f64::from(tree.size().height()));
        let (width, height, scale) = self.size.resolve(native)?;
        let mut pixmap = new_pixmap(width, height, &budget.limits())?;
        if let Some(color) = self.background {
            pixmap.fill(color);
        }
        draw(tree, Transform::from_scale(scale, scale), &mut pixmap, budget)?;
        Ok(pixmap)
    }
}

/// Renders `tree` on a transparent background.
///
/// # Errors
/// Any [`Error`] of [`RenderOptions::render_within`].
pub fn render(tree: &usvg::Tree, size: Size) -> Result<Pixmap, Error> {
    RenderOptions { size, background: None }.render(tree)
}

impl Size {
    /// Width and height of the picture, and the scale from pixels of the drawing to pixels of the picture.
    fn resolve(self, (native_width, native_height): (f64, f64)) -> Result<(f64, f64, f32), Error> {
        let scale = match self {
            Self::Native => 1.0,
            Self::Width(0) | Self::Height(0) => {
                let (width, height) = if matches!(self, Self::Width(_)) { (0, 1) } else { (1, 0) };
                return Err(Error::Empty { width, height });
            }
            Self::Width(width) => f64::from(width) / native_width,
            Self::Height(height) => f64::from(height) / native_height,
            Self::Scale(scale) if scale.is_finite() && scale > 0.0 => f64::from(scale),
            Self::Scale(scale) => return Err(Error::BadScale(scale)),
        };
        let whole = |length: f64| (length * scale - ROUNDING_SLACK).ceil().max(1.0);
        let width = if let Self::Width(width) = self { f64::from(width) } else { whole(native_width) };
        let height = if let Self::Height(height) = self { f64::from(height) } else { whole(native_height) };
        #[expect(clippy::cast_possible_truncation, reason = "the precision of the renderer")]
        let scale = scale as f32;
        Ok((width, height, scale))
    }
}

/// Draws `tree` on a picture.
///
/// # Errors
/// [`Error::TooMuch`], [`Error::TooFar`], [`Error::Octaves`], or [`Error::Renderer`].
pub(crate) fn draw(
    tree: &usvg::Tree,
    transform: Transform,
    picture: &mut Pixmap,
    budget: &Budget,
) -> Result<(), Error> {
    #[expect(clippy::cast_precision_loss, reason = "an estimate")]
    let size = [picture.width() as f32, picture.height() as f32];
    load::charge_group(tree.root(), transform, size, budget)?;
    // After a failure, the caller drops the half-painted picture.
    let drawn = catch_unwind(AssertUnwindSafe(|| resvg::render(tree, transform, &mut picture.as_mut())));
    drawn.map_err(|_| Error::Renderer)
}

/// Draws a group with its filters, clip path, mask and opacity as a picture, and charges the work to `budget`. `transform` maps the
/// group, moved so that the corner of its layer is the origin, to pixels, as in `resvg::render_node`. Returns `None` if the group
/// shows nothing.
///
/// # Errors
/// Any [`Error`] of [`RenderOptions::render_within`].
pub fn render_group(
    group: &Group,
    transform: Transform,
    [width, height]: [f64; 2],
    budget: &Budget,
) -> Result<Option<Pixmap>, Error> {
    // The renderer moves the corner of the layer to the origin.
    let corner = group.abs_layer_bounding_box();
    let from_corner = transform.pre_translate(-corner.x(), -corner.y());
    #[expect(clippy::cast_possible_truncation, reason = "an estimate")]
    load::charge_group(group, from_corner, [width as f32, height as f32], budget)?;
    let mut pixmap = new_pixmap(width, height, &budget.limits())?;
    let node = Node::Group(Box::new(group.clone()));
    let drawn = catch_unwind(AssertUnwindSafe(|| resvg::render_node(&node, transform, &mut pixmap.as_mut())));
    Ok(drawn.map_err(|_| Error::Renderer)?.map(|()| pixmap))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(svg: &str) -> usvg::Tree {
        usvg::Tree::from_str(svg, &usvg::Options::default()).unwrap()
    }

    fn half_red() -> usvg::Tree {
        tree(
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="30" height="20"><path fill="#f00" d="M0 0h15v20H0z"/></svg>"##,
        )
    }

    fn size_of(size: Size) -> (u32, u32) {
        let pixmap = render(&half_red(), size).unwrap();
        (pixmap.width(), pixmap.height())
    }

    #[test]
    fn sizes_keep_the_aspect_ratio() {
        assert_eq!(size_of(Size::Native), (30, 20));
        assert_eq!(size_of(Size::Width(60)), (60, 40));
        assert_eq!(size_of(Size::Height(10)), (15, 10));
        assert_eq!(size_of(Size::Scale(1.5)), (45, 30));
        assert_eq!(size_of(Size::Width(1)), (1, 1));
        assert_eq!(size_of(Size::Width(31)), (31, 21));
    }

    #[test]
    fn a_tiny_excess_adds_no_row() {
        let a4 = tree(r#"<svg xmlns="http://www.w3.org/2000/svg" width="25.4mm" height="50.8mm"/>"#);
        let pixmap = render(&a4, Size::Native).unwrap();
        assert_eq!((pixmap.width(), pixmap.height()), (96, 192));
    }

    #[test]
    fn draws_the_shape() {
        let pixmap = render(&half_red(), Size::Scale(2.0)).unwrap();
        let at = |x, y| pixmap.pixel(x, y).unwrap();
        assert_eq!((at(29, 39).red(), at(29, 39).alpha()), (255, 255));
        assert_eq!(at(30, 0).alpha(), 0);
    }

    #[test]
    fn a_background_lies_behind() {
        let options = RenderOptions { size: Size::Native, background: Some(Color::WHITE) };
        let pixmap = options.render(&half_red()).unwrap();
        assert_eq!(pixmap.pixel(0, 0).map(|p| (p.red(), p.green())), Some((255, 0)));
        assert_eq!(pixmap.pixel(29, 0).map(|p| (p.green(), p.alpha())), Some((255, 255)));
    }

    #[test]
    fn impossible_sizes_are_errors() {
        let refused = |size| render(&half_red(), size).unwrap_err();
        assert_eq!(refused(Size::Width(0)), Error::Empty { width: 0, height: 1 });
        assert_eq!(refused(Size::Height(0)), Error::Empty { width: 1, height: 0 });
        assert_eq!(refused(Size::Scale(0.0)), Error::BadScale(0.0));
        assert_eq!(refused(Size::Scale(-1.0)), Error::BadScale(-1.0));
        assert!(matches!(refused(Size::Scale(f32::NAN)), Error::BadScale(_)));
        assert!(matches!(refused(Size::Scale(1e30)), Error::TooLarge { .. }));
        assert!(matches!(refused(Size::Width(u32::MAX)), Error::TooLarge { .. }));
        let message = refused(Size::Width(30_000)).to_string();
        assert!(message.contains("30000 x 20000"), "{message}");
    }
}
