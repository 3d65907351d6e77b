//! Letters of the artwork, for deformations that set them one by one.

use crate::outline::Outline;
use kurbo::Point;

/// A letter: a glyph, or several that belong together, on a horizontal baseline. Coordinates are in root user units.
#[derive(Debug, Clone, PartialEq)]
pub struct Letter {
    /// The characters, for messages.
    pub name: String,
    /// The origin on the baseline.
    pub origin: Point,
    /// The advance, the distance to the origin of the next letter on the right.
    pub advance: f64,
    /// The shape.
    pub outline: Outline,
}

impl Letter {
    /// Returns the middle of the advance, on the baseline.
    #[must_use]
    pub fn middle(&self) -> Point {
        Point::new(self.origin.x + 0.5 * self.advance, self.origin.y)
    }
}

/// Returns the width of a word space between `letters`: the smallest gap between words, or half the mean advance for a single word.
/// `None` if there are no letters.
#[must_use]
pub(crate) fn word_space(letters: &[Letter]) -> Option<f64> {
    /// Least word space, as a share of the mean advance. Kerning and letter spacing leave smaller gaps.
    const MIN_SPACE: f64 = 0.25;
    /// The word space of most fonts, as a share of the mean advance.
    const USUAL: f64 = 0.5;
    let mut visible: Vec<&Letter> = letters.iter().filter(|l| !l.outline.subpaths.is_empty()).collect();
    visible.sort_by(|a, b| a.origin.y.total_cmp(&b.origin.y).then(a.origin.x.total_cmp(&b.origin.x)));
    let mean = visible.iter().map(|l| l.advance).sum::<f64>() / visible.len() as f64;
    let gap = |w: &[&Letter]| w[1].origin.x - w[0].origin.x - w[0].advance;
    let gaps = visible.windows(2).filter(|w| w[0].origin.y == w[1].origin.y).map(gap);
    let smallest = gaps.filter(|g| *g > MIN_SPACE * mean).min_by(f64::total_cmp);
    (!visible.is_empty()).then(|| smallest.unwrap_or(USUAL * mean))
}
