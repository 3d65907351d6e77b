//! usvg's resolved tree of a drawing, for rendering. Available with the feature `usvg`.
//!
//! This module exposes types of the `usvg` crate, whose major version may change in any release. It is exempt from semantic versioning.

use crate::bend::outcome::Notes;
use crate::document::Document;
use crate::scene::drawing::UnreadImages;
use crate::source::read::{self, ReadOptions};
use crate::source::tree;
use pathwarp::kurbo::{BezPath, Rect};
use pathwarp::{Error, Seg};
use std::collections::HashMap;
use std::sync::Arc;

pub use crate::source::mesh::CoonsPatch;

/// Reads SVG or svgz data into usvg's tree, with the fonts and limits of [`Document::read`]. `name` identifies the data in errors.
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
    /// Families of fonts that it lacks.
    pub missing_fonts: Vec<String>,
    /// Sentences about unsupported content and style.
    pub undrawn: Vec<String>,
    /// Sentences about content that browsers show a little differently.
    pub notes: Vec<String>,
}

/// Words in every drawing with markers or strokes of fixed width, which usvg draws differently from browsers.
const MAY_DIFFER: [&str; 2] = ["marker", "non-scaling-stroke"];

/// Reads SVG or svgz data into usvg's tree, and lists the content of the drawing that the tree lacks.
///
/// # Errors
/// [`Error::Input`] if the data is not an SVG drawing.
pub fn read_tree(data: &[u8], name: &str, options: &ReadOptions) -> Result<ReadTree, Error> {
    let text = read::text(data, name, &options.begin(data.len()).budget)?;
    let (tree, missed) = if MAY_DIFFER.iter().any(|word| text.contains(word)) {
        let document = Document::read(data, name, options)?;
        let drawing = document.drawing();
        (shown(&document, options)?, drawing.missed.clone().with_undrawn(&drawing.source))
    } else {
        tree::parse(data, name, options)?
    };
    let unread = UnreadImages::from_missed(&missed);
    Ok(ReadTree {
        tree,
        unread,
        missing_fonts: missed.fonts,
        undrawn: missed.undrawn,
        notes: Notes::in_words(&missed.notes),
    })
}

/// Returns the tree of a document with plain shapes for markers and strokes of fixed width, which usvg draws differently from browsers.
/// `options` must be the ones with which the document was read.
///
/// # Errors
/// [`Error::Input`] or [`Error::Geometry`] as for [`Document::resolved`].
pub fn shown(document: &Document, options: &ReadOptions) -> Result<Arc<usvg::Tree>, Error> {
    Ok(match document.resolved()? {
        Some(plain) => tree::parse(plain.as_bytes(), document.name(), options)?.0,
        None => Arc::clone(tree(document)),
    })
}

/// Returns the tree of a document. Elements without id have temporary ones in it.
#[must_use]
pub fn tree(document: &Document) -> &Arc<usvg::Tree> {
    &document.drawing().tree
}

/// Runs `f` with enough stack to walk the tree of a document. `f` must not wait for other threads of a thread pool.
///
/// # Errors
/// Returns the error of `f`, or [`Error::Input`] if there is no memory for the stack.
pub fn with_stack<T: Send>(document: &Document, f: impl FnOnce() -> Result<T, Error> + Send) -> Result<T, Error> {
    document.drawing().with_stack(f)
}

/// The Coons patches of the mesh gradient for which a paint of a document's tree stands, in the user space of a shape with the box
/// `bounds`; `None` for other paints. usvg has no mesh gradients and draws nothing instead.
#[must_use]
pub fn mesh(document: &Document, paint: &usvg::Paint, bounds: Rect) -> Option<Vec<CoonsPatch>> {
    Some(document.drawing().mesh(paint)?.on(bounds).patches())
}

/// Exact outlines of the paths whose arcs usvg approximates within a tenth of a unit, and of paths so far from the origin that its single
/// precision is coarse.
#[derive(Debug)]
pub struct ExactOutlines<'d> {
    by_address: HashMap<usize, BezPath>,
    // Keeps the tree, as another path could otherwise get the address.
    _document: &'d Document,
}

/// Largest distance between an arc and the curves that replace it, as a fraction of the size of its outline.
const ARC_TOLERANCE: f64 = 1e-6;

/// Coordinate from which single precision rounds to a hundredth.
const FAR: f64 = 1e5;

impl<'d> ExactOutlines<'d> {
    /// The outlines of a document.
    #[must_use]
    pub fn of(document: &'d Document) -> Self {
        let mut by_address = HashMap::new();
        for part in &document.drawing().scene().parts {
            let has_arcs = || part.local.segs().any(|s| matches!(s, Seg::Arc(_)));
            if part.path != 0 && (part.local.extent() > FAR || has_arcs()) {
                let size = part.local.bounding_box().map_or(0.0, |b| b.width().max(b.height()));
                by_address.insert(part.path, part.local.to_bez_path(ARC_TOLERANCE * size));
            }
        }
        Self { by_address, _document: document }
    }

    /// The outline of a path of the document's tree, in the path's coordinates; `None` if usvg's is exact.
    #[must_use]
    pub fn get(&self, path: &usvg::Path) -> Option<&BezPath> {
        self.by_address.get(&(std::ptr::from_ref(path) as usize))
    }
}
