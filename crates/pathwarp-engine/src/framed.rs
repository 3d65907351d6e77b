//! Photographs as drawings: a page of the picture's size with the picture on it.

use crate::failure::Failure;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pathwarp::budget::Limits;
use pathwarp::kurbo::Size;
use pathwarp_raster::{Picture, PictureFormat};
use std::borrow::Cow;

/// Returns a drawing of a PNG, JPEG or WebP alone, with one px for each of its pixels; `None` for other files. The pixels are turned as the
/// metadata ask, since not every program does that for images of drawings.
pub fn framed(bytes: &[u8], limits: &Limits) -> Result<Option<Vec<u8>>, Failure> {
    if !Picture::sniff(bytes) {
        return Ok(None);
    }
    let (media_type, format) = match bytes {
        [0xff, ..] => ("image/jpeg", PictureFormat::Jpeg { quality: PictureFormat::QUALITY }),
        [b'R', ..] => ("image/webp", PictureFormat::WebP),
        _ => ("image/png", PictureFormat::Png),
    };
    let upright = Picture::read_within(bytes, limits)?;
    let shown = if Picture::is_turned(bytes, limits) {
        Cow::Owned(upright.remade(upright.pixmap.clone(), false).write(format)?)
    } else {
        Cow::Borrowed(bytes)
    };
    let (width, height) = (upright.pixmap.width(), upright.pixmap.height());
    let shown = STANDARD.encode(shown);
    Ok(Some(format!("{}data:{media_type};base64,{shown}\"/></svg>", before([width, height])).into_bytes()))
}

/// Returns the markup before the data of a picture of this size.
fn before([width, height]: [u32; 2]) -> String {
    let size = format!("width=\"{width}\" height=\"{height}\"");
    let page = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" {size} viewBox=\"0 0 {width} {height}\">");
    page + &format!("<image id=\"picture\" {size} href=\"")
}

/// Returns `true` if a drawing consists of one picture, on a page of this size.
pub fn is_framed(svg: &str, page: Size) -> bool {
    svg.starts_with(&before([page.width as u32, page.height as u32]))
}
