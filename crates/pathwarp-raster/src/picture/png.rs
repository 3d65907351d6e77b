//! Reads PNG. Every colour type and depth becomes eight bits per channel. Of an animation, the default image is read.

use super::bitmap::{Bitmap, PNG_SIGNATURE, premultiply, set_opaque, set_straight, undecodable};
use crate::error::Error;
use png::{BitDepth, ColorType, Decoder, DecodingError, Limits, Reader, Transformations};
use std::io::Cursor;
use tiny_skia::Pixmap;

/// An opened PNG.
pub(super) struct Png<'a>(Reader<Cursor<&'a [u8]>>);

/// Reads the width and height in the header of a PNG. Unlike [`Png::open`], this allocates no row, which may be very long.
pub(super) fn size(bytes: &[u8]) -> Option<(u32, u32)> {
    let header = bytes.strip_prefix(PNG_SIGNATURE)?.get(4..)?.strip_prefix(b"IHDR")?;
    let (&[a, b, c, d, e, f, g, h], _) = header.split_first_chunk()?;
    Some((u32::from_be_bytes([a, b, c, d]), u32::from_be_bytes([e, f, g, h])))
}

impl<'a> Png<'a> {
    /// Reads the file up to its pixels. An unpacked profile and a row together take at most `max_bytes`.
    pub(super) fn open(bytes: &'a [u8], max_bytes: usize) -> Result<Self, Error> {
        let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: max_bytes });
        decoder.set_ignore_text_chunk(true);
        decoder.set_transformations(Transformations::EXPAND);
        decoder.read_info().map(Self).map_err(wrong)
    }
}

impl Bitmap for Png<'_> {
    fn size(&self) -> (u32, u32) {
        self.0.info().size()
    }

    fn profile(&mut self) -> Option<Vec<u8>> {
        self.0.info().icc_profile.as_deref().map(<[u8]>::to_vec)
    }

    fn exif(&mut self) -> Option<Vec<u8>> {
        self.0.info().exif_metadata.as_deref().map(<[u8]>::to_vec)
    }

    fn decode(mut self: Box<Self>, to: &mut Pixmap) -> Result<(), Error> {
        // The decoder (png 0.18) panics on a partial colour.
        let info = self.0.info();
        if info.color_type == ColorType::Indexed && info.palette.as_deref().is_some_and(|p| p.len() % 3 != 0) {
            return Err(undecodable("PNG", "its palette ends within a colour"));
        }
        let (color, depth) = self.0.output_color_type();
        if (color, depth) == (ColorType::Rgba, BitDepth::Eight) {
            self.0.next_frame(to.data_mut()).map_err(wrong)?;
            premultiply(to);
            return Ok(());
        }
        let size = self.0.output_buffer_size().ok_or_else(|| wrong(DecodingError::LimitsExceeded))?;
        let mut samples = vec![0; size];
        self.0.next_frame(&mut samples).map_err(wrong)?;
        // Samples of sixteen bits are two bytes each.
        match (color, depth) {
            (ColorType::Grayscale, BitDepth::Sixteen) => set_opaque(to, &samples, |[v, w]| [eight(v, w); 3]),
            (ColorType::Grayscale, _) => set_opaque(to, &samples, |[v]| [v; 3]),
            (ColorType::GrayscaleAlpha, BitDepth::Sixteen) => set_straight(to, &samples, |[v, w, a, b]| {
                let v = eight(v, w);
                [v, v, v, eight(a, b)]
            }),
            (ColorType::GrayscaleAlpha, _) => set_straight(to, &samples, |[v, a]| [v, v, v, a]),
            (ColorType::Rgb, BitDepth::Sixteen) => {
                set_opaque(to, &samples, |[r, s, g, h, b, c]| [eight(r, s), eight(g, h), eight(b, c)]);
            }
            (ColorType::Rgb, _) => set_opaque(to, &samples, |rgb| rgb),
            (ColorType::Rgba, _) => set_straight(to, &samples, |[r, s, g, h, b, c, a, z]| {
                [eight(r, s), eight(g, h), eight(b, c), eight(a, z)]
            }),
            // The decoder expands palettes.
            (ColorType::Indexed, _) => return Err(undecodable("PNG", "its colours are left as numbers")),
        }
        Ok(())
    }
}

/// Rounds a sample of sixteen bits, in units of 1/65535, to eight bits, in units of 1/255.
#[inline]
fn eight(high: u8, low: u8) -> u8 {
    ((u32::from(u16::from_be_bytes([high, low])) + 128) / 257) as u8
}

fn wrong(why: DecodingError) -> Error {
    undecodable("PNG", why)
}
