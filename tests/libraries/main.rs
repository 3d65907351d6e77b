//! The libraries from outside: against independent measurements, formulas and other programs. All tests are one program, since linking
//! takes longer than most of them run.

#![allow(
    unreachable_pub,
    unused_qualifications,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "tests may panic, and say what they find"
)]

mod bending;
mod gimp;
mod measures;
mod psd;
mod raster;
mod solid;
#[path = "../support/mod.rs"]
mod support;
mod svg;
mod text;
