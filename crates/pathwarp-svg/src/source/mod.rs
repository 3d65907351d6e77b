//! The source text: its elements and their positions, edits to it, style sheets, fonts, and usvg's tree of it.

pub(crate) mod cascade;
mod check;
pub(crate) mod edit;
pub(crate) mod element;
mod encoding;
mod fontface;
pub(crate) mod fonts;
pub(crate) mod images;
pub(crate) mod live;
mod marks;
pub(crate) mod number;
pub(crate) mod parallel;
mod precheck;
mod prefixes;
pub(crate) mod range;
pub(crate) mod read;
pub(crate) mod select;
mod selectors;
pub(crate) mod stack;
pub(crate) mod style;
mod table;
pub(crate) mod tags;
pub(crate) mod text;
pub(crate) mod tree;
mod unfold;
pub(crate) mod unpatchable;
pub(crate) mod xml;
