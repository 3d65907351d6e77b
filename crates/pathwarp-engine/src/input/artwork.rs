//! [`Artwork`]: what the pipeline asks of every kind of input.

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

/// Which of the artwork is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// All that is warped.
    All,
    /// What this step of the recipe holds for.
    Step(usize),
    /// What the same steps hold for, in the order of [`Artwork::divide`].
    Part(usize),
}

/// Artwork of one kind, read and ready to be warped.
pub trait Artwork {
    /// The path that the reference `#NAME` means.
    fn path_named(&self, name: &str) -> Result<Outline, Error>;

    /// Removes the paths that serve as guides from the artwork. Called once, before anything below.
    fn remove_guides(&mut self, guides: Vec<String>);

    /// Edits what these steps hold for before they do anything. Called once the guides are removed.
    ///
    /// # Errors
    /// The artwork cannot be edited.
    fn edit_first(&mut self, edits: &[Step], _steps: &[Step], _options: &CommonOptions) -> Result<(), Failure> {
        if edits.is_empty() { Ok(()) } else { Err(Failure::usage(advice::NO_PATHS_TO_EDIT)) }
    }

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

    /// The page that it is on.
    fn page(&self) -> Option<Rect> {
        None
    }

    /// The outlines of the artwork.
    fn outlines(&self, which: Which) -> Vec<&Outline>;

    /// The limits on the work that the artwork causes, and what is used of them.
    fn budget(&self) -> &Arc<Budget>;
}

/// Artwork from a file, which gives another one.
pub trait FileArtwork: Artwork {
    /// The name of the file in reports.
    fn file_name(&self) -> String;

    /// Warps the artwork.
    fn warp(&self, request: &WarpRequest<'_>) -> Result<WarpedArtwork, Failure>;
}

/// Outlines that come from no file.
pub struct PlainArtwork<'a> {
    /// The outlines, in user units.
    pub outlines: Vec<&'a Outline>,
    /// The frame of every step that no other comes before.
    pub frame: Frame,
    /// The limits on the work, and what is used of them.
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

/// Lines all over a box: artwork for deformations that look at it, so that the map depends on the frame alone, and no point on another.
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
    /// The deformation has none; it has no use for lettering.
    None,
    /// The recipe gives it, or the deformation has none and only asks for the letters.
    Given,
    /// The recipe leaves it at its default, which follows the lettering.
    Open,
}

/// A warp of one input.
pub struct WarpRequest<'a> {
    /// The steps as given.
    pub recipe: &'a Recipe,
    /// One for each part of the artwork.
    pub built: &'a BuiltParts,
    /// The options as read.
    pub options: &'a CommonOptions,
    /// User units.
    pub tolerance: f64,
    /// Small contours are held to less; see [`suited`](pathwarp::refit::suited).
    pub suited: bool,
    /// What is done to the artwork instead of bending it.
    pub edit: Option<Edit>,
    /// How the line of a contour is written.
    pub line: CutLine,
    /// The recipe file's text, to be embedded in the result.
    pub embedded_recipe: Option<String>,
    /// Show the result on the page of the source.
    pub same_view: bool,
}

/// The outcome of a warp. Nothing is written yet.
pub struct WarpedArtwork {
    pub result: WarpedResult,
    pub shapes: Vec<ReportedShape>,
    pub skipped: Vec<SkippedShape>,
    pub warnings: Vec<String>,
    pub page: PageNews,
    /// Elements whose filters became pictures, and those whose filters look right under their fit.
    pub(crate) filters: [Vec<String>; 2],
    /// The tolerance, if it is not that of the request.
    pub(crate) tolerance: Option<f64>,
    /// Files besides the result.
    pub(crate) files: Vec<PendingFile>,
    /// The picture of `--preview`.
    pub(crate) preview: Option<Vec<u8>>,
    /// What `--kerf` did.
    pub(crate) kerf: Option<KerfReport>,
    /// The proportions that `--crop` found in a photograph.
    pub(crate) proportions: Option<Proportions>,
    /// Something was left out besides the skipped shapes.
    pub(crate) partial: bool,
}

/// The warped file.
pub enum WarpedResult {
    /// To be written to the target or to standard output.
    Bytes(Vec<u8>),
    /// Written to its own place.
    File(PendingFile),
}

/// The warning that the shape `id` folds at `at`, with its letters that fold.
pub(super) fn fold_warning(id: &str, letters: &[String], at: Point) -> String {
    const NAMED: usize = 8;
    let place = format!("near {:.4},{:.4}: the map reverses orientation there", at.x, at.y);
    match letters {
        // An outlined letter has its name in its id.
        [] => format!("{id} folds over {place}"),
        [one] if id.contains(one.as_str()) => format!("{id} folds over {place}"),
        [one] => format!("{id}: the letter “{one}” folds over {place}"),
        _ => {
            let quoted: Vec<String> = letters.iter().map(|l| format!("“{l}”")).collect();
            format!("{id}: the letters {} fold over, first {place}", listed(&quoted, NAMED))
        }
    }
}

/// The letters of every shape, by its id.
pub(super) fn letters_by_shape<'a>(
    shapes: impl Iterator<Item = (&'a str, &'a Outline)>,
    letters: &'a [Letter],
) -> HashMap<&'a str, Vec<&'a Letter>> {
    let bits = |p: Point| [p.x.to_bits(), p.y.to_bits()];
    // The outline of a letter is a run of the subpaths of its shape.
    let starting = letters.iter().filter_map(|l| Some((bits(l.outline.subpaths.first()?.start), l)));
    let starting: HashMap<[u64; 2], &Letter> = starting.collect();
    let mut out: HashMap<&str, Vec<&Letter>> = HashMap::new();
    for (id, outline) in shapes {
        let own = outline.subpaths.iter().filter_map(|s| starting.get(&bits(s.start)));
        own.for_each(|l| out.entry(id).or_default().push(l));
    }
    out
}

/// The names of the letters that fold against the artwork as a whole.
pub(super) fn folded(
    letters: Option<&Vec<&Letter>>,
    all: &Orientation,
    orientation: impl Fn(&Outline) -> Orientation,
) -> Vec<String> {
    let folded = letters.into_iter().flatten().filter(|l| orientation(&l.outline).folded_against(all).is_some());
    folded.map(|l| l.name.clone()).collect()
}
