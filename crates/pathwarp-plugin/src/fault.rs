//! The ways in which a program fails.

use pathwarp::Error;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::OnceLock;
use std::time::Duration;
use thiserror::Error;

/// The reason why a program cannot be used, or was ended.
#[derive(Debug, Clone, PartialEq, Error, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Fault {
    /// There is no such file.
    #[error("is not a file")]
    NoFile,
    /// The file is not executable.
    #[error("is not executable; allow it with chmod +x")]
    NotExecutable,
    /// The system cannot start it.
    #[error("cannot be started: {0}; a script needs a first line such as #!/usr/bin/env python3")]
    NotStarted(String),
    /// A plug-in has started this program.
    #[error("is not started: a plug-in has called pathwarp, and the two could call each other without end")]
    Nested,
    /// It ended while an answer was expected.
    #[error("ended ({status}) without giving {expected}{}", quoted(.said))]
    Ended {
        /// The expected answer.
        expected: String,
        /// The exit status.
        status: String,
        /// The end of its standard error.
        said: String,
    },
    /// It closed its standard output or input without ending.
    #[error("closed its standard {stream} while {expected} was expected{}", quoted(.said))]
    Closed {
        /// Input or output.
        stream: String,
        /// The expected answer.
        expected: String,
        /// The end of its standard error.
        said: String,
    },
    /// A request has more bytes than its length field can hold.
    #[error(
        "cannot be sent {0} bytes at once, only 4294967294; give it shorter paths, or let it speak the text protocol"
    )]
    TooLong(usize),
    /// It did not answer in time.
    #[error("did not give {expected} within {seconds} seconds (PATHWARP_PLUGIN_SECONDS allows more){}", quoted(.said))]
    Silent {
        /// The expected answer.
        expected: String,
        /// The limit.
        seconds: f64,
        /// The end of its standard error.
        said: String,
    },
    /// It wrote more than the longest possible answer.
    #[error("wrote more than {limit} bytes where {expected} was expected")]
    Flood {
        /// The expected answer.
        expected: String,
        /// The limit.
        limit: usize,
    },
    /// It wrote too much to standard error.
    #[error("wrote more than {MAX_ERROR_BYTES} bytes to standard error{}", quoted(.0))]
    ErrorFlood(String),
    /// The entry violates the protocol.
    #[error("has a wrong entry: {0}")]
    Entry(String),
    /// The entry is for another version of the protocol.
    #[error("speaks version {found} of the protocol; this program speaks version {known} and older ones")]
    Version {
        /// The version of the entry.
        found: String,
        /// The version known to this program.
        known: u32,
    },
    /// Its name is taken by a command or a built-in deformation.
    #[error("has the name of a command, {0}; rename it")]
    NameTaken(String),
    /// An answer cannot be read.
    #[error(
        "wrote {found} to standard output where {expected} was expected; messages belong on standard error (in Python: print(…, file=sys.stderr))"
    )]
    Garbage {
        /// The expected answer.
        expected: String,
        /// The beginning of its output.
        found: String,
    },
    /// An answer has the wrong number of points.
    #[error(
        "answered too much or too little: {expected} {found}; messages belong on standard error (in Python: print(…, file=sys.stderr))"
    )]
    Count {
        /// The expected answer.
        expected: String,
        /// The values found instead, as the end of a sentence.
        found: String,
    },
    /// A crease cannot be read.
    #[error(
        "{0} is not a crease; write line A B C with A or B not 0, perhaps with a box X0 Y0 X1 Y1 unless it is an edge, or circle X Y R with R not 0"
    )]
    Crease(String),
    /// A value is not a number.
    #[error("answered NaN or infinity for the point {0},{1}, and its entry does not say \"domain\": \"partial\"")]
    NotFinite(f64, f64),
    /// It refused the parameters or a batch, with this message.
    #[error("{0}")]
    Refused(String),
}

