//! The report, `--report FILE`: the result of every file and shape. The field names are the JSON's.

use pathwarp::refit::Assurance;
use serde::Serialize;

/// The whole run.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    pub(crate) tool: &'static str,
    pub(crate) version: &'static str,
    pub(crate) steps: Vec<String>,
    pub(crate) inputs: Vec<FileReport>,
    pub(crate) totals: Totals,
}

/// One input file.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct FileReport {
    pub(crate) file: String,
    pub(crate) output: Option<String>,
    /// User units.
    pub(crate) tolerance: f64,
    pub(crate) shapes: Vec<ReportedShape>,
    pub(crate) skipped: Vec<SkippedShape>,
    pub(crate) warnings: Vec<String>,
}

impl FileReport {
    /// Returns `true` if a shape was skipped or missed the tolerance.
    pub(crate) fn is_partial(&self) -> bool {
        !self.skipped.is_empty() || self.shapes.iter().any(|s| !s.over_budget.is_empty())
    }
}

/// One shape.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct ReportedShape {
    pub(crate) id: String,
    /// Number of copies of the shape in the result; omitted if one.
    #[serde(skip_serializing_if = "is_one")]
    pub(crate) copies: usize,
    pub(crate) segments_in: usize,
    pub(crate) segments_out: usize,
    /// User units.
    pub(crate) max_error: f64,
    /// `max_error` is proven: the assurance is `certified` or `exact`.
    pub(crate) certified: bool,
    /// `exact`, `certified` or `checked`.
    pub(crate) assurance: &'static str,
    /// Number of orientation changes along a shape that folds, at least 1; 0 if it does not fold.
    pub(crate) folds: usize,
    /// The first place where the shape folds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) folded_at: Option<[f64; 2]>,
    /// Places where the work budget ran out before the tolerance was met.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) over_budget: Vec<[f64; 2]>,
    /// Largest distance between the map and the affine fit that gradients and patterns follow, in user units; null if no fit is
    /// close, omitted if there is nothing to follow.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) paint_residual: Option<f64>,
    /// Number of gradients that became pictures; omitted if none.
    #[serde(skip_serializing_if = "is_zero")]
    pub(crate) pictures: usize,
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
    pub(crate) fn of(inputs: &[FileReport], seconds: f64) -> Self {
        let mut t = Self { seconds, ..Self::default() };
        for i in inputs {
            t.skipped += i.skipped.len();
            for s in &i.shapes {
                t.shapes += 1;
                t.segments_in += s.segments_in;
                t.segments_out += s.segments_out;
                t.max_error = t.max_error.max(s.max_error);
                t.folds += s.folds;
            }
        }
        t
    }
}
