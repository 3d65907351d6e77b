//! Tests of the fitter from outside. They are one program because linking takes longer than most of them run.

#![allow(
    unreachable_pub,
    missing_docs,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "tests may panic, and say what they find"
)]

#[cfg(feature = "area")]
mod areas;
mod common;
mod hard_cases;
mod hidden;
mod long;
mod options;
mod random;
mod scale;
#[cfg(feature = "area")]
mod strokes;
