//! usvg's resolved tree of a drawing, for rendering. Available with the feature `usvg`.
//!
//! This module exposes types of the `usvg` crate, whose major version may change in any release. It is exempt from semantic
//! versioning.

use crate::document::Document;
use crate::scene::unread::UnreadImages;
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
    Ok(read_tree(data, name, options)?.tree)
}

/// A drawing read for rendering.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ReadTree {
    /// The resolved drawing.
    pub tree: Arc<usvg::Tree>,
    /// Images that it lacks.
    pub unread: UnreadImages,
}

/// Reads SVG or svgz data like [`parse_tree`], and lists the images that the drawing lacks.
///
/// # Errors
/// As for [`parse_tree`].
pub fn read_tree(data: &[u8], name: &str, options: &ReadOptions) -> Result<ReadTree, Error> {
    let (tree, missed) = tree::parse(data, name, options)?;
    Ok(ReadTree { tree, unread: UnreadImages::of(&missed) })
}

/// Returns the tree of a document. Elements without id have temporary ones in it.
#[must_use]
pub fn tree(document: &Document) -> &Arc<usvg::Tree> {
    &document.drawing().tree
}
