//! Allocates pictures within the size limit.

use crate::error::Error;
use pathwarp::budget::{Exceeded, Limit, Limits};
use tiny_skia::Pixmap;

/// Bytes held for each pixel of a picture that is made: itself, and the file that it becomes.
const BYTES: f64 = 8.0;

/// Creates a transparent picture, or fails if it would be empty or exceed the limits.
pub(crate) fn new_pixmap(width: f64, height: f64, limits: &Limits) -> Result<Pixmap, Error> {
    let too_large = |exceeded| Error::TooLarge { width, height, exceeded };
    limits.check(Limit::Memory, BYTES * width * height).map_err(too_large)?;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the limit; casts saturate")]
    let (whole_width, whole_height) = (width as u32, height as u32);
    if whole_width == 0 || whole_height == 0 {
        return Err(Error::Empty { width: whole_width, height: whole_height });
    }
    let refused = || Exceeded {
        limit: Limit::Memory,
        most: limits.of(Limit::Memory),
        needed: BYTES * width * height,
        cut: false,
    };
    Pixmap::new(whole_width, whole_height).ok_or_else(|| too_large(refused()))
}
