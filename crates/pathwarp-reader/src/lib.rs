//! Resolves SVG drawings into plain SVG that usvg reads as browsers read the original.
//!
//! A tree goes in, text comes out: [`resolve`] computes the style of every element as browsers do (CSS Cascade 5, Selectors 4, Media
//! Queries 4, CSS Values 4, CSS Transforms 1 and 2, SVG 2's geometry properties). Where usvg would read something else, it writes
//! the computed value into an attribute. Everything else stays byte for byte. Each [`Change`] records its range and the original
//! text, so that a program that edits the drawing can put the original back.
//!
//! ```
//! use pathwarp::budget::Budget;
//! use pathwarp_reader::xml;
//!
//! let svg = "<svg xmlns='http://www.w3.org/2000/svg'><style>.\\31 a{FILL:currentcolor}</style><path class='1a'/></svg>";
//! let plain = pathwarp_reader::resolve(&xml::document(svg).unwrap(), &Budget::default(), &|_| None).unwrap();
//! assert!(plain.text.unwrap().contains("<path style=\"fill:currentColor\" class='1a'/>"));
//! assert_eq!((plain.changes[1].name, plain.changes[1].text.as_str()), ("style", ""));
//! ```
//!
//! `table.rs` describes every property. The crate is written for usvg 0.49; when usvg learns to read a property, its entry there
//! can be simplified.

mod color;
mod computed;
mod element;
mod foreign;
mod geometry;
mod guard;
mod ids;
mod names;
mod range;
mod rewrite;
mod sheet;
mod table;
mod text;
mod tree;
mod value;
mod words;
pub mod xml;

pub use guard::guarded;
pub use range::LARGEST;
pub use rewrite::{Change, Linked, Plain, ReadError, resolve};
pub use value::percent_decoded;
pub use words::{PaintProperty, Words};
