//! Interfaces that a program implements to make pictures for this library: of bent bitmaps, gradients and filters.

use super::traced::Opacity;
use pathwarp::kurbo::{Affine, BezPath, Point, Rect};
use pathwarp::map::Map;
use std::error::Error;
use std::fmt;
use std::sync::Arc;

/// A picture of a bent bitmap, gradient or filter.
#[derive(Debug, Clone, PartialEq)]
pub struct BentImage {
    /// Content of a PNG or JPEG file.
    pub file: Vec<u8>,
    /// The box that the picture fills, in the requested user space.
    pub area: Rect,
    /// A sentence about colours or a profile that the picture has lost.
    pub lost: Option<&'static str>,
}

impl BentImage {
    /// A picture that has lost nothing.
    #[must_use]
    pub fn new(file: Vec<u8>, area: Rect) -> Self {
        Self { file, area, lost: None }
    }

    pub(crate) fn media_type(&self) -> &'static str {
        if is_jpeg(&self.file) { "image/jpeg" } else { "image/png" }
    }
}

/// Returns `true` if a file starts with the markers of a JPEG.
pub(crate) fn is_jpeg(file: &[u8]) -> bool {
    file.starts_with(b"\xff\xd8\xff")
}

/// The reason why a bitmap or gradient cannot be bent.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct PictureError(Box<dyn Error + Send + Sync>);

impl PictureError {
    /// Wraps another error, or a message.
    pub fn new(error: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self(error.into())
    }
}

impl From<String> for PictureError {
    fn from(message: String) -> Self {
        Self::new(message)
    }
}

impl From<&str> for PictureError {
    fn from(message: &str) -> Self {
        Self::new(message)
    }
}

/// Bends bitmaps.
pub trait ImageWarper: Send + Sync {
    /// Bends a bitmap.
    ///
    /// # Errors
    /// [`PictureError`] with the reason why the bitmap cannot be bent. It then follows the best affine fit.
    fn warp(&self, request: &ImageRequest<'_>) -> Result<BentImage, PictureError>;
}

/// A bitmap to bend.
#[non_exhaustive]
pub struct ImageRequest<'a> {
    /// Content of the file: PNG, JPEG, GIF or WebP.
    pub data: &'a [u8],
    /// From pixels to root user space.
    pub placed: Affine,
    /// The visible pixels, if not all are visible. The drawing clips the result to them, so the others need not be bent.
    pub crop: Option<Rect>,
    /// `true` if the drawing clips the result to the outline of its visible pixels, so that it may have any colours beyond, as a JPEG must.
    pub clipped: bool,
    /// `true` if pixels are shown as squares, however large.
    pub pixelated: bool,
    /// The map of root user space.
    pub map: &'a dyn Map,
    /// From root user space to the user space of the result.
    pub after: Affine,
    /// Root user space to px, to choose a resolution.
    pub to_px: Affine,
}

impl fmt::Debug for ImageRequest<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ImageRequest").field("bytes", &self.data.len()).field("map", &self.map).finish_non_exhaustive()
    }
}

/// Treatment of bitmaps.
#[derive(Clone, Default)]
#[non_exhaustive]
pub enum Images {
    /// Place them by the best affine fit, with unchanged pixels.
    #[default]
    Keep,
    /// Bend them.
    Warp(Arc<dyn ImageWarper>),
}

impl fmt::Debug for Images {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if matches!(self, Self::Keep) { "Keep" } else { "Warp" })
    }
}

impl PartialEq for Images {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Keep, Self::Keep) => true,
            (Self::Warp(a), Self::Warp(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}

/// Paints bent gradients.
pub trait GradientPainter: Send + Sync {
    /// Paints a bent gradient over the whole target and a few pixels around it.
    ///
    /// # Errors
    /// [`PictureError`] with the reason why the gradient cannot be painted. It then follows the best affine fit.
    fn paint(&self, request: &GradientRequest<'_>) -> Result<BentImage, PictureError>;
}

/// The colours of a gradient at points of its shape's user space: red, green, blue and alpha, 0 to 1, not premultiplied.
pub type GradientColors<'a> = dyn Fn(&[Point], &mut [[f64; 4]]) + Sync + 'a;

/// A gradient on a bent shape.
#[non_exhaustive]
pub struct GradientRequest<'a> {
    /// The gradient.
    pub colors: &'a GradientColors<'a>,
    /// Bounding box of the shape in its user space.
    pub area: Rect,
    /// From the shape's user space to root user space.
    pub placed: Affine,
    /// The map of root user space.
    pub map: &'a dyn Map,
    /// From root user space to the user space of the result.
    pub after: Affine,
    /// Bounding box of the bent shape in the user space of the result.
    pub target: Rect,
    /// The bent shape in the user space of the result. Only the area that it covers is visible.
    pub shape: &'a BezPath,
    /// Root user space to px, to choose a resolution.
    pub to_px: Affine,
    /// Upper bound on the number of gradients in the drawing, which share a budget of pixels.
    pub among: usize,
    /// Exact colours at points spread over the shape, for choosing a resolution.
    pub seen: &'a [SeenColor],
    /// `true` if no difference may be visible; `false` if none may be noticeable.
    pub strict: bool,
    /// `true` if colours jump, so that only the highest resolution shows them well.
    pub sharp: bool,
}

impl fmt::Debug for GradientRequest<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("GradientRequest").field("area", &self.area).field("map", &self.map).finish_non_exhaustive()
    }
}

