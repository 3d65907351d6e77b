//! Runs work on several threads, or with a large stack.

use pathwarp::Error;

/// Returns `f(0)`, …, `f(n − 1)`.
#[cfg(feature = "parallel")]
pub(crate) fn map_parallel<T: Send>(n: usize, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    use rayon::prelude::*;
    (0..n).into_par_iter().map(f).collect()
}

/// Returns `f(0)`, …, `f(n − 1)`.
#[cfg(not(feature = "parallel"))]
pub(crate) fn map_parallel<T>(n: usize, f: impl Fn(usize) -> T) -> Vec<T> {
    (0..n).map(f).collect()
}

/// Returns the results of both.
#[cfg(feature = "parallel")]
pub(crate) fn both<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    rayon::join(a, b)
}

/// Returns the results of both.
#[cfg(not(feature = "parallel"))]
pub(crate) fn both<A, B>(a: impl FnOnce() -> A, b: impl FnOnce() -> B) -> (A, B) {
    (a(), b())
}

/// Runs `f` with a stack for the deepest nesting that the parsers accept (1024 elements).
pub(crate) fn with_stack<T: Send>(name: &str, f: impl FnOnce() -> Result<T, Error> + Send) -> Result<T, Error> {
    const STACK: usize = 128 << 20;
    let failed = |why: &str| Error::input(name, format!("this drawing cannot be read: {why}"));
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, f);
        match thread {
            Ok(t) => t.join().unwrap_or_else(|_| Err(failed("the SVG library failed on it"))),
            Err(e) => Err(failed(&format!("cannot start a thread: {e}"))),
        }
    })
}
