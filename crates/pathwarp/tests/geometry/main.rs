//! Deforming and refitting paths, tested from outside against independent measurements. One program: its tests run side by side, and
//! it is linked once.

#![allow(clippy::unwrap_used, clippy::panic)]

mod budget;
mod exact;
mod few_nodes;
mod figures;
mod lattice;
mod limits;
mod merge_random;
mod random;
mod refit;
mod repeats;
mod report;
mod shaper;
#[path = "../../benches/support/mod.rs"]
mod support;
mod touching;
