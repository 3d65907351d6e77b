//! Steps of a recipe from the words of a command line.

mod chain;
mod params;

pub(crate) use chain::{ChainPart, aliases, assign, chained, parts};
pub(crate) use params::{INVERSE, args, in_lower_case, param_arg, param_values, step};
