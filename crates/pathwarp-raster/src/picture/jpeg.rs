//! Reads JPEG: grey, RGB, YCbCr, CMYK and YCCK.

use super::bitmap::{Bitmap, EarlyEnd, set_opaque, undecodable};
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
    let ends_early = matches!(why, DecodeErrors::ExhaustedData | DecodeErrors::IoErrors(_));
    if ends_early {
        undecodable("JPEG", "the file ends early, before its first line")
    } else {
        undecodable("JPEG", why)
    }
}

/// The compression of a JPEG: its quantization tables for brightness and colour, row by row.
pub(super) struct Compression {
    pub(super) tables: [[u16; 64]; 2],
    /// 1 for grey, 3 for colours, 4 for inks.
    pub(super) components: usize,
}

impl Compression {
    /// Reads the segments before the first scan (ISO 10918-1, B.2); `None` for other files.
    pub(super) fn read(bytes: &[u8]) -> Option<Self> {
        let (mut tables, mut frame) = ([None; 4], None);
        for (marker, content) in segments(bytes) {
            match marker {
                0xdb => read_tables(content, &mut tables)?,
                0xc0..=0xc2 => frame = Some(content),
                0xda => break,
                _ => {}
            }
        }
        let components: Vec<&[u8]> = frame?.get(6..)?.chunks_exact(3).collect();
        let table = |component: usize| tables[usize::from(components.get(component)?[2] & 3)];
        let tables = [table(0)?, table(1).or(table(0))?];
        Some(Self { tables, components: components.len() })
    }
}

/// The marked segments of a JPEG with their content, up to the first scan.
fn segments(bytes: &[u8]) -> impl Iterator<Item = (u8, &[u8])> {
    let mut rest = bytes.strip_prefix(b"\xff\xd8").unwrap_or_default();
    std::iter::from_fn(move || {
        while rest.starts_with(b"\xff\xff") {
            rest = &rest[1..];
        }
        let &[0xff, marker, high, low, ..] = rest else { return None };
        let end = 2 + usize::from(u16::from_be_bytes([high, low]));
        let content = rest.get(4..end)?;
        rest = &rest[end..];
        Some((marker, content))
    })
}

/// A JPEG with width and height exchanged in its header.
pub(super) fn with_sides_exchanged(bytes: &[u8]) -> Option<Vec<u8>> {
    let (_, frame) = segments(bytes).find(|(marker, _)| (0xc0..=0xc2).contains(marker))?;
    let start = frame.as_ptr().addr() - bytes.as_ptr().addr();
    let mut out = bytes.to_vec();
    // Height and width, of two bytes each, follow the precision.
    out.get_mut(start + 1..start + 5)?.rotate_left(2);
    Some(out)
}

/// Reads the tables of a DQT segment, whose values go in zigzag order.
fn read_tables(mut content: &[u8], tables: &mut [Option<[u16; 64]>; 4]) -> Option<()> {
    while let Some((&head, rest)) = content.split_first() {
        let is_wide = head >> 4 != 0;
        let values = rest.get(..if is_wide { 128 } else { 64 })?;
        let value =
            |k: usize| if is_wide { u16::from_be_bytes([values[2 * k], values[2 * k + 1]]) } else { values[k].into() };
        let mut table = [0; 64];
        zigzag().zip(0..).for_each(|(index, k)| table[index] = value(k));
        tables[usize::from(head & 3)] = Some(table);
        content = &rest[values.len()..];
    }
    Some(())
}

/// The order in which the values of a block of 8 × 8 are stored, as indices row by row: along diagonals, up and down in turn.
fn zigzag() -> impl Iterator<Item = usize> {
    (0..15).flat_map(|sum: usize| {
        let (first, last) = (sum.saturating_sub(7), sum.min(7));
        let is_upwards = sum.is_multiple_of(2);
        (first..=last).map(move |row| {
            let row = if is_upwards { last - (row - first) } else { row };
            row * 8 + (sum - row)
        })
    })
}

/// The storage of the lines of a JPEG.
#[derive(Default)]
struct Layout {
    /// `true` if the end is marked.
    has_end: bool,
    /// `true` if all data of a line are stored together, not in several scans.
    in_one_pass: bool,
    /// Number of lines that are stored together.
    lines_together: u32,
}

