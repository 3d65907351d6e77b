//! The options that every deformation shares.
//!
//! `table.rs` declares each of them once. clap's arguments and the values given on a command line or in a recipe
//! (`given.rs`), the typed struct (`common.rs`), the recipe schema, help and man page all come from that table.

mod common;
mod given;
mod table;

pub(crate) use common::{
    CommonOptions, FilterChoice, FrameChoice, GradientChoice, OnFailure, Reading, measurable, rect,
};
pub(crate) use given::{Given, INPUT, args, inputs_arg, options_without_inputs, reading_args, some_options};
pub(crate) use table::{CommonOption, OPTIONS, OptionValue};
