//! Reads and writes photographs, with orientation and colour profile.

mod bitmap;
mod decode;
mod encode;
mod gif;
mod jpeg;
mod orientation;
mod png;
mod webp;

use crate::error::Error;
use crate::picture::bitmap::Kind;
use pathwarp::budget::Limits;
use tiny_skia::Pixmap;

pub(crate) use bitmap::PNG_SIGNATURE;
pub use decode::header_size;
pub use encode::PictureFormat;

/// A bitmap with its colour profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// The pixels.
    pub pixmap: Pixmap,
    /// The ICC profile of the colours; `None` for sRGB.
    pub profile: Option<Vec<u8>>,
}

impl Picture {
    /// Whether the bytes start like a PNG, JPEG or WebP file.
    #[must_use]
    pub fn sniff(bytes: &[u8]) -> bool {
        matches!(Kind::of(bytes), Some(Kind::Png | Kind::Jpeg | Kind::WebP))
    }

    /// Reads a PNG, JPEG or WebP and applies its EXIF orientation.
    ///
    /// # Errors
    /// [`Error::Decode`] for other and damaged files; [`Error::TooLarge`] above the default limits, before any memory is
    /// allocated for the pixels.
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        Self::read_within(bytes, &Limits::default().for_input(bytes.len()))
    }

    /// Reads a picture like [`Picture::read`], within limits.
    ///
    /// # Errors
    /// As for [`Picture::read`].
    pub fn read_within(bytes: &[u8], limits: &Limits) -> Result<Self, Error> {
        if Self::sniff(bytes) {
            Self::decode(bytes, true, limits)
        } else {
            Err(Error::Decode("neither a PNG nor a JPEG nor a WebP".to_owned()))
        }
    }

    /// Reads an image of a drawing (PNG, JPEG, GIF or WebP) without applying its orientation, as SVG renderers do. Takes the
    /// first image of an animation.
    ///
    /// # Errors
    /// As for [`Picture::read`].
    pub fn read_stored(bytes: &[u8]) -> Result<Self, Error> {
        Self::read_stored_within(bytes, &Limits::default().for_input(bytes.len()))
    }

    /// Reads an image of a drawing like [`Picture::read_stored`], within limits.
    ///
    /// # Errors
    /// As for [`Picture::read`].
    pub fn read_stored_within(bytes: &[u8], limits: &Limits) -> Result<Self, Error> {
        Self::decode(bytes, false, limits)
    }

    fn decode(bytes: &[u8], upright: bool, limits: &Limits) -> Result<Self, Error> {
        decode::decode(bytes, upright, limits).map(|(pixmap, profile)| Self { pixmap, profile })
    }

    /// Encodes the picture.
    ///
    /// # Errors
    /// [`Error::Encode`], for instance for a JPEG with a side of more than 65535 pixels.
    pub fn write(&self, format: PictureFormat) -> Result<Vec<u8>, Error> {
        let profile = self.profile.as_deref().filter(|profile| !profile.is_empty());
        encode::encode(&self.pixmap, profile, format)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tiny_skia::ColorU8;

    fn half_red() -> Picture {
        let mut pixmap = Pixmap::new(16, 8).unwrap();
        for (i, p) in pixmap.pixels_mut().iter_mut().enumerate() {
            *p = ColorU8::from_rgba(255, 0, 0, if i % 16 < 8 { 255 } else { 0 }).premultiply();
        }
        Picture { pixmap, profile: Some(b"a profile".to_vec()) }
    }

    const JPEG: PictureFormat = PictureFormat::Jpeg { quality: PictureFormat::QUALITY };

    #[test]
    fn png_and_webp_are_lossless() {
        for (format, signature) in [(PictureFormat::Png, b"\x89PNG"), (PictureFormat::WebP, b"RIFF")] {
            let bytes = half_red().write(format).unwrap();
            assert!(bytes.starts_with(signature) && Picture::sniff(&bytes));
            assert_eq!(Picture::read(&bytes).unwrap(), half_red(), "{format:?}");
        }
    }

    #[test]
    fn a_lower_quality_is_smaller() {
        let size = |quality| half_red().write(PictureFormat::Jpeg { quality }).unwrap().len();
        assert!(size(1) < size(50) && size(50) < size(100));
    }

    #[test]
    fn jpeg_is_on_white() {
        let bytes = half_red().write(JPEG).unwrap();
        assert!(Picture::sniff(&bytes));
        let back = Picture::read(&bytes).unwrap();
        let at = |x| back.pixmap.pixel(x, 4).unwrap();
        assert!(at(2).red() > 240 && at(2).green() < 20 && at(13).green() > 240);
        assert_eq!(back.profile, half_red().profile);
    }

    #[test]
    fn orientation_is_applied() {
        let mut bytes = half_red().write(JPEG).unwrap();
        // Add an APP1 segment with orientation (0x0112) = 6: the first row is the right side.
        let exif = b"\xff\xe1\x00\x22Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0";
        bytes.splice(2..2, exif.iter().copied());
        let back = Picture::read(&bytes).unwrap().pixmap;
        assert_eq!((back.width(), back.height()), (8, 16));
        assert!(back.pixel(4, 2).unwrap().green() < 20 && back.pixel(4, 13).unwrap().green() > 240);
    }

    #[test]
    fn damaged_files_are_errors() {
        for format in [PictureFormat::Png, JPEG, PictureFormat::WebP] {
            let bytes = half_red().write(format).unwrap();
            for end in [0, 3, 9, 20, 60] {
                assert!(matches!(Picture::read(&bytes[..end]), Err(Error::Decode(_))), "{format:?} {end}");
            }
        }
    }
}
