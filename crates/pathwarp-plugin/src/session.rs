//! Talks to running programs: asks for their entries, maps and points.

use crate::answer::BuildAnswer;
use crate::binary;
use crate::child::Running;
use crate::fault::{Fault, MAX_ENTRY_BYTES, MAX_LINE_BYTES, MAX_MESSAGE_BYTES, MAX_POINTS, beginning};
#[cfg(unix)]
use crate::pipes_by_poll::Pipes;
#[cfg(not(unix))]
use crate::pipes_by_threads::Pipes;
use crate::text::{self, LineCount};
use pathwarp::engine::Ask;
use pathwarp::kurbo::Point;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

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
    /// Id of the map built last; 0 for none.
    instance: u64,
}

/// A question about points, and the list for the numbers of the answer.
type Batch<'a> = (Ask, &'a [Point], &'a mut Vec<f64>);

// Names of expected answers in messages.
const ENTRY: &str = "its entry as JSON with a line break after it";
const BUILT: &str = "the answer to `build`";

impl Session {
    /// Starts the program. Also returns the text of its entry.
    pub(crate) fn start(path: &Path) -> Result<(Self, Vec<u8>), Fault> {
        let running = Running::start(path)?;
        let pipes = Pipes::new(&running)?;
        let mut session = Self { running, pipes, instance: 0 };
        let mut scan = JsonScan::default();
        let expected = || ENTRY.to_owned();
        let entry = session.pipes.exchange(&mut session.running, &[], (&expected, MAX_ENTRY_BYTES), |b| scan.end(b))?;
        Ok((session, entry))
    }

    /// Returns the end of the program's standard error.
    fn said(&mut self) -> String {
        self.pipes.said()
    }

    fn build(&mut self, protocol: Protocol, instance: &Instance) -> Result<BuildAnswer, Fault> {
        let answer = self.request_map(protocol, &instance.request, 0)?;
        self.nothing_left(|| BUILT.to_owned())?;
        self.instance = instance.id;
        Ok(answer)
    }

    /// Sends `request`, which starts by requesting a map, and reads the description of the map. Up to `more` bytes may follow it.
    fn request_map(&mut self, protocol: Protocol, request: &[u8], more: usize) -> Result<BuildAnswer, Fault> {
        let expected = || BUILT.to_owned();
        let length = |b: &[u8]| match protocol {
            Protocol::Text => Ok(text::build_length(b)),
            Protocol::Binary => binary::length(b, None, &expected),
        };
        let limit = MAX_MESSAGE_BYTES + more;
        let bytes = self.pipes.exchange(&mut self.running, request, (&expected, limit), length)?;
        match protocol {
            Protocol::Text => text::read_build(&bytes),
            Protocol::Binary => text::read_build(binary::body(&bytes)?),
        }
    }

    /// Asks for batches of a map, which is built first if it is not the last one. All requests are sent at once. Appends the numbers of
    /// each answer to the batch's list.
    fn ask(&mut self, protocol: Protocol, instance: &Instance, batches: &mut [Batch<'_>]) -> Result<(), Fault> {
        let must_build = self.instance != instance.id;
        let mut request = if must_build { instance.request.clone() } else { Vec::new() };
        for (ask, points, _) in batches.iter() {
            match protocol {
                Protocol::Text => text::batch(*ask, points, &mut request),
                Protocol::Binary => binary::batch(*ask, points, &mut request)?,
            }
        }
        // All answers may arrive while the requests are still being sent.
        let mut limit = batches.iter().map(|(ask, points, _)| answer_bytes(protocol, *ask, points.len())).sum();
        if must_build {
            self.request_map(protocol, &request, limit)?;
            self.instance = instance.id;
            request.clear();
        }
        for (ask, points, out) in batches.iter_mut() {
            let count = points.len();
            let expected = || for_points(count);
            let mut lines = LineCount::default();
            let bytes = self.pipes.exchange(&mut self.running, &request, (&expected, limit), |b| match protocol {
                Protocol::Text => Ok(lines.length(b, count)),
                Protocol::Binary => binary::length(b, Some(8 * ask.numbers() * count), &expected),
            })?;
            match protocol {
                Protocol::Text => text::read_batch(&bytes, *ask, out)?,
                Protocol::Binary => binary::read_batch(&bytes, out)?,
            }
            limit -= answer_bytes(protocol, *ask, count);
            request.clear();
        }
        self.nothing_left(|| for_points(batches.last().map_or(0, |(_, points, _)| points.len())))
    }

    /// Checks that the program has written no more than its answer.
    fn nothing_left(&self, expected: impl Fn() -> String) -> Result<(), Fault> {
        match self.pipes.left_over() {
            [] => Ok(()),
            more => {
                let found = format!("is followed by {}", beginning(more));
                Err(Fault::Count { expected: expected(), found })
            }
        }
    }
}

/// Names the expected answer to a batch in messages.
fn for_points(count: usize) -> String {
    format!("the answer for {count} {}", if count == 1 { "point" } else { "points" })
}

/// Returns the largest size of the answer for `count` points, in bytes.
fn answer_bytes(protocol: Protocol, ask: Ask, count: usize) -> usize {
    let body = match protocol {
        Protocol::Text => MAX_LINE_BYTES * count,
        Protocol::Binary => 8 * ask.numbers() * count,
    };
    body + MAX_MESSAGE_BYTES
}

/// Finds the end of a JSON object as it arrives.
#[derive(Default)]
struct JsonScan {
    seen: usize,
    depth: usize,
    in_text: bool,
    escaped: bool,
    /// `true` if the closing brace has been seen.
    closed: bool,
}

impl JsonScan {
    /// Returns the length up to the line break after the object, once that has arrived.
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

/// A map: the request to build it, and an id.
#[derive(Debug)]
pub(crate) struct Instance {
    id: u64,
    request: Vec<u8>,
}

impl Instance {
    /// Makes a map with a new id. Ids start at 1; 0 stands for no map.
    pub(crate) fn new(request: Vec<u8>) -> Self {
        static LAST: AtomicU64 = AtomicU64::new(0);
        Self { id: LAST.fetch_add(1, Ordering::Relaxed) + 1, request }
    }
}

/// Number of timeouts after which a program is not asked again.
const MAX_TIMEOUTS: usize = 3;

/// A program with its processes.
pub(crate) struct Program {
    pub(crate) path: PathBuf,
    pub(crate) protocol: Protocol,
    /// Maximum number of processes, cached because asking the system takes longer than a request.
    max_processes: usize,
    state: Mutex<State>,
    returned: Condvar,
}

#[derive(Default)]
struct State {
    idle: Vec<Session>,
    /// Number of all processes, idle or not.
    running: usize,
    silent: usize,
}

impl Program {
    /// Returns the work of encoding and decoding in this process alone, in evaluations of a net.
    pub(crate) fn work(&self) -> f64 {
        match self.protocol {
            Protocol::Text => 16.0,
            Protocol::Binary => 2.0,
        }
    }

