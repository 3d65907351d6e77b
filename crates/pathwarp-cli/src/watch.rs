//! A watchdog: a thread that ends the program if it takes too much processor time or memory.
//!
//! All known work is counted before it is done (`pathwarp::budget`). Libraries may still take forever to read some file, and nothing can
//! interrupt them, so a thread checks the process periodically. It ends the program as an interruption does: temporary files are removed,
//! and no output is half written.

use crate::{interruption, terminal};
use cpu_time::ProcessTime;
use memory_stats::memory_stats;
use pathwarp::budget::{Exceeded, Limit, Limits};
use pathwarp_engine::meter;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Time between two checks. Memory grows by at most about ten megabytes meanwhile.
const INTERVAL: Duration = Duration::from_millis(4);

/// The exit code, equal to that for an unreadable input.
const TOO_MUCH: i32 = 3;

/// The inputs under way and their limits.
struct Watched {
    limits: Limits,
    /// Bytes and pixels counted before the inputs under way. Those counted during a rest only raise the limits.
    before: [u64; 2],
    /// Number of inputs of a batch under way; 0 outside a batch.
    in_batch: usize,
    /// Processor time at the end of the last input.
    since: Duration,
    /// `true` while nothing is watched.
    is_resting: bool,
}

static WATCHED: Mutex<Option<Watched>> = Mutex::new(None);

/// `true` if the watchdog may end the process. Only `main_with` allows it: a program that uses this library must not be ended.
static ALLOWED: AtomicBool = AtomicBool::new(false);

/// Allows the watchdog to end the process.
pub(crate) fn allow() {
    ALLOWED.store(true, Ordering::Relaxed);
}

/// Begins to watch the process, if allowed. Further calls only change the limits.
pub(crate) fn begin(limits: Limits) {
    if !ALLOWED.load(Ordering::Relaxed) {
        return;
    }
    let mut watched = lock();
    if let Some(watched) = watched.as_mut() {
        watched.limits = limits;
        if std::mem::take(&mut watched.is_resting) {
            watched.since = processor_time();
        }
        return;
    }
    let (before, since) = (meter::counted(), Duration::ZERO);
    *watched = Some(Watched { limits, before, in_batch: 0, since, is_resting: false });
    drop(watched);
    // Without the thread, work is still counted.
    let _ = std::thread::Builder::new().stack_size(1 << 17).spawn(watch);
}

/// Stops watching until [`begin`]: an editor may stay open for hours, and limits the work of every picture itself.
pub(crate) fn pause() {
    if let Some(watched) = lock().as_mut() {
        watched.is_resting = true;
    }
}

/// An input of a batch while it is processed. Each has the whole allowance.
pub(crate) struct InBatch(());

impl InBatch {
    pub(crate) fn begin() -> Self {
        if let Some(watched) = lock().as_mut() {
            watched.in_batch += 1;
        }
        Self(())
    }
}

impl Drop for InBatch {
    fn drop(&mut self) {
        if let Some(watched) = lock().as_mut() {
            watched.in_batch = watched.in_batch.saturating_sub(1);
            watched.since = processor_time();
            if watched.in_batch == 0 {
                watched.before = meter::counted();
            }
        }
    }
}

fn lock() -> MutexGuard<'static, Option<Watched>> {
    WATCHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the processor time that all threads have taken.
fn processor_time() -> Duration {
    ProcessTime::now().as_duration()
}

fn watch() {
    loop {
        std::thread::sleep(INTERVAL);
        let Some(exceeded) = lock().as_ref().and_then(Watched::exceeded) else { continue };
        interruption::end_after_cleaning(|| {
            let raise = pathwarp_engine::advice::raise(&exceeded);
            terminal::error(&format!("the run takes {exceeded}; no further output was written; {raise}"));
            std::process::exit(TOO_MUCH);
        });
    }
}

impl Watched {
    /// Returns the exceeded limit, if any. Inputs under way share seconds and memory equally; their whole need is not known yet.
    fn exceeded(&self) -> Option<Exceeded> {
        if self.is_resting {
            return None;
        }
        let inputs = self.in_batch.max(1);
        let now = meter::counted();
        let [bytes, pixels] = [0, 1].map(|i| now[i].saturating_sub(self.before[i]) as f64 / inputs as f64);
        let limits = self.limits.for_input(bytes as usize).for_pixels(pixels);
        let check = |limit, amount: f64| limits.check(limit, amount / inputs as f64).err().map(Exceeded::cut_short);
        let memory = || memory_stats().map_or(0, |m| m.physical_mem);
        check(Limit::Seconds, processor_time().saturating_sub(self.since).as_secs_f64())
            .or_else(|| check(Limit::Memory, memory() as f64))
    }
}
