//! XCF, GIMP's own format: big-endian, a property list, then tables of pointers.
//!
//! Paths stand in one of three places: `PROP_PATHS` (GIMP 1.x, and still written when every path is invisible), `PROP_VECTORS`
//! (GIMP 2), or items of their own behind pointers (version 18, GIMP 3). Nothing else is read. Source: GIMP's
//! `devel-docs/xcf.txt` and files written by GIMP 2.10 and 3.0, whose point types (1, 2, 3) differ from that text's.

mod items;
mod old_paths;
mod pointers;
mod replace;
mod vectors;
mod write;

pub(crate) use old_paths::strokes as old_strokes;
pub use replace::rewrite;
pub use write::new_xcf;

use crate::error::Error;
use crate::input::Input;
use crate::path::GimpPath;
use std::ops::Range;

pub(crate) const MAGIC: &[u8] = b"gimp xcf ";

/// Later versions add things, but have kept the layout so far; beyond this the number is damage.
const LAST_VERSION: u32 = 99;
/// Since when a file says its precision.
const WITH_PRECISION: u32 = 4;
/// Since when pointers have 64 bits.
const WIDE_POINTERS: u32 = 11;
/// Since when paths are items.
const PATH_ITEMS: u32 = 18;
/// A megabyte is no name.
const LONGEST_NAME: u64 = 1 << 20;
/// GIMP writes a few dozen properties.
const MOST_PROPERTIES: u32 = 100_000;

pub(super) const PROP_END: u32 = 0;
const PROP_COLORMAP: u32 = 1;
pub(super) const PROP_PATHS: u32 = 23;
pub(super) const PROP_VECTORS: u32 = 25;

/// What was found, and where.
pub(crate) struct Xcf {
    pub(crate) version: u32,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) blocks: Vec<Block>,
    pub(crate) records: Vec<Record>,
    /// Where the property list ends.
    properties_end: u64,
}

/// A property that holds paths.
pub(crate) struct Block {
    pub(crate) property: u32,
    /// From its type word to the end of its content.
    pub(crate) span: Range<u64>,
}

/// A path and where it stands.
pub(crate) struct Record {
    pub(crate) path: GimpPath,
    /// All of it: name to last point.
    pub(crate) span: Range<u64>,
    /// What the strokes' encoding needs to know.
    pub(crate) layout: Layout,
}

/// How a path is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Layout {
    /// In `PROP_PATHS`: where its state byte stands.
    Old { state_at: u64, tattoo: Option<u32> },
    /// In `PROP_VECTORS`: where its number of strokes stands, and where the strokes start.
    Vectors { count_at: u64, strokes_at: u64 },
    /// An item: where the pointer to it stands, its size word and its number of strokes.
    Item { pointer_at: u64, size_at: u64, count_at: u64 },
}

/// Reads the paths. What was read before a fault stays in `xcf`.
pub(crate) fn read(input: &mut Input<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    header(input, xcf)?;
    properties(input, xcf)?;
    xcf.properties_end = input.at();
    if xcf.version >= PATH_ITEMS { items::read(input, xcf) } else { Ok(()) }
}

impl Xcf {
    pub(crate) fn new() -> Self {
        Self { version: 0, width: 0, height: 0, blocks: Vec::new(), records: Vec::new(), properties_end: 0 }
    }

    pub(super) fn wide(&self) -> bool {
        self.version >= WIDE_POINTERS
    }
}

fn header(input: &mut Input<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    let mut magic = [0; 14];
    input.bytes(&mut magic, "the header")?;
    let version = &magic[MAGIC.len()..13];
    xcf.version = if version == b"file" {
        0
    } else {
        let digits = version.strip_prefix(b"v").and_then(|d| std::str::from_utf8(d).ok());
        let number = digits.filter(|d| d.bytes().all(|b| b.is_ascii_digit())).and_then(|d| d.parse().ok());
        number.ok_or_else(|| Error::at(9, format!("`{}` is no XCF version", version.escape_ascii())))?
    };
    if xcf.version > LAST_VERSION {
        return Err(Error::at(9, format!("XCF version {} is unknown; known are 0 to {LAST_VERSION}", xcf.version)));
    }
    xcf.width = input.u32("the header")?;
    xcf.height = input.u32("the header")?;
    let at = input.at();
    let base = input.u32("the header")?;
    if base > 2 {
        return Err(Error::at(at, format!("base type {base} is unknown; it is 0 (RGB), 1 (grey) or 2 (indexed)")));
    }
    if xcf.version >= WITH_PRECISION {
        input.u32("the header")?;
    }
    Ok(())
}

fn properties(input: &mut Input<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    for _ in 0..MOST_PROPERTIES {
        let at = input.at();
        let kind = input.u32("the image's properties")?;
        let length = u64::from(input.u32("the image's properties")?);
        match kind {
            PROP_END => return Ok(()),
            PROP_PATHS => old_paths::read(input, xcf)?,
            PROP_VECTORS => vectors::read(input, length, xcf)?,
            PROP_COLORMAP => {
                // Old GIMPs wrote a wrong length here; and version 0 a single byte for a colour.
                let colours = u64::from(input.u32("the colour map")?);
                input.skip(if xcf.version == 0 { colours } else { 3 * colours }, "the colour map")?;
            }
            _ => input.skip(length, &format!("property {kind}"))?,
        }
        if matches!(kind, PROP_PATHS | PROP_VECTORS) {
            xcf.blocks.push(Block { property: kind, span: at..input.at() });
        }
    }
    Err(Error::at(input.at(), format!("more than {MOST_PROPERTIES} properties: their list has no end")))
}

/// A string: its length with a final NUL, its bytes. None of GIMP's is empty but for the length 0.
pub(super) fn string(input: &mut Input<'_>, what: &str) -> Result<String, Error> {
    let at = input.at();
    let length = u64::from(input.u32(what)?);
    if length > input.left() {
        return Err(Error::short(at, &format!("{what} is said to have {length} bytes"), input.left()));
    }
    if length > LONGEST_NAME {
        return Err(Error::at(at, format!("{what} of {length} bytes is longer than any name")));
    }
    let mut bytes = input.vec(length, what)?;
    if let Some(last) = bytes.pop()
        && last != 0
    {
        return Err(Error::at(at + 3 + length, format!("{what} does not end with a zero byte")));
    }
    let text = String::from_utf8(bytes);
    text.map_err(|e| Error::at(at + 4 + e.utf8_error().valid_up_to() as u64, format!("{what} is not UTF-8")))
}

/// A count of things that take at least `least` bytes each.
pub(super) fn count(input: &mut Input<'_>, least: u64, what: &str) -> Result<u32, Error> {
    let at = input.at();
    let n = input.u32(what)?;
    if u64::from(n) * least > input.left() {
        let needed = format!("{n} {what} need {} bytes or more", u64::from(n) * least);
        return Err(Error::short(at, &needed, input.left()));
    }
    Ok(n)
}

/// A coordinate: neither NaN nor infinite.
pub(super) fn coordinate(bytes: [u8; 4], at: u64) -> Result<f64, Error> {
    let v = f32::from_be_bytes(bytes);
    if v.is_finite() {
        Ok(f64::from(v))
    } else {
        Err(Error::at(at, format!("a coordinate is {v}, which is no number")))
    }
}

/// The first four bytes at `i`, which the caller knows to be there.
pub(super) fn word(bytes: &[u8], i: usize) -> [u8; 4] {
    let mut w = [0; 4];
    w.copy_from_slice(&bytes[i..i + 4]);
    w
}
