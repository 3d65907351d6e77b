//! A part to warp, with everything that determines its image.

use super::bends::Bend;
use super::options::WarpOptions;
use super::path::{self, Digits, ROUNDING, allowed, with_arcs};
use super::seam::without_seams;
use super::united::AREA_SHARE;
use crate::scene::areas::stroke_extent;
use crate::scene::drawing::Drawing;
use crate::scene::geometry::stretch;
use crate::scene::model::{Part, PartRole};
use crate::scene::selected_lettering::{LetterSubpaths, letters_by_part};
use crate::source::number::arcs_data;
use pathwarp::edit::Area;
use pathwarp::engine::{KnownShapes, RESOLUTION};
use pathwarp::kurbo::{Affine, BezPath, Rect};
use pathwarp::map::Map;
use pathwarp::refit::{self, Nodes, PathReport, RefittedPath, suited};
use pathwarp::{GeometryError, Outline};
use std::ops::Range;
use std::sync::Arc;
use usvg::FillRule;

/// Settings that the parts under one map share.
#[derive(Clone, Copy)]
pub(super) struct PartContext<'a> {
    pub(super) map: &'a dyn Map,
    pub(super) options: &'a WarpOptions,
    /// Images of shapes that recur in the drawing.
    pub(super) known: &'a KnownShapes,
    pub(super) drawing: &'a Drawing,
    /// Root user space to px.
    pub(super) to_px: Affine,
    /// Number of gradients in the drawing that may become pictures, which share a budget of pixels.
    pub(super) gradient_count: usize,
    /// Largest width of a hairline, in root user units; 0 if the page is not measured in physical units.
    pub(super) hairline: f64,
}

/// The image of an outline in the part's user space as written.
pub(super) struct BentPath {
    pub(super) path: BezPath,
    /// The path data of the image if it is already written, because it has arcs, which `path` approximates, or several spans.
    pub(super) data: Option<String>,
    pub(super) report: PathReport,
}

/// A part to warp.
pub(super) struct PartTask<'a> {
    pub(super) part: &'a Part,
    pub(super) context: &'a PartContext<'a>,
    /// From the part's user space as written to root user space.
    pub(super) write: Affine,
    /// From root user space to the part's user space as written.
    pub(super) back: Affine,
    pub(super) pieces: &'a [LetterPiece],
    /// The part's outline in root user space.
    pub(super) whole: Arc<Outline>,
    /// The outline to bend: all copies, or the placed letters.
    pub(super) outline: Arc<Outline>,
    /// The part of the source to cut away, if it may meet this part.
    pub(super) hidden: Option<&'a Area>,
    /// The tolerances of the contours of `outline`; empty if they all have the drawing's.
    pub(super) contours: Vec<f64>,
    /// The tolerances of the contours of `whole`; empty if they all have the drawing's.
    pub(super) whole_contours: &'a [f64],
    /// The smallest tolerance.
    pub(super) finest: f64,
    /// The map that bends `outline`.
    pub(super) map: &'a dyn Map,
    digits: Digits,
    /// Decimals for the finest contour.
    pub(super) decimals: u8,
    /// Largest error from rounding, in root user units.
    pub(super) rounding: f64,
}

