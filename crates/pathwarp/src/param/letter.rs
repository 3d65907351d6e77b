//! Letters of the artwork, for deformations that place lettering letter by letter.

use crate::outline::Outline;
use kurbo::Point;

/// A letter: a glyph, or several that belong together, on a horizontal baseline. Root user units.
#[derive(Debug, Clone, PartialEq)]
pub struct Letter {
    /// The characters, to name the letter in messages.
    pub name: String,
    /// The origin on the baseline.
    pub origin: Point,
    /// The advance: the distance to the origin of the next letter, to the right.
    pub advance: f64,
    /// The shape.
    pub outline: Outline,
}

impl Letter {
    /// The middle of the advance, on the baseline.
    #[must_use]
    pub fn middle(&self) -> Point {
        Point::new(self.origin.x + 0.5 * self.advance, self.origin.y)
    }
}
