//! The report of a file and of its shapes. The field names are the JSON's.

use crate::export::KerfReport;
use crate::input::Proportions;
use pathwarp::fold::Orientation;
use pathwarp::kurbo::Point;
use pathwarp::refit::Assurance;
use pathwarp_svg::{ShapeReport, Skipped};
use serde::ser::SerializeMap as _;
use serde::{Serialize, Serializer};
use std::fmt;

/// The report of one input file.
#[derive(Debug, Clone, Default, Serialize)]
pub struct FileReport {
    /// The name of the file.
    pub file: String,
    /// The name of the output; `None` for standard output or after an error.
    pub output: Option<String>,
    /// The error, if the input could not be warped; omitted otherwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// The tolerance in user units; `None` after an error.
    pub(crate) tolerance: Option<f64>,
    /// The frame that percentages refer to: x, y, width and height in user units; `None` after an error.
    pub frame: Option<[f64; 4]>,
    /// The part of the artwork that each step applies to; omitted if all apply to the same.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) selections: Vec<StepSelection>,
    /// The height of the lettering's baseline, if the frame has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub baseline: Option<f64>,
    /// The visible part of the plane, x, y, width and height in user units, if `--fit` has changed it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) page: Option<[f64; 4]>,
    /// The shapes that were warped.
    pub shapes: Vec<ReportedShape>,
    /// The shapes that were left out.
    pub skipped: Vec<SkippedShape>,
    /// The contours that `--kerf` moved; omitted without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) kerf: Option<KerfReport>,
    /// The proportions that `--crop` found in a photograph; omitted if there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) proportions: Option<Proportions>,
    /// Warnings about the whole file.
    pub warnings: Vec<String>,
}

impl FileReport {
    /// Reports an input that could not be warped.
    pub fn failed(file: String, error: String) -> Self {
        Self { file, error: Some(error), ..Self::default() }
    }

    /// Returns `true` if a shape was skipped or missed the tolerance.
    pub(crate) fn is_partial(&self) -> bool {
        !self.skipped.is_empty() || self.shapes.iter().any(|s| !s.shape.path.unresolved.is_empty())
    }
}

/// A step with a part of the artwork.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct StepSelection {
    pub(crate) deformation: String,
    /// Selectors; empty for all artwork.
    pub(crate) select: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) exclude: Vec<String>,
    /// The frame that its percentages refer to: x, y, width and height in user units.
    pub(crate) frame: [f64; 4],
}

/// One shape: the changes of its curves and paint, the steps that applied to it, and its folds.
#[derive(Debug, Clone)]
pub struct ReportedShape {
    /// Its curves and paint, before and after.
    pub shape: ShapeReport,
    /// The steps that apply to the shape, counted from 1; `None` if all do.
    pub(crate) steps: Option<Vec<usize>>,
    /// Its folds.
    pub fold: Fold,
}

/// The folds of one shape.
#[derive(Debug, Clone)]
pub struct Fold {
    /// Number of orientation changes along the shape, at least 1; 0 if it does not fold.
    pub count: usize,
    /// The first point where it folds.
    pub at: Option<Point>,
}

impl Fold {
    /// Compares the orientation of one shape with that of all artwork.
    pub(crate) fn of(shape: &Orientation, all: &Orientation) -> Self {
        let at = shape.folded_against(all);
        Self { count: if at.is_some() { shape.changes.max(1) } else { 0 }, at }
    }
}

/// Leaves out what nearly all shapes have in common. An infinite number stands for an unknown one, and is null in JSON.
impl Serialize for ReportedShape {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let ShapeReport { id, copies, path, paint_residual, pictures, stroke_error, outlined_strokes, united, .. } =
            &self.shape;
        let coordinates = |p: &Point| [p.x, p.y];
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("id", id)?;
        if let Some(steps) = &self.steps {
            map.serialize_entry("steps", steps)?;
        }
        if *copies != 1 {
            map.serialize_entry("copies", copies)?;
        }
        map.serialize_entry("segments_in", &path.segments_in)?;
        map.serialize_entry("segments_out", &path.segments_out)?;
        map.serialize_entry("max_error", &path.max_error)?;
        map.serialize_entry("share", &path.share)?;
        // Proven by interval arithmetic, or because the map is exact on the curve.
        map.serialize_entry("certified", &(path.assurance >= Assurance::Certified))?;
        map.serialize_entry("assurance", assurance_word(path.assurance))?;
        map.serialize_entry("folds", &self.fold.count)?;
        if let Some(at) = &self.fold.at {
            map.serialize_entry("folded_at", &coordinates(at))?;
        }
        if !path.unresolved.is_empty() {
            map.serialize_entry("unresolved", &path.unresolved.iter().map(coordinates).collect::<Vec<_>>())?;
        }
        if let Some(resolution) = path.resolution {
            map.serialize_entry("resolution", &resolution)?;
        }
        if let Some(distance) = paint_residual {
            map.serialize_entry("paint_residual", distance)?;
        }
        if *pictures > 0 {
            map.serialize_entry("pictures", pictures)?;
        }
        if let Some(distance) = stroke_error {
            map.serialize_entry("stroke_error", distance)?;
        }
        if *outlined_strokes > 0 {
            map.serialize_entry("outlined_strokes", outlined_strokes)?;
        }
        if !united.is_empty() {
            map.serialize_entry("united", united)?;
        }
        map.end()
    }
}

/// A shape that was left unchanged, or warped only in part.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct SkippedShape {
    /// Its id, or its position in the document.
    pub id: String,
    /// The reason; begins with `only` if the shape was warped in part.
    pub why: String,
}

impl From<Skipped> for SkippedShape {
    fn from(Skipped { id, why }: Skipped) -> Self {
        Self { id, why }
    }
}

impl fmt::Display for SkippedShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { id, why } = self;
        let verb = if why.starts_with("only ") { "is warped" } else { "is not warped:" };
        write!(f, "{id} {verb} {why}")
    }
}

/// The report's word for an assurance.
fn assurance_word(a: Assurance) -> &'static str {
    match a {
        Assurance::Exact => "exact",
        Assurance::Certified => "certified",
        Assurance::Checked => "checked",
        Assurance::Sampled => "sampled",
    }
}
