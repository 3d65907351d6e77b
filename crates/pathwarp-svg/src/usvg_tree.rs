//! usvg's resolved tree of a drawing, for rendering. Available with the feature `usvg`.
//!
//! This module exposes types of the `usvg` crate, whose major version may change in any release. It is exempt from semantic
//! versioning.

use crate::document::Document;
use crate::source::read::ReadOptions;
use crate::source::tree;
use pathwarp::Error;
use std::sync::Arc;

/// Reads SVG or svgz data into usvg's tree, with the same fonts and limits as [`Document::read`]. `name` identifies the data
/// in errors.
///
/// # Errors
/// Returns [`Error::Input`] if the data is not an SVG drawing.
pub fn parse_tree(data: &[u8], name: &str, options: &ReadOptions) -> Result<Arc<usvg::Tree>, Error> {
    tree::parse(data, name, options)
}

/// Returns the tree of a document. Elements without id have temporary ones in it.
#[must_use]
pub fn tree(document: &Document) -> &Arc<usvg::Tree> {
    &document.drawing().tree
}
