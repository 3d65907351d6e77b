//! Drawings read, warped and written. One program: linking takes longer than most of these tests run.

mod arcs;
#[path = "../common/mod.rs"]
mod common;
mod covers;
mod degenerate_strokes;
mod features;
mod filters;
mod keeping;
mod lettering;
mod live;
mod open_fills;
mod page;
mod patterns;
mod reading;
mod report;
mod seen;
mod strokes;
mod structure;
mod style;
mod unsupported;
mod vector_images;
