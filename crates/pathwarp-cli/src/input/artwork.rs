//! [`Artwork`]: what the pipeline asks of every kind of input.

use crate::failure::Failure;
use crate::options::{CommonOptions, FrameChoice};
use crate::output::PendingFile;
use crate::page::PageNews;
use crate::report::{ReportedShape, SkippedShape};
use pathwarp::budget::Budget;
use pathwarp::kurbo::Rect;
use pathwarp::outline::Subpath;
use pathwarp::param::Frame;
use pathwarp::recipe::{BuiltParts, Recipe, Step};
use pathwarp::refit;
use pathwarp::{Error, Outline};
use pathwarp_svg::Edit;
use std::sync::Arc;

/// Which of the artwork is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Which {
    /// All that is warped.
    All,
    /// What this step of the recipe holds for.
    Step(usize),
    /// What the same steps hold for, in the order of [`Artwork::divide`].
    Part(usize),
}

/// Artwork of one kind, read and ready to be warped.
pub(crate) trait Artwork {
    /// The name of the file in reports.
    fn file_name(&self) -> String;

    /// The path that the reference `#NAME` means.
    fn path_named(&self, name: &str) -> Result<Outline, Error>;

    /// Removes the paths that serve as guides from the artwork. Called once, before anything below.
    fn remove_guides(&mut self, guides: Vec<String>);

    /// Divides the artwork by what the steps hold for; returns the indices of each part's steps. Called once, after the guides are
    /// removed, and only if a step has a selection of its own.
    ///
    /// # Errors
    /// A selector matches nothing, or the artwork has no parts.
    fn divide(&mut self, steps: &[Step]) -> Result<Vec<Vec<usize>>, Failure>;

    /// The bounding box of the artwork; `None` if there is none.
    fn bounding_box(&self, which: Which) -> Option<Rect>;

    /// The bounding box of all of the artwork, with strokes.
    fn painted_box(&self) -> Option<Rect> {
        self.bounding_box(Which::All)
    }

    /// The bounding box, `bounds`, with what the page cuts off the artwork. `None` if it cuts nothing.
    fn uncut_box(&self, _which: Which, _bounds: Rect) -> Option<Rect> {
        None
    }

    /// The frame for building a step that no other comes before. `bounds` is the artwork's bounding box.
    fn frame(
        &self,
        which: Which,
        choice: FrameChoice,
        bounds: Option<Rect>,
        baseline: Baseline,
    ) -> Result<Frame, Failure>;

    /// User units per px along x and y.
    fn units_per_px(&self) -> [f64; 2] {
        [1.0; 2]
    }

    /// The outlines of the artwork.
    fn outlines(&self, which: Which) -> Vec<&Outline>;

    /// The limits on the work that the artwork causes, and what is used of them.
    fn budget(&self) -> &Arc<Budget>;

    /// Warps the artwork.
    fn warp(&self, request: &WarpRequest<'_>) -> Result<WarpedArtwork, Failure>;
}

/// The baseline of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Baseline {
    /// The deformation has none; it has no use for lettering.
    None,
    /// The recipe gives it, or the deformation has none and only asks for the letters.
    Given,
    /// The recipe leaves it at its default, which follows the lettering.
    Open,
}

/// A warp of one input.
pub(crate) struct WarpRequest<'a> {
    pub(crate) recipe: &'a Recipe,
    /// One for each part of the artwork.
    pub(crate) built: &'a BuiltParts,
    pub(crate) options: &'a CommonOptions,
    /// User units.
    pub(crate) tolerance: f64,
    /// Small contours are held to less; see [`refit::suited`].
    pub(crate) suited: bool,
    /// What is done to the artwork instead of bending it.
    pub(crate) edit: Option<Edit>,
    /// The recipe file's text, to be embedded in the result.
    pub(crate) embedded_recipe: Option<String>,
    /// Show the result on the page of the source.
    pub(crate) same_view: bool,
}

impl WarpRequest<'_> {
    /// The tolerances of an outline's contours.
    pub(crate) fn contours(&self, o: &Outline) -> Vec<f64> {
        let own = |s: &Subpath| if self.suited { refit::suited(self.tolerance, s.diagonal()) } else { self.tolerance };
        o.subpaths.iter().map(own).collect()
    }
}

/// The outcome of a warp. Nothing is written yet.
pub(crate) struct WarpedArtwork {
    pub(crate) result: WarpedResult,
    pub(crate) shapes: Vec<ReportedShape>,
    pub(crate) skipped: Vec<SkippedShape>,
    pub(crate) warnings: Vec<String>,
    pub(crate) page: PageNews,
    /// Files besides the result.
    pub(crate) files: Vec<PendingFile>,
    /// The picture of `--preview`.
    pub(crate) preview: Option<Vec<u8>>,
    /// Something was left out besides the skipped shapes.
    pub(crate) partial: bool,
}

/// The warped file.
pub(crate) enum WarpedResult {
    /// To be written to the target or to standard output.
    Bytes(Vec<u8>),
    /// Written to its own place.
    File(PendingFile),
}
