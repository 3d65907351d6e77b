//! Threads that survive `fork`, and work on them that Ctrl-C ends. Python forks processes (multiprocessing, Spark), and a child has none
//! of its parent's threads, so a pool started before would never answer. Each process therefore starts a pool when it first needs one.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::borrow::Borrow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// A pool, and the process that started it.
struct Pool {
    process: u32,
    threads: usize,
    pool: Arc<ThreadPool>,
}

static POOL: Mutex<Option<Pool>> = Mutex::new(None);

/// Number of threads. 0 means the value of the environment variable `RAYON_NUM_THREADS`, or one per core.
static THREADS: AtomicUsize = AtomicUsize::new(0);

/// Interval of checking Python's signals during work.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// Sets the number of threads; 0 means one per core. Results do not depend on it.
#[pyfunction]
pub(crate) fn use_threads(count: usize) {
    THREADS.store(count, Ordering::Relaxed);
}

/// A switch that ends work. Limits hold a `&'static` reference to it, so it is never freed; a dropped one is reused.
struct Switch(&'static AtomicBool);

static SWITCHES: Mutex<Vec<&'static AtomicBool>> = Mutex::new(Vec::new());

impl Switch {
    fn take() -> Self {
        let unused = lock(&SWITCHES).pop();
        Self(unused.unwrap_or_else(|| Box::leak(Box::default())))
    }
}

impl Drop for Switch {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Relaxed);
        lock(&SWITCHES).push(self.0);
    }
}

/// Locks a mutex, also after a panic.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// State shared by work and the thread that waits for its end.
#[derive(Default)]
struct End {
    reached: Mutex<bool>,
    news: Condvar,
}

/// Signals the end when it is dropped, even by a panic.
struct Ending<E: Borrow<End>>(E);

impl<E: Borrow<End>> Drop for Ending<E> {
    fn drop(&mut self) {
        let end = self.0.borrow();
        *lock(&end.reached) = true;
        end.news.notify_all();
    }
}

impl End {
    /// Waits without the interpreter's lock. Meanwhile, it calls `poll` and checks Python's signals. If one of them raises an exception,
    /// the switch is turned, and the exception is returned at the end, or after `patience` more intervals.
    fn wait(
        &self,
        py: Python<'_>,
        mut poll: impl FnMut() -> PyResult<()>,
        stop: &AtomicBool,
        mut patience: usize,
    ) -> PyResult<()> {
        let mut polled = Ok(());
        let wait = || {
            let waited = self.news.wait_timeout_while(lock(&self.reached), POLL_INTERVAL, |reached| !*reached);
            *waited.unwrap_or_else(PoisonError::into_inner).0
        };
        while !py.detach(wait) {
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

/// Calls `work` on the threads of this process, without the interpreter's lock. Ctrl-C turns the switch passed to `work`, and is raised
/// when `work` has ended.
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
            *lock(&result) = Some(work(stop));
        });
        end.wait(py, || Ok(()), stop, usize::MAX)
    });
    waited.and_then(|()| done(&result))
}

/// Calls `work`, which owns its data, on the threads of this process, without the interpreter's lock. After Ctrl-C, it returns soon, even
/// if `work` goes on. `poll` is called from time to time.
pub(crate) fn on_threads_abandonable<T: Send + 'static>(
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
    let (ending, slot) = (Ending(Arc::clone(&end)), Arc::clone(&result));
    pool.spawn(move || {
        // They are dropped in reverse order: the switch is released before the end is signalled, so that the next call can reuse it.
        let _ending = ending;
        let _switch = switch;
        // A panic must not end the process; the missing result is reported.
        let worked = catch_unwind(AssertUnwindSafe(|| work(stop)));
        *lock(&slot) = worked.ok();
    });
    end.wait(py, poll, stop, 2)?;
    done(&result)
}

/// Returns the result of work, which is missing after a panic.
fn done<T>(result: &Mutex<Option<T>>) -> PyResult<T> {
    lock(result).take().ok_or_else(|| PyRuntimeError::new_err("pathwarp failed; please report it"))
}

/// Returns the threads of this process. `None` if it may start none, or if the caller is one of them, as in a function that a map calls:
/// work must then be done at once.
fn pool() -> Option<Arc<ThreadPool>> {
    if rayon::current_thread_index().is_some() {
        return None;
    }
    let (process, threads) = (std::process::id(), THREADS.load(Ordering::Relaxed));
    let mut current = lock(&POOL);
    if let Some(p) = current.as_ref().filter(|p| p.process == process && p.threads == threads) {
        return Some(Arc::clone(&p.pool));
    }
    let pool = Arc::new(ThreadPoolBuilder::new().num_threads(threads).build().ok()?);
    if let Some(old) = current.replace(Pool { process, threads, pool: Arc::clone(&pool) })
        && old.process != process
    {
        // Its threads do not exist in this process; ending them could wait for ever.
        std::mem::forget(old);
    }
    Some(pool)
}
