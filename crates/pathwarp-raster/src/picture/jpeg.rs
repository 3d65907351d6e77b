//! Reads JPEG: grey, RGB, YCbCr, CMYK and YCCK.

use super::bitmap::{Bitmap, set_opaque, undecodable};
use crate::error::Error;
use tiny_skia::Pixmap;
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// An opened JPEG.
pub(super) struct Jpeg<'a> {
    decoder: JpegDecoder<ZCursor<&'a [u8]>>,
    size: (u32, u32),
}

impl<'a> Jpeg<'a> {
    /// Reads the file up to its pixels. Metadata are not compressed, so they take no more than the file.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Error> {
        // The format stores sides in 16 bits.
        let side = usize::from(u16::MAX);
        let options = DecoderOptions::default().set_strict_mode(false).set_max_width(side).set_max_height(side);
        let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
        decoder.decode_headers().map_err(wrong)?;
        let info = decoder.info().ok_or_else(|| wrong(DecodeErrors::ExhaustedData))?;
        Ok(Self { size: (u32::from(info.width), u32::from(info.height)), decoder })
    }
}

impl Bitmap for Jpeg<'_> {
    fn size(&self) -> (u32, u32) {
        self.size
    }

    fn profile(&mut self) -> Option<Vec<u8>> {
        self.decoder.icc_profile()
    }

    fn exif(&mut self) -> Option<Vec<u8>> {
        self.decoder.exif().cloned()
    }

    fn decode(mut self: Box<Self>, to: &mut Pixmap) -> Result<(), Error> {
        let is_grey = self.decoder.input_colorspace() == Some(ColorSpace::Luma);
        let space = if is_grey { ColorSpace::Luma } else { ColorSpace::RGB };
        self.decoder.set_options(self.decoder.options().jpeg_set_out_colorspace(space));
        let samples = self.decoder.decode().map_err(wrong)?;
        if is_grey {
            set_opaque(to, &samples, |[v]| [v; 3]);
        } else {
            set_opaque(to, &samples, |rgb| rgb);
        }
        Ok(())
    }
}

fn wrong(why: DecodeErrors) -> Error {
    undecodable("JPEG", why)
}
