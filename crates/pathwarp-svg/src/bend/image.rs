//! Bitmaps in a drawing under a map. The pixels themselves are somebody else's work: an [`ImageWarper`]'s.

use crate::bend::paint;
use crate::bend::part::{Placed, usable, written};
use crate::scene::model::{Bitmap, Scene};
use pathwarp::kurbo::{Affine, Rect};
use pathwarp::map::Map;
use std::fmt;
use std::sync::Arc;

/// Bends bitmaps.
pub trait ImageWarper: Send + Sync {
    /// The image bent, and where it goes.
    ///
    /// # Errors
    /// Why it cannot be bent; it is placed by the best affine fit then.
    fn warp(&self, request: &ImageRequest<'_>) -> Result<BentImage, String>;
}

/// A bitmap of a drawing that is to be bent.
pub struct ImageRequest<'a> {
    /// The file: PNG, JPEG, GIF or WebP.
    pub data: &'a [u8],
    /// From its pixels to root user space.
    pub placed: Affine,
    /// The map of root user space.
    pub map: &'a dyn Map,
    /// From root user space to the user space that the result is placed in.
    pub after: Affine,
    /// Root user space to px, for resolutions.
    pub to_px: Affine,
}

/// A bent bitmap.
#[derive(Debug, Clone, PartialEq)]
pub struct BentImage {
    /// A PNG file.
    pub png: Vec<u8>,
    /// Where it goes, in the user space asked for.
    pub area: Rect,
}

/// What becomes of bitmaps.
#[derive(Clone, Default)]
pub enum Images {
    /// They are placed by the best affine fit, pixels unchanged.
    #[default]
    Keep,
    /// They are bent.
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

/// What becomes of one bitmap.
#[derive(Debug)]
pub(crate) enum Picture {
    /// It is not meant, or its affine place is its exact place.
    Placed,
    /// Placed only nearly right, and why.
    Nearly(String),
    /// In the user space around its own placing transform.
    Bent(BentImage),
}

/// Below this share of its size an affine fit is exact.
const EXACT: f64 = 1e-6;

/// Bends one bitmap; `meant` says whether it is selected.
pub(crate) fn bend(
    b: &Bitmap,
    scene: &Scene,
    slots: &[Placed],
    meant: bool,
    map: &dyn Map,
    images: &Images,
) -> Picture {
    let pixels = b.image.size();
    let area = Rect::new(0.0, 0.0, f64::from(pixels.width()), f64::from(pixels.height()));
    let write = written(scene, slots, b.slot, b.frame);
    if !meant || !b.bends || !b.image.is_visible() || !usable(b.frame) || !usable(write) {
        return Picture::Placed;
    }
    let fit = paint::fit(area, b.frame, write, map);
    if fit.is_some_and(|f| f.residual <= EXACT && f.is_identity(area)) {
        return Picture::Placed;
    }
    let nearly = |why: &str| Picture::Nearly(format!("{why}; it is placed by the best affine fit"));
    let Images::Warp(warper) = images else { return nearly("images are kept") };
    let data = match b.image.kind() {
        usvg::ImageKind::JPEG(d) | usvg::ImageKind::PNG(d) | usvg::ImageKind::GIF(d) | usvg::ImageKind::WEBP(d) => d,
        // These are no bitmaps.
        usvg::ImageKind::SVG(_) => return Picture::Placed,
    };
    if b.sliced {
        return nearly("images that are cut to their place (slice) are not bent yet");
    }
    let after = (write * b.placing.inverse()).inverse();
    match warper.warp(&ImageRequest { data, placed: b.frame, map, after, to_px: scene.to_px }) {
        Ok(bent) => Picture::Bent(bent),
        Err(why) => nearly(&why),
    }
}