impl<'a> PartTask<'a> {
    /// `whole` is the part's outline in root user space, with the tolerances of its contours.
    pub(super) fn new(
        part: &'a Part,
        (whole, whole_contours): (Arc<Outline>, &'a [f64]),
        write: Affine,
        context: &'a PartContext<'a>,
        pieces: &'a [LetterPiece],
    ) -> Self {
        let options = context.options;
        let (mut outline, contours) = placed_outline(&whole, whole_contours, options, pieces);
        // Placed letters skip the first step; everything else goes through the whole map.
        let map: &dyn Map = if pieces.is_empty() { context.map } else { &options.letters.after };
        let digits = Digits { size: stretch(write), given: options.precision, tolerance: options.refit.tolerance };
        let finest = contours.iter().copied().fold(options.refit.tolerance, f64::min);
        let (decimals, rounding) = (digits.decimals(finest), digits.rounding(finest));
        if outline.subpaths.iter().any(|s| path::has_closing_stub(s, rounding)) {
            let subpaths = &mut Arc::make_mut(&mut outline).subpaths;
            subpaths.iter_mut().for_each(|s| path::drop_closing_stub(s, rounding));
        }
        let extent = stroke_extent(part, context.to_px);
        let bounds = whole.bounding_box().map(|b| b.inflate(extent, extent));
        Self {
            part,
            context,
            write,
            back: write.inverse(),
            pieces,
            whole,
            hidden: options.hidden.as_deref().filter(|hidden| boxes_meet(bounds, hidden)),
            outline,
            contours,
            whole_contours,
            finest,
            map,
            digits,
            decimals,
            rounding,
        }
    }

    /// Cuts the hidden part out of the outline to bend: out of the area of a fill without a stroke, otherwise out of the line.
    pub(super) fn without_hidden(mut self) -> Result<Self, GeometryError> {
        let Some(hidden) = self.hidden else { return Ok(self) };
        let seen = match self.seen_fill()? {
            Some(fill) if self.part.stroke.is_none() => fill,
            _ => hidden.lines_outside(&self.outline, AREA_SHARE * self.finest),
        };
        (self.outline, self.contours) = (Arc::new(seen), Vec::new());
        Ok(self)
    }

    /// Returns the area of the fill without what is hidden; `None` if there is no fill or nothing of it is hidden.
    pub(super) fn seen_fill(&self) -> Result<Option<Outline>, GeometryError> {
        let fill = self.part.fill.as_ref();
        let even_odd = fill.is_some_and(|f| f.rule() == FillRule::EvenOdd);
        let has_area = fill.is_some() || self.part.role == PartRole::Clip;
        self.hidden.filter(|_| has_area).map(|hidden| self.seen_area(hidden, &self.whole, even_odd)).transpose()
    }

    /// Returns an area without its hidden part.
    pub(super) fn seen_area(&self, hidden: &Area, outline: &Outline, even_odd: bool) -> Result<Outline, GeometryError> {
        let fine = AREA_SHARE * self.finest;
        Ok(Area::of(outline, even_odd, fine)?.difference(hidden, fine)?.outline().clone())
    }

    pub(super) fn options(&self) -> &'a WarpOptions {
        self.context.options
    }

    /// Bends an outline whose contours have these tolerances.
    pub(super) fn bend(&self, outline: &Outline, contours: &[f64]) -> Result<BentPath, GeometryError> {
        if let Some(parts) = without_seams(outline, self.map) {
            let tolerances: Vec<f64> = parts.iter().filter_map(|(i, _)| contours.get(*i).copied()).collect();
            let subpaths = parts.into_iter().map(|(_, s)| s).collect();
            return self.bend_contours(&Outline { subpaths }, &tolerances, true);
        }
        self.bend_contours(outline, contours, false)
    }

    /// Bends an outline whose segments the map does not bring together in seams. If it had seams, its contours are rings now (`are_rings`),
    /// and lines may become arcs.
    fn bend_contours(&self, outline: &Outline, contours: &[f64], are_rings: bool) -> Result<BentPath, GeometryError> {
        // Runs of segments, each with its tolerance: an edge shared with a finer contour takes the finer one.
        let spans = self.options().refit.shared.spans(outline, contours);
        let options = self.refit(self.allowed()).with_spans(self.digits.remaining_for_spans(&spans));
        if let Some(edit) = self.options().edit {
            let tolerances: Vec<f64> = (0..contours.len()).map(|i| self.allowed_of(i)).collect();
            // Without a result, the edit only refits the outline, as below.
            if let Some(RefittedPath { path, report, .. }) =
                edit.for_part(self.part).apply(outline, &self.refit(self.allowed()), &tolerances)?
            {
                return Ok(BentPath { path: self.to_local(path), data: None, report });
            }
        }
        if let Some((image, report)) = with_arcs(self.map, outline, &options, are_rings)? {
            let image = if self.back == Affine::IDENTITY { image } else { image.transformed(self.back) };
            let fine = ROUNDING * allowed(self.finest, self.rounding) / stretch(self.write).max(f64::MIN_POSITIVE);
            let decimals = |i: usize| self.digits.decimals(contours.get(i).copied().unwrap_or(self.finest));
            let data = arcs_data(&image, self.digits.extra_for_arcs(), decimals);
            return Ok(BentPath { path: image.to_bez_path(fine), data: Some(data), report });
        }
        let warped = self.context.known.warp_path(outline, self.map, &options)?;
        let mut report = warped.report;
        let path = self.to_local(warped.path);
        if spans.is_empty() {
            report.share = (report.max_error + self.rounding) / self.finest;
            return Ok(BentPath { path, data: None, report });
        }
        let [error, share] = self.digits.errors(&spans, &warped.spans);
        report.max_error = report.max_error.max(error - self.rounding);
        let missed = if report.resolution.is_some() { report.max_error / self.finest } else { 0.0 };
        report.share = share.max(missed);
        let data = self.digits.path_data(&path, outline, &spans, &warped.spans);
        Ok(BentPath { path, data: Some(data), report })
    }