    /// Makes a program, with a process if one is already running.
    pub(crate) fn new(path: PathBuf, protocol: Protocol, running: Option<Session>) -> Self {
        let idle = Vec::from_iter(running);
        let state = State { running: idle.len(), idle, silent: 0 };
        let max_processes = std::thread::available_parallelism().map_or(1, usize::from);
        Self { path, protocol, max_processes, state: Mutex::new(state), returned: Condvar::new() }
    }

    /// Returns the end of the standard error of idle processes.
    pub(crate) fn said(&self) -> Option<String> {
        let all: Vec<String> = self.state().idle.iter_mut().map(Session::said).filter(|s| !s.is_empty()).collect();
        all.into_iter().reduce(|a, b| if a == b { a } else { format!("{a} | {b}") })
    }

    pub(crate) fn build(&self, instance: &Instance) -> Result<BuildAnswer, Fault> {
        self.with_session(0, |s| s.build(self.protocol, instance))
    }

    /// Asks for points of a map, in batches. Returns the numbers of all answers.
    pub(crate) fn ask(&self, instance: &Instance, ask: Ask, points: &[Point]) -> Result<Vec<f64>, Fault> {
        let mut out = Vec::with_capacity(ask.numbers() * points.len());
        self.with_session(instance.id, |s| {
            points.chunks(MAX_POINTS).try_for_each(|ps| s.ask(self.protocol, instance, &mut [(ask, ps, &mut out)]))
        })?;
        Ok(out)
    }

    /// Asks for the values of `points` and the jets of `others`, in one request with the binary protocol if they are few enough.
    pub(crate) fn ask_both(
        &self,
        instance: &Instance,
        [points, others]: [&[Point]; 2],
    ) -> Result<[Vec<f64>; 2], Fault> {
        if self.protocol == Protocol::Text || points.len() + others.len() > MAX_POINTS {
            return Ok([self.ask(instance, Ask::Points, points)?, self.ask(instance, Ask::Jets, others)?]);
        }
        let (mut values, mut jets) = (Vec::new(), Vec::new());
        let mut batches = [(Ask::Points, points, &mut values), (Ask::Jets, others, &mut jets)];
        self.with_session(instance.id, |s| s.ask(self.protocol, instance, &mut batches))?;
        Ok([values, jets])
    }

    /// Runs `f` with a process, preferably one that has built the map `id`; 0 stands for none. A process that fails is ended.
    fn with_session<T>(&self, id: u64, f: impl FnOnce(&mut Session) -> Result<T, Fault>) -> Result<T, Fault> {
        let mut session = self.take(id)?;
        let result = f(&mut session);
        let mut state = self.state();
        if result.is_ok() {
            state.idle.push(session);
        } else {
            state.running -= 1;
            state.silent += usize::from(matches!(result, Err(Fault::Silent { .. })));
            drop(state);
            drop(session);
        }
        self.returned.notify_one();
        result
    }

    /// Takes an idle process, starts one, or waits for one if there are as many as processors.
    fn take(&self, id: u64) -> Result<Session, Fault> {
        let mut state = self.state();
        loop {
            if state.silent >= MAX_TIMEOUTS {
                let why = format!("gave no answer in time {MAX_TIMEOUTS} times; it is not asked again");
                return Err(Fault::Refused(why));
            }
            let same = state.idle.iter().position(|s| s.instance == id);
            if let Some(i) = same.or_else(|| state.idle.len().checked_sub(1)) {
                return Ok(state.idle.swap_remove(i));
            }
            if state.running < self.max_processes {
                state.running += 1;
                break;
            }
            state = self.returned.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        drop(state);
        Session::start(&self.path).map(|(session, _)| session).inspect_err(|_| {
            self.state().running -= 1;
            self.returned.notify_one();
        })
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