/// Makes pictures of bent filters.
pub trait FilterPainter: Send + Sync {
    /// Returns a picture of each layer under the map, `None` for empty layers; or `None` for all if the fit looks right.
    ///
    /// # Errors
    /// [`PictureError`] with the reason why the filter cannot be bent. It then follows the best affine fit.
    fn paint(&self, request: &FilterRequest<'_>) -> Result<Option<Vec<Option<BentImage>>>, PictureError>;
}

/// Makes an SVG drawing whose visible area is a box.
pub type FilterDrawing<'a> = dyn Fn(Rect) -> String + 'a;

/// A filter to bend, with its graphic.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct FilterRequest<'a> {
    /// SVG drawings of `area` that are to become pictures: the filter's drawing beneath and above the graphic, or the graphic with its
    /// filter.
    pub layers: &'a dyn Fn() -> Vec<Option<String>>,
    /// Drawings to compare: the graphic with its filter, and the result where the filter follows its fit. `None` if pictures are wanted in
    /// any case.
    pub compared: Option<[&'a FilterDrawing<'a>; 2]>,
    /// The box that the filter may paint, in its user space.
    pub area: Rect,
    /// The box that the graphic covers without the filter.
    pub graphic: Rect,
    /// From the filter's user space to root user space.
    pub placed: Affine,
    /// The map of root user space.
    pub map: &'a dyn Map,
    /// From root user space to the user space of the result.
    pub after: Affine,
    /// Root user space to px, to choose a resolution.
    pub to_px: Affine,
    /// The area of the page, in square units of the result.
    pub page: f64,
    /// Upper bound on the number of filters in the drawing, which share a budget of pixels.
    pub among: usize,
}

impl fmt::Debug for FilterRequest<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FilterRequest").field("area", &self.area).field("map", &self.map).finish_non_exhaustive()
    }
}

/// Reads the opacity of pictures, and continues colours beyond the edge of a drawing.
pub trait EdgePainter: Send + Sync {
    /// The opacity of a PNG, GIF or WebP; `None` if it cannot be read.
    fn opacity(&self, data: &[u8]) -> Option<Opacity>;

    /// Returns a PNG of an SVG drawing in which transparent pixels have the colour of the nearest others. `size` is the drawing's size in px.
    ///
    /// # Errors
    /// [`PictureError`] with the reason why the drawing cannot be rendered.
    fn continued(&self, drawing: &str, size: [f64; 2]) -> Result<Vec<u8>, PictureError>;
}

/// A colour of a bent gradient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenColor {
    /// Point in the user space of the result.
    pub at: Point,
    /// Red, green, blue and alpha, 0 to 1, premultiplied.
    pub color: [f64; 4],
}

/// Paints bent gradients and filters, and continues colours beyond edges.
#[derive(Clone)]
pub struct Painter(Arc<dyn PaintsAll>);

trait PaintsAll: GradientPainter + FilterPainter + EdgePainter {}
impl<P: GradientPainter + FilterPainter + EdgePainter> PaintsAll for P {}

impl Painter {
    /// Wraps an implementation of the three interfaces.
    pub fn new(painter: Arc<impl GradientPainter + FilterPainter + EdgePainter + 'static>) -> Self {
        Self(painter)
    }

    pub(crate) fn gradient(&self, request: &GradientRequest<'_>) -> Result<BentImage, PictureError> {
        GradientPainter::paint(&*self.0, request)
    }

    pub(crate) fn opacity(&self, data: &[u8]) -> Option<Opacity> {
        self.0.opacity(data)
    }

    pub(crate) fn continued(&self, drawing: &str, size: [f64; 2]) -> Result<Vec<u8>, PictureError> {
        self.0.continued(drawing, size)
    }

    pub(crate) fn filter(&self, request: &FilterRequest<'_>) -> Result<Option<Vec<Option<BentImage>>>, PictureError> {
        FilterPainter::paint(&*self.0, request)
    }
}

impl fmt::Debug for Painter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Painter")
    }
}

impl PartialEq for Painter {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
