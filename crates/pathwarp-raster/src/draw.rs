//! Draws a resolved tree, within limits and without panics.

use crate::error::Error;
use crate::load;
use crate::pixmap::new_pixmap;
use pathwarp::budget::Budget;
use std::panic::{AssertUnwindSafe, catch_unwind};
use tiny_skia::{Pixmap, Transform};
use usvg::{Group, Node};

/// Draws `tree` on a picture.
///
/// # Errors
/// It takes more than the limits allow, or the renderer fails.
pub(crate) fn draw(
    tree: &usvg::Tree,
    transform: Transform,
    picture: &mut Pixmap,
    budget: &Budget,
) -> Result<(), Error> {
    #[expect(clippy::cast_precision_loss, reason = "an estimate")]
    let size = [picture.width() as f32, picture.height() as f32];
    load::of_group(tree.root(), transform, size, budget)?;
    // A failure leaves the picture half painted; it is then dropped.
    let drawn = catch_unwind(AssertUnwindSafe(|| resvg::render(tree, transform, &mut picture.as_mut())));
    drawn.map_err(|_| Error::Renderer)
}

/// Draws a group with its filters, clip path, mask and opacity as a picture, and counts the work in `budget`. `transform` leads from
/// the corner of the group's layer to pixels, as in `resvg::render_node`. `None` if the group shows nothing.
///
/// # Errors
/// As for [`RenderOptions::render_within`](crate::RenderOptions::render_within).
pub fn render_group(
    group: &Group,
    transform: Transform,
    [width, height]: [f64; 2],
    budget: &Budget,
) -> Result<Option<Pixmap>, Error> {
    // The renderer moves the corner of the layer to the origin.
    let corner = group.abs_layer_bounding_box();
    let moved = transform.pre_translate(-corner.x(), -corner.y());
    #[expect(clippy::cast_possible_truncation, reason = "an estimate")]
    load::of_group(group, moved, [width as f32, height as f32], budget)?;
    let mut pixmap = new_pixmap(width, height, &budget.limits())?;
    let node = Node::Group(Box::new(group.clone()));
    let drawn = catch_unwind(AssertUnwindSafe(|| resvg::render_node(&node, transform, &mut pixmap.as_mut())));
    Ok(drawn.map_err(|_| Error::Renderer)?.map(|()| pixmap))
}
