//! The ways in which a run ends, with their exit codes.

use crate::terminal;
use pathwarp_engine::advice::Flags;
use pathwarp_engine::failure::Failure;

/// The result of a run that did not fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Status {
    /// All was done.
    Complete,
    /// Something was left unchanged or missed the tolerance, or a comparison exceeded its limit.
    Partial,
}

impl Status {
    /// Returns `Partial` if `partial`, else `Complete`.
    pub(crate) fn partial_if(partial: bool) -> Self {
        if partial { Self::Partial } else { Self::Complete }
    }
}

/// The reason why a run ended early.
pub(crate) enum Ending {
    /// A message of clap: wrong usage, or a request for help.
    Clap(clap::Error),
    Failed(Failure),
}

impl Ending {
    /// Returns the exit code.
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Clap(e) => u8::try_from(e.exit_code()).unwrap_or(2),
            Self::Failed(failure) => failure.code(),
        }
    }

    /// Converts the reason to a failure, whose message has no colours and has not been printed.
    pub(crate) fn into_failure(self) -> Failure {
        match self {
            Self::Clap(e) => Failure::Usage(e.to_string()),
            Self::Failed(failure) => failure,
        }
    }

    /// Prints the message, in which parameters appear as `flags`.
    pub(crate) fn show(&self, flags: &Flags) {
        match self {
            // clap selects the stream: help goes to standard output. Ignore a closed pipe.
            Self::Clap(e) => drop(e.print()),
            Self::Failed(failure) => terminal::error(&failure.message(flags)),
        }
    }
}

impl From<clap::Error> for Ending {
    fn from(e: clap::Error) -> Self {
        Self::Clap(e)
    }
}

impl From<Failure> for Ending {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}
