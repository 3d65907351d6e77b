//! Draws a resolved tree, within limits and without panics.

use crate::error::Error;
use crate::load;
use pathwarp::budget::Limits;
use std::panic::{AssertUnwindSafe, catch_unwind};
use tiny_skia::{Pixmap, Transform};

/// Draws `tree` on a picture.
///
/// # Errors
/// It takes more than the limits allow, or the renderer fails.
pub(crate) fn draw(
    tree: &usvg::Tree,
    transform: Transform,
    picture: &mut Pixmap,
    limits: &Limits,
) -> Result<(), Error> {
    #[expect(clippy::cast_precision_loss, reason = "an estimate")]
    let size = [picture.width() as f32, picture.height() as f32];
    load::check(tree, transform, size, limits)?;
    // A failure leaves the picture half painted; it is then dropped.
    let drawn = catch_unwind(AssertUnwindSafe(|| resvg::render(tree, transform, &mut picture.as_mut())));
    drawn.map_err(|_| Error::Renderer)
}
