//! What the fuzz targets share: small limits, a clock, checks of a warped path, and the program run in this process.

mod program;
mod warped;

pub use program::Program;
pub use warped::{check_built, check_map};

use cpu_time::ProcessTime;
use pathwarp::budget::{Limit, Limits};
use std::time::Duration;

/// Most processor time of one input. The limits below allow about a tenth of it; the rest is for sanitizers and coverage.
const MOST_TIME: Duration = Duration::from_secs(5);

/// Limits that keep one input below a second.
#[must_use]
pub fn limits() -> Limits {
    SMALL.into_iter().fold(Limits::default(), |limits, (limit, most)| limits.with(limit, most))
}

/// A hundredth of the program's own limits.
const SMALL: [(Limit, f64); 4] =
    [(Limit::Bytes, 500e3), (Limit::Elements, 1000.0), (Limit::Pixels, 1e6), (Limit::Work, 1e6)];

/// Lets panics of libraries pass: pathwarp turns those it knows of into errors, which libFuzzer's hook would not let it do. A panic
/// that nobody catches counts all the same.
pub fn let_libraries_panic() {
    let abort = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        // Cargo's folder for crates from the registry.
        if panic.location().is_some_and(|l| l.file().contains("/registry/src/")) {
            eprintln!("in a library: {panic}");
        } else {
            abort(panic);
        }
    }));
}

/// Runs one input.
///
/// # Panics
/// It takes too much processor time, which is a finding as any other. libFuzzer's own clock counts time that other programs took.
pub fn bounded(run: impl FnOnce()) {
    let started = ProcessTime::now();
    run();
    let took = started.elapsed();
    assert!(took < MOST_TIME, "one input takes {took:?}");
}
