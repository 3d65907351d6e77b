//! The paths in GIMP's files, exactly as they are stored, and the way back.
//!
//! Read are XCF of every version (also packed by gzip, bzip2 or xz), the SVG that GIMP exports, point lists as JSON (what
//! `gimp-path-stroke-get-points` answers), and the text files of GIMP 1. Of an XCF only the bytes that hold paths are read,
//! whatever its size. Every count is bounded by the bytes that are left, so that a damaged file costs an [`Error`] with the
//! place and nothing else.
//!
//! ```
//! let text = "Name: slope\n#POINTS: 5\nCLOSED: 0\nDRAW: 0\nSTATE: 2\nTYPE: 1 X: 0 Y: 0\nTYPE: 2 X: 0 Y: 0\n\
//!             TYPE: 2 X: 9 Y: 5\nTYPE: 1 X: 9 Y: 5\nTYPE: 2 X: 9 Y: 5\n";
//! let paths = pathwarp_gimp::read(text.as_bytes())?;
//! assert_eq!((paths[0].name.as_str(), paths[0].strokes[0].anchors()), ("slope", 2));
//! # Ok::<(), pathwarp_gimp::Error>(())
//! ```

mod error;
mod input;
mod number;
mod open;
mod outline;
mod path;
mod pdb;
mod svg;
mod text;
mod xcf;

pub use error::Error;
pub use open::{File, Kind, Salvaged, open, salvage, sniff};
pub use path::{GimpPath, Stroke};
pub use pdb::to_json;
pub use svg::to_svg;
pub use xcf::{new_xcf, rewrite};

/// The paths of a file in memory, the topmost of GIMP's list first.
///
/// # Errors
/// What is wrong with the file, and at which byte.
pub fn read(bytes: &[u8]) -> Result<Vec<GimpPath>, Error> {
    open(std::io::Cursor::new(bytes)).map(|f| f.paths)
}
