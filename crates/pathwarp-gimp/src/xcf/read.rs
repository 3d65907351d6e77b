//! Reads the header and the property list, and the paths that these lead to.

use super::model::{MAGIC, MAX_PROPERTIES, PATH_ITEMS, PROP_END, PROP_PATHS, PROP_VECTORS, PathBlock, Xcf};
use super::{items, old_paths, vectors};
use crate::error::Error;
use crate::source::ByteSource;

/// Versions so far have added things but kept the layout. A higher number is damage.
const LAST_VERSION: u32 = 99;
/// The first version that stores a precision.
const WITH_PRECISION: u32 = 4;
const PROP_COLORMAP: u32 = 1;

/// Reads the paths. After an error, `xcf` holds the paths before it.
pub(crate) fn read(input: &mut ByteSource<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    header(input, xcf)?;
    properties(input, xcf)?;
    xcf.properties_end = input.offset();
    if xcf.version >= PATH_ITEMS { items::read(input, xcf) } else { Ok(()) }
}

fn header(input: &mut ByteSource<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    let start: [u8; 14] = input.array("the header")?;
    // The last byte is a zero.
    let version = &start[MAGIC.len()..13];
    xcf.version = if version == b"file" {
        0
    } else {
        let digits = version.strip_prefix(b"v").and_then(|d| std::str::from_utf8(d).ok());
        let number = digits.filter(|d| d.bytes().all(|b| b.is_ascii_digit())).and_then(|d| d.parse().ok());
        number.ok_or_else(|| Error::damaged(9, format!("`{}` is not an XCF version", version.escape_ascii())))?
    };
    if xcf.version > LAST_VERSION {
        let problem = format!("XCF version {} is unknown; versions 0 to {LAST_VERSION} are known", xcf.version);
        return Err(Error::unsupported(9, problem));
    }
    xcf.width = input.u32("the header")?;
    xcf.height = input.u32("the header")?;
    let at = input.offset();
    let base = input.u32("the header")?;
    if base > 2 {
        let problem = format!("base type {base} is unknown; it must be 0 (RGB), 1 (grey) or 2 (indexed)");
        return Err(Error::damaged(at, problem));
    }
    if xcf.version >= WITH_PRECISION {
        input.u32("the header")?;
    }
    Ok(())
}

fn properties(input: &mut ByteSource<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    for _ in 0..MAX_PROPERTIES {
        let at = input.offset();
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
            xcf.blocks.push(PathBlock { span: at..input.offset() });
        }
    }
    Err(Error::damaged(input.offset(), format!("more than {MAX_PROPERTIES} properties: the list has no end")))
}
