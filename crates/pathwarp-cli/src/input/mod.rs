//! Input files: the kinds of artwork and what the pipeline asks of each, and the readers of other files.

mod artwork;
mod data_file;
mod folds;
mod foreign;
mod gimp;
mod gimp_file;
mod gimp_format;
mod gimp_stroke;
mod kind;
mod picture;
mod preview;
mod read;
mod reference_name;
mod surface;
mod svg;

pub(crate) use artwork::{Artwork, Baseline, WarpRequest, WarpedResult, Which};
pub(crate) use data_file::read_data_file;
pub(crate) use folds::Fold;
pub(crate) use foreign::{described, unreadable};
pub(crate) use gimp_file::GimpFile;
pub(crate) use gimp_format::{file_name, svg_name};
pub(crate) use kind::Input;
pub(crate) use preview::PREVIEW;
pub(crate) use read::{bytes, display, document, document_of, not_a_drawing, read_options};
pub(crate) use reference_name::{no_document, split_reference};
pub(crate) use svg::SvgArtwork;
