//! Groups with filters as pictures.

use crate::file::File;
use crate::options::PRINT;
use crate::space::{affine, rect};
use kurbo::{Affine, Rect};
use pathwarp_raster::{Error, Pixmap, render_group};
use resvg::tiny_skia::Transform;
use usvg::Group;

/// Px per inch.
const PX_PER_INCH: f64 = 96.0;

/// Times that the sides of a picture are halved to stay within the limits: from print to a thumbnail.
const MOST_HALVINGS: i32 = 4;

/// A picture in the coordinates of a group.
pub(crate) struct Picture {
    pub(crate) pixmap: Pixmap,
    pub(crate) area: Rect,
}

/// Renders a group with its filters, clip path, mask and opacity, with fewer pixels if the limits do not allow the resolution.
/// `None` if it shows nothing.
pub(crate) fn of_group(file: &mut File<'_>, g: &Group) -> Result<Option<Picture>, Error> {
    let area = rect(g.layer_bounding_box().to_rect());
    let dpi = file.options.picture_dpi.unwrap_or(PRINT);
    let wanted = affine(g.abs_transform()).determinant().abs().sqrt() * dpi / PX_PER_INCH;
    // The renderer moves the picture's corner to the origin, and applies the group's transform; both are undone.
    let back = affine(g.transform()).inverse();
    if !back.is_finite() || !wanted.is_finite() {
        return Ok(None);
    }
    let moved = g.abs_layer_bounding_box();
    let to_area = Affine::translate(-area.origin().to_vec2())
        * back
        * Affine::translate((f64::from(moved.x()), f64::from(moved.y())));
    let mut halvings = 0;
    loop {
        let scale = wanted * 0.5_f64.powi(halvings);
        let size = [area.width(), area.height()].map(|v| (v * scale).ceil().max(1.0));
        let to_pixels = Affine::scale_non_uniform(size[0] / area.width(), size[1] / area.height()) * to_area;
        let [a, b, c, d, e, f] = to_pixels.as_coeffs().map(|v| v as f32);
        match render_group(g, Transform::from_row(a, b, c, d, e, f), size, &file.budget) {
            Err(Error::TooLarge { .. } | Error::TooMuch(_)) if halvings < MOST_HALVINGS => halvings += 1,
            Err(e) => return Err(e),
            Ok(drawn) => {
                file.coarser += usize::from(halvings > 0);
                return Ok(drawn.map(|pixmap| Picture { pixmap, area }));
            }
        }
    }
}
