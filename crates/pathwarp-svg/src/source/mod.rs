//! The source text: its elements and their positions, edits to it, style sheets, fonts, and usvg's tree of it.

pub(crate) mod cascade;
pub(crate) mod edit;
pub(crate) mod element;
mod encoding;
pub(crate) mod families;
mod fontface;
pub(crate) mod fonts;
pub(crate) mod live;
mod marks;
pub(crate) mod number;
pub(crate) mod parallel;
mod prefixes;
pub(crate) mod read;
pub(crate) mod select;
pub(crate) mod stack;
pub(crate) mod style;
mod table;
pub(crate) mod tags;
pub(crate) mod text;
pub(crate) mod tree;
mod unfold;
pub(crate) mod unpatchable;
pub(crate) mod xml;
