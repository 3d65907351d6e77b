//! pathwarp for C. `include/pathwarp.h` is the documentation; a test compares it with the functions here.
//!
//! `exports.rs` holds the functions, `raw.rs` handles pointers, and `function.rs` maps by functions of C. No panic crosses the border.

mod exports;
mod function;
mod raw;

pub use exports::*;
pub use function::{MapFn, PathwarpFunction};
