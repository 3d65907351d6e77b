//! The options that every deformation shares.
//!
//! `table.rs` declares each of them once. clap's arguments (`args.rs`), the values given on a command line or in a recipe
//! (`given.rs`), the typed struct (`common.rs`), the recipe schema, help and man page all come from that table.

mod args;
mod common;
mod definition;
mod given;
mod parse;
mod reading;
mod table;
mod typed_box;

pub(crate) use args::{INPUT, args, inputs_arg, options_without_inputs, reading_args, some_options};
pub(crate) use common::{CommonOptions, FrameChoice, GradientChoice, OnFailure};
pub(crate) use definition::{CommonOption, OptionValue};
pub(crate) use given::Given;
pub(crate) use parse::rect;
pub(crate) use reading::Reading;
pub(crate) use table::OPTIONS;
