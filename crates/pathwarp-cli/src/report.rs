//! The report, `--report FILE`: the result of every file and shape. The field names are the JSON's. A run writes it input by input, so that
//! a large batch need not be held in memory.

use crate::failure::Failure;
use crate::options::CommonOptions;
use crate::output::{Draft, PendingFile};
use crate::readable;
use pathwarp::fold::Orientation;
use pathwarp::kurbo::Point;
use pathwarp::recipe::Recipe;
use pathwarp::refit::Assurance;
use pathwarp_svg::ShapeReport;
use serde::ser::SerializeMap as _;
use serde::{Serialize, Serializer};
use std::time::Instant;

/// One input file.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct FileReport {
    pub(crate) file: String,
    /// `None`: standard output, or none because of an error.
    pub(crate) output: Option<String>,
    /// Why the input could not be warped; omitted if it was.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) error: Option<String>,
    /// User units; `None` after an error.
    pub(crate) tolerance: Option<f64>,
    /// The frame that percentages refer to: x, y, width and height in user units; `None` after an error.
    pub(crate) frame: Option<[f64; 4]>,
    /// What every step holds for; omitted if all hold for the same.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) selections: Vec<StepSelection>,
    /// The height of the lettering's baseline, if the frame has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) baseline: Option<f64>,
    /// The visible part of the plane, x, y, width and height in user units, if `--fit` has changed it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) page: Option<[f64; 4]>,
    pub(crate) shapes: Vec<ReportedShape>,
    pub(crate) skipped: Vec<SkippedShape>,
    pub(crate) warnings: Vec<String>,
}

impl FileReport {
    /// An input that could not be warped.
    pub(crate) fn failed(file: String, error: String) -> Self {
        Self {
            file,
            output: None,
            error: Some(error),
            tolerance: None,
            frame: None,
            selections: Vec::new(),
            baseline: None,
            page: None,
            shapes: Vec::new(),
            skipped: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// Returns `true` if a shape was skipped or missed the tolerance.
    pub(crate) fn is_partial(&self) -> bool {
        !self.skipped.is_empty() || self.shapes.iter().any(|s| !s.shape.path.over_budget.is_empty())
    }
}

/// A step with a part of the artwork.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct StepSelection {
    pub(crate) deformation: String,
    /// Selectors; none for all artwork.
    pub(crate) select: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) exclude: Vec<String>,
    /// The frame that its percentages refer to, as in a report.
    pub(crate) frame: [f64; 4],
}

/// One shape: what became of its curves and paint, and what the run knows of it.
#[derive(Debug, Clone)]
pub(crate) struct ReportedShape {
    pub(crate) shape: ShapeReport,
    /// The steps that hold for the shape, counted from 1, unless all do.
    pub(crate) steps: Option<Vec<usize>>,
    pub(crate) fold: Fold,
}

/// A fold of one shape.
#[derive(Debug, Clone)]
pub(crate) struct Fold {
    /// Number of orientation changes along the shape, at least 1; 0 if it does not fold.
    pub(crate) count: usize,
    /// The first place where it folds.
    pub(crate) at: Option<Point>,
}

impl Fold {
    /// Compares the orientation of one shape with that of all artwork.
    pub(crate) fn of(shape: &Orientation, all: &Orientation) -> Self {
        let at = shape.folded_against(all);
        Self { count: if at.is_some() { shape.changes.max(1) } else { 0 }, at }
    }
}

/// Numbers that are usual, and texts that have nothing to say, are omitted. Unknown numbers are infinite here and null in JSON.
impl Serialize for ReportedShape {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let ShapeReport { id, copies, path, paint_residual, pictures, stroke_error, outlined_strokes, .. } =
            &self.shape;
        let place = |p: &Point| [p.x, p.y];
        let mut map = to.serialize_map(None)?;
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
        // Proven, by interval arithmetic or because the map is exact on the curve.
        map.serialize_entry("certified", &(path.assurance != Assurance::Checked))?;
        map.serialize_entry("assurance", assurance_word(path.assurance))?;
        map.serialize_entry("folds", &self.fold.count)?;
        if let Some(at) = &self.fold.at {
            map.serialize_entry("folded_at", &place(at))?;
        }
        if !path.over_budget.is_empty() {
            map.serialize_entry("over_budget", &path.over_budget.iter().map(place).collect::<Vec<_>>())?;
        }
        if let Some(resolution) = path.unresolved {
            map.serialize_entry("unresolved", &resolution)?;
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
        map.end()
    }
}

