//! Writes bitmaps as PNG, JPEG and WebP.

use super::jpeg;
use crate::error::Error;
use crate::pixmap::straight;
use image_webp::WebPEncoder;
use jpeg_encoder::{ImageBuffer, JpegColorType, QuantizationTableType, SamplingFactor, rgb_to_ycbcr};
use png::{BitDepth, ColorType, Compression, Filter, Info};
use std::fmt::Display;
use tiny_skia::Pixmap;

/// An output format.
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
    /// Lossless WebP with transparency.
    WebP,
}

impl PictureFormat {
    /// JPEG quality at which artefacts are hard to see.
    pub const QUALITY: u8 = 92;
}

/// Encodes a picture with its ICC profile and EXIF metadata.
pub(super) fn encode(
    pixmap: &Pixmap,
    profile: Option<&[u8]>,
    exif: Option<&[u8]>,
    format: PictureFormat,
) -> Result<Vec<u8>, Error> {
    match format {
        PictureFormat::Png => encode_png(pixmap, profile, exif),
        PictureFormat::Jpeg { quality } => encode_jpeg(pixmap, profile, exif, JpegColorType::Ycbcr, |encoder| {
            encoder.set_quality(quality.clamp(1, 100));
        }),
        PictureFormat::WebP => encode_webp(pixmap, profile, exif),
    }
}

fn encode_png(pixmap: &Pixmap, profile: Option<&[u8]>, exif: Option<&[u8]>) -> Result<Vec<u8>, Error> {
    let mut info = Info::with_size(pixmap.width(), pixmap.height());
    info.icc_profile = profile.map(Into::into);
    info.exif_metadata = exif.map(Into::into);
    let mut out = Vec::new();
    let mut encoder = png::Encoder::with_info(&mut out, info).map_err(unencodable)?;
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    // Setting the compression sets a filter, so this comes after it.
    encoder.set_filter(Filter::Adaptive);
    let mut writer = encoder.write_header().map_err(unencodable)?;
    writer.write_image_data(&straight_bytes(pixmap)).map_err(unencodable)?;
    writer.finish().map_err(unencodable)?;
    Ok(out)
}

fn encode_webp(pixmap: &Pixmap, profile: Option<&[u8]>, exif: Option<&[u8]>) -> Result<Vec<u8>, Error> {
    let mut out = Vec::new();
    let mut encoder = WebPEncoder::new(&mut out);
    encoder.set_icc_profile(profile.unwrap_or_default().to_vec());
    encoder.set_exif_metadata(exif.unwrap_or_default().to_vec());
    let (width, height) = (pixmap.width(), pixmap.height());
    encoder.encode(&straight_bytes(pixmap), width, height, image_webp::ColorType::Rgba8).map_err(unencodable)?;
    Ok(out)
}

/// Encodes a picture as JPEG with the quantization tables of another, grey if that one is grey. Colours are not subsampled.
pub(super) fn encode_like(like: &jpeg::Compression, pixmap: &Pixmap, profile: Option<&[u8]>) -> Result<Vec<u8>, Error> {
    let is_grey = like.components == 1;
    let color = if is_grey { JpegColorType::Luma } else { JpegColorType::Ycbcr };
    encode_jpeg(pixmap, profile, None, color, |encoder| {
        // The encoder writes values of 8 bits.
        let [luma, chroma] = like.tables.map(|t| QuantizationTableType::Custom(Box::new(t.map(|v| v.clamp(1, 255)))));
        encoder.set_quantization_tables(luma, chroma);
    })
}

/// Encodes a picture as JPEG. `set_quality` sets the quality or the tables of the encoder.
fn encode_jpeg(
    pixmap: &Pixmap,
    profile: Option<&[u8]>,
    exif: Option<&[u8]>,
    color: JpegColorType,
    set_quality: impl Fn(&mut jpeg_encoder::Encoder<&mut Vec<u8>>),
) -> Result<Vec<u8>, Error> {
    let mut out = Vec::new();
    let mut encoder = jpeg_encoder::Encoder::new(&mut out, PictureFormat::QUALITY);
    // Don't subsample colours, so that red on white has no fringes.
    encoder.set_sampling_factor(SamplingFactor::F_1_1);
    set_quality(&mut encoder);
    exif.map_or(Ok(()), |exif| encoder.add_exif_metadata(exif)).map_err(unencodable)?;
    encoder.add_icc_profile(profile.unwrap_or_default()).map_err(unencodable)?;
    encoder.encode_image(OnWhite::new(pixmap, color)?).map_err(unencodable)?;
    Ok(out)
}

/// Feeds a picture on white to the JPEG encoder.
struct OnWhite<'a> {
    pixmap: &'a Pixmap,
    size: [u16; 2],
    color: JpegColorType,
}

impl<'a> OnWhite<'a> {
    fn new(pixmap: &'a Pixmap, color: JpegColorType) -> Result<Self, Error> {
        let side = |n: u32| {
            let too_long = |_| unencodable(format!("a JPEG has at most {} pixels on a side, not {n}", u16::MAX));
            u16::try_from(n).map_err(too_long)
        };
        Ok(Self { pixmap, size: [side(pixmap.width())?, side(pixmap.height())?], color })
    }
}

impl ImageBuffer for OnWhite<'_> {
    fn get_jpeg_color_type(&self) -> JpegColorType {
        self.color
    }

    fn width(&self) -> u16 {
        self.size[0]
    }

    fn height(&self) -> u16 {
        self.size[1]
    }

    fn fill_buffers(&self, y: u16, [luma, blue, red, _]: &mut [Vec<u8>; 4]) {
        let mut rows = self.pixmap.pixels().chunks_exact(usize::from(self.size[0]));
        for p in rows.nth(usize::from(y)).into_iter().flatten() {
            let white = u8::MAX - p.alpha();
            let (y, cb, cr) = rgb_to_ycbcr(p.red() + white, p.green() + white, p.blue() + white);
            luma.push(y);
            if self.color == JpegColorType::Ycbcr {
                blue.push(cb);
                red.push(cr);
            }
        }
    }
}

/// The samples of a picture with straight alpha.
fn straight_bytes(pixmap: &Pixmap) -> Vec<u8> {
    pixmap.pixels().iter().flat_map(straight).collect()
}

fn unencodable(why: impl Display) -> Error {
    Error::Encode(why.to_string())
}
