//! Folds of warped shapes: their counts for the report, and the warning.

use pathwarp::fold::Orientation;
use pathwarp::kurbo::Point;

/// A fold of one shape.
pub(super) struct Fold {
    /// Number of orientation changes along the shape, at least 1; 0 if it does not fold.
    pub(super) count: usize,
    /// The first place where it folds.
    pub(super) at: Option<Point>,
}

impl Fold {
    /// Compares the orientation of one shape with that of all artwork.
    pub(super) fn of(shape: &Orientation, all: &Orientation) -> Self {
        let at = shape.folded_against(all);
        Self { count: if at.is_some() { shape.changes.max(1) } else { 0 }, at }
    }

    /// The place as the report has it.
    pub(super) fn place(&self) -> Option<[f64; 2]> {
        self.at.map(|p| [p.x, p.y])
    }
}

/// The warning that the shape `id` folds at `at`.
pub(super) fn warning(id: &str, at: Point) -> String {
    format!("{id} folds over near {:.4},{:.4}: the map reverses orientation there", at.x, at.y)
}
