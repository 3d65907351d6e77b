//! Pictures to and from PNG files.
//!
//! PNG stores colours as they are, a [`Pixmap`] stores them premultiplied by alpha. Going out and coming back loses
//! nothing (a test walks through every pair of colour and alpha). Coming in and going out again may lose precision of
//! nearly transparent colours, which premultiplied pixels cannot hold.

use crate::{Error, MAX_PIXELS};
use tiny_skia::Pixmap;

/// Every PNG file begins with these bytes.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// The first chunk of a PNG file: its length and name, which the format fixes. Width and height follow.
const HEADER: &[u8] = b"\x00\x00\x00\x0dIHDR";

/// Writes a picture as an RGBA PNG.
pub fn encode_png(pixmap: &Pixmap) -> Result<Vec<u8>, Error> {
    pixmap.encode_png().map_err(|error| Error::Encode(error.to_string()))
}

/// Reads a PNG of any colour type, at 8 bits per channel. Refused when it has more than [`MAX_PIXELS`] pixels, before
/// any memory is taken for them.
pub fn decode_png(bytes: &[u8]) -> Result<Pixmap, Error> {
    let (width, height) =
        declared_size(bytes).ok_or_else(|| Error::Decode("it does not begin like a PNG file".to_owned()))?;
    if u64::from(width) * u64::from(height) > u64::from(MAX_PIXELS) {
        return Err(Error::TooLarge { width: f64::from(width), height: f64::from(height) });
    }
    Pixmap::decode_png(bytes).map_err(|error| Error::Decode(error.to_string()))
}

/// Width and height as the file's header has them.
fn declared_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let rest = bytes.strip_prefix(SIGNATURE)?.strip_prefix(HEADER)?;
    let (width, rest) = rest.split_first_chunk::<4>()?;
    let (height, _) = rest.split_first_chunk::<4>()?;
    Some((u32::from_be_bytes(*width), u32::from_be_bytes(*height)))
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
    fn alpha_is_premultiplied_when_read() {
        let mut pixmap = Pixmap::new(1, 1).unwrap();
        pixmap.fill(tiny_skia::Color::from_rgba8(255, 0, 0, 128));
        let png = encode_png(&pixmap).unwrap();
        let back = decode_png(&png).unwrap();
        assert_eq!(back.pixel(0, 0).map(|p| (p.red(), p.alpha())), Some((128, 128)));
    }

    #[test]
    fn a_bomb_is_refused_before_it_is_unpacked() {
        let mut bytes = SIGNATURE.to_vec();
        bytes.extend_from_slice(HEADER);
        bytes.extend_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 8, 6, 0, 0, 0, 0, 0, 0, 0]);
        assert!(matches!(decode_png(&bytes), Err(Error::TooLarge { .. })));
    }

    #[test]
    fn a_cut_file_is_an_error() {
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
