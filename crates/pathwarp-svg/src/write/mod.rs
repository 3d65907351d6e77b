//! The result as text: the source patched in place, or flattened to a new file.

pub(crate) mod bent_filters;
mod boxes;
mod defs;
pub(crate) mod document;
mod filter;
mod fragment;
pub(crate) mod input;
mod keep;
mod layers;
pub(crate) mod lettering;
mod line;
mod markup;
mod mesh;
mod page;
mod surroundings;
