//! Functions of C as maps.

#![expect(unsafe_code, reason = "C's functions can only be called so")]

use crate::raw::{Failed, text, value};
use pathwarp::Error;
use pathwarp::engine::{Abilities, Ask, Callee};
use pathwarp::kurbo::Point;
use std::cell::OnceCell;
use std::ffi::{c_char, c_void};

/// `pathwarp_map_fn` of the header.
pub type MapFn = unsafe extern "C" fn(data: *mut c_void, from: *const f64, to: *mut f64, count: usize) -> i32;

/// `pathwarp_function` of the header, which describes the fields.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PathwarpFunction {
    points: Option<MapFn>,
    jets: Option<MapFn>,
    inverse: Option<MapFn>,
    creases: *const c_char,
    detail: f64,
    any_thread: i32,
    data: *mut c_void,
}

/// The functions of one map, with their data.
pub(crate) struct Function {
    points: MapFn,
    jets: Option<MapFn>,
    inverse: Option<MapFn>,
    data: *mut c_void,
}

// SAFETY: the header requires that any thread may use `data` if `any_thread` is set. Otherwise all calls come from the thread that
// called the library, by `on_calling_thread`.
unsafe impl Send for Function {}
// SAFETY: the reason given for `Send` holds.
unsafe impl Sync for Function {}

impl Function {
    /// Reads a description from C: the functions, their abilities, and `true` if any thread may call them.
    ///
    /// # Safety
    /// `function` is null, or as `pathwarp.h` says.
    pub(crate) unsafe fn read(function: *const PathwarpFunction) -> Result<(Self, Abilities, bool), Failed> {
        // SAFETY: the caller guarantees it.
        let f = unsafe { value(function, "function")? };
        let points = f.points.ok_or_else(|| Failed::usage("function.points is NULL".into()))?;
        // SAFETY: the header requires NULL or a text.
        let creases = if f.creases.is_null() { "" } else { unsafe { text(f.creases, "function.creases")? } };
        let creases = pathwarp_plugin::creases(creases.lines().filter(|l| !l.trim().is_empty()));
        let creases = creases.map_err(|fault| Failed::usage(format!("function.creases: {fault}")))?;
        let detail = Some(f.detail).filter(|d| *d > 0.0 && d.is_finite());
        // The header lets every function write NaN where its map has no image.
        let abilities =
            Abilities { jacobian: f.jets.is_some(), inverse: f.inverse.is_some(), partial: true, creases, detail };
        Ok((Self { points, jets: f.jets, inverse: f.inverse, data: f.data }, abilities, f.any_thread != 0))
    }
}

impl Callee for Function {
    fn ask(&self, ask: Ask, points: &[Point]) -> Result<Vec<f64>, Error> {
        let (name, function) = match ask {
            Ask::Points => ("points", Some(self.points)),
            Ask::Jets => ("jets", self.jets),
            Ask::Inverse => ("inverse", self.inverse),
        };
        let from: Vec<f64> = points.iter().flat_map(|p| [p.x, p.y]).collect();
        let mut to = vec![f64::NAN; ask.numbers() * points.len()];
        let failed = |why: String| Error::input(format!("function.{name}"), why);
        let function = function.ok_or_else(|| failed("is NULL".into()))?;
        // SAFETY: the header requires that it reads and writes the numbers of `points.len()` points.
        match unsafe { function(self.data, from.as_ptr(), to.as_mut_ptr(), points.len()) } {
            0 => Ok(to),
            status => Err(failed(format!("failed with {status}"))),
        }
    }

    fn not_finite(&self, at: Point) -> Error {
        Error::input("function.points", format!("gives no numbers at {},{}", at.x, at.y))
    }
}

/// Runs `work` with the calling thread as its only one.
pub(crate) fn on_calling_thread<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    thread_local! {
        // A thread can join one pool only, for good.
        static POOL_OF_ONE: OnceCell<Option<rayon::ThreadPool>> = const { OnceCell::new() };
    }
    let pool = || rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build().ok();
    POOL_OF_ONE.with(|one| match one.get_or_init(pool) {
        Some(pool) => pool.install(work),
        None => work(),
    })
}

/// Runs `work` on all cores, even on a thread that [`on_calling_thread`] has bound to a pool of one.
pub(crate) fn on_all_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    static ALL: std::sync::OnceLock<Option<rayon::ThreadPool>> = std::sync::OnceLock::new();
    if rayon::current_thread_index().is_none() {
        return work();
    }
    match ALL.get_or_init(|| rayon::ThreadPoolBuilder::new().build().ok()) {
        Some(pool) => pool.install(work),
        None => work(),
    }
}
