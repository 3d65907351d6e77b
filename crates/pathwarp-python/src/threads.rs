//! Threads that survive `fork`. Python forks processes (multiprocessing, Spark), and a child has none of its parent's threads, so a
//! pool that was started before would never answer. Each process has its own, started when it is first used.

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// A pool, and the process that started it.
struct Pool {
    process: u32,
    threads: usize,
    pool: Arc<ThreadPool>,
}

static POOL: Mutex<Option<Pool>> = Mutex::new(None);

/// Number of threads; 0: one per core, or as the environment variable `RAYON_NUM_THREADS` says.
static THREADS: AtomicUsize = AtomicUsize::new(0);

/// Sets the number of threads; 0 means one per core. Results do not depend on it.
#[pyfunction]
pub(crate) fn use_threads(count: usize) {
    THREADS.store(count, Ordering::Relaxed);
}

/// Calls `work` on the threads of this process.
pub(crate) fn on_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match pool() {
        Some(pool) => pool.install(work),
        // A process that may start no threads works on one.
        None => work(),
    }
}

fn pool() -> Option<Arc<ThreadPool>> {
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
