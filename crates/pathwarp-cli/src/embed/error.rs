//! Errors for callers that are programs: a kind to branch on, and a message without dashes before names.

use super::names::without_dashes;
use crate::advice::Flags;
use crate::failure::Failure;
use pathwarp::deform::Registry;
use pathwarp::{Error as LibraryError, GeometryError};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The kind of an error: who can mend it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A name or value is wrong: the caller.
    Usage,
    /// A file or drawing cannot be read.
    Input,
    /// The geometry does not allow the deformation.
    Geometry,
    /// The work exceeds a limit.
    Limit,
    /// The library failed. Please report it.
    Internal,
}

/// An error, with a message that says what is wrong, where, and what to do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Error {
    /// The kind.
    pub kind: ErrorKind,
    /// The message. Parameters and options have the names they have on the command line, without dashes.
    pub message: String,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

impl Error {
    /// An error about a name or value.
    pub(super) fn usage(message: impl Into<String>) -> Self {
        Self { kind: ErrorKind::Usage, message: message.into() }
    }

    pub(super) fn of(failure: &Failure, registry: &Registry) -> Self {
        let kind = match failure {
            Failure::Clap(_) | Failure::Usage(_) => ErrorKind::Usage,
            Failure::Input(_) | Failure::Output(_) => ErrorKind::Input,
            Failure::Geometry(_) => ErrorKind::Geometry,
            Failure::Library { error, .. } => match **error {
                LibraryError::Input { limit: Some(_), .. } | LibraryError::Geometry(GeometryError::Limit(_)) => {
                    ErrorKind::Limit
                }
                LibraryError::Input { .. } => ErrorKind::Input,
                LibraryError::Geometry(_) => ErrorKind::Geometry,
                _ => ErrorKind::Usage,
            },
        };
        Self { kind, message: without_dashes(&failure.message(&Flags::of(registry)), registry) }
    }
}

/// Calls `work`, and turns failures and panics into errors.
pub(super) fn guarded<T>(registry: &Registry, work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Error> {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(done) => done.map_err(|f| Error::of(&f, registry)),
        Err(panic) => {
            let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
            let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
            Err(Error { kind: ErrorKind::Internal, message: format!("pathwarp failed ({text}); please report it") })
        }
    }
}
