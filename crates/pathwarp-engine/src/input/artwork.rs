//! [`Artwork`]: the interface between the pipeline and every kind of input.

use super::files::no_document;
use super::proportions::Proportions;
use crate::advice;
use crate::export::KerfReport;
use crate::failure::Failure;
use crate::options::{CommonOptions, FrameChoice};
use crate::output::PendingFile;
use crate::page::PageNews;
use crate::readable::listed;
use crate::report::{ReportedShape, SkippedShape};
use pathwarp::budget::Budget;
use pathwarp::engine::BuiltParts;
use pathwarp::fold::Orientation;
use pathwarp::kurbo::{Point, Rect};
use pathwarp::param::{Frame, Letter};
use pathwarp::recipe::{Recipe, Step};
use pathwarp::{Error, Outline};
use pathwarp_svg::Edit;
use pathwarp_svg::engine::CutLine;
use std::collections::HashMap;
use std::sync::Arc;

/// A selection of the artwork.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// All that the recipe warps.
    All,
    /// The selection of this step of the recipe.
    Step(usize),
    /// A part to which the same steps apply, in the order of [`Artwork::divide`].
    Part(usize),
}

/// Artwork of one kind, read and ready to be warped.
pub trait Artwork {
    /// Returns the path that the reference `#NAME` means.
    fn path_named(&self, name: &str) -> Result<Outline, Error>;

    /// Removes the paths that serve as guides. Called once, before all methods below.
    fn remove_guides(&mut self, guides: Vec<String>);

    /// Edits the artwork before the first of these steps, which bend it. Called once the guides are removed.
    ///
    /// # Errors
    /// [`Failure::Usage`] if the artwork cannot be edited, [`Failure::Library`] if an edit fails.
    fn edit_first(&mut self, edits: &[Step], _steps: &[Step], _options: &CommonOptions) -> Result<(), Failure> {
        if edits.is_empty() { Ok(()) } else { Err(Failure::usage(advice::NO_PATHS_TO_EDIT)) }
    }

    /// Divides the artwork into parts to which the same steps apply. Returns the indices of each part's steps. Called once, after the
    /// guides are removed, and only if a step has a selection.
    ///
    /// # Errors
    /// [`Failure::Library`] if a selector matches nothing, [`Failure::Usage`] if the artwork has no parts.
    fn divide(&mut self, steps: &[Step]) -> Result<Vec<Vec<usize>>, Failure>;

    /// Returns the bounding box; `None` if there is no artwork.
    fn bounding_box(&self, which: Which) -> Option<Rect>;

    /// Returns the bounding box of all artwork, with strokes.
    fn painted_box(&self) -> Option<Rect> {
        self.bounding_box(Which::All)
    }

    /// Enlarges the bounding box, `bounds`, by the artwork that the page cuts off; `None` if it cuts nothing.
    fn uncut_box(&self, _which: Which, _bounds: Rect) -> Option<Rect> {
        None
    }

    /// Returns the frame for a step that no other precedes. `bounds` is the artwork's bounding box.
    fn frame(
        &self,
        which: Which,
        choice: FrameChoice,
        bounds: Option<Rect>,
        baseline: Baseline,
    ) -> Result<Frame, Failure>;

    /// Returns the user units per px along x and y.
    fn units_per_px(&self) -> [f64; 2] {
        [1.0; 2]
    }

    /// Returns the page that the artwork is on.
    fn page(&self) -> Option<Rect> {
        None
    }

    /// Returns the outlines of the artwork.
    fn outlines(&self, which: Which) -> Vec<&Outline>;

    /// The limits on the work that the artwork causes, and the work spent.
    fn budget(&self) -> &Arc<Budget>;
}

/// Artwork from a file, warped to another file.
pub trait FileArtwork: Artwork {
    /// Returns the name of the file in reports.
    fn file_name(&self) -> String;

    /// Warps the artwork.
    fn warp(&self, request: &WarpRequest<'_>) -> Result<WarpedArtwork, Failure>;
}

/// Outlines without a file.
pub struct PlainArtwork<'a> {
    /// The outlines, in user units.
    pub outlines: Vec<&'a Outline>,
    /// The frame of every step that no other precedes.
    pub frame: Frame,
    /// The limits on the work, and the work spent.
    pub budget: Arc<Budget>,
}

impl Artwork for PlainArtwork<'_> {
    fn path_named(&self, name: &str) -> Result<Outline, Error> {
        Err(no_document(name))
    }

    fn remove_guides(&mut self, _guides: Vec<String>) {}

    fn divide(&mut self, _steps: &[Step]) -> Result<Vec<Vec<usize>>, Failure> {
        Err(Failure::usage("select and exclude are for drawings"))
    }

    fn bounding_box(&self, _which: Which) -> Option<Rect> {
        self.outlines.iter().filter_map(|o| o.bounding_box()).reduce(|a, b| a.union(b))
    }

    fn frame(&self, _: Which, _: FrameChoice, _: Option<Rect>, _: Baseline) -> Result<Frame, Failure> {
        Ok(self.frame.clone())
    }

    fn units_per_px(&self) -> [f64; 2] {
        self.frame.units_per_px
    }

    fn outlines(&self, _which: Which) -> Vec<&Outline> {
        self.outlines.clone()
    }

    fn budget(&self) -> &Arc<Budget> {
        &self.budget
    }
}

