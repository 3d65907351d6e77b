//! The one run of every deformation: each input is opened, built, warped and reported (`file_run.rs`); when all have
//! succeeded, every output file is put in place, or none.

mod file_run;
mod messages;
mod progress;
mod targets;

use crate::advice::Flags;
use crate::failure::Failure;
use crate::input::display;
use crate::options::{CommonOptions, Given};
use crate::output::{self, PendingFile};
use crate::recipe_file;
use crate::report::{FileReport, Report, Totals};
use crate::status::Status;
use crate::terminal;
use file_run::{Batch, FileRun};
use pathwarp::deform::Registry;
use pathwarp::recipe::Recipe;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Warps all inputs by a recipe.
pub(crate) fn run(registry: &Registry, recipe: &Recipe, given: &Given) -> Result<Status, Failure> {
    let started = Instant::now();
    let options = given.read()?;
    let inputs = if options.inputs.is_empty() { vec![PathBuf::from("-")] } else { options.inputs.clone() };
    let targets = targets::targets(&options, &inputs)?;
    let batch = Batch { registry, recipe, options: &options, given, flags: Flags::of(registry) };
    let runs = run_files(&batch, &inputs, &targets)?;

    let mut status = Status::Complete;
    let (mut pending, mut reports, mut printed) = (Vec::new(), Vec::new(), Vec::new());
    for run in runs {
        for n in &run.notes {
            terminal::note(n);
        }
        if !options.quiet {
            messages::warn(&run.report);
        }
        if run.partial {
            status = Status::Partial;
        }
        pending.extend(run.files);
        printed.extend(run.stdout);
        reports.push(run.report);
    }
    if let Some(file) = &options.report {
        pending.push(report(file, recipe, reports, started)?);
    }
    if let Some(file) = &options.write_recipe {
        let text = recipe_file::write(registry, recipe, given, file.parent().unwrap_or(Path::new("")))?;
        pending.push(PendingFile::new(file, text.as_bytes())?);
    }
    PendingFile::commit_all(pending)?;
    for bytes in printed {
        output::to_stdout(&bytes)?;
    }
    Ok(status)
}

/// Runs every input, in parallel; the results are in order. A single input starts threads only when it has work for them.
fn run_files(batch: &Batch<'_>, inputs: &[PathBuf], targets: &[Option<PathBuf>]) -> Result<Vec<FileRun>, Failure> {
    let CommonOptions { jobs, quiet, .. } = batch.options;
    let bar = progress::bar(inputs.len(), *quiet);
    let run = |(input, target): (&PathBuf, &Option<PathBuf>)| {
        let run = batch.run(input, target.as_deref());
        bar.inc(1);
        run.map_err(|f| f.about(&display(input)))
    };
    let runs = if inputs.len() == 1 && jobs.is_none() {
        inputs.iter().zip(targets).map(run).collect()
    } else {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(jobs.unwrap_or(0))
            .build()
            .map_err(|e| Failure::usage(format!("--jobs: {e}")))?;
        pool.install(|| inputs.par_iter().zip(targets).map(run).collect())
    };
    bar.finish_and_clear();
    runs
}

fn report(file: &Path, recipe: &Recipe, inputs: Vec<FileReport>, started: Instant) -> Result<PendingFile, Failure> {
    let report = Report {
        tool: "pathwarp",
        version: env!("CARGO_PKG_VERSION"),
        steps: recipe.steps.iter().map(|s| s.deformation.clone()).collect(),
        totals: Totals::of(&inputs, started.elapsed().as_secs_f64()),
        inputs,
    };
    let mut json = serde_json::to_vec_pretty(&report).map_err(|e| Failure::file(file, e))?;
    json.push(b'\n');
    PendingFile::new(file, &json)
}
