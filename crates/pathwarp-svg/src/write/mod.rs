//! The result as text: the source patched in place, or a file written anew.

mod defs;
mod filter;
pub(crate) mod fragment;
pub(crate) mod keep;
pub(crate) mod lettering;
pub(crate) mod page;
mod pieces;
