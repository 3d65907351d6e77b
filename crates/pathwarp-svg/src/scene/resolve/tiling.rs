//! Request to lay out patterns as geometry.

use crate::scene::model::SceneNote;
use crate::source::tags::ElementId;
use pathwarp::kurbo::{Affine, Rect};

/// Total number of segments in the tiles of a drawing; more would make the result slow to open.
const MOST_SEGMENTS: usize = 250_000;

/// Decides which patterns are laid out as geometry, and how much of it there may be.
pub(crate) struct Tiling<'a> {
    /// Returns `true` if the pattern over an area must be laid out. The arguments are the element that is painted, the area in its
    /// user space, and the transform from there to root user space.
    pub(super) needed: &'a (dyn Fn(Painted, Rect, Affine) -> bool + Sync),
    /// Lay out patterns on strokes, too.
    pub(super) strokes: bool,
    /// Remaining number of segments.
    pub(super) budget: usize,
    /// Patterns that could not be laid out.
    pub(super) notes: Vec<SceneNote>,
}

/// What is painted with a pattern.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Painted {
    Element(Option<ElementId>),
    /// Content of a mask, with the index of what bends those who refer to it, if the drawing is divided.
    Mask(Option<usize>),
}

impl<'a> Tiling<'a> {
    pub(crate) fn new(needed: &'a (dyn Fn(Painted, Rect, Affine) -> bool + Sync), strokes: bool) -> Self {
        Self { needed, strokes, budget: MOST_SEGMENTS, notes: Vec::new() }
    }
}
