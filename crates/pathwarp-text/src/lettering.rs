//! Text as outlines: lines of clusters of glyphs.

use crate::metrics::FontMetrics;
use kurbo::{BezPath, Point, Rect};

/// A glyph and its offset in its cluster, in user units, with y pointing down.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PlacedGlyph {
    /// Index of the font in the list given to [`layout`](crate::layout()).
    pub font: usize,
    /// Number of the glyph in the font; 0 is the glyph for missing characters.
    pub id: u32,
    /// Horizontal offset from the origin of the cluster.
    pub dx: f64,
    /// Vertical offset from the origin of the cluster.
    pub dy: f64,
    /// Advance width.
    pub advance: f64,
}

/// Characters that form a unit (a letter with its marks, a ligature), with their outline.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Cluster {
    /// The characters, in reading order.
    pub text: String,
    /// Left end on the baseline.
    pub origin: Point,
    /// Advance width as shaped: includes kerning, but not letter and word spacing.
    pub advance: f64,
    /// Outline at its position; empty for a space. Fill it by the nonzero rule, since glyphs may overlap.
    pub outline: BezPath,
    /// The glyphs of the outline.
    pub glyphs: Vec<PlacedGlyph>,
}

/// A line of text.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LetteringLine {
    /// The characters, in reading order.
    pub text: String,
    /// Left end of the baseline: the start of the first advance.
    pub start: Point,
    /// Right end of the baseline: the end of the last advance.
    pub end: Point,
    /// Size of the em relative to the style's. It is 1 except with [`Align::Fill`](crate::Align::Fill), for which `start` and `end` are the
    /// ends of the ink.
    pub scale: f64,
    /// The clusters from left to right.
    pub clusters: Vec<Cluster>,
}

impl LetteringLine {
    /// Returns the bounding box of the line's outlines; `None` if all are empty.
    #[must_use]
    pub fn ink(&self) -> Option<Rect> {
        let outlines = self.clusters.iter().map(|c| &c.outline).filter(|o| !o.is_empty());
        outlines.map(kurbo::Shape::bounding_box).reduce(|a, b| a.union(b))
    }
}

/// Text as outlines. The longest line starts at x = 0, and the ascent of the first line is at y = 0; y points down.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OutlinedText {
    /// The text with newlines between lines; control characters are replaced by spaces.
    pub text: String,
    /// Heights of the first font in the list, for a line of scale 1.
    pub metrics: FontMetrics,
    /// `true` if the base direction is right to left.
    pub rtl: bool,
    /// The lines from top to bottom.
    pub lines: Vec<LetteringLine>,
    /// Characters that no font has, without duplicates.
    pub missing: Vec<char>,
}

impl OutlinedText {
    /// Returns the bounding box of all outlines; `None` if all are empty.
    #[must_use]
    pub fn ink(&self) -> Option<Rect> {
        self.lines.iter().filter_map(LetteringLine::ink).reduce(|a, b| a.union(b))
    }

    /// Returns the bounding box of all lines. Horizontally, it covers the baselines; vertically, it extends from the first ascent to the
    /// last descent.
    #[must_use]
    pub fn line_box(&self) -> Rect {
        let line_box = |l: &LetteringLine| {
            let FontMetrics { ascent, descent, .. } = self.metrics.scaled(l.scale);
            Rect::new(l.start.x, l.start.y - ascent, l.end.x, l.end.y + descent).abs()
        };
        self.lines.iter().map(line_box).reduce(|a, b| a.union(b)).unwrap_or_default()
    }

    /// Returns the bounding box of outlines and lines.
    #[must_use]
    pub fn page(&self) -> Rect {
        let lines = self.line_box();
        self.ink().map_or(lines, |ink| ink.union(lines))
    }
}
