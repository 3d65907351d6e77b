//! The paths of an XCF with their offsets in the file.

use crate::path::GimpPath;
use std::ops::Range;

pub(crate) const MAGIC: &[u8] = b"gimp xcf ";

/// The first version with 64-bit pointers.
const WIDE_POINTERS: u32 = 11;
/// The first version that stores paths as items.
pub(super) const PATH_ITEMS: u32 = 18;

/// Limit for damaged property lists. GIMP writes a few dozen properties.
pub(super) const MAX_PROPERTIES: u32 = 100_000;
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
    /// From the type word to the end of the content.
    pub(crate) span: Range<u64>,
}

/// A path and its position in the file.
pub(crate) struct PathRecord {
    pub(crate) path: GimpPath,
    /// From the name to the last point.
    pub(crate) span: Range<u64>,
    pub(crate) layout: PathLayout,
}

/// The offsets needed to replace the strokes of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PathLayout {
    /// In `PROP_PATHS`: the state byte, and the tattoo that format 3 stores.
    Old { state_at: u64, tattoo: Option<u32> },
    /// In `PROP_VECTORS`: the number of strokes, and the first stroke.
    Vectors { count_at: u64, strokes_at: u64 },
    /// An item: the pointer to it, its size word, and its number of strokes.
    Item { pointer_at: u64, size_at: u64, count_at: u64 },
}