impl Fault {
    /// Converts the fault to an error about the file at `path`.
    #[must_use]
    pub fn of(&self, path: &Path) -> Error {
        Error::input(format!("plug-in {}", path.display()), self.to_string())
    }
}

/// Quotes a program's standard error at the end of a message.
fn quoted(said: &str) -> String {
    if said.is_empty() { String::new() } else { format!("; it said: {said}") }
}

/// The standard error of a program: its end, for messages, and its length.
#[derive(Default)]
pub(crate) struct StandardError {
    end: Vec<u8>,
    length: usize,
}

impl StandardError {
    pub(crate) fn push(&mut self, bytes: &[u8]) {
        self.length += bytes.len();
        self.end.extend_from_slice(bytes);
        let surplus = self.end.len().saturating_sub(KEPT_ERROR_BYTES);
        self.end.drain(..surplus);
    }

    /// Checks that the program has not written too much.
    pub(crate) fn check(&self) -> Result<(), Fault> {
        if self.length > MAX_ERROR_BYTES { Err(Fault::ErrorFlood(self.readable())) } else { Ok(()) }
    }

    /// Joins the last lines to one line, without characters that would control the terminal. Repeated lines appear once with their number.
    pub(crate) fn readable(&self) -> String {
        let text = String::from_utf8_lossy(&self.end);
        let lines: Vec<&str> = text.split(|c: char| c.is_control()).map(str::trim).filter(|l| !l.is_empty()).collect();
        let times = |same: &[&str]| match same.len() {
            1 => same[0].to_owned(),
            n => format!("{} ({n} times)", same[0]),
        };
        let line = lines.chunk_by(|a, b| a == b).map(times).collect::<Vec<_>>().join(" | ");
        let skipped = line.char_indices().rev().nth(MAX_QUOTED_BYTES).map_or(0, |(i, _)| i);
        if skipped == 0 { line } else { format!("…{}", &line[skipped..]) }
    }
}

/// Quotes the beginning of `bytes`.
pub(crate) fn beginning(bytes: &[u8]) -> String {
    const MAX_CHARS: usize = 40;
    let text = String::from_utf8_lossy(bytes);
    let mut shown: String = text.chars().take(MAX_CHARS).flat_map(char::escape_default).collect();
    if text.chars().nth(MAX_CHARS).is_some() {
        shown.push('…');
    }
    format!("`{shown}`")
}

/// Environment variable for the number of seconds that a program may take for one answer.
const SECONDS_VARIABLE: &str = "PATHWARP_PLUGIN_SECONDS";

/// Default number of seconds for one answer, ample for slow interpreters on a busy machine.
const SECONDS: f64 = 10.0;

/// Largest number of points in one request. More are split, so that a program needs little memory and answers in time.
pub(crate) const MAX_POINTS: usize = 1 << 13;

pub(crate) const MAX_ENTRY_BYTES: usize = 1 << 18;

/// Limit on an answer that is a message or a list of creases.
pub(crate) const MAX_MESSAGE_BYTES: usize = 1 << 16;

/// Limit on a line with the answer for one point: six numbers of up to 25 characters, with some room to spare.
pub(crate) const MAX_LINE_BYTES: usize = 256;

/// Limit on standard error over the whole run of a program.
const MAX_ERROR_BYTES: usize = 1 << 20;

/// Bytes of standard error to keep for messages.
const KEPT_ERROR_BYTES: usize = 4096;

/// Limit on the part of standard error that messages quote.
const MAX_QUOTED_BYTES: usize = 300;

/// Returns the time limit for one answer.
pub(crate) fn time() -> Duration {
    static TIME: OnceLock<Duration> = OnceLock::new();
    *TIME.get_or_init(|| {
        let given = std::env::var(SECONDS_VARIABLE).ok().and_then(|t| t.parse().ok());
        let seconds: f64 = given.filter(|s: &f64| *s > 0.0 && *s < 1e6).unwrap_or(SECONDS);
        Duration::from_secs_f64(seconds)
    })
}
