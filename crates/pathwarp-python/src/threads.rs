//! Threads that survive `fork`, and work on them that Ctrl-C ends. Python forks processes (multiprocessing, Spark), and a child has none
//! of its parent's threads, so a pool that was started before would never answer. Each process has its own, started when it is first used.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, LockResult, Mutex, PoisonError};
use std::time::Duration;

/// A pool, and the process that started it.
struct Pool {
    process: u32,
    threads: usize,
    pool: Arc<ThreadPool>,
}

static POOL: Mutex<Option<Pool>> = Mutex::new(None);

/// Number of threads; 0: one per core, or as the environment variable `RAYON_NUM_THREADS` says.
static THREADS: AtomicUsize = AtomicUsize::new(0);

/// Time between two looks at Python's signals while work goes on.
const LOOK: Duration = Duration::from_millis(50);

/// Sets the number of threads; 0 means one per core. Results do not depend on it.
#[pyfunction]
pub(crate) fn use_threads(count: usize) {
    THREADS.store(count, Ordering::Relaxed);
}

/// A switch that ends work. It is static, as the work's limits hold it, and used again later.
struct Switch(&'static AtomicBool);

static SWITCHES: Mutex<Vec<&'static AtomicBool>> = Mutex::new(Vec::new());

impl Switch {
    fn take() -> Self {
        let unused = SWITCHES.lock().unwrap_or_else(PoisonError::into_inner).pop();
        Self(unused.unwrap_or_else(|| Box::leak(Box::default())))
    }
}

impl Drop for Switch {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Relaxed);
        SWITCHES.lock().unwrap_or_else(PoisonError::into_inner).push(self.0);
    }
}

/// The end of work.
#[derive(Default)]
struct End {
    reached: Mutex<bool>,
    news: Condvar,
}

/// Tells the end when it is dropped, also by a panic.
struct Ending<E: AsRef<End>>(E);

impl<E: AsRef<End>> Drop for Ending<E> {
    fn drop(&mut self) {
        let end = self.0.as_ref();
        *end.reached.lock().unwrap_or_else(PoisonError::into_inner) = true;
        end.news.notify_all();
    }
}

impl AsRef<Self> for End {
    fn as_ref(&self) -> &Self {
        self
    }
}

impl End {
    /// Waits without the interpreter's lock. In between `poll` is called, and Python's signals are looked at; if one of them raises an
    /// exception, the switch is turned, and the exception is returned at the end, or after as many looks as `patience`.
    fn wait(
        &self,
        py: Python<'_>,
        mut poll: impl FnMut() -> PyResult<()>,
        stop: &AtomicBool,
        mut patience: usize,
    ) -> PyResult<()> {
        let mut polled = Ok(());
        let look = || {
            let reached = self.reached.lock().unwrap_or_else(PoisonError::into_inner);
            *self.news.wait_timeout_while(reached, LOOK, |r| !*r).unwrap_or_else(PoisonError::into_inner).0
        };
        while !py.detach(look) {
            if polled.is_ok() {
                polled = py.check_signals().and_then(|()| poll());
                stop.store(polled.is_err(), Ordering::Relaxed);
            } else if patience == 0 {
                break;
            } else {
                patience -= 1;
            }
        }
        polled
    }
}

/// Calls `work` on the threads of this process, without the interpreter's lock. Ctrl-C turns the switch that it gets, and is raised when it
/// has ended.
pub(crate) fn on_threads<T: Send>(py: Python<'_>, work: impl FnOnce(&'static AtomicBool) -> T + Send) -> PyResult<T> {
    let switch = Switch::take();
    let stop = switch.0;
    let Some(pool) = pool() else {
        return Ok(py.detach(|| work(stop)));
    };
    let (end, result) = (End::default(), Mutex::new(None));
    let waited = pool.in_place_scope(|scope| {
        scope.spawn(|_| {
            let _ending = Ending(&end);
            *result.lock().unwrap_or_else(PoisonError::into_inner) = Some(work(stop));
        });
        end.wait(py, || Ok(()), stop, usize::MAX)
    });
    waited.and_then(|()| done(result.into_inner()))
}

/// As [`on_threads`] for work that owns what it needs: after Ctrl-C it is left alone soon, whatever it is at. `poll` is called from time to
/// time.
pub(crate) fn on_threads_alone<T: Send + 'static>(
    py: Python<'_>,
    poll: impl FnMut() -> PyResult<()>,
    work: impl FnOnce(&'static AtomicBool) -> T + Send + 'static,
) -> PyResult<T> {
    let switch = Switch::take();
    let stop = switch.0;
    let Some(pool) = pool() else {
        return Ok(py.detach(|| work(stop)));
    };
    let end = Arc::new(End::default());
    let result = Arc::new(Mutex::new(None));
    let (ending, place) = (Ending(Arc::clone(&end)), Arc::clone(&result));
    pool.spawn(move || {
        // In this order: the switch is free, and then the end is told.
        let _ending = ending;
        let _switch = switch;
        // A panic must not end the process; without a result it is reported.
        let worked = catch_unwind(AssertUnwindSafe(|| work(stop)));
        *place.lock().unwrap_or_else(PoisonError::into_inner) = worked.ok();
    });
    end.wait(py, poll, stop, 2)?;
    let mut result = result.lock().unwrap_or_else(PoisonError::into_inner);
    done(Ok(result.take()))
}

fn done<T>(result: LockResult<Option<T>>) -> PyResult<T> {
    let result = result.unwrap_or_else(PoisonError::into_inner);
    result.ok_or_else(|| PyRuntimeError::new_err("pathwarp failed; please report it"))
}

/// The threads of this process. `None` if it may start none, and on one of them, as in a function that a map calls: there is no other to
/// wait for then, and work is done at once.
fn pool() -> Option<Arc<ThreadPool>> {
    if rayon::current_thread_index().is_some() {
        return None;
    }
    let (process, threads) = (std::process::id(), THREADS.load(Ordering::Relaxed));
    let mut current = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(p) = current.as_ref().filter(|p| p.process == process && p.threads == threads) {
        return Some(Arc::clone(&p.pool));
    }
    let pool = Arc::new(ThreadPoolBuilder::new().num_threads(threads).build().ok()?);
    if let Some(old) = current.replace(Pool { process, threads, pool: Arc::clone(&pool) })
        && old.process != process
    {
        // Its threads do not exist here; ending them could wait for ever.
        std::mem::forget(old);
    }
    Some(pool)
}
