//! Request to lay out patterns as geometry.

use crate::scene::model::SceneNote;
use pathwarp::kurbo::{Affine, Rect};

/// Total number of segments in the tiles of a drawing; more would make the result slow to open.
const MOST_SEGMENTS: usize = 250_000;

/// Decides which patterns are laid out as geometry, and how much of it there may be.
pub(crate) struct Tiling<'a> {
    /// Returns `true` if the pattern over an area must be laid out. The arguments are the area in the shape's user space, and
    /// the transform from there to root user space.
    pub(super) needed: &'a (dyn Fn(Rect, Affine) -> bool + Sync),
    /// Lay out patterns on strokes, too.
    pub(super) strokes: bool,
    /// Selection state of every element.
    pub(super) selected: Vec<bool>,
    /// Everything is selected, including parts without an element.
    pub(super) all: bool,
    /// Remaining number of segments.
    pub(super) budget: usize,
    /// Patterns that could not be laid out.
    pub(super) notes: Vec<SceneNote>,
}

impl<'a> Tiling<'a> {
    pub(crate) fn new(
        needed: &'a (dyn Fn(Rect, Affine) -> bool + Sync),
        strokes: bool,
        selected: Vec<bool>,
        all: bool,
    ) -> Self {
        Self { needed, strokes, selected, all, budget: MOST_SEGMENTS, notes: Vec::new() }
    }
}