    /// Bends the part's outline to measure it, without merging segments, which would take most of the time.
    pub(super) fn draft(&self) -> Result<BentPath, GeometryError> {
        let options = self.refit(allowed(self.finest, self.rounding)).with_nodes(Nodes::Source).with_certify(false);
        let warped = self.context.known.warp_path(&self.outline, self.map, &options)?;
        Ok(BentPath { path: self.to_local(warped.path), data: None, report: warped.report })
    }

    /// Options for refitting within a tolerance.
    pub(super) fn refit(&self, tolerance: f64) -> refit::Options {
        self.options().refit.clone().with_tolerance(tolerance).with_suited(false)
    }

    /// The tolerance that remains after rounding for a contour of `whole`, or for the drawing if there is no such contour.
    pub(super) fn allowed_of(&self, contour: usize) -> f64 {
        let tolerance = self.whole_contours.get(contour).copied().unwrap_or(self.options().refit.tolerance);
        self.digits.remaining(tolerance)
    }

    /// [`Digits::coarsest`] for the finest contour.
    pub(super) fn coarsest(&self) -> Option<f64> {
        self.digits.coarsest(self.finest)
    }

    /// The drawing's tolerance that remains after rounding.
    fn allowed(&self) -> f64 {
        self.allowed_of(usize::MAX)
    }

    /// Transforms a path from root user space to the part's user space as written.
    pub(super) fn to_local(&self, mut path: BezPath) -> BezPath {
        if self.back != Affine::IDENTITY {
            path.apply_affine(self.back);
        }
        path
    }
}

/// Returns `true` if the boxes of a part and of the hidden area meet.
fn boxes_meet(part: Option<Rect>, hidden: &Area) -> bool {
    part.zip(hidden.outline().bounding_box()).is_some_and(|(a, b)| a.overlaps(b))
}

/// The tolerances of the contours of every part, one for each subpath; empty for parts with the drawing's tolerance or with another bend
/// than `k`.
pub(super) fn contour_tolerances(
    drawing: &Drawing,
    bend: &Bend<'_>,
    part_bends: &[Option<usize>],
    k: usize,
) -> Vec<Vec<f64>> {
    let (parts, shapes) = (&drawing.scene().parts, drawing.shapes());
    let tolerance = bend.options.refit.tolerance;
    let to_px = drawing.scene().to_px;
    let tolerances = |i: usize| {
        if part_bends[i] != Some(k) || !bend.options.refit.suited {
            return Vec::new();
        }
        let is_text = shapes[i].element == "text";
        suited_tolerances(&shapes[i].outline, stroke_extent(&parts[i], to_px), is_text, tolerance)
    };
    let all: Vec<Vec<f64>> = (0..parts.len()).map(tolerances).collect();
    let is_small = |t: &f64| *t < tolerance;
    if all.iter().flatten().any(is_small) { all } else { vec![Vec::new(); parts.len()] }
}

/// The tolerances suited to the sizes of an outline's contours; in text, to the sizes of letters. `extent` is the stroke's on either side.
fn suited_tolerances(outline: &Outline, extent: f64, is_text: bool, tolerance: f64) -> Vec<f64> {
    // A tolerance below the resolution of the numbers cannot be met.
    let finest = (4.0 * RESOLUTION * outline.extent()).min(tolerance);
    let boxes: Vec<Rect> = outline.subpaths.iter().map(|s| s.bounding_box().inflate(extent, extent)).collect();
    let tolerance_of = |i: usize| {
        let shown = if is_text { letter_box(&boxes, i) } else { boxes[i] };
        suited(tolerance, shown.size().to_vec2().hypot()).max(finest)
    };
    (0..boxes.len()).map(tolerance_of).collect()
}

