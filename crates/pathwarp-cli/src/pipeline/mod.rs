//! The one run of every deformation: the outputs are planned, each input is opened, built, warped and reported
//! (`file_run.rs`), and its files are put in place, all or none. Of several inputs, each is finished on its own.

mod beyond;
mod file_run;
mod folders;
mod inputs;
mod links;
mod memory;
mod messages;
mod naming;
mod plan;
mod progress;
mod report_file;
mod session;

use crate::advice::Flags;
use crate::failure::Failure;
use crate::input::{PREVIEW, display};
use crate::options::{Given, OnFailure};
use crate::output::{self, Draft, PendingFile};
use crate::status::Status;
use crate::{recipe_file, references, temporaries, watch};
use file_run::{Batch, FileRun};
pub(crate) use file_run::{baseline, build, divided, explained, starts};
pub(crate) use folders::Folders;
use indicatif::ProgressBar;
pub(crate) use inputs::InputFile;
pub(crate) use memory::warp_bytes;
use pathwarp::deform::Registry;
use pathwarp::recipe::Recipe;
use pathwarp_svg::PageFit;
pub(crate) use plan::{Inputs, Job};
use rayon::prelude::*;
use report_file::ReportFile;
use session::Session;
use std::convert;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::Instant;

/// Number of inputs per thread that are warped before their reports are written: enough to keep all threads busy, few enough to
/// hold in memory.
const CHUNK_PER_THREAD: usize = 64;

/// More threads than this per core only take memory.
const MOST_THREADS_PER_CORE: usize = 4;

/// Warps all inputs by a recipe, which was read from the file `from` if there is one.
pub(crate) fn run(registry: &Registry, recipe: &Recipe, given: &Given, from: Option<&Path>) -> Result<Status, Failure> {
    let started = Instant::now();
    let mut options = given.read()?;
    watch::begin(options.reading.limits);
    let inputs = inputs::inputs(&options)?;
    options.reading.check()?;
    let kind = Inputs { files: &inputs, kind: "input", replaceable: true, result: convert::identity };
    let jobs = kind.plan(registry, recipe, &options, from)?;
    drop(inputs);
    // The files of a batch belong together and keep their pages.
    let is_batch = jobs.len() > 1 || options.out_dir.is_some() || options.in_place || options.recursive;
    if options.page == PageFit::Auto && is_batch {
        options.page = PageFit::None;
    }
    if let Some(preview) = &options.preview {
        PREVIEW.format(Some(preview), None)?;
    }
    if options.dry_run {
        output::to_stdout(plan::listing(recipe, &options, &jobs).as_bytes())?;
        return Ok(Status::Complete);
    }
    let mut resolved = recipe.clone();
    references::resolve_files(registry, &mut resolved, &options.reading)?;
    let batch = Batch { registry, recipe: &resolved, options: &options, given, flags: Flags::of(registry) };

    let _empty_ones_removed_at_the_end = Folders::create(&options, &jobs)?;
    let draft = options.report.as_deref().map(Draft::new).transpose()?;
    let report = draft.map(|d| ReportFile::new(d, recipe, &options, started)).transpose()?;
    let mut session = Session::new(&options, &batch.flags, report, jobs.len());
    run_jobs(&batch, &jobs, &mut session)?;
    if let Some(file) = &options.write_recipe {
        let text = recipe_file::write(registry, recipe, given, file.parent().unwrap_or(Path::new("")))?;
        session.pending.push(PendingFile::new(file, text.as_bytes())?);
    }
    session.finish()
}

/// Runs every job, in parallel; the session gets the results in order.
///
/// # Errors
/// The only input fails, any fails and the options say to stop, or the recipe is at fault.
fn run_jobs(batch: &Batch<'_>, jobs: &[Job], session: &mut Session<'_>) -> Result<(), Failure> {
    // A single input starts threads only when it has work for them.
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = (jobs.len() > 1 || batch.options.jobs.is_some())
        .then(|| batch.options.jobs.map_or(0, |n| n.min(cores * MOST_THREADS_PER_CORE)));
    let pool = threads
        .map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build())
        .transpose()
        .map_err(|e| Failure::usage(format!("--jobs: {e}")))?;
    let at_once = pool.as_ref().map_or(1, |p| p.current_num_threads() * CHUNK_PER_THREAD);
    let bar = progress::bar(jobs.len(), batch.options.quiet);
    let stops = jobs.len() == 1 || batch.options.on_failure == OnFailure::Stop;
    let mut rest = jobs;
    while !rest.is_empty() {
        // An error in the recipe must show before any file is written, so the first inputs go alone until one succeeds.
        let size = if session.is_untried() { 1 } else { at_once };
        let (chunk, later) = rest.split_at(size.min(rest.len()));
        rest = later;
        let one = |job: &Job| one(batch, job, stops, &bar);
        let results: Vec<Result<FileRun, Failure>> = match &pool {
            Some(pool) => pool.install(|| chunk.par_iter().map(one).collect()),
            None => chunk.iter().map(one).collect(),
        };
        for (job, result) in chunk.iter().zip(results) {
            bar.suspend(|| match result {
                Ok(run) => session.done(run),
                Err(failure) if stops || failure.is_of_recipe() && session.is_untried() => Err(failure),
                Err(failure) => session.failed(&job.input, &failure),
            })?;
        }
    }
    bar.finish_and_clear();
    Ok(())
}

/// Runs one job, and puts its files in place unless they have to wait for the others.
fn one(batch: &Batch<'_>, job: &Job, files_wait: bool, bar: &ProgressBar) -> Result<FileRun, Failure> {
    let name = display(&job.input);
    let _watched = watch::InBatch::begin();
    if let Some(why) = job.refused {
        bar.inc(1);
        return Err(Failure::file(&job.input, why));
    }
    let run = catch_unwind(AssertUnwindSafe(|| batch.run(job))).unwrap_or_else(|_| {
        Err(Failure::Input("the program failed on this input (see the message above); please report it".into()))
    });
    bar.inc(1);
    let mut run = run.map_err(|f| f.about(&name))?;
    if !files_wait {
        PendingFile::commit_all(std::mem::take(&mut run.files))?;
        temporaries::count_finished();
    }
    Ok(run)
}
