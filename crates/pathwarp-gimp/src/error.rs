//! What is wrong with a file, and where.

use thiserror::Error;

/// A file that cannot be read, or not be written.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("byte {offset}: {problem}")]
pub struct Error {
    /// Where, in bytes from the start; of the unpacked data, if the file is packed.
    pub offset: u64,
    /// What is wrong.
    pub problem: String,
}

impl Error {
    pub(crate) fn at(offset: u64, problem: impl Into<String>) -> Self {
        Self { offset, problem: problem.into() }
    }
}
