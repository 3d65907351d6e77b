//! Pictures as files.

use crate::failure::Failure;
use crate::format::Format;
use pathwarp_raster::{Picture, Pixmap, encode_png};

/// The file of a picture in a format; PNG for formats that are not pictures'.
pub(crate) fn encode(pixmap: Pixmap, format: Format, quality: Option<u8>) -> Result<Vec<u8>, Failure> {
    match format.of_picture(quality) {
        None | Some(pathwarp_raster::PictureFormat::Png) => Ok(encode_png(&pixmap)?),
        Some(other) => Ok(Picture { pixmap, profile: None }.write(other)?),
    }
}
