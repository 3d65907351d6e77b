//! A running program that is asked for its entry, maps and points.

use crate::answer::{Ask, BuildAnswer};
use crate::child::Running;
use crate::fault::{Fault, beginning};
use crate::instance::Instance;
use crate::limits::{ENTRY_BYTES, LINE_BYTES, MESSAGE_BYTES};
#[cfg(unix)]
use crate::pipes_by_poll::Pipes;
#[cfg(not(unix))]
use crate::pipes_by_threads::Pipes;
use crate::text::LineCount;
use crate::{binary, text};
use pathwarp::kurbo::Point;
use serde::Deserialize;
use std::path::Path;

/// The form of the protocol.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Protocol {
    #[default]
    Binary,
    Text,
}

/// A running program.
pub(crate) struct Session {
    running: Running,
    pipes: Pipes,
    /// The map it has built last; 0 for none.
    pub(crate) instance: u64,
}

/// Words for messages.
const ENTRY: &str = "its entry as JSON with a line break after it";
const BUILT: &str = "the answer to `build`";

impl Session {
    /// Starts the program. Returns the text of its entry, too.
    pub(crate) fn start(path: &Path) -> Result<(Self, Vec<u8>), Fault> {
        let running = Running::start(path)?;
        let pipes = Pipes::new(&running)?;
        let mut session = Self { running, pipes, instance: 0 };
        let mut scan = JsonScan::default();
        let entry = session.exchange(&[], (ENTRY, ENTRY_BYTES), |bytes| scan.end(bytes))?;
        Ok((session, entry))
    }

    /// Builds a map.
    pub(crate) fn build(&mut self, protocol: Protocol, instance: &Instance) -> Result<BuildAnswer, Fault> {
        let answer = self.built(protocol, &instance.request)?;
        self.nothing_left(BUILT)?;
        self.instance = instance.id;
        Ok(answer)
    }

    fn built(&mut self, protocol: Protocol, request: &[u8]) -> Result<BuildAnswer, Fault> {
        let (expected, limit) = (BUILT, MESSAGE_BYTES);
        match protocol {
            Protocol::Text => {
                let bytes = self.exchange(request, (expected, limit), |b| Ok(text::build_length(b)))?;
                text::read_build(&bytes)
            }
            Protocol::Binary => {
                let bytes = self.exchange(request, (expected, limit), |b| binary::length(b, None, expected))?;
                text::read_build(binary::body(&bytes)?)
            }
        }
    }

    /// Asks for a batch of a map, which is built first if it is not the last one. Appends the numbers of the answer to `out`.
    pub(crate) fn ask(
        &mut self,
        protocol: Protocol,
        instance: &Instance,
        (ask, points): (Ask, &[Point]),
        out: &mut Vec<f64>,
    ) -> Result<(), Fault> {
        let count = points.len();
        let expected = format!("the answer for {count} {}", if count == 1 { "point" } else { "points" });
        let must_build = self.instance != instance.id;
        let mut request = if must_build { instance.request.clone() } else { Vec::new() };
        match protocol {
            Protocol::Text => text::batch(ask, points, &mut request),
            Protocol::Binary => binary::batch(ask, points, &mut request),
        }
        if must_build {
            // Both requests go at once; this reads the first answer.
            self.built(protocol, &request)?;
            self.instance = instance.id;
            request.clear();
        }
        let body = 8 * ask.numbers() * count;
        match protocol {
            Protocol::Text => {
                let mut lines = LineCount::default();
                let limit = LINE_BYTES * count + MESSAGE_BYTES;
                let bytes = self.exchange(&request, (&expected, limit), |b| Ok(lines.length(b, count)))?;
                text::read_batch(&bytes, ask, out)?;
            }
            Protocol::Binary => {
                let limit = body + MESSAGE_BYTES;
                let whole = |b: &[u8]| binary::length(b, Some(body), &expected);
                let bytes = self.exchange(&request, (&expected, limit), whole)?;
                binary::read_batch(&bytes, out)?;
            }
        }
        self.nothing_left(&expected)
    }

    fn exchange(
        &mut self,
        request: &[u8],
        expected: (&str, usize),
        whole: impl FnMut(&[u8]) -> Result<Option<usize>, Fault>,
    ) -> Result<Vec<u8>, Fault> {
        self.pipes.exchange(&mut self.running, request, expected, whole)
    }

    /// Checks that the program has not written more than its answer.
    fn nothing_left(&self, expected: &str) -> Result<(), Fault> {
        match self.pipes.left_over() {
            [] => Ok(()),
            more => {
                let found = format!("is followed by {}", beginning(more));
                Err(Fault::Count { expected: expected.to_owned(), found })
            }
        }
    }
}

/// Finds the end of a JSON object as it arrives.
#[derive(Default)]
struct JsonScan {
    seen: usize,
    depth: usize,
    in_text: bool,
    escaped: bool,
    /// The closing brace was seen.
    closed: bool,
}

impl JsonScan {
    /// The length up to the line break after the object, once it is there.
    fn end(&mut self, bytes: &[u8]) -> Result<Option<usize>, Fault> {
        let garbage = || Fault::Garbage { expected: ENTRY.into(), found: beginning(bytes) };
        for (i, b) in bytes.iter().enumerate().skip(self.seen) {
            match b {
                b'\n' if self.closed => return Ok(Some(i + 1)),
                b if self.closed && !b.is_ascii_whitespace() => return Err(garbage()),
                b if self.depth == 0 && !self.closed && *b != b'{' && !b.is_ascii_whitespace() => return Err(garbage()),
                _ if self.escaped => self.escaped = false,
                b'\\' if self.in_text => self.escaped = true,
                b'"' => self.in_text = !self.in_text,
                b'{' if !self.in_text => self.depth += 1,
                b'}' if !self.in_text => {
                    self.depth -= 1;
                    self.closed = self.depth == 0;
                }
                _ => {}
            }
        }
        self.seen = bytes.len();
        Ok(None)
    }
}
