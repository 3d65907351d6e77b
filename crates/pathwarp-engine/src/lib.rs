//! The engine of pathwarp: from artwork, deformations and options to a result and a report. The command line, the editor, C, Python and
//! Inkscape are front ends of it.
//!
//! A [`Warper`] is a recipe with its options, given as text, as on a command line. It maps points, bends paths and warps drawings in
//! memory. Nothing is printed, and no file is written. Panics become errors.
//!
//! ```
//! use pathwarp::deform::Registry;
//! use pathwarp_engine::Warper;
//!
//! let mut warper = Warper::new(&Registry::builtin(), "arc", &[("bend", "40%")])?;
//! warper.set_option("tolerance", "0.01")?;
//! let warped = warper.warp_path("M0,0 H100 V50 H0 Z")?;
//! assert!(warped.path.data.starts_with('M') && warped.path.report.max_error <= 0.01);
//! # Ok::<(), pathwarp_engine::Error>(())
//! ```
//!
//! A front end that reads and writes files takes the same steps one by one: it reads the [`options`], opens an [`Input`](input::Input),
//! lets a [`Session`](session::Session) build the recipe for it and warp it, and puts the files in place through [`output`].

#![expect(missing_debug_implementations, reason = "front ends show none of the parts")]

pub mod advice;
pub mod bitmap;
pub mod caption;
pub mod catalogue;
pub mod coming_from;
mod edges;
pub mod edits;
mod embed;
pub mod export;
pub mod failure;
mod filters;
pub mod format;
pub mod framed;
pub mod input;
pub mod lettering;
pub mod links;
pub mod meter;
pub mod options;
pub mod output;
pub mod page;
pub mod readable;
pub mod recipe_file;
pub mod references;
pub mod report;
pub mod session;
pub mod steps;
pub mod temporaries;
pub mod units;
pub mod weights;

pub use embed::{
    Details, Drawing, Error, ErrorKind, Path, PointMap, Warper, lettering_drawing, option_names, option_words, preset,
    reserved_names,
};
