//! Input files: the kinds of artwork and what the pipeline asks of each, and the readers of other files.

mod artwork;
mod beside;
mod files;
mod gimp;
mod gimp_file;
mod picture;
mod svg;

pub(crate) use artwork::{Artwork, Baseline, FileArtwork, Fold, PlainArtwork, WarpRequest, WarpedResult, Which};
pub(crate) use beside::PREVIEW;
pub(crate) use files::{
    bytes, described, display, document, document_of, no_document, not_a_drawing, read_data_file, read_options,
    split_reference, unreadable,
};
pub(crate) use gimp::{file_name, svg_name};
pub(crate) use gimp_file::GimpFile;
pub(crate) use svg::SvgArtwork;

use crate::failure::Failure;
use crate::options::CommonOptions;
use gimp::GimpArtwork;
use pathwarp_raster::Picture;
use picture::PictureArtwork;
use std::path::Path;

/// An input file.
pub(crate) enum Input {
    Svg(Box<SvgArtwork>),
    Gimp(GimpArtwork),
    Picture(PictureArtwork),
}

impl Input {
    /// Opens an input and checks that the options and the target suit its kind.
    pub(crate) fn open(input: &Path, options: &CommonOptions, target: Option<&Path>) -> Result<Self, Failure> {
        if let (None, Some(bytes)) = (&options.into, files::ordinary_bytes(input)?) {
            return Self::of_bytes(&bytes, input, options, target);
        }
        if let Some(file) = GimpFile::open(input, options.salvage, &options.reading.limits)? {
            return Ok(Self::Gimp(GimpArtwork::new(file, options, target)?));
        }
        if options.into.is_some() {
            let file = display(input);
            return Err(Failure::usage(format!("--into copies an XCF with its paths warped; {file} is not an XCF")));
        }
        Self::of_bytes(&bytes(input)?, input, options, target)
    }

    /// A drawing or picture with this content. `input` is its name.
    pub(crate) fn of_bytes(
        bytes: &[u8],
        input: &Path,
        options: &CommonOptions,
        target: Option<&Path>,
    ) -> Result<Self, Failure> {
        if Picture::sniff(bytes) {
            return Ok(Self::Picture(PictureArtwork::read(bytes, input, options, target)?));
        }
        Ok(Self::Svg(Box::new(SvgArtwork::read(bytes, input, options, target)?)))
    }

    pub(crate) fn artwork(&mut self) -> &mut dyn FileArtwork {
        match self {
            Self::Svg(a) => &mut **a,
            Self::Gimp(a) => a,
            Self::Picture(a) => a,
        }
    }
}
