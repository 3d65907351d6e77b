//! The outcome of one check.

use crate::deform::Built;
use crate::error::Error;

/// Why a map that asks another program has failed, if it has: its values after that mean nothing.
pub(super) fn failure(built: &Built) -> Option<Error> {
    built.failure.as_ref().and_then(|f| f())
}

/// One check with its outcome.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Check {
    /// A word for what is checked.
    pub name: &'static str,
    /// What was looked at, and the largest error.
    pub detail: String,
    /// What is wrong; empty if nothing is.
    pub faults: Vec<String>,
}

/// Faults of one kind that are listed. A wrong formula is wrong at every sample.
const LISTED: usize = 3;

impl Check {
    pub(super) fn new(name: &'static str) -> Self {
        Self { name, detail: String::new(), faults: Vec::new() }
    }

    pub(super) fn fault(&mut self, what: impl Into<String>) {
        self.faults.push(what.into());
    }

    /// Replaces the faults by the failure of the map, if it has failed: values after that mean nothing.
    pub(super) fn unless_failed(mut self, built: &Built) -> Self {
        if let Some(failure) = failure(built) {
            self.faults = vec![failure.to_string()];
        }
        let more = self.faults.len().saturating_sub(LISTED);
        if more > 0 {
            self.faults.truncate(LISTED);
            self.faults.push(format!("and {more} more"));
        }
        self
    }
}
