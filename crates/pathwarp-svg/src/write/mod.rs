//! The result as text: the source patched in place, or flattened to a new file.

mod arrivals;
mod bitmaps;
mod boxes;
mod defs;
pub(crate) mod document;
mod filter;
mod filter_region;
mod flat;
mod fragment;
mod gradients;
pub(crate) mod input;
mod keep;
pub(crate) mod lettering;
mod markup;
mod masks;
mod page;
mod patterns;
mod style;
mod unsupported;
mod values;
