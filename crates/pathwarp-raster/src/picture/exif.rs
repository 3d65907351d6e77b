//! Reads and edits EXIF metadata, which are a TIFF file: a header, then directories of entries, whose values are at offsets from the start.
//!
//! [`edited`] changes entries in place, so that offsets in the notes of camera makers stay right.

use std::ops::Range;

/// Tags of TIFF and EXIF 2.32.
const IMAGE_WIDTH: u16 = 0x0100;
const IMAGE_LENGTH: u16 = 0x0101;
const ORIENTATION: u16 = 0x0112;
const EXIF_DIRECTORY: u16 = 0x8769;
const GPS_DIRECTORY: u16 = 0x8825;
const PIXEL_X_DIMENSION: u16 = 0xa002;
const PIXEL_Y_DIMENSION: u16 = 0xa003;
const INTEROPERABILITY_DIRECTORY: u16 = 0xa005;

/// Types of numbers of 16 and 32 bits.
const SHORT: u16 = 3;
const LONG: u16 = 4;
/// Bytes of a value of each type; types are numbered from 1.
const TYPE_SIZES: [usize; 13] = [1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4];

/// Bytes of an entry: tag (2), type (2), count (4), and the value or its offset (4).
const ENTRY: usize = 12;
/// Precedes the TIFF file in a JPEG, and sometimes in other formats.
const PREFIX: &[u8] = b"Exif\0\0";
/// Most bytes of a TIFF file in a JPEG: 65,535 of a segment, less its length (2) and the prefix (6).
const MAX_BYTES: usize = 65_527;

/// A TIFF file.
#[derive(Clone)]
struct Tiff {
    bytes: Vec<u8>,
    is_little: bool,
}

/// An entry of a directory.
#[derive(Clone, Copy)]
struct Entry {
    /// Offset of the entry in the file.
    start: usize,
    tag: u16,
    /// The type of its values.
    kind: u16,
    count: u32,
}

impl Tiff {
    fn parse(exif: &[u8]) -> Option<Self> {
        let bytes = exif.strip_prefix(PREFIX).unwrap_or(exif);
        let is_little = match bytes.get(..4)? {
            b"II\x2a\0" => true,
            b"MM\0\x2a" => false,
            _ => return None,
        };
        Some(Self { bytes: bytes.to_vec(), is_little })
    }

    fn short(&self, at: usize) -> Option<u16> {
        let (two, _) = self.bytes.get(at..)?.split_first_chunk()?;
        Some(if self.is_little { u16::from_le_bytes(*two) } else { u16::from_be_bytes(*two) })
    }

    fn long(&self, at: usize) -> Option<u32> {
        let (four, _) = self.bytes.get(at..)?.split_first_chunk()?;
        Some(if self.is_little { u32::from_le_bytes(*four) } else { u32::from_be_bytes(*four) })
    }

    fn offset(&self, at: usize) -> Option<usize> {
        usize::try_from(self.long(at)?).ok()
    }

    fn write_short(&mut self, at: usize, n: u16) {
        let two = if self.is_little { n.to_le_bytes() } else { n.to_be_bytes() };
        self.bytes.splice(at..at + 2, two);
    }

    fn write_long(&mut self, at: usize, n: u32) {
        let four = if self.is_little { n.to_le_bytes() } else { n.to_be_bytes() };
        self.bytes.splice(at..at + 4, four);
    }

    /// The entries of a directory that lie in the file, up to the first that does not.
    fn entries(&self, directory: usize) -> impl Iterator<Item = Entry> {
        let entry = move |i: usize| {
            let start = directory.checked_add(2 + ENTRY * i)?;
            self.long(start + 8)?;
            Some(Entry { start, tag: self.short(start)?, kind: self.short(start + 2)?, count: self.long(start + 4)? })
        };
        (0..usize::from(self.short(directory).unwrap_or(0))).map_while(entry)
    }

    /// The bytes of a directory with the offset of the next one; `None` if the file ends within its entries.
    fn extent(&self, directory: usize) -> Option<Range<usize>> {
        let end = directory.checked_add(2 + ENTRY * usize::from(self.short(directory)?))?;
        (end <= self.bytes.len()).then(|| directory..(end + 4).min(self.bytes.len()))
    }

    /// The directory that an entry leads to.
    fn directory(&self, from: usize, tag: u16) -> Option<usize> {
        let entry = self.entries(from).find(|e| e.tag == tag)?;
        self.offset(entry.start + 8)
    }

    /// The bytes of the values that do not fit into the entries of a directory.
    fn value_ranges(&self, directory: usize) -> impl Iterator<Item = Range<usize>> {
        self.entries(directory).filter_map(|e| {
            let size = TYPE_SIZES.get(usize::from(e.kind).checked_sub(1)?)?;
            let length = size.checked_mul(usize::try_from(e.count).ok()?)?;
            let start = self.offset(e.start + 8)?;
            let end = start.checked_add(length)?;
            (length > 4 && end <= self.bytes.len()).then_some(start..end)
        })
    }

    /// Writes a number into the entries of a directory that have this tag.
    fn set(&mut self, directory: usize, tag: u16, kind: u16, n: u32) {
        let starts: Vec<usize> = self.entries(directory).filter(|e| e.tag == tag).map(|e| e.start).collect();
        for start in starts {
            self.write_short(start + 2, kind);
            self.write_long(start + 4, 1);
            self.write_long(start + 8, n);
            if kind == SHORT {
                // The value is in the first two bytes of four.
                self.write_short(start + 8, n as u16);
                self.write_short(start + 10, 0);
            }
        }
    }

