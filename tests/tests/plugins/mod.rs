//! Plug-ins that are programs: the ways to write one, and everything that one can do wrong.

mod authors;
mod common;
mod faults;
mod guide;
mod interruption;
mod results;
