//! Handles the three pipes of a program where they cannot be polled, with a thread for each.

use crate::child::{GRACE, POLL_INTERVAL, Running};
use crate::fault::{Fault, StandardError, time};
use std::io::{Read, Write};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, channel, sync_channel};
use std::thread::Builder;
use std::time::{Duration, Instant};

/// Capacity of the queue of events. A program that writes more has to wait.
const WAITING: usize = 4;

/// An event at a pipe.
enum Event {
    Output(Vec<u8>),
    Errors(Vec<u8>),
    Ended(&'static str),
}

/// The pipes of a running program.
pub(crate) struct Pipes {
    requests: Sender<Vec<u8>>,
    events: Receiver<Event>,
    /// Bytes received and not yet taken.
    incoming: Vec<u8>,
    said: StandardError,
}

impl Pipes {
    pub(crate) fn new(running: &Running) -> Result<Self, Fault> {
        let (mut input, output, errors) = running.pipes().ok_or_else(|| Fault::NotStarted("without pipes".into()))?;
        let (requests, to_write) = channel::<Vec<u8>>();
        let (happened, events) = sync_channel(WAITING);
        let at_input = happened.clone();
        let threads = [
            Builder::new().spawn(move || {
                while let Ok(request) = to_write.recv() {
                    if input.write_all(&request).and_then(|()| input.flush()).is_err() {
                        let _ = at_input.send(Event::Ended("input"));
                        break;
                    }
                }
            }),
            forward(output, happened.clone(), Event::Output, Some("output")),
            forward(errors, happened, Event::Errors, None),
        ];
        for thread in threads {
            thread.map_err(|e| Fault::NotStarted(e.to_string()))?;
        }
        Ok(Self { requests, events, incoming: Vec::new(), said: StandardError::default() })
    }

    /// Sends `request` and reads until `whole` finds the end of the answer, which may take up to `limit` bytes.
    pub(crate) fn exchange(
        &mut self,
        running: &mut Running,
        request: &[u8],
        (expected, limit): (&dyn Fn() -> String, usize),
        mut whole: impl FnMut(&[u8]) -> Result<Option<usize>, Fault>,
    ) -> Result<Vec<u8>, Fault> {
        let until = Instant::now() + time();
        let mut ended = None;
        if !request.is_empty() && self.requests.send(request.to_owned()).is_err() {
            ended = Some("input");
        }
        loop {
            if let Some(length) = whole(&self.incoming)?.filter(|n| *n <= self.incoming.len()) {
                let later = self.incoming.split_off(length);
                return Ok(std::mem::replace(&mut self.incoming, later));
            }
            if self.incoming.len() > limit {
                return Err(Fault::Flood { expected: expected(), limit });
            }
            if let Some(stream) = ended {
                return Err(self.stopped(running, stream, expected));
            }
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                let (expected, said) = (expected(), self.said.readable());
                return Err(Fault::Silent { expected, seconds: time().as_secs_f64(), said });
            }
            match self.events.recv_timeout(left.min(POLL_INTERVAL)) {
                Ok(Event::Output(bytes)) => self.incoming.extend(bytes),
                Ok(Event::Errors(bytes)) => self.hear(&bytes)?,
                Ok(Event::Ended(stream)) => ended = Some(stream),
                Err(RecvTimeoutError::Timeout) if !running.has_ended() => {}
                Err(_) => ended = Some("output"),
            }
        }
    }

    /// Returns the end of standard error so far.
    pub(crate) fn said(&mut self) -> String {
        while let Ok(event) = self.events.try_recv() {
            match event {
                Event::Output(bytes) => self.incoming.extend(bytes),
                Event::Errors(bytes) if self.hear(&bytes).is_ok() => {}
                _ => break,
            }
        }
        self.said.readable()
    }

    /// Returns the bytes received after the last answer.
    pub(crate) fn left_over(&self) -> &[u8] {
        &self.incoming
    }

    fn hear(&mut self, bytes: &[u8]) -> Result<(), Fault> {
        self.said.push(bytes);
        self.said.check()
    }

    /// Waits for the end of a program that seems to have ended or closed a stream, hears it out, and returns its fault.
    fn stopped(&mut self, running: &mut Running, stream: &str, expected: &dyn Fn() -> String) -> Fault {
        let until = Instant::now() + GRACE;
        while Instant::now() < until && !running.has_ended() {
            std::thread::sleep(Duration::from_millis(1));
        }
        while let Ok(event) = self.events.recv_timeout(Duration::from_millis(10)) {
            if let Event::Errors(bytes) = event
                && let Err(fault) = self.hear(&bytes)
            {
                return fault;
            }
        }
        running.fault(stream, expected(), self.said.readable())
    }
}

/// Starts a thread that forwards all bytes read from `pipe` as events, and the end of the stream if it has a `name`.
fn forward(
    mut pipe: impl Read + Send + 'static,
    happened: SyncSender<Event>,
    event: fn(Vec<u8>) -> Event,
    name: Option<&'static str>,
) -> std::io::Result<std::thread::JoinHandle<()>> {
    Builder::new().spawn(move || {
        let mut chunk = vec![0; 1 << 16];
        while let Ok(n) = pipe.read(&mut chunk) {
            if n == 0 || happened.send(event(chunk[..n].to_owned())).is_err() {
                break;
            }
        }
        if let Some(name) = name {
            let _ = happened.send(Event::Ended(name));
        }
    })
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::PermissionsExt;

    /// Runs a script, sends it `request`, and waits for an answer of `length` bytes and at most 1000.
    fn ask(script: &str, request: &[u8], length: usize) -> Result<Vec<u8>, Fault> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("script");
        fs::write(&file, format!("#!/bin/sh\n{script}\n")).unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).unwrap();
        let mut running = Running::start(&file)?;
        let mut pipes = Pipes::new(&running)?;
        let answer = pipes.exchange(&mut running, request, (&|| "an answer".to_owned(), 1000), |b| {
            Ok((b.len() >= length).then_some(length))
        });
        assert!(answer.is_err() || pipes.left_over().is_empty());
        assert!(answer.is_err() || pipes.said().is_empty() || script.contains(">&2"));
        answer
    }

    #[test]
    fn answers_arrive_and_faults_are_told() {
        // More bytes than a pipe can hold.
        let request = vec![b'x'; 300_000];
        assert_eq!(ask("head -c 300000 | wc -c | tr -d ' \n'", &request, 6), Ok(b"300000".to_vec()));
        let ended = ask("echo sorry >&2; exit 5", b"", 1).unwrap_err();
        assert!(matches!(&ended, Fault::Ended { said, .. } if said == "sorry"), "{ended:?}");
        assert!(ended.to_string().contains("exit status: 5"), "{ended}");
        assert!(matches!(ask("exec yes", b"", 100_000), Err(Fault::Flood { limit: 1000, .. })));
        assert!(matches!(ask("exec yes >&2", b"", 1), Err(Fault::ErrorFlood(_))));
        assert!(matches!(ask("exec >&-; exec sleep 100", b"", 1), Err(Fault::Closed { .. })));
        assert!(matches!(ask("sleep 100 & exit 4", b"", 1), Err(Fault::Ended { .. })));
    }
}
