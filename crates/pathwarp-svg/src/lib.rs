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

mod cascade;
mod cut;
mod defs;
mod document;
mod edit;
mod embed;
mod filter;
mod fontface;
mod fonts;
mod geometry;
mod gradient;
mod image;
mod keep;
mod lettering;
mod letters;
mod marks;
mod number;
mod options;
mod page;
mod paint;
mod pieces;
mod read;
mod resolve;
mod scene;
mod select;
pub mod sheet;
mod source;
mod stroke;
mod unfold;
mod warp;
mod write;

pub use document::{Document, NamedPath, Shape};
pub use embed::Origin;
pub use fonts::{FontFile, GenericFamilies, bundled_font, system_font};
pub use gradient::{GradientPainter, GradientRequest};
pub use image::{BentImage, ImageRequest, ImageWarper, Images};
pub use lettering::{LetterPlaces, Lettering, LetteringFrame, LetteringOptions, write_lettering};
pub use options::{Gradients, OnError, PageFit, Patterns, Strokes, Structure, TextMode, WarpOptions};
pub use page::Overhang;
pub use read::{ReadOptions, compressed, parse_tree};
pub use select::Selection;
pub use warp::{ShapeReport, Skipped, Warped};