    /// Removes the entries of a directory that have this tag, unless the directory is cut short; later entries move up.
    fn remove(&mut self, directory: usize, tag: u16) {
        let Some(extent) = self.extent(directory) else { return };
        let starts: Vec<usize> = self.entries(directory).filter(|e| e.tag == tag).map(|e| e.start).collect();
        for start in starts.iter().rev() {
            self.bytes.copy_within(start + ENTRY..extent.end, *start);
            self.bytes[extent.end - ENTRY..extent.end].fill(0);
        }
        let left = self.entries(directory).count().saturating_sub(starts.len());
        self.write_short(directory, u16::try_from(left).unwrap_or(0));
    }

    /// Keeps only the header, these directories and their values; anything else becomes zeros, or is cut off at the end.
    fn keep_only(&mut self, directories: &[usize]) {
        let ranges = |d: &usize| self.extent(*d).into_iter().chain(self.value_ranges(*d)).collect::<Vec<_>>();
        let mut kept: Vec<Range<usize>> = std::iter::once(0..8).chain(directories.iter().flat_map(ranges)).collect();
        kept.sort_by_key(|r| r.start);
        let mut end = 0;
        for range in kept {
            if range.start > end {
                self.bytes[end..range.start].fill(0);
            }
            end = end.max(range.end);
        }
        self.bytes.truncate(end);
    }
}

/// Finds the number of the orientation, from 1 (upright) to 8.
pub(super) fn orientation(exif: &[u8]) -> Option<u16> {
    let tiff = Tiff::parse(exif)?;
    let mut entries = tiff.entries(tiff.offset(4)?);
    let entry = entries.find(|e| (e.tag, e.kind, e.count) == (ORIENTATION, SHORT, 1))?;
    tiff.short(entry.start + 8)
}

/// The metadata for an upright picture of another size, without the thumbnail and, unless `keep_location`, the geographic position.
/// `None` if they are damaged, or too long for a JPEG.
pub(super) fn edited(exif: &[u8], (width, height): (u32, u32), keep_location: bool) -> Option<Vec<u8>> {
    let mut tiff = Tiff::parse(exif).filter(|t| t.bytes.len() <= MAX_BYTES)?;
    let first = tiff.offset(4)?;
    let end = tiff.extent(first)?.end;
    tiff.set(first, ORIENTATION, SHORT, 1);
    tiff.set(first, IMAGE_WIDTH, LONG, width);
    tiff.set(first, IMAGE_LENGTH, LONG, height);
    // The next directory is the thumbnail's.
    let after_entries = first + 2 + ENTRY * usize::from(tiff.short(first)?);
    tiff.bytes[after_entries..end].fill(0);
    let mut kept = vec![first];
    if let Some(exif) = tiff.directory(first, EXIF_DIRECTORY) {
        tiff.extent(exif)?;
        tiff.set(exif, PIXEL_X_DIMENSION, LONG, width);
        tiff.set(exif, PIXEL_Y_DIMENSION, LONG, height);
        kept.push(exif);
        kept.extend(tiff.directory(exif, INTEROPERABILITY_DIRECTORY));
    }
    if keep_location {
        kept.extend(tiff.directory(first, GPS_DIRECTORY));
    } else {
        tiff.remove(first, GPS_DIRECTORY);
    }
    tiff.keep_only(&kept);
    Some(tiff.bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A directory with every tag that is looked at, whose pointers lead anywhere.
    fn hostile() -> impl Strategy<Value = Vec<u8>> {
        const TAGS: [u16; 6] =
            [IMAGE_WIDTH, ORIENTATION, EXIF_DIRECTORY, GPS_DIRECTORY, INTEROPERABILITY_DIRECTORY, 0x0201];
        let entry = (prop::sample::select(&TAGS[..]), 0u16..15, prop_oneof![0u32..40, any::<u32>()], 0u32..200);
        let entries = prop::collection::vec(entry, 0..9);
        (entries, any::<bool>(), prop_oneof![0u16..12, any::<u16>()], prop::collection::vec(any::<u8>(), 0..60))
            .prop_map(|(entries, is_little, count, rest)| {
                let mut tiff = Tiff { bytes: vec![0; 10], is_little };
                tiff.bytes[..4].copy_from_slice(if is_little { b"II\x2a\0" } else { b"MM\0\x2a" });
                tiff.write_long(4, 8);
                tiff.write_short(8, count);
                for (tag, kind, count, value) in entries {
                    let at = tiff.bytes.len();
                    tiff.bytes.resize(at + ENTRY, 0);
                    tiff.write_short(at, tag);
                    tiff.write_short(at + 2, kind);
                    tiff.write_long(at + 4, count);
                    tiff.write_long(at + 8, value);
                }
                tiff.bytes.extend(rest);
                tiff.bytes
            })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// Nothing that a file says makes the result longer, or leaves a geographic position in its first directory.
        #[test]
        fn any_metadata_are_edited_or_refused(exif in hostile(), keeps in any::<bool>()) {
            let _ = orientation(&exif);
            if let Some(out) = edited(&exif, (640, 480), keeps) {
                prop_assert!(out.len() <= exif.len());
                let again = edited(&out, (640, 480), keeps);
                prop_assert!(again.is_none_or(|a| a.len() <= out.len()));
            }
        }
    }

    #[test]
    fn the_largest_directory_takes_no_time() {
        let mut exif = b"MM\0\x2a\0\0\0\x08\x15\x50".to_vec();
        for _ in 0..0x1550 {
            // Each has a value that is nearly all of the file.
            exif.extend(b"\x88\x26\0\x07\0\0\xff\0\0\0\0\0");
        }
        exif.extend([0; 4]);
        assert_eq!(edited(&exif, (1, 1), false).map(|out| out.len()), Some(exif.len()));
        exif.resize(MAX_BYTES + 1, 0);
        assert_eq!(edited(&exif, (1, 1), false), None);
    }
}
