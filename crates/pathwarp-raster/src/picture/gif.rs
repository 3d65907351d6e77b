//! Reads the first frame of a GIF, placed on a transparent page.

use super::bitmap::{Bitmap, undecodable};
use crate::error::Error;
use gif::{DecodeOptions, Decoder, DecodingError};
use tiny_skia::{ColorU8, Pixmap, PremultipliedColorU8};

/// An opened GIF.
pub(super) struct Gif<'a> {
    decoder: Decoder<&'a [u8]>,
    /// Largest number of bytes of a frame that is larger than the page.
    max_bytes: usize,
}

impl<'a> Gif<'a> {
    /// Reads the header.
    pub(super) fn open(bytes: &'a [u8], max_bytes: usize) -> Result<Self, Error> {
        let decoder = DecodeOptions::new().read_info(bytes).map_err(wrong)?;
        Ok(Self { decoder, max_bytes })
    }
}

impl Bitmap for Gif<'_> {
    fn size(&self) -> (u32, u32) {
        (u32::from(self.decoder.width()), u32::from(self.decoder.height()))
    }

    fn profile(&mut self) -> Option<Vec<u8>> {
        self.decoder.icc_profile().map(<[u8]>::to_vec)
    }

    fn decode(mut self: Box<Self>, to: &mut Pixmap) -> Result<(), Error> {
        let frame = self.decoder.next_frame_info().map_err(wrong)?;
        let frame = frame.ok_or_else(|| undecodable("GIF", "it has no frame"))?;
        let [left, top, width, height] = [frame.left, frame.top, frame.width, frame.height].map(usize::from);
        let transparent = frame.transparent;
        let area = width.saturating_mul(height);
        if area == 0 || area > self.max_bytes.max(to.pixels().len()) {
            return Err(undecodable("GIF", format!("its first frame has {width} x {height} pixels")));
        }
        let mut colors = [PremultipliedColorU8::TRANSPARENT; 256];
        let (palette, _) = self.decoder.palette().map_err(wrong)?.as_chunks::<3>();
        for (i, (color, [r, g, b])) in (0..=u8::MAX).zip(colors.iter_mut().zip(palette)) {
            if Some(i) != transparent {
                *color = ColorU8::from_rgba(*r, *g, *b, u8::MAX).premultiply();
            }
        }
        let mut indices = vec![0; area];
        self.decoder.read_into_buffer(&mut indices).map_err(wrong)?;
        let page_width = to.width() as usize;
        let rows = to.pixels_mut().chunks_exact_mut(page_width).skip(top);
        for (row, indices) in rows.zip(indices.chunks_exact(width)) {
            for (to, index) in row.iter_mut().skip(left).zip(indices) {
                *to = colors[usize::from(*index)];
            }
        }
        Ok(())
    }
}

fn wrong(why: DecodingError) -> Error {
    undecodable("GIF", why)
}
