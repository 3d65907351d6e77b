//! The source text: its elements and their positions, edits to it, style sheets, fonts, and usvg's tree of it.

pub(crate) mod check;
pub(crate) mod edit;
pub(crate) mod elements;
pub(crate) mod faces;
pub(crate) mod fallback;
pub(crate) mod fontface;
pub(crate) mod fonts;
pub(crate) mod images;
pub(crate) mod links;
pub(crate) mod markup;
pub(crate) mod mesh;
pub(crate) mod number;
pub(crate) mod pieces;
pub(crate) mod read;
pub(crate) mod select;
pub(crate) mod shaping;
pub(crate) mod text;
pub(crate) mod threads;
pub(crate) mod tree;