/// Reads the layout from the markers of a JPEG, as far as they go.
fn layout(bytes: &[u8]) -> Layout {
    let (mut out, mut position, mut components) = (Layout::default(), 2, 0);
    while let Some(&[0xff, marker]) = bytes.get(position..).and_then(|b| b.first_chunk()) {
        let segment = bytes.get(position + 2..).and_then(|b| b.first_chunk());
        let segment = segment.map_or(0, |length| usize::from(u16::from_be_bytes(*length)));
        let content = bytes.get(position + 4..).unwrap_or_default();
        match marker {
            0xd9 => return Layout { has_end: true, ..out },
            // Frames, of which the third is progressive: precision, height, width, and three bytes for each component, of which the
            // second has the lines stored together, in eights, in its lower half.
            0xc0..=0xc2 => {
                components = content.get(5).copied().unwrap_or(0);
                let factors = content.get(6..).unwrap_or_default().chunks(3).take(components.into());
                let most = factors.filter_map(|c| c.get(1)).map(|f| f & 15).max();
                out.lines_together = 8 * u32::from(most.unwrap_or(1).max(1));
                out.in_one_pass = marker < 0xc2;
            }
            0xda => out.in_one_pass &= content.first() == Some(&components),
            _ => {}
        }
        position += match marker {
            0xff => 1,
            0x00 | 0x01 | 0xd0..=0xd8 => 2,
            _ => 2 + segment,
        };
        // Data, up to the next marker.
        position += bytes.get(position..).map_or(0, |rest| rest.iter().position(|b| *b == 0xff).unwrap_or(rest.len()));
    }
    out
}

/// Returns the extent of a JPEG that ends early, and clears the missing lines.
pub(super) fn early_end(bytes: &[u8], decoded: &mut Pixmap) -> Option<EarlyEnd> {
    /// The decoder's mark of missing lines (zune-jpeg 0.5).
    const MISSING: [u8; 4] = [128, 128, 128, 255];
    let layout = layout(bytes);
    if layout.has_end {
        return None;
    }
    let of = decoded.height();
    if !layout.in_one_pass {
        return Some(EarlyEnd { lines: None, of });
    }
    let row = 4 * decoded.width() as usize;
    let is_missing = |line: &&[u8]| line.as_chunks().0.iter().all(|p| *p == MISSING);
    let missing = decoded.data().rchunks_exact(row).take_while(is_missing).count();
    // If only the mark of the end is missing, nothing is lost.
    let decoded_lines = of.checked_sub(u32::try_from(missing).ok()?).filter(|n| *n < of)?;
    // Of the last lines that are stored together, some are missing.
    let lines = decoded_lines.saturating_sub(layout.lines_together);
    decoded.data_mut()[row * lines as usize..].fill(0);
    Some(EarlyEnd { lines: Some(lines), of })
}

#[cfg(test)]
mod tests {
    use crate::Picture;
    use jpeg_encoder::{ColorType, Encoder, SamplingFactor};

    /// A JPEG of 64 × 96 pixels of noise.
    fn noise(factor: SamplingFactor, scans: Option<u8>, color: (ColorType, usize)) -> Vec<u8> {
        let mut n = 1u32;
        let mut random = || {
            n = n.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (n >> 24) as u8
        };
        let samples: Vec<u8> = (0..64 * 96 * color.1).map(|_| random()).collect();
        let mut out = Vec::new();
        let mut encoder = Encoder::new(&mut out, 90);
        encoder.set_sampling_factor(factor);
        scans.into_iter().for_each(|n| encoder.set_progressive_scans(n));
        encoder.encode(&samples, 64, 96, color.0).unwrap();
        out
    }

    /// Wherever a file is cut, the reported lines equal the lines of the whole file.
    #[test]
    fn lines_before_the_cut_are_right() {
        let kinds = [
            (SamplingFactor::F_1_1, (ColorType::Rgb, 3), 8),
            (SamplingFactor::F_2_2, (ColorType::Rgb, 3), 16),
            (SamplingFactor::F_1_1, (ColorType::Luma, 1), 8),
        ];
        for (factor, color, together) in kinds {
            let whole = noise(factor, None, color);
            let expected = Picture::read(&whole).unwrap();
            assert_eq!(expected.early_end, None);
            let mut most = 0;
            for cut in (1000..whole.len() - 2).step_by(whole.len() / 40) {
                let found = Picture::read(&whole[..cut]).unwrap();
                let Some(end) = found.early_end else {
                    // Cut in the data of the last lines.
                    assert!(cut as f64 > whole.len() as f64 * 0.8, "{cut} of {}", whole.len());
                    continue;
                };
                let lines = end.lines.unwrap();
                assert!(end.of == 96 && lines >= most, "{end}");
                // At most two groups of lines that are stored together are not counted.
                assert!(lines + 2 * together > 96 * cut as u32 / whole.len() as u32, "{cut}: {end}");
                let (there, missing) = found.pixmap.data().split_at(lines as usize * 64 * 4);
                assert!(expected.pixmap.data().starts_with(there), "{cut}: {end}");
                assert!(missing.iter().all(|b| *b == 0));
                most = lines;
            }
            assert!(most + 2 * together + 2 >= 96, "{most}");
        }
    }

    #[test]
    fn a_progressive_file_lacks_details() {
        let whole = noise(SamplingFactor::F_1_1, Some(6), (ColorType::Rgb, 3));
        assert_eq!(Picture::read(&whole).unwrap().early_end, None);
        let cut = Picture::read(&whole[..whole.len() / 2]).unwrap().early_end.unwrap();
        assert_eq!(cut.to_string(), "ends early, before all details of its 96 lines");
    }
}
