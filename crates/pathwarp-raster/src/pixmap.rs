//! Allocates pictures within the size limit.

use crate::error::Error;
use crate::limit::MAX_PIXELS;
use tiny_skia::Pixmap;

/// Creates a transparent picture, or fails if it would be empty or exceed [`MAX_PIXELS`].
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
