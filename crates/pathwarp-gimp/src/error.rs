//! Errors with their offset in the file.

use pathwarp::budget::Exceeded;
use thiserror::Error;

/// The reason why a file cannot be read or written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The format of the file is none that this crate reads.
    UnknownFormat,
    /// The file ends too early.
    Truncated,
    /// The file violates its format.
    Damaged,
    /// The file is valid, but of a version or form that this crate does not read or write.
    Unsupported,
    /// The file exceeds a limit that protects against unbounded work or memory.
    TooLarge,
    /// The caller's strokes cannot be written to the file.
    Strokes,
    /// Reading or writing failed.
    Io,
}

/// An error at an offset in a file.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("byte {offset}: {problem}")]
#[non_exhaustive]
pub struct Error {
    /// The reason.
    pub kind: ErrorKind,
    /// Offset in bytes from the start of the file, or of the unpacked data if the file is compressed.
    pub offset: u64,
    /// Description of the problem.
    pub problem: String,
    /// The limit, if the file takes more work than it allows.
    pub limit: Option<Exceeded>,
}

impl Error {
    pub(crate) fn new(kind: ErrorKind, offset: u64, problem: impl Into<String>) -> Self {
        Self { kind, offset, problem: problem.into(), limit: None }
    }

    pub(crate) fn damaged(offset: u64, problem: impl Into<String>) -> Self {
        Self::new(ErrorKind::Damaged, offset, problem)
    }

    pub(crate) fn unsupported(offset: u64, problem: impl Into<String>) -> Self {
        Self::new(ErrorKind::Unsupported, offset, problem)
    }

    pub(crate) fn too_large(offset: u64, what: &str, limit: Exceeded) -> Self {
        Self { limit: Some(limit), ..Self::new(ErrorKind::TooLarge, offset, format!("{what} {limit}")) }
    }

    pub(crate) fn io(offset: u64, error: &std::io::Error) -> Self {
        Self::new(ErrorKind::Io, offset, format!("cannot be read: {error}"))
    }

    /// Reports that only `left` bytes remain. `needed` is a clause that names the part that takes more.
    pub(crate) fn truncated(offset: u64, needed: &str, left: u64) -> Self {
        Self::new(ErrorKind::Truncated, offset, format!("{needed}, but only {left} are left"))
    }

    /// Reports damage at a line and a column of a text, which count from 1.
    pub(crate) fn in_text(text: &str, line: usize, column: usize, problem: impl Into<String>) -> Self {
        let lines = text.split_inclusive('\n').take(line.saturating_sub(1));
        let offset = lines.map(str::len).sum::<usize>() + column.saturating_sub(1);
        Self::damaged(offset as u64, problem)
    }
}