/// Returns lines all over a box, for deformations that examine artwork: the map then depends on the frame, not on the points mapped.
pub fn hatching(frame: Rect) -> Outline {
    const LINES: u32 = 24;
    let line = |i: u32| {
        let y = frame.y0 + frame.height() * f64::from(i) / f64::from(LINES - 1);
        Outline::from_points(&[Point::new(frame.x0, y), Point::new(frame.x1, y)], false).subpaths
    };
    Outline { subpaths: (0..LINES).flat_map(line).collect() }
}

/// The baseline of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Baseline {
    /// The deformation has no baseline and does not use lettering.
    None,
    /// The recipe gives it, or the deformation has none and only needs the letters.
    Given,
    /// The recipe omits it; the default follows the lettering.
    Open,
}

/// A warp of one input.
pub struct WarpRequest<'a> {
    /// The steps as given.
    pub recipe: &'a Recipe,
    /// The built steps of each part of the artwork.
    pub built: &'a BuiltParts,
    /// The options as read.
    pub options: &'a CommonOptions,
    /// The tolerance in user units.
    pub tolerance: f64,
    /// `true` to use smaller tolerances for small contours; see [`suited`](pathwarp::refit::suited).
    pub suited: bool,
    /// The edit to do instead of bending.
    pub edit: Option<Edit>,
    /// The line that the edit `contour` draws.
    pub line: CutLine,
    /// The recipe file's text, to be embedded in the result.
    pub embedded_recipe: Option<String>,
    /// `true` to show the result on the source's page.
    pub same_view: bool,
}

/// The outcome of a warp. Nothing is written yet.
pub struct WarpedArtwork {
    pub result: WarpedResult,
    pub shapes: Vec<ReportedShape>,
    pub skipped: Vec<SkippedShape>,
    pub warnings: Vec<String>,
    pub page: PageNews,
    /// Elements whose filters became pictures, and those whose filters kept their affine fits.
    pub(crate) filters: [Vec<String>; 2],
    /// The tolerance, if it differs from the request's.
    pub(crate) tolerance: Option<f64>,
    /// Files besides the result.
    pub(crate) files: Vec<PendingFile>,
    /// The picture of `--preview`.
    pub(crate) preview: Option<Vec<u8>>,
    /// The changes made by `--kerf`.
    pub(crate) kerf: Option<KerfReport>,
    /// The proportions that `--crop` found in a photograph.
    pub(crate) proportions: Option<Proportions>,
    /// `true` if something besides the skipped shapes was left out.
    pub(crate) partial: bool,
}

/// The warped file.
pub enum WarpedResult {
    /// Bytes for the target or for standard output.
    Bytes(Vec<u8>),
    /// A file with a destination.
    File(PendingFile),
}

/// Returns the warning that the shape `id` folds at `at`, with the letters in it that fold.
pub(super) fn fold_warning(id: &str, letters: &[String], at: Point) -> String {
    const NAMED: usize = 8;
    let position = format!("near {:.4},{:.4}: the map reverses orientation there", at.x, at.y);
    match letters {
        [] => format!("{id} folds over {position}"),
        // The id of an outlined letter contains its name.
        [one] if id.contains(one.as_str()) => format!("{id} folds over {position}"),
        [one] => format!("{id}: the letter “{one}” folds over {position}"),
        _ => {
            let quoted: Vec<String> = letters.iter().map(|l| format!("“{l}”")).collect();
            format!("{id}: the letters {} fold over, first {position}", listed(&quoted, NAMED))
        }
    }
}

/// Groups the letters by the ids of their shapes.
pub(super) fn letters_by_shape<'a>(
    shapes: impl Iterator<Item = (&'a str, &'a Outline)>,
    letters: &'a [Letter],
) -> HashMap<&'a str, Vec<&'a Letter>> {
    let bits = |p: Point| [p.x.to_bits(), p.y.to_bits()];
    // The outline of a letter is a range of the subpaths of its shape.
    let starting = letters.iter().filter_map(|l| Some((bits(l.outline.subpaths.first()?.start), l)));
    let starting: HashMap<[u64; 2], &Letter> = starting.collect();
    let mut out: HashMap<&str, Vec<&Letter>> = HashMap::new();
    for (id, outline) in shapes {
        let letters = outline.subpaths.iter().filter_map(|s| starting.get(&bits(s.start)));
        letters.for_each(|l| out.entry(id).or_default().push(l));
    }
    out
}

/// Returns the names of the letters that fold, relative to the artwork as a whole.
pub(super) fn folded(
    letters: Option<&Vec<&Letter>>,
    all: &Orientation,
    orientation: impl Fn(&Outline) -> Orientation,
) -> Vec<String> {
    let folded = letters.into_iter().flatten().filter(|l| orientation(&l.outline).folded_against(all).is_some());
    folded.map(|l| l.name.clone()).collect()
}
