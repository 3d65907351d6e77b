//! Plug-ins that are programs: their abilities, and everything that they can do wrong.

mod faults;
mod interruption;
mod results;
