//! Handles the three pipes of a program on Unix. One loop writes, reads, and checks the clock, so that neither side can block the
//! other, and a short answer waits for no other thread.

use crate::child::{GRACE, POLL_INTERVAL, Running};
use crate::fault::{Fault, StandardError, time};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{OFlags, fcntl_setfl};
use std::io::{ErrorKind, Read, Write};
use std::process::{ChildStderr, ChildStdin, ChildStdout};
use std::time::{Duration, Instant};

/// The pipes of a running program.
pub(crate) struct Pipes {
    input: ChildStdin,
    output: ChildStdout,
    errors: Option<ChildStderr>,
    /// Bytes received and not yet taken.
    incoming: Vec<u8>,
    said: StandardError,
    chunk: Box<[u8]>,
}

impl Pipes {
    pub(crate) fn new(running: &Running) -> Result<Self, Fault> {
        let (input, output, errors) = running.pipes().ok_or_else(|| Fault::NotStarted("without pipes".into()))?;
        let unblocked = fcntl_setfl(&input, OFlags::NONBLOCK)
            .and_then(|()| fcntl_setfl(&output, OFlags::NONBLOCK))
            .and_then(|()| fcntl_setfl(&errors, OFlags::NONBLOCK));
        unblocked.map_err(|e| Fault::NotStarted(e.to_string()))?;
        Ok(Self {
            input,
            output,
            errors: Some(errors),
            incoming: Vec::new(),
            said: StandardError::default(),
            chunk: vec![0; 1 << 16].into_boxed_slice(),
        })
    }

    /// Sends `request` and reads until `whole` finds the end of the answer, which may take up to `limit` bytes.
    pub(crate) fn exchange(
        &mut self,
        running: &mut Running,
        request: &[u8],
        (expected, limit): (&dyn Fn() -> String, usize),
        mut whole: impl FnMut(&[u8]) -> Result<Option<usize>, Fault>,
    ) -> Result<Vec<u8>, Fault> {
        let (mut rest, until) = (request, Instant::now() + time());
        loop {
            // An answer may arrive before everything is sent, since points follow a request to build.
            if rest.is_empty()
                && let Some(length) = whole(&self.incoming)?.filter(|n| *n <= self.incoming.len())
            {
                let later = self.incoming.split_off(length);
                return Ok(std::mem::replace(&mut self.incoming, later));
            }
            if self.incoming.len() > limit {
                return Err(Fault::Flood { expected: expected(), limit });
            }
            rest = self.write(rest).or_else(|()| self.stopped(running, "input", expected).map(|()| &[][..]))?;
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                if self.input_is_closed() {
                    self.stopped(running, "input", expected)?;
                }
                let (expected, said) = (expected(), self.said.readable());
                return Err(Fault::Silent { expected, seconds: time().as_secs_f64(), said });
            }
            let [can_read, can_hear] = self.wait(!rest.is_empty(), left.min(POLL_INTERVAL));
            if can_hear {
                self.hear()?;
            }
            let is_over =
                if can_read { !self.read() } else { running.has_ended() && !self.wait(false, Duration::ZERO)[0] };
            if is_over {
                self.stopped(running, "output", expected)?;
            }
        }
    }

    /// Returns the end of standard error so far.
    pub(crate) fn said(&mut self) -> String {
        while self.wait(false, Duration::ZERO)[1] && self.hear().is_ok() {}
        self.said.readable()
    }

    /// Returns the bytes received after the last answer.
    pub(crate) fn left_over(&self) -> &[u8] {
        &self.incoming
    }

    /// Writes as much as fits, and returns the rest. `Err` means that the pipe is closed.
    fn write<'a>(&mut self, mut rest: &'a [u8]) -> Result<&'a [u8], ()> {
        while !rest.is_empty() {
            match self.input.write(rest) {
                Ok(n) => rest = &rest[n..],
                Err(e) if e.kind() == ErrorKind::WouldBlock => break,
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(_) => return Err(()),
            }
        }
        Ok(rest)
    }

    /// Returns `true` if the program has closed its input, possibly after a request was written to the pipe.
    fn input_is_closed(&self) -> bool {
        let mut fds = [PollFd::new(&self.input, PollFlags::empty())];
        poll(&mut fds, Some(&Timespec { tv_sec: 0, tv_nsec: 0 })).is_ok() && !fds[0].revents().is_empty()
    }

    /// Waits until there is something to do. Returns `true` for output, and for errors, if there is something to read or the stream ended.
    fn wait(&self, write: bool, time: Duration) -> [bool; 2] {
        let mut fds = vec![PollFd::new(&self.output, PollFlags::IN)];
        fds.extend(self.errors.as_ref().map(|e| PollFd::new(e, PollFlags::IN)));
        if write {
            fds.push(PollFd::new(&self.input, PollFlags::OUT));
        }
        let time = Timespec { tv_sec: 0, tv_nsec: time.subsec_nanos().into() };
        // The caller repeats an interrupted wait.
        if poll(&mut fds, Some(&time)).is_err() {
            return [false; 2];
        }
        let ready = |i: usize| fds.get(i).is_some_and(|fd| !fd.revents().is_empty());
        [ready(0), self.errors.is_some() && ready(1)]
    }

    /// Reads the available output. Returns `false` at the end of the stream.
    fn read(&mut self) -> bool {
        match self.output.read(&mut self.chunk) {
            Ok(0) => false,
            Ok(n) => {
                self.incoming.extend_from_slice(&self.chunk[..n]);
                true
            }
            Err(e) => matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted),
        }
    }

    /// Reads the available standard error.
    fn hear(&mut self) -> Result<(), Fault> {
        let Some(errors) = &mut self.errors else { return Ok(()) };
        match errors.read(&mut self.chunk) {
            Ok(0) => self.errors = None,
            Ok(n) => self.said.push(&self.chunk[..n]),
            Err(e) if matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
            Err(_) => self.errors = None,
        }
        self.said.check()
    }

    /// Waits for the end of a program that seems to have ended or closed a stream, hears it out, and returns its fault.
    fn stopped(&mut self, running: &mut Running, stream: &str, expected: &dyn Fn() -> String) -> Result<(), Fault> {
        let until = Instant::now() + GRACE;
        while Instant::now() < until && !(running.has_ended() && self.errors.is_none()) {
            if !self.wait(false, POLL_INTERVAL.min(GRACE / 10))[1] && running.has_ended() {
                break;
            }
            self.hear()?;
            std::thread::sleep(Duration::from_millis(1));
        }
        Err(running.fault(stream, expected(), self.said.readable()))
    }
}
