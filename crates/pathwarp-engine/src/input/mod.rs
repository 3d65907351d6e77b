//! Input files: the kinds of artwork with their common interface, and the readers of other files.

mod artwork;
mod before;
mod beside;
mod crop;
mod files;
mod gimp;
mod gimp_file;
mod picture;
mod proportions;
mod svg;

pub use artwork::{Artwork, Baseline, FileArtwork, PlainArtwork, WarpRequest, WarpedResult, Which, hatching};
pub(crate) use before::{Planned, planned};
pub use beside::PREVIEW;
pub use files::{
    bytes, described, display, document, document_of, no_document, not_a_drawing, read_data_file, read_options,
    split_reference, unreadable,
};
pub use gimp::{file_name, gimp_outline, svg_name};
pub use gimp_file::GimpFile;
pub(crate) use proportions::Proportions;
pub use svg::SvgArtwork;

use crate::failure::Failure;
use crate::links::Destination;
use crate::options::CommonOptions;
use pathwarp_raster::Picture;
use picture::PictureArtwork;
use std::path::Path;

/// An input file.
pub struct Input(Box<dyn FileArtwork>);

impl Input {
    /// Opens an input and checks that the options and the target suit its kind.
    pub fn open(input: &Path, options: &CommonOptions, target: Option<&Path>) -> Result<Self, Failure> {
        if let (None, Some(bytes)) = (&options.into, files::ordinary_bytes(input)?) {
            return Self::of_bytes(&bytes, input, options, (target, Destination::of(target)));
        }
        if let Some(paths) = gimp::open(input, options, target)? {
            return Ok(Self(Box::new(paths)));
        }
        if options.into.is_some() {
            let file = display(input);
            return Err(Failure::usage(format!("--into copies an XCF with its paths warped; {file} is not an XCF")));
        }
        Self::of_bytes(&bytes(input)?, input, options, (target, Destination::of(target)))
    }

    /// Reads a drawing or picture with this content. `input` is its name; the target determines the format.
    pub(crate) fn of_bytes(
        bytes: &[u8],
        input: &Path,
        options: &CommonOptions,
        (target, destination): (Option<&Path>, Destination),
    ) -> Result<Self, Failure> {
        if Picture::sniff(bytes) {
            return Ok(Self(Box::new(PictureArtwork::read(bytes, input, options, target)?)));
        }
        let mut drawing = SvgArtwork::read(bytes, input, options, target)?;
        drawing.destination = destination;
        Ok(Self(Box::new(drawing)))
    }

    /// Returns the artwork in the file.
    pub fn artwork(&mut self) -> &mut dyn FileArtwork {
        &mut *self.0
    }
}
