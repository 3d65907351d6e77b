//! Reads WebP. Of an animation, the first frame is read.

use super::bitmap::{Bitmap, premultiply, set_opaque, undecodable};
use crate::error::Error;
use image_webp::{DecodingError, WebPDecoder};
use std::io::Cursor;
use tiny_skia::Pixmap;

/// An opened WebP.
pub(super) struct WebP<'a> {
    decoder: WebPDecoder<Cursor<&'a [u8]>>,
    bytes: &'a [u8],
}

impl<'a> WebP<'a> {
    /// Reads the file up to its pixels.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Error> {
        let mut decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(wrong)?;
        // Metadata are not compressed, so none can be longer than the file.
        decoder.set_memory_limit(bytes.len());
        Ok(Self { decoder, bytes })
    }
}

impl Bitmap for WebP<'_> {
    fn size(&self) -> (u32, u32) {
        self.decoder.dimensions()
    }

    fn profile(&mut self) -> Option<Vec<u8>> {
        self.decoder.icc_profile().ok().flatten()
    }

    fn exif(&mut self) -> Option<Vec<u8>> {
        let found = self.decoder.exif_metadata().ok().flatten();
        // A file that announces metadata but ends before them has empty ones.
        found.or_else(|| announces_exif(self.bytes).then(Vec::new))
    }

    fn decode(mut self: Box<Self>, to: &mut Pixmap) -> Result<(), Error> {
        if self.decoder.is_animated() && first_frame_fits(self.bytes) == Some(false) {
            return Err(undecodable("WebP", "the picture in its first frame has another size than the frame"));
        }
        if self.decoder.has_alpha() {
            self.decoder.read_image(to.data_mut()).map_err(wrong)?;
            premultiply(to);
        } else {
            let size = self.decoder.output_buffer_size().ok_or_else(|| wrong(DecodingError::ImageTooLarge))?;
            let mut samples = vec![0; size];
            self.decoder.read_image(&mut samples).map_err(wrong)?;
            set_opaque(to, &samples, |rgb| rgb);
        }
        Ok(())
    }
}

/// Returns `true` if the first frame of an animation has the size of the picture with transparency in it; otherwise the decoder
/// (image-webp 0.2) panics. `None` if there is no such picture.
fn first_frame_fits(bytes: &[u8]) -> Option<bool> {
    let (_, frame) = chunks(bytes.get(12..)?).find(|(name, _)| name == b"ANMF")?;
    let (head, parts) = frame.split_at_checked(16)?;
    let mut parts = chunks(parts);
    let (_, picture) = parts.next().filter(|(name, _)| name == b"ALPH").and_then(|_| parts.next())?;
    // The frame stores each side less one in three bytes; the picture, in 14 bits after a tag and a signature of three bytes each.
    let (&[.., a, b, c, d, e, f], _) = head.split_first_chunk::<12>()?;
    let frame = [[a, b, c, 0], [d, e, f, 0]].map(|side| u32::from_le_bytes(side) + 1);
    let (&[.., a, b, c, d], _) = picture.split_first_chunk::<10>()?;
    Some([[a, b], [c, d]].map(|side| u32::from(u16::from_le_bytes(side) & 0x3fff)) == frame)
}

/// Returns `true` if the header says that there are EXIF data.
fn announces_exif(bytes: &[u8]) -> bool {
    /// The flag for EXIF data.
    const EXIF: u8 = 8;
    let first = bytes.get(12..).and_then(|b| chunks(b).next());
    first.is_some_and(|(name, data)| &name == b"VP8X" && data.first().is_some_and(|flags| flags & EXIF != 0))
}

/// Lists the chunks of a RIFF file with their names. The last one may be cut short.
fn chunks(mut bytes: &[u8]) -> impl Iterator<Item = ([u8; 4], &[u8])> {
    std::iter::from_fn(move || {
        let (&[a, b, c, d, e, f, g, h], rest) = bytes.split_first_chunk()?;
        let size = u32::from_le_bytes([e, f, g, h]) as usize;
        // Chunks are padded to an even size.
        bytes = rest.get(size.saturating_add(size % 2)..).unwrap_or_default();
        Some(([a, b, c, d], rest.get(..size).unwrap_or(rest)))
    })
}

fn wrong(why: DecodingError) -> Error {
    undecodable("WebP", why)
}
