//! The common options as typed values.

use super::reading::Reading;
use super::typed_box::TypedBox;
use crate::edits::EditChoice;
use crate::failure::Failure;
use crate::format::Format;
use pathwarp::kurbo::Rect;
use pathwarp::param::{Axis, Frame, Length};
use pathwarp::refit::RESOLUTION;
use pathwarp_dxf::Curves;
use pathwarp_svg::{Clones, LetteringFrame, OnError, PageFit, Patterns, Strokes, Structure, TextMode};
use std::path::PathBuf;

/// Default tolerance as a fraction of the artwork's diagonal: a tenth of a pixel on a poster-sized screen, and finer than any
/// plotter draws.
const TOLERANCE_OF_DIAGONAL: f64 = 1e-4;

/// The box that percentages refer to.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) enum FrameChoice {
    /// Not given: the artwork's box, or for lettering the box a deformation with a baseline asks for.
    #[default]
    Default,
    Artwork,
    Lettering(LetteringFrame),
    ViewBox,
    Rect(TypedBox),
}

/// Treatment of gradients.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum GradientChoice {
    #[default]
    Auto,
    Exact,
    Fit,
    Keep,
}

/// Reaction to an input or a shape that cannot be warped.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum OnFailure {
    /// Leave the input out and go on with the others.
    #[default]
    Continue,
    /// End the run and write nothing.
    Stop,
    /// Leave the shape unchanged, or the input out.
    Skip,
}

impl OnFailure {
    /// The reaction to a shape.
    pub(crate) fn of_shapes(self) -> OnError {
        if self == Self::Skip { OnError::Skip } else { OnError::Stop }
    }
}

/// The values of the common options. `Default` holds the unset state; [`Given::read`](super::Given::read) applies the defaults
/// that the table declares and then the values given.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct CommonOptions {
    pub(crate) inputs: Vec<PathBuf>,
    /// What is done to the artwork instead of bending it.
    pub(crate) edit: Option<EditChoice>,
    /// `None`: standard output.
    pub(crate) out: Option<PathBuf>,
    pub(crate) out_dir: Option<PathBuf>,
    /// `None`: by the extension.
    pub(crate) format: Option<Format>,
    /// Overwrite the inputs.
    pub(crate) in_place: bool,
    /// Warp the SVG files in folders.
    pub(crate) recursive: bool,
    /// Print what would be written, and write nothing.
    pub(crate) dry_run: bool,
    /// Copy of the input XCF that receives the warped paths.
    pub(crate) into: Option<PathBuf>,
    /// Read the paths before the damage in a damaged GIMP file.
    pub(crate) salvage: bool,
    pub(crate) tolerance: Option<Length>,
    pub(crate) certify: bool,
    pub(crate) merge: bool,
    pub(crate) frame: FrameChoice,
    pub(crate) select: Vec<String>,
    pub(crate) exclude: Vec<String>,
    pub(crate) precision: Option<u8>,
    pub(crate) strokes: Strokes,
    /// Outlines of strokes become simple.
    pub(crate) union: bool,
    pub(crate) text: TextMode,
    pub(crate) gradients: GradientChoice,
    pub(crate) patterns: Patterns,
    pub(crate) page: PageFit,
    pub(crate) clones: Clones,
    pub(crate) structure: Structure,
    /// Warp the bitmaps in drawings.
    pub(crate) warp_images: bool,
    pub(crate) image_dpi: Option<f64>,
    /// Width, and height if given, of a warped picture in pixels.
    pub(crate) image_size: Option<(u32, Option<u32>)>,
    /// Form of Bézier curves in a DXF.
    pub(crate) dxf_curves: Curves,
    /// Quality of a JPEG, from 1 to 100.
    pub(crate) quality: Option<u8>,
    pub(crate) on_failure: OnFailure,
    pub(crate) report: Option<PathBuf>,
    pub(crate) preview: Option<PathBuf>,
    pub(crate) write_recipe: Option<PathBuf>,
    pub(crate) embed_recipe: bool,
    pub(crate) explain: bool,
    /// Number of threads; `None`: one per core.
    pub(crate) jobs: Option<usize>,
    pub(crate) reading: Reading,
    pub(crate) quiet: bool,
}

impl CommonOptions {
    /// Returns the tolerance given, or the default for artwork with this bounding box, in user units.
    ///
    /// # Errors
    /// The tolerance given is finer than numbers of the artwork's size can be.
    pub(crate) fn tolerance_for(&self, artwork: Option<Rect>, frame: &Frame) -> Result<f64, Failure> {
        let diagonal = artwork.map_or(0.0, |r| r.width().hypot(r.height()));
        let given = self.tolerance.map(|d| d.in_units(Axis::Diagonal, frame)).filter(|d| *d > 0.0);
        let largest = artwork.map_or(0.0, |r| r.x0.abs().max(r.x1.abs()).max(r.y0.abs()).max(r.y1.abs()));
        let finest = RESOLUTION * largest;
        if given.is_some_and(|d| d < finest) {
            let problem = "is finer than the numbers it would be measured with; use at least";
            return Err(Failure::usage(format!("--tolerance: {:e} {problem} {finest:.0e}", given.unwrap_or(0.0))));
        }
        let share = self.edit.as_ref().and_then(|e| e.info.tolerance).unwrap_or(TOLERANCE_OF_DIAGONAL);
        Ok(given.unwrap_or(if diagonal > 0.0 { diagonal * share } else { share }))
    }
}
