//! Results of warping, by part for the writers and by shape for the report.

use super::fits::PaintFit;
use super::gradients::NewGradient;
use super::pictures::{BentImage, PictureError};
use crate::source::number::path_data_by;
use pathwarp::kurbo::{Affine, BezPath, Rect};
use pathwarp::refit::{Assurance, PathReport};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Display};

/// A warped document.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct WarpedDocument {
    /// The text of the file.
    pub svg: String,
    /// Report on every warped shape, in painting order.
    pub shapes: Vec<ShapeReport>,
    /// Elements that were not warped.
    pub skipped: Vec<Skipped>,
    /// Warnings for the user.
    pub warnings: Vec<Warning>,
    /// Distance by which the artwork extends past the page. `None` if it does not, or no farther than the original, or the page is
    /// adapted (see [`PageFit`](crate::PageFit)).
    pub overhang: Option<Overhang>,
    /// The visible areas of the source and the result, in root user units, if the page is adapted.
    pub page: Option<[Rect; 2]>,
    /// With [`PageFit::Shrink`](crate::PageFit::Shrink), if the artwork leaves the page: the transform that takes it back, with the margin
    /// of the original. `svg` does not contain it; the caller applies it.
    pub back: Option<Affine>,
    /// Names of the elements whose filters became pictures, and of the elements whose filters follow an affine fit that looks right.
    pub filters: [Vec<String>; 2],
    /// `true` if nothing of the result lies on its page.
    pub blank: bool,
}

/// Report on a warped shape.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ShapeReport {
    /// Id in the source, or else tag and position such as `path at 12:5`.
    pub id: String,
    /// Number of copies in the result.
    pub copies: usize,
    /// Report on the curves. Segments are counted in every copy, tile and letter; those of the output include outlined strokes. Errors
    /// include the rounding of the text.
    pub path: PathReport,
    /// Largest distance between the map and the affine fit of the shape's gradients or patterns, in root user units; infinite if no
    /// affine map is close. `None` if there are no such paints, or they were kept or replaced.
    pub paint_residual: Option<f64>,
    /// Number of gradients that became pictures.
    pub pictures: usize,
    /// Largest distance between the painted areas of a stroke that remains a stroke and of the exact one, in root user units; infinite if
    /// it is unknown. For dashes, it is an estimate: they shift along the path, and may gain or lose a piece at its corners and ends.
    /// `None` if there is no such stroke, or its width is kept on request.
    pub stroke_error: Option<f64>,
    /// Number of strokes that became outlines.
    pub outlined_strokes: usize,
    /// Names of the shapes that were united to this one, including itself; empty if none were.
    pub united: Vec<String>,
}

impl ShapeReport {
    /// Reports on a shape whose paints and strokes need no remark.
    #[must_use]
    pub fn new(id: &str, copies: usize, path: PathReport) -> Self {
        Self {
            id: id.to_owned(),
            copies,
            path,
            paint_residual: None,
            pictures: 0,
            stroke_error: None,
            outlined_strokes: 0,
            united: Vec::new(),
        }
    }

    /// Adds another part of the same shape.
    fn add(&mut self, part: Self) {
        let larger = |a: Option<f64>, b: Option<f64>| [a, b].into_iter().flatten().reduce(f64::max);
        self.path.segments_in += part.path.segments_in;
        self.path.segments_out += part.path.segments_out;
        self.path.add(part.path); // This leaves the numbers of segments alone.
        self.pictures += part.pictures;
        self.paint_residual = larger(self.paint_residual, part.paint_residual);
        self.stroke_error = larger(self.stroke_error, part.stroke_error);
        self.outlined_strokes += part.outlined_strokes;
    }
}

/// An element that was not warped. It is unchanged, or left out of flattened output if it cannot be included.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Skipped {
    /// Id in the source, or else tag and position.
    pub id: String,
    /// The reason.
    pub why: String,
}

/// Distances by which the warped artwork extends past the page, on sides where the original does not extend as far.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Overhang {
    /// Left, top, right and bottom, in root user units; 0 for sides without overhang.
    pub by: [f64; 4],
    /// The largest overhang as a fraction of the page's width (left, right) or height (top, bottom).
    pub share: f64,
}

impl WarpedDocument {
    /// Adds a part to its shape's report, whose index is `known` if there is one. Returns the index of the report.
    pub(super) fn report(&mut self, id: &str, part: &WarpedPart, copies: usize, known: Option<usize>) -> usize {
        let mut path = part.report.clone();
        path.max_error += part.rounding;
        let of_part = ShapeReport {
            paint_residual: part.residual,
            pictures: usize::from(part.fill_image.is_some()) + usize::from(part.stroke_image.is_some()),
            stroke_error: part.stroke_error,
            outlined_strokes: usize::from(part.stroke.outline().is_some()),
            ..ShapeReport::new(id, copies, path)
        };
        if let Some((i, shape)) = known.and_then(|i| Some((i, self.shapes.get_mut(i)?))) {
            shape.add(of_part);
            return i;
        }
        self.shapes.push(of_part);
        self.shapes.len() - 1
    }
}

