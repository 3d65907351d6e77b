//! Writes the report, input by input, so that a large batch need not be held in memory.

use crate::failure::Failure;
use crate::options::CommonOptions;
use crate::output::{Draft, PendingFile};
use crate::readable;
use crate::report::{FileReport, Totals};
use pathwarp::recipe::Recipe;
use serde::Serialize;
use std::time::Instant;

/// A report under way.
pub(super) struct ReportFile {
    draft: Draft,
    totals: Totals,
    started: Instant,
}

impl ReportFile {
    /// Starts the report of a run of `recipe`.
    pub(super) fn new(
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
    pub(super) fn add(&mut self, input: &FileReport) -> Result<(), Failure> {
        let comma = if self.totals.inputs > 0 { "," } else { "" };
        self.totals.add(input);
        self.draft.write(format!("{comma}\n    {}", indented(&json(input)?, 2)).as_bytes())
    }

    /// Adds the totals.
    pub(super) fn finish(mut self) -> Result<PendingFile, Failure> {
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
