//! Photographs: PNG and JPEG files with what belongs to their pixels, the camera's orientation and the colour profile.

use crate::{Error, MAX_PIXELS, render::new_pixmap};
use image::codecs::{jpeg, png};
use image::metadata::Orientation;
use image::{DynamicImage, ExtendedColorType, ImageDecoder, ImageEncoder, ImageReader};
use std::io::Cursor;
use tiny_skia::{ColorU8, Pixmap};

/// A bitmap with its colour profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// The pixels, 8 bits per channel.
    pub pixmap: Pixmap,
    /// The ICC profile that says what their colours mean; sRGB if there is none.
    pub profile: Option<Vec<u8>>,
}

/// What a picture is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PictureFormat {
    /// PNG with transparency.
    #[default]
    Png,
    /// JPEG; what is transparent becomes white.
    Jpeg,
}

impl Picture {
    /// Whether these bytes begin like a file that [`Picture::read`] reads.
    #[must_use]
    pub fn is_one(bytes: &[u8]) -> bool {
        bytes.starts_with(b"\x89PNG\r\n\x1a\n") || bytes.starts_with(b"\xff\xd8\xff")
    }

    /// Reads a PNG or JPEG, turned as its EXIF orientation says. Refused when it has more than [`MAX_PIXELS`] pixels, before
    /// any memory is taken for them.
    ///
    /// # Errors
    /// [`Error::Decode`] for other files and damaged ones, [`Error::TooLarge`].
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        if Self::is_one(bytes) { Self::decode(bytes, true) } else { Err(unknown("it is neither a PNG nor a JPEG")) }
    }

    /// Reads an image that is part of a drawing (PNG, JPEG, GIF or WebP), its pixels as they are stored, as SVG renderers
    /// take them; of an animation, the first.
    ///
    /// # Errors
    /// As [`Picture::read`].
    pub fn read_stored(bytes: &[u8]) -> Result<Self, Error> {
        Self::decode(bytes, false)
    }

    fn decode(bytes: &[u8], upright: bool) -> Result<Self, Error> {
        let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(unknown)?;
        // The number of pixels is what is limited, below.
        reader.no_limits();
        let mut decoder = reader.into_decoder().map_err(unknown)?;
        let (width, height) = decoder.dimensions();
        if u64::from(width) * u64::from(height) > u64::from(MAX_PIXELS) {
            return Err(Error::TooLarge { width: f64::from(width), height: f64::from(height) });
        }
        let profile = decoder.icc_profile().ok().flatten();
        let orientation = decoder.orientation().ok().filter(|_| upright).unwrap_or(Orientation::NoTransforms);
        let mut image = DynamicImage::from_decoder(decoder).map_err(unknown)?;
        image.apply_orientation(orientation);
        let image = image.into_rgba8();
        let mut pixmap = new_pixmap(f64::from(image.width()), f64::from(image.height()))?;
        for (to, from) in pixmap.pixels_mut().iter_mut().zip(image.pixels()) {
            let [r, g, b, a] = from.0;
            *to = ColorU8::from_rgba(r, g, b, a).premultiply();
        }
        Ok(Self { pixmap, profile })
    }

    /// Writes it.
    ///
    /// # Errors
    /// [`Error::Encode`], such as for a JPEG with more than 65535 pixels along a side.
    pub fn write(&self, format: PictureFormat) -> Result<Vec<u8>, Error> {
        let mut out = Vec::new();
        let profile = self.profile.clone();
        match format {
            PictureFormat::Png => {
                let pixels = self.pixmap.pixels().iter().flat_map(|p| {
                    let c = p.demultiply();
                    [c.red(), c.green(), c.blue(), c.alpha()]
                });
                let encoder = png::PngEncoder::new(&mut out);
                self.encode(encoder, profile, &pixels.collect::<Vec<u8>>(), ExtendedColorType::Rgba8)?;
            }
            PictureFormat::Jpeg => {
                /// Artefacts are hard to see from here on.
                const QUALITY: u8 = 92;
                let pixels = self.pixmap.pixels().iter().flat_map(|p| {
                    let white = u8::MAX - p.alpha();
                    [p.red() + white, p.green() + white, p.blue() + white]
                });
                let encoder = jpeg::JpegEncoder::new_with_quality(&mut out, QUALITY);
                self.encode(encoder, profile, &pixels.collect::<Vec<u8>>(), ExtendedColorType::Rgb8)?;
            }
        }
        Ok(out)
    }

    fn encode(
        &self,
        mut encoder: impl ImageEncoder,
        profile: Option<Vec<u8>>,
        pixels: &[u8],
        kind: ExtendedColorType,
    ) -> Result<(), Error> {
        let wrong = |e: image::ImageError| Error::Encode(e.to_string());
        if let Some(profile) = profile {
            encoder.set_icc_profile(profile).map_err(|e| Error::Encode(e.to_string()))?;
        }
        encoder.write_image(pixels, self.pixmap.width(), self.pixmap.height(), kind).map_err(wrong)
    }
}

#[expect(clippy::needless_pass_by_value, reason = "for map_err")]
fn unknown(why: impl ToString) -> Error {
    Error::Decode(why.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half_red() -> Picture {
        let mut pixmap = Pixmap::new(16, 8).unwrap();
        for (i, p) in pixmap.pixels_mut().iter_mut().enumerate() {
            *p = ColorU8::from_rgba(255, 0, 0, if i % 16 < 8 { 255 } else { 0 }).premultiply();
        }
        Picture { pixmap, profile: Some(b"a profile".to_vec()) }
    }

    #[test]
    fn png_keeps_all() {
        let bytes = half_red().write(PictureFormat::Png).unwrap();
        assert!(Picture::is_one(&bytes));
        assert_eq!(Picture::read(&bytes).unwrap(), half_red());
    }

    #[test]
    fn jpeg_is_on_white() {
        let bytes = half_red().write(PictureFormat::Jpeg).unwrap();
        assert!(Picture::is_one(&bytes));
        let back = Picture::read(&bytes).unwrap();
        let at = |x| back.pixmap.pixel(x, 4).unwrap();
        assert!(at(2).red() > 240 && at(2).green() < 20 && at(13).green() > 240);
        assert_eq!(back.profile, half_red().profile);
    }

    #[test]
    fn a_camera_held_upright_is_understood() {
        let mut bytes = half_red().write(PictureFormat::Jpeg).unwrap();
        // APP1 with one entry, orientation (0x0112) = 6: the first row is the right side.
        let exif = b"\xff\xe1\x00\x22Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0";
        bytes.splice(2..2, exif.iter().copied());
        let back = Picture::read(&bytes).unwrap().pixmap;
        assert_eq!((back.width(), back.height()), (8, 16));
        assert!(back.pixel(4, 2).unwrap().green() < 20 && back.pixel(4, 13).unwrap().green() > 240);
    }

    #[test]
    fn damaged_files_are_errors() {
        for format in [PictureFormat::Png, PictureFormat::Jpeg] {
            let bytes = half_red().write(format).unwrap();
            for end in [0, 3, 9, 20, 60] {
                assert!(matches!(Picture::read(&bytes[..end]), Err(Error::Decode(_))), "{format:?} {end}");
            }
        }
    }
}
