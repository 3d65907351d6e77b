//! Errors for programs: a kind to branch on, a message without dashes before names, and the parts of the message.

use super::without_dashes;
use crate::advice::Flags;
use crate::failure::Failure;
use pathwarp::budget::Exceeded;
use pathwarp::deform::Registry;
use pathwarp::kurbo::Point;
use pathwarp::{Error as LibraryError, GeometryError};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The kind of an error: the caller, the input, the geometry, a limit or the library is at fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A name or value that the caller gave is wrong.
    Usage,
    /// A file or drawing cannot be read, or a result cannot be written.
    Input,
    /// The geometry does not allow the deformation.
    Geometry,
    /// The work exceeds a limit.
    Limit,
    /// A defect of the library. Please report it.
    Internal,
}

/// An error. Its message tells what is wrong, where, and what to do.
#[derive(Debug, Clone, PartialEq)]
pub struct Error {
    /// The kind.
    pub kind: ErrorKind,
    /// The message. Parameters and options have their names on the command line, without dashes.
    pub message: String,
    /// The parts of the message that are known.
    pub details: Box<Details>,
}

/// The parts of an error's message.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Details {
    /// The message with dashes before names, as the command line shows it.
    pub with_dashes: String,
    /// The parameter or option.
    pub parameter: Option<String>,
    /// The value as given.
    pub value: Option<String>,
    /// The file, with a position in it if that is known.
    pub file: Option<String>,
    /// The point of the drawing at fault.
    pub at: Option<Point>,
    /// The exceeded limit, its value, and the amount needed.
    pub limit: Option<Exceeded>,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

impl Error {
    /// Creates an error of the kind [`ErrorKind::Usage`].
    pub(super) fn usage(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Usage, message.into())
    }

    fn new(kind: ErrorKind, message: String) -> Self {
        Self { kind, details: Box::new(Details { with_dashes: message.clone(), ..Details::default() }), message }
    }

    /// Adds the parameter or option concerned, and its value.
    pub(super) fn with_parameter(mut self, parameter: &str, value: &str) -> Self {
        self.details.parameter.get_or_insert_with(|| parameter.to_owned());
        self.details.value.get_or_insert_with(|| value.to_owned());
        self
    }

    /// Turns a failure into an error, whose message names parameters without dashes.
    pub(super) fn from_failure(failure: &Failure, registry: &Registry) -> Self {
        let details = details(failure);
        let kind = match failure {
            _ if details.limit.is_some() => ErrorKind::Limit,
            Failure::Usage(_) => ErrorKind::Usage,
            Failure::Input(_) | Failure::Limited(..) | Failure::Output(_) => ErrorKind::Input,
            Failure::Geometry(_) => ErrorKind::Geometry,
            Failure::Library { error, .. } => match **error {
                LibraryError::Input { .. } => ErrorKind::Input,
                LibraryError::Geometry(_) => ErrorKind::Geometry,
                _ => ErrorKind::Usage,
            },
        };
        let with_dashes = failure.message(&Flags::of(registry));
        let message = without_dashes(&with_dashes, registry);
        Self { kind, message, details: Box::new(Details { with_dashes, ..details }) }
    }
}

/// Extracts the parts of a failure's message.
fn details(failure: &Failure) -> Details {
    let mut details = Details::default();
    let error = match failure {
        Failure::Library { error, .. } => &**error,
        Failure::Limited(_, exceeded, _) => return Details { limit: Some(*exceeded), ..details },
        _ => return details,
    };
    match error {
        LibraryError::Usage { param, value, .. } => {
            details.parameter = Some(param.clone());
            details.value = Some(value.clone()).filter(|v| !v.is_empty());
        }
        LibraryError::Missing { param, .. } => details.parameter = Some(param.clone()),
        LibraryError::Input { place, limit, .. } => {
            details.file = Some(place.clone());
            details.limit = *limit;
        }
        LibraryError::Geometry(GeometryError::Limit(exceeded)) => details.limit = Some(*exceeded),
        LibraryError::Geometry(e) => details.at = e.place(),
        _ => {}
    }
    details
}

/// Calls `work`, and turns failures and panics into errors.
pub(super) fn guarded<T>(registry: &Registry, work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Error> {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(done) => done.map_err(|failure| Error::from_failure(&failure, registry)),
        Err(panic) => {
            let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
            let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
            Err(Error::new(ErrorKind::Internal, format!("pathwarp failed ({text}); please report it")))
        }
    }
}
