//! Encodes and decodes PNG.
//!
//! PNG stores straight colours, a [`Pixmap`] premultiplied ones. Encoding and decoding a [`Pixmap`] is lossless (a test covers
//! every pair of colour and alpha). Decoding and encoding a PNG may lose precision in nearly transparent colours.

use crate::error::Error;
use crate::picture::{PNG_SIGNATURE, Picture};
use tiny_skia::Pixmap;

/// Encodes a picture as RGBA PNG.
///
/// # Errors
/// [`Error::Encode`].
pub fn encode_png(pixmap: &Pixmap) -> Result<Vec<u8>, Error> {
    pixmap.encode_png().map_err(|error| Error::Encode(error.to_string()))
}

/// Decodes a PNG of any colour type to 8 bits per channel.
///
/// # Errors
/// [`Error::Decode`] for other and damaged files; [`Error::TooLarge`] above the default limits, before any
/// memory is allocated for the pixels.
pub fn decode_png(bytes: &[u8]) -> Result<Pixmap, Error> {
    if !bytes.starts_with(PNG_SIGNATURE) {
        return Err(Error::Decode("not a PNG file".to_owned()));
    }
    Picture::read_stored(bytes).map(|picture| picture.pixmap)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use tiny_skia::PremultipliedColorU8;

    #[test]
    fn every_premultiplied_colour_survives() {
        let mut pixmap = Pixmap::new(256, 256).unwrap();
        for (i, pixel) in (0u32..).zip(pixmap.pixels_mut()) {
            let (alpha, channel) = ((i / 256) as u8, (i % 256) as u8);
            if let Some(color) = PremultipliedColorU8::from_rgba(channel, channel / 2, 0, alpha) {
                *pixel = color;
            }
        }
        let back = decode_png(&encode_png(&pixmap).unwrap()).unwrap();
        assert!(pixmap.pixels() == back.pixels());
    }

    #[test]
    fn alpha_is_premultiplied_when_decoded() {
        let mut pixmap = Pixmap::new(1, 1).unwrap();
        pixmap.fill(tiny_skia::Color::from_rgba8(255, 0, 0, 128));
        let png = encode_png(&pixmap).unwrap();
        let back = decode_png(&png).unwrap();
        assert_eq!(back.pixel(0, 0).map(|p| (p.red(), p.alpha())), Some((128, 128)));
    }

    /// The checksum of a chunk (PNG specification, annex D).
    fn crc(chunk: &[u8]) -> u32 {
        !chunk.iter().fold(!0, |crc, byte| {
            (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
        })
    }

    #[test]
    fn a_bomb_is_rejected_before_it_is_unpacked() {
        let mut bytes = encode_png(&Pixmap::new(1, 1).unwrap()).unwrap();
        // Replace width and height in the header chunk, which follows the signature and a length word, and fix its checksum.
        let side = 100_000_u32.to_be_bytes();
        bytes[16..24].copy_from_slice(&[side, side].concat());
        let checksum = crc(&bytes[12..29]).to_be_bytes();
        bytes[29..33].copy_from_slice(&checksum);
        assert!(matches!(decode_png(&bytes), Err(Error::TooLarge { .. })));
    }

    #[test]
    fn a_truncated_file_is_an_error() {
        let png = encode_png(&Pixmap::new(5, 5).unwrap()).unwrap();
        for end in 0..png.len() - 16 {
            assert!(matches!(decode_png(&png[..end]), Err(Error::Decode(_))), "{end} bytes");
        }
    }

    proptest! {
        #[test]
        fn damaged_files_never_panic(at in 8usize..60, byte: u8) {
            let mut png = encode_png(&Pixmap::new(3, 2).unwrap()).unwrap();
            let at = at % png.len();
            png[at] = byte;
            let _ = decode_png(&png);
        }
    }
}
