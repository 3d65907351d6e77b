//! Errors of reading a Photoshop file.

use thiserror::Error;

/// The reason why a file cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Error {
    /// The file has no Photoshop header.
    #[error("not a Photoshop file (PSD or PSB)")]
    NotPsd,
    /// The file breaks its format.
    #[error("byte {at}: {what}")]
    Format {
        /// Offset in bytes.
        at: usize,
        /// Description of the problem.
        what: String,
    },
}
