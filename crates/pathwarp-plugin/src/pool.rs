//! The processes of one program: as many as threads ask at the same time.

use crate::answer::{Ask, BuildAnswer};
use crate::fault::Fault;
use crate::instance::Instance;
use crate::limits::MOST_POINTS;
use crate::session::{Protocol, Session};
use pathwarp::kurbo::Point;
use std::path::PathBuf;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Times that the program may fail to answer in time before it is not asked again.
const MOST_SILENT: usize = 3;

/// A program with its processes.
pub(crate) struct Program {
    pub(crate) path: PathBuf,
    pub(crate) protocol: Protocol,
    /// Processes at most. Asking the system for it takes longer than a request.
    most: usize,
    state: Mutex<State>,
    returned: Condvar,
}

#[derive(Default)]
struct State {
    idle: Vec<Session>,
    /// All processes, idle or not.
    running: usize,
    silent: usize,
}

impl Program {
    /// The work of an answer for this side alone, in evaluations of a net.
    pub(crate) fn work(&self) -> f64 {
        match self.protocol {
            Protocol::Text => 16.0,
            Protocol::Binary => 2.0,
        }
    }

    /// A program, with a process that runs already.
    pub(crate) fn new(path: PathBuf, protocol: Protocol, running: Option<Session>) -> Self {
        let idle = Vec::from_iter(running);
        let state = State { running: idle.len(), idle, silent: 0 };
        let most = std::thread::available_parallelism().map_or(1, usize::from);
        Self { path, protocol, most, state: Mutex::new(state), returned: Condvar::new() }
    }

    /// The end of what the processes have said on standard error.
    pub(crate) fn said(&self) -> Option<String> {
        let all: Vec<String> = self.state().idle.iter_mut().map(Session::said).filter(|s| !s.is_empty()).collect();
        all.into_iter().reduce(|a, b| if a == b { a } else { format!("{a} | {b}") })
    }

    /// Builds a map.
    pub(crate) fn build(&self, instance: &Instance) -> Result<BuildAnswer, Fault> {
        self.with_session(0, |s| s.build(self.protocol, instance))
    }

    /// Asks for points of a map, in batches. Returns the numbers of all answers.
    pub(crate) fn ask(&self, instance: &Instance, ask: Ask, points: &[Point]) -> Result<Vec<f64>, Fault> {
        let mut out = Vec::with_capacity(ask.numbers() * points.len());
        self.with_session(instance.id, |s| {
            points.chunks(MOST_POINTS).try_for_each(|ps| s.ask(self.protocol, instance, &mut [(ask, ps, &mut out)]))
        })?;
        Ok(out)
    }

    /// Asks for the values of `points` and the jets of `others`: at once by the binary protocol, if they are few enough.
    pub(crate) fn ask_both(
        &self,
        instance: &Instance,
        [points, others]: [&[Point]; 2],
    ) -> Result<[Vec<f64>; 2], Fault> {
        if self.protocol == Protocol::Text || points.len() + others.len() > MOST_POINTS {
            return Ok([self.ask(instance, Ask::Points, points)?, self.ask(instance, Ask::Jets, others)?]);
        }
        let (mut values, mut jets) = (Vec::new(), Vec::new());
        let mut batches = [(Ask::Points, points, &mut values), (Ask::Jets, others, &mut jets)];
        self.with_session(instance.id, |s| s.ask(self.protocol, instance, &mut batches))?;
        Ok([values, jets])
    }

    /// Runs `f` with a process, preferably one that has built the map `id`. A process that fails is ended.
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

    fn take(&self, id: u64) -> Result<Session, Fault> {
        let mut state = self.state();
        loop {
            if state.silent >= MOST_SILENT {
                return Err(Fault::Refused(format!(
                    "gave no answer in time {MOST_SILENT} times; it is not asked again"
                )));
            }
            let same = state.idle.iter().position(|s| s.instance == id);
            if let Some(i) = same.or_else(|| state.idle.len().checked_sub(1)) {
                return Ok(state.idle.swap_remove(i));
            }
            if state.running < self.most {
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
