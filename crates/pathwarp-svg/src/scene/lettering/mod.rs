//! Lettering in a drawing: lines with their baselines and letters.
//!
//! It comes from two sources, which behave alike: text (from usvg's layout), and outlines with data attributes, as
//! [`write_lettering`](crate::write_lettering) makes them:
//!
//! ```xml
//! <g data-ascent="57" data-descent="16" data-cap-height="38" data-x-height="29">
//!   <g data-baseline="20 80 220 80">
//!     <path aria-label="W" data-glyph="20 80 51.5" d="…"/>
//!   </g>
//! </g>
//! ```
//!
//! `data-baseline` holds the line's start and end, `data-glyph` a letter's origin on the baseline and its advance, all in the
//! element's user units. The heights count from the baseline.

pub(crate) mod line;
mod marked;
pub(crate) mod selected;
mod shaped;
mod texts;

use super::geometry::GeometryReader;
use super::model::Scene;
use line::TextLine;

/// Finds all lines of a drawing: those of texts in painting order, then those of outlines.
pub(crate) fn lines(tree: &usvg::Tree, reader: &GeometryReader<'_>, scene: &Scene) -> Vec<TextLine> {
    let mut out = texts::lines(tree, scene);
    out.extend(marked::lines(reader, &scene.parts, &scene.by_source));
    out
}
