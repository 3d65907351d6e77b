//! SVG drawings, warped in place.
//!
//! A [`Document`] is an SVG file: usvg tells what it paints, the source text keeps its bytes. [`Document::warp`] bends every
//! shape by a map of root user space (the coordinates inside the root `<svg>`) and gives the file back with ids, classes,
//! styles, titles, groups and formatting as they were.
//!
//! ```
//! use pathwarp::map::{Formula, Real};
//! use pathwarp::refit;
//! use pathwarp_svg::{Document, ReadOptions, WarpOptions};
//!
//! struct Wave;
//! impl Formula for Wave {
//!     fn f<S: Real>(&self, x: S, y: S) -> (S, S) { (x, y + (x / 20.0).sin() * 5.0) }
//! }
//!
//! let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 50'><rect id='a' width='90' height='40'/></svg>";
//! let document = Document::read(svg.as_bytes(), "example.svg", &ReadOptions::default())?;
//! let warped = document.warp(&Wave, &WarpOptions::new(refit::Options::new(0.01)))?;
//! assert!(warped.svg.contains("<path id='a' d=\"M"));
//! # Ok::<(), pathwarp::Error>(())
//! ```

mod bend;
mod document;
mod embed;
mod scene;
pub mod sheet;
mod source;
mod write;

pub use bend::gradient::{GradientPainter, GradientRequest};
pub use bend::image::{BentImage, ImageRequest, ImageWarper, Images};
pub use bend::letters::LetterPlaces;
pub use bend::options::{Gradients, OnError, PageFit, Patterns, Strokes, Structure, TextMode, WarpOptions};
pub use bend::part::{ShapeReport, Skipped, Warped};
pub use document::{Document, NamedPath, Shape};
pub use embed::Origin;
pub use scene::lettering::{Lettering, LetteringFrame};
pub use source::fonts::{FontFile, GenericFamilies, bundled_font, system_font};
pub use source::read::{ReadOptions, compressed, parse_tree};
pub use source::select::Selection;
pub use write::lettering::{LetteringOptions, write_lettering};
pub use write::page::Overhang;
