//! The report: what was done, shape by shape.

use pathwarp::refit::Assurance;
use serde::Serialize;

/// The whole run.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    pub(crate) tool: &'static str,
    pub(crate) version: &'static str,
    pub(crate) steps: Vec<String>,
    pub(crate) inputs: Vec<Input>,
    pub(crate) totals: Totals,
}

/// One input file.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Input {
    pub(crate) file: String,
    pub(crate) output: Option<String>,
    /// User units.
    pub(crate) tolerance: f64,
    pub(crate) shapes: Vec<Shape>,
    pub(crate) skipped: Vec<Skipped>,
    pub(crate) warnings: Vec<String>,
}

/// One shape.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Shape {
    pub(crate) id: String,
    /// How often the shape stands in the result; left out where that is once.
    #[serde(skip_serializing_if = "is_once")]
    pub(crate) copies: usize,
    pub(crate) segments_in: usize,
    pub(crate) segments_out: usize,
    /// User units.
    pub(crate) max_error: f64,
    /// Whether `max_error` is proven: certified or exact.
    pub(crate) certified: bool,
    /// `exact`, `certified` or `checked`.
    pub(crate) assurance: &'static str,
    /// How often the map turns over along the shape.
    pub(crate) folds: usize,
    /// The first place that is turned over.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) folded_at: Option<[f64; 2]>,
    /// Places where the work budget ended before the tolerance was met.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) over_budget: Vec<[f64; 2]>,
    /// The largest distance between the map and the affine fit that gradients or patterns follow, in user units; null where no
    /// fit comes near, left out where there is nothing to follow.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) paint_residual: Option<f64>,
    /// How many gradients became pictures; left out where none did.
    #[serde(skip_serializing_if = "is_none")]
    pub(crate) pictures: usize,
}

/// Something that stayed as it was.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Skipped {
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

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde wants it so")]
fn is_once(copies: &usize) -> bool {
    *copies == 1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde wants it so")]
fn is_none(count: &usize) -> bool {
    *count == 0
}

pub(crate) fn assurance_word(a: Assurance) -> &'static str {
    match a {
        Assurance::Exact => "exact",
        Assurance::Certified => "certified",
        Assurance::Checked => "checked",
    }
}

impl Totals {
    pub(crate) fn of(inputs: &[Input], seconds: f64) -> Self {
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
