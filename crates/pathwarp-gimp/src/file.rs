//! A file of paths.

use crate::error::Error;
use crate::path::GimpPath;

/// The formats in which GIMP stores paths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileKind {
    /// An XCF of this version.
    Xcf(u32),
    /// An XCF of this version, compressed with gzip, bzip2 or xz.
    PackedXcf(u32),
    /// SVG as GIMP exports it.
    Svg,
    /// Point lists in JSON.
    Json,
    /// The text format of GIMP 1.
    Text,
}

/// The paths of a file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PathFile {
    /// The format of the file.
    pub kind: FileKind,
    /// Width and height of the canvas in pixels, if the file contains them.
    pub size: Option<[f64; 2]>,
    /// The paths, topmost first.
    pub paths: Vec<GimpPath>,
}

/// The readable part of a damaged file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Salvaged {
    /// The file with the paths before the damage.
    pub file: PathFile,
    /// The damage; `None` if the file is sound.
    pub damage: Option<Error>,
}
