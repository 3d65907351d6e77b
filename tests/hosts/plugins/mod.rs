//! Plug-ins in Python, the guide to writing one, and the examples that are crates.

mod authors;
mod guide;
mod results;