/// A shape that was left unchanged.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct SkippedShape {
    pub(crate) id: String,
    pub(crate) why: String,
}

/// Sums over all inputs.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Totals {
    pub(crate) inputs: usize,
    /// Number of inputs that could not be warped.
    pub(crate) failed: usize,
    pub(crate) shapes: usize,
    pub(crate) segments_in: usize,
    pub(crate) segments_out: usize,
    pub(crate) max_error: f64,
    pub(crate) folds: usize,
    pub(crate) skipped: usize,
    pub(crate) seconds: f64,
}

/// The report's word for an assurance.
fn assurance_word(a: Assurance) -> &'static str {
    match a {
        Assurance::Exact => "exact",
        Assurance::Certified => "certified",
        Assurance::Checked => "checked",
    }
}

impl Totals {
    /// Adds one input.
    pub(crate) fn add(&mut self, input: &FileReport) {
        self.inputs += 1;
        self.failed += usize::from(input.error.is_some());
        self.skipped += input.skipped.len();
        for s in &input.shapes {
            self.shapes += 1;
            self.segments_in += s.shape.path.segments_in;
            self.segments_out += s.shape.path.segments_out;
            self.max_error = self.max_error.max(s.shape.path.max_error);
            self.folds += s.fold.count;
        }
    }
}

/// A report under way.
pub(crate) struct ReportFile {
    draft: Draft,
    totals: Totals,
    started: Instant,
}

impl ReportFile {
    /// Starts the report of a run of `recipe`.
    pub(crate) fn new(
        mut draft: Draft,
        recipe: &Recipe,
        options: &CommonOptions,
        started: Instant,
    ) -> Result<Self, Failure> {
        let deformations = || recipe.steps.iter().map(|s| s.deformation.as_str()).collect();
        let steps: Vec<&str> = options.edit.as_ref().map_or_else(deformations, |e| vec![e.info.name]);
        let head = [
            ("tool", json(&"pathwarp")?),
            ("version", json(&env!("CARGO_PKG_VERSION"))?),
            ("steps", indented(&json(&steps)?, 1)),
        ];
        draft.write(b"{\n")?;
        for (name, value) in head {
            draft.write(format!("  \"{name}\": {value},\n").as_bytes())?;
        }
        draft.write(b"  \"inputs\": [")?;
        Ok(Self { draft, totals: Totals::default(), started })
    }

    /// Adds one input.
    pub(crate) fn add(&mut self, input: &FileReport) -> Result<(), Failure> {
        let comma = if self.totals.inputs > 0 { "," } else { "" };
        self.totals.add(input);
        self.draft.write(format!("{comma}\n    {}", indented(&json(input)?, 2)).as_bytes())
    }

    /// Adds the totals.
    pub(crate) fn finish(mut self) -> Result<PendingFile, Failure> {
        self.totals.seconds = self.started.elapsed().as_secs_f64();
        let totals = indented(&json(&self.totals)?, 1);
        self.draft.write(format!("\n  ],\n  \"totals\": {totals}\n}}\n").as_bytes())?;
        self.draft.finish()
    }
}

fn json(value: &impl Serialize) -> Result<String, Failure> {
    readable::json(value).map_err(|e| Failure::Output(format!("the report: {e}")))
}

/// JSON that stands `levels` deep in other JSON. Texts in it hold no raw newlines.
fn indented(json: &str, levels: usize) -> String {
    json.replace('\n', &format!("\n{}", "  ".repeat(levels)))
}
