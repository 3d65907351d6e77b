//! Bent gradients as the library's users see them. A [`GradientPainter`] does the work on pixels.

use super::picture::{BentImage, PictureError};
use pathwarp::kurbo::{Affine, BezPath, Point, Rect};
use pathwarp::map::Map;
use std::fmt;

/// Paints bent gradients.
pub trait GradientPainter: Send + Sync {
    /// Paints a bent gradient over the whole target and a few pixels around it.
    ///
    /// # Errors
    /// Returns the reason why the gradient cannot be painted. It then follows the best affine fit.
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
    /// The bent shape in the user space of the result. Only what it covers is seen.
    pub shape: &'a BezPath,
    /// Root user space to px, to choose a resolution.
    pub to_px: Affine,
    /// Upper bound on the number of gradients in the drawing, which share a budget of pixels.
    pub among: usize,
    /// Exact colours at places spread over the shape, to judge a resolution by.
    pub seen: &'a [SeenColor],
    /// No difference may be visible; otherwise, none may be noticed.
    pub strict: bool,
    /// Colours jump, so that only the highest resolution shows them right.
    pub sharp: bool,
}

impl fmt::Debug for GradientRequest<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("GradientRequest").field("area", &self.area).field("map", &self.map).finish_non_exhaustive()
    }
}

/// A colour of a bent gradient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenColor {
    /// Place in the user space of the result.
    pub at: Point,
    /// Red, green, blue and alpha, 0 to 1, premultiplied.
    pub color: [f64; 4],
}
