//! Decodes files to pixels, within limits.

use super::Picture;
use super::bitmap::{Bitmap, Kind};
use super::gif::Gif;
use super::jpeg::{Jpeg, early_end};
use super::orientation::Orientation;
use super::png::{self, Png};
use super::webp::WebP;
use crate::error::Error;
use crate::pixmap::{check_size, new_pixmap};
use pathwarp::budget::{Limit, Limits};

/// Decodes the pixels and the ICC profile. If `upright`, applies the EXIF orientation and keeps the metadata.
pub(super) fn decode(bytes: &[u8], upright: bool, limits: &Limits) -> Result<Picture, Error> {
    let check = |(width, height): (u32, u32)| check_size(f64::from(width), f64::from(height), limits);
    png::size(bytes).map_or(Ok(()), check)?;
    let mut bitmap = open(bytes, limits)?;
    let (width, height) = bitmap.size();
    check((width, height))?;
    let profile = bitmap.profile();
    let exif = if upright { bitmap.exif() } else { None };
    let limits = &limits.for_pixels(f64::from(width) * f64::from(height));
    let mut pixmap = new_pixmap(f64::from(width), f64::from(height), limits)?;
    bitmap.decode(&mut pixmap)?;
    let is_jpeg = Kind::sniff(bytes) == Some(Kind::Jpeg);
    let early_end = if upright && is_jpeg { early_end(bytes, &mut pixmap) } else { None };
    let orientation = exif.as_deref().map_or_else(Orientation::default, Orientation::of_exif);
    Ok(Picture { pixmap: orientation.apply(pixmap, limits)?, profile, exif, early_end })
}

/// Reads the orientation from the metadata of a picture; upright if there is none.
pub(super) fn orientation(bytes: &[u8], limits: &Limits) -> Orientation {
    let exif = open(bytes, limits).ok().and_then(|mut bitmap| bitmap.exif());
    exif.as_deref().map_or_else(Orientation::default, Orientation::of_exif)
}

/// Returns the width and height in the header of a picture.
///
/// # Errors
/// [`Error::Decode`] for other and damaged files.
pub fn header_size(bytes: &[u8]) -> Result<(u32, u32), Error> {
    let opened = open(bytes, &Limits::default().for_input(bytes.len())).map(|bitmap| bitmap.size());
    // A PNG may be larger than its decoder allows.
    opened.or_else(|e| png::size(bytes).ok_or(e))
}

/// Opens a picture. The caller limits the number of pixels; this limits what else a decoder holds: unpacked profiles, and a frame of an
/// animation, which may be larger than the picture.
fn open<'a>(bytes: &'a [u8], limits: &Limits) -> Result<Box<dyn Bitmap + 'a>, Error> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "casts saturate")]
    let max_bytes = limits.of(Limit::Bytes) as usize;
    match Kind::sniff(bytes) {
        Some(Kind::Png) => Ok(Box::new(Png::open(bytes, max_bytes)?)),
        Some(Kind::Jpeg) => Ok(Box::new(Jpeg::open(bytes)?)),
        Some(Kind::WebP) => Ok(Box::new(WebP::open(bytes)?)),
        Some(Kind::Gif) => Ok(Box::new(Gif::open(bytes, max_bytes)?)),
        None => Err(Error::Decode("neither a PNG nor a JPEG nor a WebP nor a GIF".to_owned())),
    }
}
