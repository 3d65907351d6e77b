//! The program beside other programs: browsers, Inkscape, GIMP, Poppler, Python, cargo. `.ci/run` runs these tests, and `cargo test` leaves
//! them out. Where a program is not installed, a line names the tests that are skipped.

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

mod browser;
mod drawings;
mod gimp;
mod inkscape;
mod new_deformation;
mod page;
mod pdf;
#[cfg(unix)]
mod plugins;
mod scripts;
mod styles;
#[path = "../support/mod.rs"]
mod support;
#[cfg(unix)]
mod terminal;
