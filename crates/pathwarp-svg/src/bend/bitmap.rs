//! Bends the bitmaps of a drawing.

use super::bends::Bend;
use super::image::{ImageRequest, Images};
use super::paint;
use super::picture::BentImage;
use super::slots::{PlacedSlot, written};
use crate::scene::affine::is_invertible;
use crate::scene::model::{Bitmap, Scene};
use pathwarp::kurbo::Rect;
use usvg::ImageRendering;

/// Result for a bitmap.
#[derive(Debug)]
pub(crate) enum EmbeddedImage {
    /// Not selected, or placed exactly by its slot.
    Placed,
    /// Placed approximately, with the reason.
    Approximate(String),
    /// Bent, in the user space outside of its placing transform.
    Bent(BentImage),
}

/// An affine fit with a relative residual below this is exact.
const EXACT: f64 = 1e-6;

/// Bends a bitmap, if anything bends it.
pub(super) fn bend(b: &Bitmap, scene: &Scene, slots: &[PlacedSlot], bend: Option<&Bend<'_>>) -> EmbeddedImage {
    let Some(Bend { map, options }) = bend else { return EmbeddedImage::Placed };
    let pixels = b.image.size();
    let area = Rect::new(0.0, 0.0, f64::from(pixels.width()), f64::from(pixels.height()));
    let write = written(scene, slots, b.slot, b.frame);
    if !b.bends || b.is_unread() || !b.image.is_visible() || !is_invertible(b.frame) || !is_invertible(write) {
        return EmbeddedImage::Placed;
    }
    let fit = paint::fit(area, b.frame, write, *map);
    if fit.is_some_and(|f| f.residual <= EXACT && f.is_identity(area)) {
        return EmbeddedImage::Placed;
    }
    let approximate = |why: &str| EmbeddedImage::Approximate(format!("{why}; it is placed by the best affine fit"));
    let Images::Warp(warper) = &options.images else { return approximate("images are kept") };
    let data = match b.image.kind() {
        usvg::ImageKind::JPEG(d) | usvg::ImageKind::PNG(d) | usvg::ImageKind::GIF(d) | usvg::ImageKind::WEBP(d) => d,
        // Not a bitmap.
        usvg::ImageKind::SVG(_) => return EmbeddedImage::Placed,
    };
    let after = (write * b.placing.inverse()).inverse();
    let pixelated = matches!(b.image.rendering_mode(), ImageRendering::Pixelated | ImageRendering::CrispEdges);
    let request = ImageRequest { data, placed: b.frame, crop: b.crop, pixelated, map: *map, after, to_px: scene.to_px };
    match warper.warp(&request) {
        Ok(bent) => EmbeddedImage::Bent(bent),
        Err(why) => approximate(&why.to_string()),
    }
}
