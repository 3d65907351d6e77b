//! Hostile files: every command ends with a documented exit code, within the promised time and memory, and reads and writes
//! nothing that was not named.

mod bounded;
mod formulas;
mod markup;
mod numbers;
mod pictures;
#[path = "../support/mod.rs"]
mod support;
mod trust;
