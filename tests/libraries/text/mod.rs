//! Lettering.

mod common;
mod harfbuzz;
mod layout;