/// The box of the letter that a subpath of a text belongs to: the subpath's box or, if it is a hole, the box of the neighbour around it.
fn letter_box(boxes: &[Rect], i: usize) -> Rect {
    /// Letters have at most a few holes.
    const NEIGHBOURS: usize = 4;
    let neighbours = &boxes[i.saturating_sub(NEIGHBOURS)..(i + NEIGHBOURS + 1).min(boxes.len())];
    let contains = |b: &&Rect| b.union(boxes[i]) == **b;
    neighbours.iter().filter(contains).copied().fold(boxes[i], |a, b| if b.area() > a.area() { b } else { a })
}

/// The outline of a part to bend, which consists of all copies, or of the placed letters, with the tolerances of its contours.
pub(super) fn placed_outline(
    whole: &Arc<Outline>,
    contours: &[f64],
    options: &WarpOptions,
    pieces: &[LetterPiece],
) -> (Arc<Outline>, Vec<f64>) {
    match (pieces, options.copies.as_slice()) {
        ([], []) => (Arc::clone(whole), contours.to_vec()),
        ([], copies) => (Arc::new(whole.repeated(copies)), contours.repeat(copies.len())),
        _ => (Arc::new(place_letters(whole, pieces)), pieces.iter().flat_map(|p| p.repeated(contours)).collect()),
    }
}

/// The subpaths of a part that belong to one letter, with the transforms that place its copies.
#[derive(Debug, Clone)]
pub(crate) struct LetterPiece {
    range: Range<usize>,
    pub(crate) copies: Vec<Affine>,
}

impl LetterPiece {
    /// The letter's subpaths of `whole`.
    pub(crate) fn cut_from(&self, whole: &Outline) -> Outline {
        Outline { subpaths: whole.subpaths.get(self.range.clone()).unwrap_or_default().to_vec() }
    }

    /// The index in `whole` of the letter's first subpath.
    pub(crate) fn first(&self) -> usize {
        self.range.start
    }

    /// The values of the letter's subpaths in `whole`, repeated for each placed copy.
    pub(crate) fn repeated(&self, whole: &[f64]) -> Vec<f64> {
        whole.get(self.range.clone()).unwrap_or_default().repeat(self.copies.len())
    }
}

pub(crate) fn place_letters(whole: &Outline, pieces: &[LetterPiece]) -> Outline {
    Outline { subpaths: pieces.iter().flat_map(|p| p.cut_from(whole).repeated(&p.copies).subpaths).collect() }
}

/// The placed letters of every part; empty for parts that the map bends.
pub(crate) fn placed_letters(drawing: &Drawing, options: &WarpOptions) -> Vec<Vec<LetterPiece>> {
    let places = &options.letters.places;
    if places.is_empty() {
        return vec![Vec::new(); drawing.scene().parts.len()];
    }
    let piece = |l: LetterSubpaths| {
        let copies = places.get(l.letter).filter(|p| !p.is_empty())?.clone();
        Some(LetterPiece { range: l.range, copies })
    };
    letters_by_part(drawing, options.letters.of.as_ref().unwrap_or(&options.selection), options.letters.of_objects)
        .into_iter()
        .map(|of_part| of_part.into_iter().filter_map(piece).collect())
        .collect()
}

/// For the selected painted shapes in order, the outline with its letters placed, if there are any.
pub(crate) fn placed_outlines(drawing: &Drawing, options: &WarpOptions) -> Vec<Option<Outline>> {
    let selected = drawing.selected_parts(&options.selection);
    let shapes = drawing.shapes().iter().zip(selected).zip(placed_letters(drawing, options));
    let chosen = shapes.filter(|((s, selected), _)| *selected && s.painted);
    chosen.map(|((s, _), pieces)| (!pieces.is_empty()).then(|| place_letters(&s.outline, &pieces))).collect()
}
