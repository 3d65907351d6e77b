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
    /// Whether the problem is that fewer bytes are left than are needed; its text then ends with how many are.
    pub(crate) short: bool,
}

impl Error {
    pub(crate) fn at(offset: u64, problem: impl Into<String>) -> Self {
        Self { offset, problem: problem.into(), short: false }
    }

    /// What is needed, in words, is more than the `left` bytes that there are.
    pub(crate) fn short(offset: u64, needed: &str, left: u64) -> Self {
        Self { offset, problem: format!("{needed}, but only {left} are left"), short: true }
    }

    /// The same, naming the length word (`length`, of `what`) behind what is called left.
    pub(crate) fn within(mut self, length: u64, what: &str) -> Self {
        if self.short {
            self.problem += &format!(" of the {length} that {what} is said to have");
        }
        self
    }
}
