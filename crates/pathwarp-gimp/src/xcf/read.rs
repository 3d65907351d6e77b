//! Reads the header and the property list of an XCF, and from there its paths.

use crate::error::Error;
use crate::path::GimpPath;
use crate::source::ByteSource;
use crate::xcf::{items, old_paths, vectors};
use std::ops::Range;

/// Later versions add things but have kept the layout so far. A higher number is damage.
const LAST_VERSION: u32 = 99;
/// The first version that stores a precision.
const WITH_PRECISION: u32 = 4;
const PROP_COLORMAP: u32 = 1;

/// Reads the paths. Those before an error remain in `xcf`.
pub(crate) fn read(input: &mut ByteSource<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    header(input, xcf)?;
    properties(input, xcf)?;
    xcf.properties_end = input.at();
    if xcf.version >= PATH_ITEMS { items::read(input, xcf) } else { Ok(()) }
}

fn header(input: &mut ByteSource<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    let mut magic = [0; 14];
    input.bytes(&mut magic, "the header")?;
    let version = &magic[MAGIC.len()..13];
    xcf.version = if version == b"file" {
        0
    } else {
        let digits = version.strip_prefix(b"v").and_then(|d| std::str::from_utf8(d).ok());
        let number = digits.filter(|d| d.bytes().all(|b| b.is_ascii_digit())).and_then(|d| d.parse().ok());
        number.ok_or_else(|| Error::damaged(9, format!("`{}` is not an XCF version", version.escape_ascii())))?
    };
    if xcf.version > LAST_VERSION {
        return Err(Error::unsupported(
            9,
            format!("XCF version {} is unknown; versions 0 to {LAST_VERSION} are known", xcf.version),
        ));
    }
    xcf.width = input.u32("the header")?;
    xcf.height = input.u32("the header")?;
    let at = input.at();
    let base = input.u32("the header")?;
    if base > 2 {
        return Err(Error::damaged(
            at,
            format!("base type {base} is unknown; it must be 0 (RGB), 1 (grey) or 2 (indexed)"),
        ));
    }
    if xcf.version >= WITH_PRECISION {
        input.u32("the header")?;
    }
    Ok(())
}

fn properties(input: &mut ByteSource<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    for _ in 0..MOST_PROPERTIES {
        let at = input.at();
        let kind = input.u32("the image's properties")?;
        let length = u64::from(input.u32("the image's properties")?);
        match kind {
            PROP_END => return Ok(()),
            PROP_PATHS => old_paths::read(input, xcf)?,
            PROP_VECTORS => vectors::read(input, length, xcf)?,
            PROP_COLORMAP => {
                // Old versions of GIMP wrote a wrong length here, and version 0 a single byte per colour.
                let colours = u64::from(input.u32("the colour map")?);
                input.skip(if xcf.version == 0 { colours } else { 3 * colours }, "the colour map")?;
            }
            _ => input.skip(length, &format!("property {kind}"))?,
        }
        if matches!(kind, PROP_PATHS | PROP_VECTORS) {
            xcf.blocks.push(PathBlock { property: kind, span: at..input.at() });
        }
    }
    Err(Error::damaged(input.at(), format!("more than {MOST_PROPERTIES} properties: the list has no end")))
}

pub(crate) const MAGIC: &[u8] = b"gimp xcf ";

/// The first version with 64-bit pointers.
const WIDE_POINTERS: u32 = 11;
/// The first version that stores paths as items.
pub(super) const PATH_ITEMS: u32 = 18;

/// A bound for damaged property lists; GIMP writes a few dozen properties.
pub(super) const MOST_PROPERTIES: u32 = 100_000;
pub(super) const PROP_END: u32 = 0;
pub(super) const PROP_PATHS: u32 = 23;
pub(super) const PROP_VECTORS: u32 = 25;

/// The paths found in a file.
#[derive(Default)]
pub(crate) struct Xcf {
    pub(crate) version: u32,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) blocks: Vec<PathBlock>,
    pub(crate) records: Vec<PathRecord>,
    /// End of the property list.
    pub(super) properties_end: u64,
}

impl Xcf {
    /// Returns `true` if pointers have 64 bits.
    pub(super) fn wide(&self) -> bool {
        self.version >= WIDE_POINTERS
    }
}

/// A property that holds paths.
pub(crate) struct PathBlock {
    pub(crate) property: u32,
    /// From its type word to the end of its content.
    pub(crate) span: Range<u64>,
}

/// A path and its place.
pub(crate) struct PathRecord {
    pub(crate) path: GimpPath,
    /// From its name to its last point.
    pub(crate) span: Range<u64>,
    pub(crate) layout: PathLayout,
}

/// Offsets that are needed to replace the strokes of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PathLayout {
    /// In `PROP_PATHS`: the state byte, and the tattoo that format 3 stores.
    Old { state_at: u64, tattoo: Option<u32> },
    /// In `PROP_VECTORS`: the number of strokes, and the first stroke.
    Vectors { count_at: u64, strokes_at: u64 },
    /// An item: the pointer to it, its size word, and its number of strokes.
    Item { pointer_at: u64, size_at: u64, count_at: u64 },
}

/// Longest accepted name in bytes; anything longer is damage.
const LONGEST_NAME: u64 = 1 << 20;

/// Reads a string: its length including a final NUL, then its bytes. GIMP writes an empty string as length 0.
pub(super) fn string(input: &mut ByteSource<'_>, what: &str) -> Result<String, Error> {
    let at = input.at();
    let length = u64::from(input.u32(what)?);
    input.need(length, at, || format!("{what} needs {length} bytes"))?;
    if length > LONGEST_NAME {
        return Err(Error::damaged(at, format!("{what} of {length} bytes is longer than any name")));
    }
    let mut bytes = input.vec(length, what)?;
    if let Some(last) = bytes.pop()
        && last != 0
    {
        return Err(Error::damaged(at + 3 + length, format!("{what} does not end with a zero byte")));
    }
    let text = String::from_utf8(bytes);
    text.map_err(|e| Error::damaged(at + 4 + e.utf8_error().valid_up_to() as u64, format!("{what} is not UTF-8")))
}

/// Reads the number of things that take at least `least` bytes each.
pub(super) fn count(input: &mut ByteSource<'_>, least: u64, what: &str) -> Result<u32, Error> {
    let at = input.at();
    let n = input.u32(what)?;
    let size = u64::from(n) * least;
    input.need(size, at, || format!("{n} {what} need {size} bytes or more"))?;
    Ok(n)
}

/// Decodes a coordinate; NaN and infinities are errors.
pub(super) fn coordinate(bytes: [u8; 4], at: u64) -> Result<f64, Error> {
    let v = f32::from_be_bytes(bytes);
    if v.is_finite() {
        Ok(f64::from(v))
    } else {
        Err(Error::damaged(at, format!("a coordinate is {v}, not a finite number")))
    }
}

/// Returns the four bytes at `i`; the caller has checked the length.
pub(super) fn word(bytes: &[u8], i: usize) -> [u8; 4] {
    let mut w = [0; 4];
    w.copy_from_slice(&bytes[i..i + 4]);
    w
}
