//! A resolved SVG tree to pixels, at a chosen size and within a fixed budget.

use crate::Error;
use tiny_skia::{Color, Pixmap, Transform};

/// The largest picture this crate makes or reads, in pixels: 2^28, one gibibyte of memory.
///
/// Larger pictures are almost always a unit mistaken; they would fail much later, by running out of memory.
pub const MAX_PIXELS: u32 = 1 << 28;

/// A drawing's size may miss a whole number by this much (in pixels) before another row of pixels is begun for it.
///
/// Sizes that come from physical units (`210mm`) carry rounding errors; a row that is covered by a thousandth shows
/// nothing but a faint line.
const ROUNDING_SLACK: f64 = 1e-3;

/// How large a picture becomes. The aspect ratio is always the drawing's own.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Size {
    /// One pixel per CSS pixel of the drawing's `width` and `height`.
    #[default]
    Native,
    /// This many pixels wide.
    Width(u32),
    /// This many pixels high.
    Height(u32),
    /// The native size times a factor.
    Scale(f32),
}

/// How a drawing is rendered.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RenderOptions {
    /// The size of the picture.
    pub size: Size,
    /// What lies behind the drawing; transparent when `None`.
    pub background: Option<Color>,
}

impl RenderOptions {
    /// Renders `tree` with these options.
    pub fn render(&self, tree: &usvg::Tree) -> Result<Pixmap, Error> {
        let native = (f64::from(tree.size().width()), f64::from(tree.size().height()));
        let (width, height, scale) = self.size.resolve(native)?;
        let mut pixmap = new_pixmap(width, height)?;
        if let Some(color) = self.background {
            pixmap.fill(color);
        }
        resvg::render(tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
        Ok(pixmap)
    }
}

/// Renders `tree` on a transparent background.
pub fn render(tree: &usvg::Tree, size: Size) -> Result<Pixmap, Error> {
    RenderOptions { size, background: None }.render(tree)
}

impl Size {
    /// The picture's width and height, and the scale from the drawing's pixels to the picture's.
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
        #[expect(clippy::cast_possible_truncation, reason = "the renderer's own precision")]
        let scale = scale as f32;
        Ok((width, height, scale))
    }
}

/// A transparent picture, refused when it would be empty or larger than [`MAX_PIXELS`].
pub(crate) fn new_pixmap(width: f64, height: f64) -> Result<Pixmap, Error> {
    if !(width.is_finite() && height.is_finite()) || width * height > f64::from(MAX_PIXELS) {
        return Err(Error::TooLarge { width, height });
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most MAX_PIXELS; casts saturate")]
    let (whole_width, whole_height) = (width as u32, height as u32);
    if whole_width == 0 || whole_height == 0 {
        return Err(Error::Empty { width: whole_width, height: whole_height });
    }
    Pixmap::new(whole_width, whole_height).ok_or(Error::TooLarge { width, height })
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
    fn a_hair_over_a_whole_size_is_no_new_row() {
        let a4 = tree(r#"<svg xmlns="http://www.w3.org/2000/svg" width="25.4mm" height="50.8mm"/>"#);
        let pixmap = render(&a4, Size::Native).unwrap();
        assert_eq!((pixmap.width(), pixmap.height()), (96, 192));
    }

    #[test]
    fn draws_what_is_there() {
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
    fn impossible_sizes_are_refused() {
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
