//! Bent bitmaps as the library's users see them. An [`ImageWarper`] does the work on pixels.

use super::picture::{BentImage, PictureError};
use pathwarp::kurbo::{Affine, Rect};
use pathwarp::map::Map;
use std::fmt;
use std::sync::Arc;

/// Bends bitmaps.
pub trait ImageWarper: Send + Sync {
    /// Bends a bitmap.
    ///
    /// # Errors
    /// Returns the reason why the bitmap cannot be bent. It then follows the best affine fit.
    fn warp(&self, request: &ImageRequest<'_>) -> Result<BentImage, PictureError>;
}

/// A bitmap to bend.
#[non_exhaustive]
pub struct ImageRequest<'a> {
    /// Content of the file: PNG, JPEG, GIF or WebP.
    pub data: &'a [u8],
    /// From pixels to root user space.
    pub placed: Affine,
    /// The pixels that are shown, if not all. The drawing cuts the result there; what lies beyond need not be bent.
    pub crop: Option<Rect>,
    /// Pixels are shown as squares, however large.
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
