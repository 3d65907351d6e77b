//! Reads and writes the paths in GIMP's files without loss.
//!
//! * [`read`] and [`open`] read XCF files of every version (also compressed with gzip, bzip2 or xz), SVG exported by GIMP, point
//!   lists in JSON (as returned by `gimp-path-stroke-get-points`), and the text files of GIMP 1. [`sniff`] recognizes them, and
//!   [`salvage`] reads damaged ones as far as possible.
//! * [`rewrite`] replaces paths in a copy of an XCF and keeps every other byte.
//! * [`to_svg`], [`to_json`] and [`new_xcf`] write paths to new files.
//!
//! Only the bytes of an XCF that hold paths are read, whatever its size. Every count is checked against the bytes left, so a
//! damaged file gives an [`Error`] with its offset and never exhausts memory.
//!
//! ```
//! let text = "Name: slope\n#POINTS: 5\nCLOSED: 0\nDRAW: 0\nSTATE: 2\nTYPE: 1 X: 0 Y: 0\nTYPE: 2 X: 0 Y: 0\n\
//!             TYPE: 2 X: 9 Y: 5\nTYPE: 1 X: 9 Y: 5\nTYPE: 2 X: 9 Y: 5\n";
//! let paths = pathwarp_gimp::read(text.as_bytes())?;
//! assert_eq!((paths[0].name.as_str(), paths[0].strokes[0].anchors()), ("slope", 2));
//! # Ok::<(), pathwarp_gimp::Error>(())
//! ```

mod error;
mod old_strokes;
mod open;
mod path;
mod point_list;
mod source;
mod svg;
mod text;
mod xcf;

pub use error::{Error, ErrorKind};
pub use open::{HEAD, may_begin, open, salvage, salvage_within, sniff};
pub use path::{FileKind, GimpPath, PathFile, Salvaged, Stroke};
pub use point_list::to_json;
pub use svg::to_svg;
pub use xcf::{new_xcf, rewrite};

/// Reads the paths of a file in memory, topmost first.
///
/// # Errors
/// [`ErrorKind::UnknownFormat`] for other files; [`ErrorKind::Damaged`], [`ErrorKind::Truncated`] and [`ErrorKind::TooLarge`].
pub fn read(bytes: &[u8]) -> Result<Vec<GimpPath>, Error> {
    open(std::io::Cursor::new(bytes)).map(|f| f.paths)
}
