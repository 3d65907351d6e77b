//! Letters in the artwork: what a deformation needs to know of lettering to place it letter by letter.

use crate::outline::Outline;
use kurbo::Point;

/// A letter: a glyph, or several that belong together. Root user units; its baseline is level.
#[derive(Debug, Clone, PartialEq)]
pub struct Letter {
    /// What it is called in messages: its characters.
    pub name: String,
    /// Where it begins on its baseline.
    pub origin: Point,
    /// How far the next letter begins to the right of it.
    pub advance: f64,
    /// What it looks like.
    pub outline: Outline,
}

impl Letter {
    /// The middle of its advance, on the baseline.
    #[must_use]
    pub fn middle(&self) -> Point {
        Point::new(self.origin.x + 0.5 * self.advance, self.origin.y)
    }
}
