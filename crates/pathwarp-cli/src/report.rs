//! The report, `--report FILE`: the result of every file and shape. The field names are the JSON's. A run writes it input by input, so that
//! a large batch need not be held in memory.

use crate::failure::Failure;
use crate::options::CommonOptions;
use crate::output::{Draft, PendingFile};
use crate::readable;
use pathwarp::recipe::Recipe;
use pathwarp::refit::Assurance;
use serde::Serialize;
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
        !self.skipped.is_empty() || self.shapes.iter().any(|s| !s.over_budget.is_empty())
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

/// One shape.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct ReportedShape {
    pub(crate) id: String,
    /// The steps that hold for the shape, counted from 1; omitted if all do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) steps: Option<Vec<usize>>,
    /// Number of copies of the shape in the result; omitted if one.
    #[serde(skip_serializing_if = "is_one")]
    pub(crate) copies: usize,
    pub(crate) segments_in: usize,
    pub(crate) segments_out: usize,
    /// User units.
    pub(crate) max_error: f64,
    /// The largest distance as a share of the tolerance that holds for its contour: at most 1 if all are kept.
    pub(crate) share: f64,
    /// `max_error` is proven: the assurance is `certified` or `exact`.
    pub(crate) certified: bool,
    /// `exact`, `certified` or `checked`.
    pub(crate) assurance: &'static str,
    /// Number of orientation changes along a shape that folds, at least 1; 0 if it does not fold.
    pub(crate) folds: usize,
    /// The first place where the shape folds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) folded_at: Option<[f64; 2]>,
    /// Places where the tolerance was not met.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) over_budget: Vec<[f64; 2]>,
    /// Resolution of the coordinates, in user units, if the tolerance is below it; omitted otherwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) unresolved: Option<f64>,
    /// Largest distance between the map and the affine fit that gradients and patterns follow, in user units; null if no fit is
    /// close, omitted if there is nothing to follow.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) paint_residual: Option<f64>,
    /// Number of gradients that became pictures; omitted if none.
    #[serde(skip_serializing_if = "is_zero")]
    pub(crate) pictures: usize,
    /// Largest distance between a stroke that is still a stroke and the exact one, in user units, an estimate for dashes;
    /// null if unknown, omitted if there is no such stroke or its width was to be kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) stroke_error: Option<f64>,
    /// Number of strokes that became outlines; omitted if none.
    #[serde(skip_serializing_if = "is_zero")]
    pub(crate) outlined_strokes: usize,
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

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_one(copies: &usize) -> bool {
    *copies == 1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// The report's word for an assurance.
pub(crate) fn assurance_word(a: Assurance) -> &'static str {
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
            self.segments_in += s.segments_in;
            self.segments_out += s.segments_out;
            self.max_error = self.max_error.max(s.max_error);
            self.folds += s.folds;
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
