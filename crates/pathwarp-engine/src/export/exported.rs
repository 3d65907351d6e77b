//! The result of an export.

use super::kerf::KerfReport;

/// A drawing in a file format.
pub struct Exported {
    /// The file.
    pub bytes: Vec<u8>,
    /// Messages about content that the format cannot express.
    pub warnings: Vec<String>,
    /// The changes made by `--kerf`.
    pub kerf: Option<KerfReport>,
}

impl From<Vec<u8>> for Exported {
    fn from(bytes: Vec<u8>) -> Self {
        Self { bytes, warnings: Vec::new(), kerf: None }
    }
}

/// Formats a number with its noun, singular or plural.
pub(super) fn counted(n: usize, one: &str, more: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { more })
}
