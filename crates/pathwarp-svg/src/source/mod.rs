//! The source text: its elements and their places in it, edits to it, style sheets, fonts, and usvg's tree of it.

pub(crate) mod cascade;
pub(crate) mod edit;
mod fontface;
pub(crate) mod fonts;
mod marks;
pub(crate) mod number;
pub(crate) mod read;
pub(crate) mod select;
mod table;
pub(crate) mod text;
mod unfold;
