//! The interface of all decoders, and conversion of their samples to pixels.

use crate::error::Error;
use crate::pixmap::bytes;
use std::fmt::{self, Display, Formatter};
use tiny_skia::{ColorU8, Pixmap};

/// The extent of a picture in a file that ends early.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EarlyEnd {
    /// The lines of pixels in the file; `None` if all of them lack details.
    pub lines: Option<u32>,
    /// The lines of the whole picture.
    pub of: u32,
}

impl Display for EarlyEnd {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.lines {
            Some(lines) => write!(f, "ends early, after {lines} of {} lines", self.of),
            None => write!(f, "ends early, before all details of its {} lines", self.of),
        }
    }
}

/// A file whose header has been read.
pub(super) trait Bitmap {
    /// Width and height in pixels.
    fn size(&self) -> (u32, u32);

    /// The ICC profile.
    fn profile(&mut self) -> Option<Vec<u8>>;

    /// The EXIF metadata, starting with its TIFF header.
    fn exif(&mut self) -> Option<Vec<u8>> {
        None
    }

    /// Decodes the pixels into a transparent picture of the same size.
    fn decode(self: Box<Self>, to: &mut Pixmap) -> Result<(), Error>;
}

pub(super) fn undecodable(format: &str, why: impl Display) -> Error {
    Error::Decode(format!("{format}: {why}"))
}

/// Sets opaque pixels from `N` samples each.
pub(super) fn set_opaque<const N: usize>(to: &mut Pixmap, samples: &[u8], rgb: impl Fn([u8; N]) -> [u8; 3]) {
    for (to, from) in to.data_mut().as_chunks_mut().0.iter_mut().zip(samples.as_chunks::<N>().0) {
        let [r, g, b] = rgb(*from);
        *to = [r, g, b, u8::MAX];
    }
}

/// Sets pixels with straight alpha from `N` samples each.
pub(super) fn set_straight<const N: usize>(to: &mut Pixmap, samples: &[u8], rgba: impl Fn([u8; N]) -> [u8; 4]) {
    for (to, from) in to.data_mut().as_chunks_mut().0.iter_mut().zip(samples.as_chunks::<N>().0) {
        *to = premultiplied(rgba(*from));
    }
}

/// Premultiplies pixels that were decoded in place with straight alpha.
pub(super) fn premultiply(pixmap: &mut Pixmap) {
    for pixel in pixmap.data_mut().as_chunks_mut::<4>().0 {
        *pixel = premultiplied(*pixel);
    }
}

#[inline]
fn premultiplied([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    bytes(ColorU8::from_rgba(r, g, b, a).premultiply())
}

/// The first bytes of every PNG file.
pub(crate) const PNG_SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// A readable file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Png,
    Jpeg,
    WebP,
    Gif,
}

impl Kind {
    /// Recognizes the format of a file by its first bytes.
    pub(super) fn sniff(bytes: &[u8]) -> Option<Self> {
        if bytes.starts_with(PNG_SIGNATURE) {
            Some(Self::Png)
        } else if bytes.starts_with(b"\xff\xd8\xff") {
            Some(Self::Jpeg)
        } else if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") {
            Some(Self::WebP)
        } else if bytes.starts_with(b"GIF87a") || bytes.starts_with(b"GIF89a") {
            Some(Self::Gif)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_bytes_tell() {
        assert_eq!(Kind::sniff(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"), Some(Kind::Png));
        assert_eq!(Kind::sniff(b"\xff\xd8\xff\xe0\0\x10JFIF"), Some(Kind::Jpeg));
        assert_eq!(Kind::sniff(b"RIFF\x1a\0\0\0WEBPVP8L"), Some(Kind::WebP));
        assert_eq!(Kind::sniff(b"GIF87a\x01\0\x01\0"), Some(Kind::Gif));
        assert_eq!(Kind::sniff(b"GIF89a\x01\0\x01\0"), Some(Kind::Gif));
        for other in [&b""[..], b"\x89PNG\r\n\x1a", b"\xff\xd8", b"RIFF\x1a\0\0\0WAVE", b"GIF88a", b"BM\0\0\0\0"] {
            assert_eq!(Kind::sniff(other), None);
        }
    }
}
