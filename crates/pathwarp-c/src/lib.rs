//! pathwarp for C. `include/pathwarp.h` is the documentation; a test compares it with the functions here.
//!
//! `exports.rs` holds the functions, `raw.rs` what they do with pointers. No panic crosses the border.

mod exports;
mod raw;

pub use exports::*;
