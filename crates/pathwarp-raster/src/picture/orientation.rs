//! Reads the EXIF orientation of a photograph, and turns the picture upright.

use super::exif;
use crate::error::Error;
use crate::pixmap::new_pixmap;
use pathwarp::budget::Limits;
use tiny_skia::Pixmap;

/// The operation that turns a stored picture upright: mirrors it along its axes, then swaps rows and columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Orientation {
    mirror_x: bool,
    mirror_y: bool,
    /// `true` if width and height are exchanged.
    pub(super) transpose: bool,
}

impl Orientation {
    /// Reads the orientation, a number `n` from 1 to 8, from EXIF metadata, which are a TIFF file; upright if there is none.
    pub(super) fn of_exif(metadata: &[u8]) -> Self {
        exif::orientation(metadata).map_or_else(Self::default, |n| Self {
            mirror_x: matches!(n, 2 | 3 | 7 | 8),
            mirror_y: matches!(n, 3 | 4 | 6 | 7),
            transpose: matches!(n, 5..=8),
        })
    }

    /// Turns a picture upright.
    pub(super) fn apply(self, stored: Pixmap, limits: &Limits) -> Result<Pixmap, Error> {
        if self == Self::default() {
            return Ok(stored);
        }
        let [width, height] = [stored.width(), stored.height()];
        let (columns, rows) = if self.transpose { (height, width) } else { (width, height) };
        let mut upright = new_pixmap(f64::from(columns), f64::from(rows), limits)?;
        let [width, height] = [width, height].map(|n| n as usize);
        let pixels = stored.pixels();
        for (y, row) in upright.pixels_mut().chunks_exact_mut(columns as usize).enumerate() {
            for (x, pixel) in row.iter_mut().enumerate() {
                let (x, y) = if self.transpose { (y, x) } else { (x, y) };
                let x = if self.mirror_x { width - 1 - x } else { x };
                let y = if self.mirror_y { height - 1 - y } else { y };
                *pixel = pixels[y * width + x];
            }
        }
        Ok(upright)
    }
}

#[cfg(test)]
mod tests {
    use super::exif::orientation as number;
    use super::*;
    use tiny_skia::PremultipliedColorU8;

    /// A TIFF file with entries of a tag, a type, a count and a value each.
    fn tiff(is_little: bool, entries: &[(u16, u16, u32, u16)]) -> Vec<u8> {
        let short = |n: u16| if is_little { n.to_le_bytes() } else { n.to_be_bytes() };
        let long = |n: u32| if is_little { n.to_le_bytes() } else { n.to_be_bytes() };
        let mut out = if is_little { b"II\x2a\0".to_vec() } else { b"MM\0\x2a".to_vec() };
        // The directory follows two bytes of something else.
        out.extend(long(10));
        out.extend([0xaa, 0xbb]);
        out.extend(short(entries.len() as u16));
        for (tag, kind, count, value) in entries {
            out.extend([short(*tag), short(*kind)].concat());
            out.extend(long(*count));
            out.extend([short(*value), short(0)].concat());
        }
        out
    }

    #[test]
    fn the_number_is_found() {
        for is_little in [false, true] {
            let other = (0x010f, 2, 1, 65);
            assert_eq!(number(&tiff(is_little, &[other, (0x0112, 3, 1, 6)])), Some(6));
            assert_eq!(number(&tiff(is_little, &[other])), None);
            // A number of 32 bits does not count, nor do two numbers.
            assert_eq!(number(&tiff(is_little, &[(0x0112, 4, 1, 6)])), None);
            assert_eq!(number(&tiff(is_little, &[(0x0112, 3, 2, 6)])), None);
            let whole = tiff(is_little, &[other, (0x0112, 3, 1, 6)]);
            for end in 0..whole.len() {
                assert_eq!(number(&whole[..end]), None, "{end}");
            }
        }
        assert_eq!(number(b"MM\0\x2a\xff\xff\xff\xff\0\x01\x01\x12"), None);
        assert_eq!(number(b"II\0\x2a\x08\0\0\0"), None);
    }

    /// The stored picture is `ab` over `cd` over `ef`. EXIF 2.32, 4.6.4.A, gives for each number the sides at which the first row and
    /// the first column are.
    #[test]
    fn every_orientation() {
        let upright = [
            (0, "ab cd ef"),
            (1, "ab cd ef"),
            (2, "ba dc fe"),
            (3, "fe dc ba"),
            (4, "ef cd ab"),
            (5, "ace bdf"),
            (6, "eca fdb"),
            (7, "fdb eca"),
            (8, "bdf ace"),
            (9, "ab cd ef"),
        ];
        let mut stored = Pixmap::new(2, 3).unwrap();
        for (pixel, letter) in stored.pixels_mut().iter_mut().zip(b'a'..) {
            *pixel = PremultipliedColorU8::from_rgba(letter, 0, 0, 255).unwrap();
        }
        for (n, expected) in upright {
            let orientation = Orientation::of_exif(&tiff(false, &[(0x0112, 3, 1, n)]));
            let seen = orientation.apply(stored.clone(), &Limits::default()).unwrap();
            let rows = seen.pixels().chunks(seen.width() as usize);
            let rows: Vec<String> = rows.map(|row| row.iter().map(|p| char::from(p.red())).collect()).collect();
            assert_eq!(rows.join(" "), expected, "{n}");
        }
    }
}
