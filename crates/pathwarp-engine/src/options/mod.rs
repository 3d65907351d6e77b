//! The options that every deformation shares.
//!
//! `table.rs` declares each of them once. The values given on a command line or in a recipe (`given.rs`), the typed struct (`common.rs`),
//! clap's arguments, the recipe schema, help and man page all come from that table.

mod common;
mod given;
mod table;

pub use common::{CommonOptions, FrameChoice, OnFailure, Reading, measurable, rect};
pub(crate) use common::{TOLERANCE_OF_DIAGONAL, distance};
pub use given::Given;
pub use table::{CommonOption, LeadingMinus, OPTIONS, OptionValue};
