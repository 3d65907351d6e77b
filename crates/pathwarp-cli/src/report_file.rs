//! The report of `--report FILE`. It is written input by input, so that a large batch does not fill the memory.

use pathwarp::recipe::Recipe;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::output::{Draft, PendingFile};
use pathwarp_engine::readable;
use pathwarp_engine::report::FileReport;
use serde::Serialize;
use std::time::Instant;

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

impl Totals {
    /// Adds one input.
    pub(crate) fn add(&mut self, input: &FileReport) {
        self.inputs += 1;
        self.failed += usize::from(input.error.is_some());
        self.skipped += input.skipped.len();
        self.shapes += input.shapes.len();
        for s in &input.shapes {
            self.segments_in += s.shape.path.segments_in;
            self.segments_out += s.shape.path.segments_out;
            self.max_error = self.max_error.max(s.shape.path.max_error);
            self.folds += s.fold.count;
        }
    }
}

/// A report that is being written.
pub(crate) struct ReportFile {
    draft: Draft,
    totals: Totals,
    started: Instant,
}

impl ReportFile {
    /// Begins the report of a run of `recipe`.
    pub(crate) fn new(mut draft: Draft, recipe: &Recipe, started: Instant) -> Result<Self, Failure> {
        let steps: Vec<&str> = recipe.steps.iter().map(|s| s.deformation.as_str()).collect();
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

/// Indents JSON by `levels`. Strings in JSON contain no raw newlines.
fn indented(json: &str, levels: usize) -> String {
    json.replace('\n', &format!("\n{}", "  ".repeat(levels)))
}
