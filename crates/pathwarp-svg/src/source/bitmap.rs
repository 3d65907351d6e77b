//! Checks bitmaps beyond their headers: packed colour profiles, damage, and missing pixels.

use flate2::Crc;
use flate2::read::ZlibDecoder;
use std::io::{self, Read as _};

const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// Bytes of a chunk's length and name, and of its checksum.
const HEAD: usize = 8;
const CHECKSUM: usize = 4;

/// A chunk of a PNG.
struct Chunk<'a> {
    name: [u8; 4],
    content: &'a [u8],
    /// As the file states it; `None` if the file ends before the chunk does.
    checksum: Option<u32>,
}

impl Chunk<'_> {
    /// Returns `true` if the content is as it was written.
    fn is_intact(&self) -> bool {
        let mut computed = Crc::new();
        computed.update(&self.name);
        computed.update(self.content);
        self.checksum == Some(computed.sum())
    }
}

fn chunks(png: &[u8]) -> impl Iterator<Item = Chunk<'_>> {
    let mut rest = png.strip_prefix(SIGNATURE).unwrap_or_default();
    std::iter::from_fn(move || {
        let (&[a, b, c, d, e, f, g, h], after) = rest.split_first_chunk::<HEAD>()?;
        let length = u32::from_be_bytes([a, b, c, d]) as usize;
        let (content, next) = after.split_at(length.min(after.len()));
        let checksum = next.split_first_chunk::<CHECKSUM>();
        rest = checksum.map_or(&[], |(_, rest)| rest);
        Some(Chunk { name: [e, f, g, h], content, checksum: checksum.map(|(sum, _)| u32::from_be_bytes(*sum)) })
    })
}

/// The bytes of the colour profile of a PNG, unpacked up to one byte more than `most`. Decoders unpack it whenever they open the file.
pub(super) fn unpacked_profile(png: &[u8], most: u64) -> u64 {
    let mut before_pixels = chunks(png).take_while(|c| &c.name != b"IDAT");
    let Some(Chunk { content, .. }) = before_pixels.find(|c| &c.name == b"iCCP") else { return 0 };
    // A name that ends with a zero, and the method.
    let Some(end) = content.iter().position(|b| *b == 0) else { return 0 };
    let packed = content.get(end + 2..).unwrap_or_default();
    let mut counted = Counted(0);
    let _ = io::copy(&mut ZlibDecoder::new(packed).take(most.saturating_add(1)), &mut counted);
    counted.0
}

/// Returns `true` for a PNG that is damaged or lacks pixels, and for a GIF whose first frame is larger than its page: the renderer shows
/// nothing of them, and does not say so. Takes time in proportion to the pixels that the header announces.
pub(super) fn is_unreadable(data: &[u8]) -> bool {
    let is_damaged = || chunks(data).any(|c| matches!(&c.name, b"IHDR" | b"PLTE" | b"IDAT") && !c.is_intact());
    let lacks_pixels = || pixel_bytes(data).is_some_and(|needed| unpacked_pixels(data, needed) < needed);
    data.starts_with(SIGNATURE) && (is_damaged() || cuts_colors(data) || lacks_pixels())
        || is_beyond_page(data).unwrap_or(false)
}

/// Returns `true` if the palette that the pixels refer to ends within a colour. The decoder (png 0.18) panics at it.
fn cuts_colors(png: &[u8]) -> bool {
    let find = |name: &[u8; 4]| chunks(png).find(|c| &c.name == name).map(|c| c.content);
    let is_indexed = find(b"IHDR").is_some_and(|header| header.get(9) == Some(&3));
    is_indexed && find(b"PLTE").is_some_and(|colors| colors.len() % 3 != 0)
}

/// The bytes that the pixels of a PNG take at least, without the filters of the rows; `None` if its header is none.
fn pixel_bytes(png: &[u8]) -> Option<u64> {
    let header = chunks(png).find(|c| &c.name == b"IHDR")?.content;
    let (width, rest) = header.split_first_chunk::<4>()?;
    let (height, rest) = rest.split_first_chunk::<4>()?;
    let [depth, kind, ..] = *rest else { return None };
    let channels = match kind {
        0 | 3 => 1,
        4 => 2,
        2 => 3,
        6 => 4,
        _ => return None,
    };
    let [width, height] = [*width, *height].map(|n| u64::from(u32::from_be_bytes(n)));
    Some(width.checked_mul(height)?.checked_mul(u64::from(depth) * channels)? / 8)
}

/// The bytes of a PNG's pixels that can be unpacked, up to `most`.
fn unpacked_pixels(png: &[u8], most: u64) -> u64 {
    let packed: Vec<u8> = chunks(png).filter(|c| &c.name == b"IDAT").flat_map(|c| c.content).copied().collect();
    let mut counted = Counted(0);
    let _ = io::copy(&mut ZlibDecoder::new(&packed[..]).take(most), &mut counted);
    counted.0
}

/// `None` for other files, and where the first frame is not found.
fn is_beyond_page(gif: &[u8]) -> Option<bool> {
    let size = |at: &[u8]| Some([0, 2].map(|i| u16::from_le_bytes([at[i], at[i + 1]]))).filter(|_| at.len() >= 4);
    let (head, mut rest) = gif.strip_prefix(b"GIF8")?.get(2..)?.split_at_checked(7)?;
    let page = size(head)?;
    if head[4] & 0x80 != 0 {
        rest = rest.get(3 << ((head[4] & 7) + 1)..)?;
    }
    // Extensions, each of blocks with their lengths up to an empty one.
    while let Some(blocks) = rest.strip_prefix(b"!") {
        rest = blocks.get(1..)?;
        while *rest.first()? > 0 {
            rest = rest.get(usize::from(rest[0]) + 1..)?;
        }
        rest = &rest[1..];
    }
    let frame = size(rest.strip_prefix(b",")?.get(4..8)?)?;
    Some(frame[0] > page[0] || frame[1] > page[1])
}

/// Counts what is written, also before an error.
struct Counted(u64);

impl io::Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests;
