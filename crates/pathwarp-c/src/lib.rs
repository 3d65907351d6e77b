//! pathwarp for C. `include/pathwarp.h` is the documentation; a test compares it with the functions here.
//!
//! `exports.rs` holds the functions, `raw.rs` what they do with pointers, and `function.rs` the maps that are functions of C. No panic crosses the border.

mod exports;
mod function;
mod raw;

pub use exports::*;
pub use function::{MapFn, PathwarpFunction};
