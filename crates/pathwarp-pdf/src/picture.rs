//! Groups with filters as pictures.

use crate::options::PRINT;
use crate::space::{affine, rect};
use kurbo::{Affine, Rect};
use resvg::tiny_skia::{Pixmap, Transform};
use usvg::{Group, Node};

/// Most pixels of a picture: a square of 8192 pixels.
const MOST_PIXELS: f64 = 67_108_864.0;

/// Px per inch.
const PX_PER_INCH: f64 = 96.0;

/// A picture in the coordinates of a group.
pub(crate) struct Picture {
    pub(crate) pixmap: Pixmap,
    pub(crate) area: Rect,
}

/// Renders a group with its filters, clip path, mask and opacity. `None` if it shows nothing.
pub(crate) fn of_group(g: &Group, dpi: Option<f64>) -> Option<Picture> {
    let area = rect(g.layer_bounding_box().to_rect());
    let per_unit = affine(g.abs_transform()).determinant().abs().sqrt() * dpi.unwrap_or(PRINT) / PX_PER_INCH;
    let scale = per_unit.min((MOST_PIXELS / area.area()).sqrt());
    let size = [area.width(), area.height()].map(|v| (v * scale).ceil().max(1.0));
    let mut pixmap = Pixmap::new(size[0] as u32, size[1] as u32)?;
    // The renderer moves the picture's corner to the origin, and applies the group's transform; both are undone.
    let moved = g.abs_layer_bounding_box();
    let back = affine(g.transform()).inverse();
    if !back.is_finite() || !scale.is_finite() {
        return None;
    }
    let to_pixels = Affine::scale_non_uniform(size[0] / area.width(), size[1] / area.height())
        * Affine::translate(-area.origin().to_vec2())
        * back
        * Affine::translate((f64::from(moved.x()), f64::from(moved.y())));
    let [a, b, c, d, e, f] = to_pixels.as_coeffs().map(|v| v as f32);
    let node = Node::Group(Box::new(g.clone()));
    resvg::render_node(&node, Transform::from_row(a, b, c, d, e, f), &mut pixmap.as_mut())?;
    Some(Picture { pixmap, area })
}
