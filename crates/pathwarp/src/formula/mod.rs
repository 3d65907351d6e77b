//! Formulas as text: `expr` maps the plane by them, warp styles and text shapes compute their numbers with them.

mod calculator;
mod error;
mod parse;
mod program;

pub(crate) use calculator::Calculator;
pub(crate) use error::{FormulaError, SyntaxError};
pub(crate) use parse::{Names, is_function, is_name, parse};
pub(crate) use program::{Binary, Program};
