//! Lettering in a drawing: lines with their baselines, and the letters that stand on them.

mod write;

pub use write::{LetteringOptions, write_lettering};
