//! Photographs: bitmap files with orientation and colour profile.

use crate::error::Error;
use crate::pixmap::new_pixmap;
use image::codecs::{jpeg, png, webp};
use image::metadata::Orientation;
use image::{DynamicImage, ExtendedColorType, ImageDecoder, ImageEncoder, ImageReader};
use pathwarp::budget::{Limit, Limits};
use std::io::Cursor;
use tiny_skia::{ColorU8, Pixmap};

/// Pixels held for each pixel of a picture that is warped: decoded, reduced for sampling, the result, and its file.
const COPIES: f64 = 4.0;

/// A bitmap with its colour profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// The pixels.
    pub pixmap: Pixmap,
    /// The ICC profile of the colours; `None` for sRGB.
    pub profile: Option<Vec<u8>>,
}

/// A file format to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum PictureFormat {
    /// PNG with transparency.
    #[default]
    Png,
    /// JPEG on white, since it has no transparency.
    Jpeg {
        /// From 1 (small) to 100 (fine).
        quality: u8,
    },
    /// WebP with transparency, without loss.
    WebP,
}

impl PictureFormat {
    /// A quality of JPEGs at which artefacts are hard to see.
    pub const QUALITY: u8 = 92;
}

impl Picture {
    /// The first bytes of every PNG file.
    pub(crate) const PNG_SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
    /// The first bytes of every JPEG file.
    const JPEG_SIGNATURE: &[u8] = b"\xff\xd8\xff";

    /// Returns `true` if the bytes start like a PNG, JPEG or WebP file.
    #[must_use]
    pub fn sniff(bytes: &[u8]) -> bool {
        let is_webp = || bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP");
        bytes.starts_with(Self::PNG_SIGNATURE) || bytes.starts_with(Self::JPEG_SIGNATURE) || is_webp()
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
            Err(undecodable("neither a PNG nor a JPEG nor a WebP"))
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
        let check = |(width, height): (u32, u32)| {
            let (w, h) = (f64::from(width), f64::from(height));
            let too_large = |exceeded| Error::TooLarge { width: w, height: h, exceeded };
            limits.check(Limit::Pixels, COPIES * w * h).map_err(too_large)
        };
        // Opening a PNG takes memory for a row.
        png_size(bytes).map_or(Ok(()), check)?;
        let mut decoder = decoder(bytes, limits)?;
        check(decoder.dimensions())?;
        let profile = decoder.icc_profile().ok().flatten();
        let orientation = decoder.orientation().ok().filter(|_| upright).unwrap_or(Orientation::NoTransforms);
        let mut image = DynamicImage::from_decoder(decoder).map_err(undecodable)?;
        image.apply_orientation(orientation);
        let image = image.into_rgba8();
        let mut pixmap = new_pixmap(f64::from(image.width()), f64::from(image.height()), limits)?;
        for (to, from) in pixmap.pixels_mut().iter_mut().zip(image.pixels()) {
            let [r, g, b, a] = from.0;
            *to = ColorU8::from_rgba(r, g, b, a).premultiply();
        }
        Ok(Self { pixmap, profile })
    }

    /// Encodes the picture.
    ///
    /// # Errors
    /// [`Error::Encode`], for instance for a JPEG with a side of more than 65535 pixels.
    pub fn write(&self, format: PictureFormat) -> Result<Vec<u8>, Error> {
        let mut out = Vec::new();
        let profile = self.profile.clone();
        match format {
            PictureFormat::Png => {
                let encoder = png::PngEncoder::new(&mut out);
                self.encode(encoder, profile, &self.straight(), ExtendedColorType::Rgba8)?;
            }
            PictureFormat::WebP => {
                let encoder = webp::WebPEncoder::new_lossless(&mut out);
                self.encode(encoder, profile, &self.straight(), ExtendedColorType::Rgba8)?;
            }
            PictureFormat::Jpeg { quality } => {
                let pixels = self.pixmap.pixels().iter().flat_map(|p| {
                    let white = u8::MAX - p.alpha();
                    [p.red() + white, p.green() + white, p.blue() + white]
                });
                let encoder = jpeg::JpegEncoder::new_with_quality(&mut out, quality.clamp(1, 100));
                self.encode(encoder, profile, &pixels.collect::<Vec<u8>>(), ExtendedColorType::Rgb8)?;
            }
        }
        Ok(out)
    }

    /// The pixels with straight alpha.
    fn straight(&self) -> Vec<u8> {
        let pixels = self.pixmap.pixels().iter().flat_map(|p| {
            let c = p.demultiply();
            [c.red(), c.green(), c.blue(), c.alpha()]
        });
        pixels.collect()
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

/// Width and height in the header of a PNG.
fn png_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let header = bytes.strip_prefix(Picture::PNG_SIGNATURE)?.get(4..)?.strip_prefix(b"IHDR")?;
    let (&[a, b, c, d, e, f, g, h], _) = header.split_first_chunk()?;
    Some((u32::from_be_bytes([a, b, c, d]), u32::from_be_bytes([e, f, g, h])))
}

/// Width and height that the header of a picture announces.
///
/// # Errors
/// [`Error::Decode`] for other and damaged files.
pub fn header_size(bytes: &[u8]) -> Result<(u32, u32), Error> {
    decoder(bytes, &Limits::default().for_input(bytes.len())).map(|d| d.dimensions())
}

/// The number of pixels is limited by the caller. What a decoder holds besides them is limited here: unpacked profiles and texts, and a
/// frame of an animation, which may be larger than the picture.
fn decoder(bytes: &[u8], limits: &Limits) -> Result<impl ImageDecoder, Error> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(undecodable)?;
    let mut held = image::Limits::no_limits();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "casts saturate")]
    let most = limits.of(Limit::ImageBytes) as u64;
    held.max_alloc = Some(most);
    reader.limits(held.clone());
    let mut decoder = reader.into_decoder().map_err(undecodable)?;
    decoder.set_limits(held).map_err(undecodable)?;
    Ok(decoder)
}

#[expect(clippy::needless_pass_by_value, reason = "for map_err")]
fn undecodable(why: impl ToString) -> Error {
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
