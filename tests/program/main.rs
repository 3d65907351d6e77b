//! Tests of the whole program from outside. They are one test binary, so that the program's crates are linked once.

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

mod architecture;
mod c_header;
mod cli;
mod data;
mod editor;
mod envelope;
mod filters;
mod formats;
mod gimp;
mod gradient_colors;
mod gradients;
mod guarantee;
mod hostile;
mod inkscape;
mod lettering;
mod linked_pictures;
mod mirror;
mod oracle;
mod photographs;
mod pictures;
#[cfg(unix)]
mod plugins;
mod presets;
mod recipes;
mod scripts;
mod solid;
mod straightened;
#[path = "../support/mod.rs"]
mod support;
mod text;
mod text_shapes;
mod watertight;
