//! A change of one control point of a net, as the free-form grid and the Bézier triangle take it.

use kurbo::{Point, Vec2};

/// A change of one control point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Change {
    /// Put it here.
    Place(Point),
    /// Move it by so much, user units.
    Shift(Vec2),
    /// Set its weight.
    Weight(f64),
}

impl Change {
    /// The parameter that makes such a change.
    pub(super) const fn param(self) -> &'static str {
        match self {
            Self::Place(_) => "at",
            Self::Shift(_) => "move",
            Self::Weight(_) => "weight",
        }
    }
}
