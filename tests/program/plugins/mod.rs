//! Plug-ins that are programs: what they can do, and everything that one can do wrong.

mod faults;
mod interruption;
mod results;
