//! Sets text as outlines.
//!
//! [`Font`] reads a font from bytes. [`layout`] sets text: it separates directions and scripts (Unicode annexes 9 and 24), shapes
//! every run (kerning, ligatures, marks, joined and reordered scripts), takes missing characters from the next font, and spaces
//! and aligns lines. The result is an [`OutlinedText`]: lines of clusters, each with its origin on the baseline, its advance width and
//! its outline, the exact curves of the font with y pointing down.
//!
//! The crate accesses no files and has no global state: the same bytes and text always give the same outlines.
//!
//! ```
//! use pathwarp_text::{Font, TextStyle, layout};
//!
//! # let bytes = include_bytes!("../../pathwarp-svg/fonts/NotoSans-Regular.subset.ttf");
//! let font = Font::new(bytes, 0)?;
//! let lettering = layout("Welcome", &[font], &TextStyle { size: 100.0, ..TextStyle::default() })?;
//!
//! let line = &lettering.lines[0];
//! assert_eq!(line.clusters.len(), 7);
//! assert_eq!(line.clusters[0].text, "W");
//! // The advance width of W in Noto Sans is 0.93 em; kerning moves the following e 0.02 em closer.
//! assert!((line.clusters[1].origin.x - 91.0).abs() < 1e-9);
//! assert!(!line.clusters[0].outline.is_empty());
//! # Ok::<(), pathwarp_text::Error>(())
//! ```

mod charstrings;
mod error;
mod font;
mod glyph;
mod itemize;
mod layout;
mod lettering;
mod limits;
mod metrics;
mod painter;
mod shape;
mod style;
mod work;

pub use error::{Error, Quantity};
pub use font::Font;
pub use itemize::{Run, Writing, runs};
pub use layout::{layout, layout_within};
pub use lettering::{Cluster, LetteringLine, OutlinedText, PlacedGlyph};
pub use limits::TextLimits;
pub use metrics::{FontAxis, FontMetrics};
pub use shape::{FontRun, shape_run};
pub use style::{Align, Direction, Feature, Ligatures, TextStyle, Variation, features, variations};
pub use work::{GlyphWork, MAX_WORK};
