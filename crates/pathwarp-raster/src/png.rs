//! Encodes and decodes PNG.
//!
//! PNG stores straight colours, a [`Pixmap`] premultiplied ones. Encoding and decoding a [`Pixmap`] is lossless (a test covers
//! every pair of colour and alpha). Decoding and encoding a PNG may lose precision in nearly transparent colours.

use crate::error::Error;
use crate::picture::{PNG_SIGNATURE, Picture};
use crate::pixmap::straight;
use png::{ColorType, DeflateCompression, Encoder, Filter};
use tiny_skia::Pixmap;

/// Encodes a picture as RGBA PNG.
///
/// # Errors
/// [`Error::Encode`] when the encoder fails.
pub fn encode_png(pixmap: &Pixmap) -> Result<Vec<u8>, Error> {
    pixmap.encode_png().map_err(|error| Error::Encode(error.to_string()))
}

/// Decodes a PNG of any colour type to 8 bits per channel, without applying its orientation.
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

/// Level of compression. Lower levels save little time; higher ones take much longer for files that are hardly smaller.
const LEVEL: u8 = 3;

/// Encodes a picture of smooth colours, as greyscale if it is grey, and without alpha if it is opaque.
///
/// # Errors
/// [`Error::Encode`] when the encoder fails.
pub fn encode_smooth_png(pixmap: &Pixmap) -> Result<Vec<u8>, Error> {
    let pixels = pixmap.pixels();
    let is_opaque = pixels.iter().all(|p| p.alpha() == u8::MAX);
    let is_grey = pixels.iter().all(|p| p.red() == p.green() && p.green() == p.blue());
    let straight = pixels.iter().map(straight);
    let (color, data): (ColorType, Vec<u8>) = match (is_grey, is_opaque) {
        (true, true) => (ColorType::Grayscale, straight.map(|[r, ..]| r).collect()),
        (true, false) => (ColorType::GrayscaleAlpha, straight.flat_map(|[r, _, _, a]| [r, a]).collect()),
        (false, true) => (ColorType::Rgb, straight.flat_map(|[r, g, b, _]| [r, g, b]).collect()),
        (false, false) => (ColorType::Rgba, straight.flatten().collect()),
    };
    let mut out = Vec::new();
    let mut encoder = Encoder::new(&mut out, pixmap.width(), pixmap.height());
    encoder.set_color(color);
    encoder.set_deflate_compression(DeflateCompression::Level(LEVEL));
    // Differences from the row above suit smooth pictures best.
    encoder.set_filter(Filter::Up);
    let written = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(&data)?;
        writer.finish()
    });
    written.map_err(|e| Error::Encode(e.to_string()))?;
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use tiny_skia::{ColorU8, PremultipliedColorU8};

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

    #[test]
    fn pictures_survive_and_have_no_needless_channels() {
        let colors: [fn(u8, u8) -> ColorU8; 4] = [
            |x, _| ColorU8::from_rgba(x * 9, x * 9, x * 9, 255),
            |x, y| ColorU8::from_rgba(x * 9, y * 5, 3, 255),
            |x, y| ColorU8::from_rgba(y, y, y, 200 + x),
            |x, y| ColorU8::from_rgba(x * 9, y * 5, 3, 100 + x),
        ];
        let types = colors.map(|color| {
            let mut pixmap = Pixmap::new(20, 30).unwrap();
            for (p, i) in pixmap.pixels_mut().iter_mut().zip(0_u32..) {
                *p = color((i % 20) as u8, (i / 20) as u8).premultiply();
            }
            let bytes = encode_smooth_png(&pixmap).unwrap();
            assert!(Picture::read(&bytes).unwrap().pixmap == pixmap);
            assert!(bytes.len() < 20 * 30, "{}", bytes.len());
            // The colour type in the header.
            bytes[25]
        });
        assert_eq!(types, [0, 2, 4, 6]);
    }
}