/// Remarks for the user. Each is listed once, with the names of everything it applies to.
#[derive(Debug, Default)]
pub(crate) struct Notes(BTreeMap<&'static str, BTreeSet<String>>);

impl Notes {
    pub(crate) fn add(&mut self, text: &'static str, name: &str) {
        self.0.entry(text).or_default().insert(name.to_owned());
    }

    /// The sentences for notes from reading the drawing, given as pairs of a text and a name.
    pub(crate) fn in_words(read: &BTreeSet<(&'static str, String)>) -> Vec<String> {
        let mut notes = Self::default();
        read.iter().for_each(|(text, name)| notes.add(text, name));
        notes.warnings().map(|w| w.to_string()).collect()
    }

    pub(crate) fn warnings(self) -> impl Iterator<Item = Warning> {
        let named = |names: BTreeSet<String>| names.into_iter().filter(|n| !n.is_empty()).collect();
        self.0.into_iter().map(move |(text, names)| Warning::Note { text, names: named(names) })
    }
}

/// Result of warping a part.
#[derive(Debug)]
pub(crate) enum PartOutcome {
    /// The part is written as it is in the source.
    Kept,
    Warped(Box<WarpedPart>),
}

impl PartOutcome {
    pub(crate) fn warped(&self) -> Option<&WarpedPart> {
        if let Self::Warped(part) = self { Some(part) } else { None }
    }
}

/// The image of a part, with the replacements of its paints.
#[derive(Debug)]
pub(crate) struct WarpedPart {
    /// Outline in the part's user space.
    pub(crate) path: BezPath,
    /// The filled outline, if it differs from `path`: an open path is filled as if closed by a line, which is bent, too. Empty if there
    /// is nothing to fill.
    pub(crate) fill: Option<BezPath>,
    pub(crate) decimals: u8,
    /// The largest step between coordinates that rounding may have, in units as written; the unit of the last decimal is the power of ten
    /// below. `None` if the number of decimals is requested.
    pub(crate) coarsest: Option<f64>,
    /// The path data of `path`, if already written: because it has arcs, which `path` approximates, or because the threads that bend a
    /// large drawing also write its path data.
    pub(crate) data: Option<String>,
    pub(crate) stroke: StrokeOutcome,
    /// Largest distance between a scaled stroke and the exact one, in root user units.
    pub(super) stroke_error: Option<f64>,
    /// `true` if the stroke is scaled because the map is not defined around it.
    pub(super) stroke_off_domain: bool,
    /// Fit to be applied to gradients and patterns; `None` if they are unchanged.
    pub(crate) fit: Option<PaintFit>,
    /// Gradients that replace the ones of fill and stroke, where the fit would look wrong.
    pub(crate) fill_gradient: Option<NewGradient>,
    pub(crate) stroke_gradient: Option<NewGradient>,
    /// Pictures that replace the gradients of fill and stroke.
    pub(crate) fill_image: Option<BentImage>,
    pub(crate) stroke_image: Option<BentImage>,
    /// The reason why a gradient that should be a picture is not.
    pub(super) unpainted: Option<PictureError>,
    /// Largest distance between the map and the fit for paints that follow it, in root user units.
    pub(super) residual: Option<f64>,
    pub(super) report: PathReport,
    /// Largest error from rounding coordinates, in root user units.
    pub(super) rounding: f64,
}

impl WarpedPart {
    /// Returns `true` if anything of the part is drawn.
    pub(crate) fn draws(&self) -> bool {
        !self.path.is_empty() || self.stroke.outline().is_some()
    }

    /// For a simplification: returns `true` if the part got no fewer segments. It then stays as it was, and its report is reset.
    pub(super) fn reset_if_no_fewer(&mut self) -> bool {
        let r = &mut self.report;
        let stays = r.segments_out >= r.segments_in;
        if stays {
            (r.segments_out, r.max_error, r.share, self.rounding) = (r.segments_in, 0.0, 0.0, 0.0);
            (r.assurance, r.resolution) = (Assurance::Exact, None);
            r.unresolved.clear();
        }
        stays
    }

    /// Writes a path of the part as path data.
    pub(crate) fn text(&self, path: &BezPath) -> String {
        path_data_by(path, |_| self.coarsest, |_| [self.decimals; 2])
    }

    /// The part with its path data written.
    pub(super) fn with_data(mut self) -> Self {
        self.data = Some(self.data.take().unwrap_or_else(|| self.text(&self.path)));
        self
    }
}

/// Result for a stroke.
#[derive(Debug)]
pub(crate) enum StrokeOutcome {
    /// Factor for width and dashes.
    Scaled(f64),
    /// Outline of the stroke in the part's user space.
    Outlined(BezPath),
}

impl StrokeOutcome {
    /// The outline of an expanded stroke.
    pub(crate) fn outline(&self) -> Option<&BezPath> {
        if let Self::Outlined(outline) = self { Some(outline) } else { None }
    }

    /// Factor for width and dashes; 1 for an expanded stroke.
    pub(crate) fn scale(&self) -> f64 {
        if let Self::Scaled(factor) = self { *factor } else { 1.0 }
    }
}

/// A warning for the user about a warped drawing. [`Display`] writes it as a sentence without a full stop.
///
/// Elements are named as in [`ShapeReport::id`](crate::ShapeReport::id).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// The structure of the file could not be kept, for this reason: the result is flattened.
    Flattened(String),
    /// A gradient only follows the best affine fit of the map.
    FittedGradient {
        /// The shape that it paints.
        id: String,
        /// The reason why it did not become a picture.
        why: String,
    },
    /// A stroke that should have become an outline remains a stroke, as the map is undefined beside it.
    SingleWidth {
        /// The shape.
        id: String,
        /// Largest distance from the exact stroke, in root user units; infinite if it is unknown.
        error: f64,
    },
    /// Gradients and patterns span the whole row of copies instead of each copy.
    SharedPaints,
    /// Images and filtered groups follow the row of copies as a whole.
    SharedImages,
    /// Text uses another font, as these are missing.
    MissingFonts(Vec<String>),
    /// Sentences about letters that no font has, each with the text around it.
    MissingLetters(Vec<String>),
    /// Artwork that lay off the page has moved onto it: these elements, in the order of the file.
    Arrivals(Vec<String>),
    /// Something else that is lost or changed.
    Note {
        /// The sentence.
        text: &'static str,
        /// The elements, attributes or prefixes that it applies to, sorted.
        names: Vec<String>,
    },
}

impl Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flattened(why) => write!(f, "the file is flattened, as its structure cannot be kept: {why}"),
            Self::FittedGradient { id, why } => write!(f, "a gradient of {id} only follows the best affine fit: {why}"),
            Self::SingleWidth { id, error } => {
                write!(f, "the stroke of {id} extends to where the map is undefined; it keeps a single width")?;
                if error.is_finite() { write!(f, ", off by up to {error:.3} units") } else { Ok(()) }
            }
            Self::SharedPaints => {
                f.write_str("gradients and patterns span the whole row of copies instead of each copy")
            }
            Self::SharedImages => {
                f.write_str("images and filtered groups are not repeated; they follow the row as a whole")
            }
            Self::MissingFonts(names) => {
                write!(f, "text uses another font, as {} is missing; install it or outline the text", names.join(", "))
            }
            Self::MissingLetters(sentences) => {
                write!(f, "{}; install a font that has them, or give one", sentences.join(", "))
            }
            Self::Note { text, names } => {
                f.write_str(text)?;
                write_names(f, names)
            }
            Self::Arrivals(names) => {
                let shapes = if names.len() == 1 {
                    "shape that lay off the page has"
                } else {
                    "shapes that lay off the page have"
                };
                write!(f, "{} {shapes} moved onto it", names.len())?;
                write_names(f, names)
            }
        }
    }
}

fn write_names(f: &mut fmt::Formatter<'_>, names: &[String]) -> fmt::Result {
    /// Names listed; the others are counted.
    const MAX_NAMES: usize = 4;
    if let Some((first, others)) = names.split_first() {
        write!(f, ": {first}")?;
        others.iter().take(MAX_NAMES - 1).try_for_each(|name| write!(f, ", {name}"))?;
    }
    if names.len() > MAX_NAMES { write!(f, " and {} more", names.len() - MAX_NAMES) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::Warning;

    #[test]
    fn notes_name_a_few_of_many() {
        let note = |n: usize| {
            let names = ["a", "b", "c", "d", "e", "f"][..n].iter().map(|s| (*s).to_owned()).collect();
            Warning::Note { text: "dropped", names }.to_string()
        };
        assert_eq!(
            [0, 1, 4, 6].map(note),
            ["dropped", "dropped: a", "dropped: a, b, c, d", "dropped: a, b, c, d and 2 more"]
        );
    }
}
