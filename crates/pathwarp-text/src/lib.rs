//! Lettering: text shaped and laid out to outlines.
//!
//! A [`Font`] is read from bytes, [`layout`] sets text in it: scripts and directions are told apart (Unicode annexes 9 and 24),
//! every run is shaped as its font asks (kerning, ligatures, marks, joined and reordered scripts), what a font lacks is taken
//! from the next one, and lines are spaced and aligned. The result is a [`Lettering`]: lines of clusters, each with its place on
//! the baseline, its advance width and its outline, the font's own curves with y pointing down.
//!
//! There is no file access and no global state: same bytes and text, same outlines.
//!
//! ```
//! use pathwarp_text::{Font, Style, layout};
//!
//! # let bytes = include_bytes!("../../pathwarp-svg/fonts/NotoSans-Regular.subset.ttf");
//! let font = Font::new(bytes, 0)?;
//! let lettering = layout("Welcome", &[font], &Style { size: 100.0, ..Style::default() })?;
//!
//! let line = &lettering.lines[0];
//! assert_eq!(line.clusters.len(), 7);
//! assert_eq!(line.clusters[0].text, "W");
//! // The advance width of Noto Sans's W is 0.93 em; the e after it is drawn 0.02 em closer by kerning.
//! assert!((line.clusters[1].origin.x - 91.0).abs() < 1e-9);
//! assert!(!line.clusters[0].outline.is_empty());
//! # Ok::<(), pathwarp_text::Error>(())
//! ```

mod error;
mod font;
mod glyph;
mod itemize;
mod layout;
mod setting;
mod shape;

pub use error::Error;
pub use font::{Axis, Font, Metrics};
pub use layout::{Align, Cluster, Direction, Lettering, Ligatures, Line, Style, layout};
pub use setting::{Feature, Variation, features, variations};
pub use shape::Glyph;
