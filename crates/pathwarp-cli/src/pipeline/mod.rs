//! The pipeline of every command that warps: it plans the outputs, opens, builds, warps and reports each input ([`Session`]), and commits
//! its files, all or none. Several inputs are finished independently.

mod plan;

pub(crate) use plan::{Folders, InputFile, Inputs, Job};

use crate::ending::Status;
use crate::report_file::ReportFile;
use crate::{interruption, terminal, watch};
use indicatif::{ProgressBar, ProgressStyle};
use pathwarp::deform::Registry;
use pathwarp::kurbo::Point;
use pathwarp::recipe::Recipe;
use pathwarp_engine::advice::Flags;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::input::{Input, PREVIEW, WarpedResult, display};
use pathwarp_engine::options::{CommonOptions, Given, OnFailure};
use pathwarp_engine::output::{self, Draft, PendingFile};
use pathwarp_engine::page::{PageCounts, PageNews};
use pathwarp_engine::report::FileReport;
use pathwarp_engine::session::{Session, Warped};
use pathwarp_engine::{readable, recipe_file, references};
use pathwarp_svg::PageFit;
use rayon::prelude::*;
use std::convert;
use std::io::IsTerminal;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::Instant;

/// Number of inputs per thread that are warped before their reports are written: enough to keep all threads busy, and few for the memory.
const CHUNK_PER_THREAD: usize = 64;

/// Most threads per core; more would only take memory.
const MOST_THREADS_PER_CORE: usize = 4;

/// Warps all inputs by a recipe, which was read from the file `from` if there is one.
pub(crate) fn run(registry: &Registry, recipe: &Recipe, given: &Given, from: Option<&Path>) -> Result<Status, Failure> {
    let started = Instant::now();
    let mut options = given.read()?;
    watch::begin(options.reading.limits);
    let inputs = plan::inputs(&options)?;
    options.reading.check()?;
    let inputs = Inputs { files: &inputs, kind: "input", replaceable: true, corrected_name: convert::identity };
    let jobs = inputs.plan(registry, recipe, &options, from)?;
    // The files of a batch belong together, so their pages stay.
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
    let flags = Flags::of(registry);
    let session = Session { registry, recipe: &resolved, options: &options, given };

    let _empty_ones_removed_at_the_end = Folders::create(&options, &jobs)?;
    let draft = options.report.as_deref().map(Draft::new).transpose()?;
    let report = draft.map(|d| ReportFile::new(d, recipe, started)).transpose()?;
    let mut collected = Collected::new(&options, &flags, report, jobs.len());
    run_jobs(&session, &jobs, &mut collected)?;
    if let Some(file) = &options.write_recipe {
        let text = recipe_file::write(registry, recipe, given, file.parent().unwrap_or(Path::new("")))?;
        collected.pending.push(PendingFile::new(file, text.as_bytes())?);
    }
    collected.finish()
}

/// Runs all jobs in parallel, and passes the results to `collected` in order.
///
/// # Errors
/// A failure of the only input, of any input if the options demand to stop then, or of the recipe.
fn run_jobs(session: &Session<'_>, jobs: &[Job], collected: &mut Collected<'_>) -> Result<(), Failure> {
    // A single input starts threads only if its work is large enough.
    let needs_pool = jobs.len() > 1 || session.options.jobs.is_some();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    // Of 0 threads, rayon makes one per core.
    let threads = session.options.jobs.map_or(0, |n| n.min(cores * MOST_THREADS_PER_CORE));
    let pool = needs_pool.then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build()).transpose();
    let pool = pool.map_err(|e| Failure::usage(format!("--jobs: {e}")))?;
    let chunk_size = pool.as_ref().map_or(1, |p| p.current_num_threads() * CHUNK_PER_THREAD);
    let bar = progress_bar(jobs.len(), session.options.quiet);
    let stops = jobs.len() == 1 || session.options.on_failure == OnFailure::Stop;
    let (mut rest, flags) = (jobs, collected.flags);
    while !rest.is_empty() {
        // An error in the recipe must appear before any file is written, so inputs are run singly until one succeeds.
        let size = if collected.is_untried() { 1 } else { chunk_size };
        let (chunk, later) = rest.split_at(size.min(rest.len()));
        rest = later;
        let run = |job: &Job| run_job(session, flags, job, stops, &bar);
        let results: Vec<Result<Finished, Failure>> = match &pool {
            Some(pool) => pool.install(|| chunk.par_iter().map(run).collect()),
            None => chunk.iter().map(run).collect(),
        };
        for (job, result) in chunk.iter().zip(results) {
            bar.suspend(|| match result {
                Ok(finished) => collected.add_finished(finished),
                Err(failure) if stops || (failure.is_of_recipe() && collected.is_untried()) => Err(failure),
                Err(failure) => collected.add_failed(&job.input, &failure),
            })?;
        }
    }
    bar.finish_and_clear();
    Ok(())
}

/// A warped input, whose files are not yet committed.
struct Finished {
    report: FileReport,
    files: Vec<PendingFile>,
    page: PageNews,
    notes: Vec<String>,
    partial: bool,
}

/// Warps one input; without a target, the result goes to standard output.
fn warp_input(session: &Session<'_>, flags: &Flags, job: &Job) -> Result<Finished, Failure> {
    let target = job.target.as_deref();
    let mut input = Input::open(&job.input, session.options, target)?;
    let Warped { result, mut report, page, notes, partial, saves, preview, files: others } =
        session.warp(input.artwork(), flags)?;
    report.output = target.or(session.options.into.as_deref()).map(|t| t.display().to_string());
    let mut files = vec![match (result, target) {
        (WarpedResult::File(file), _) => file,
        (WarpedResult::Bytes(bytes), Some(t)) => PendingFile::new(t, &bytes)?,
        (WarpedResult::Bytes(bytes), None) => PendingFile::stdout(bytes),
    }];
    files.extend(others);
    for file in saves {
        files.push(PendingFile::new(Path::new(&file.name), file.text.as_bytes())?);
    }
    if let (Some(file), Some(png)) = (&job.preview, preview) {
        files.push(PendingFile::new(file, &png)?);
    }
    Ok(Finished { report, files, page, notes, partial })
}

/// Runs one job, and commits its files unless they must wait for the others.
fn run_job(
    session: &Session<'_>,
    flags: &Flags,
    job: &Job,
    files_wait: bool,
    bar: &ProgressBar,
) -> Result<Finished, Failure> {
    let name = display(&job.input);
    let _watched = watch::InBatch::begin();
    if let Some(why) = job.refused {
        bar.inc(1);
        return Err(Failure::file(&job.input, why));
    }
    let finished = catch_unwind(AssertUnwindSafe(|| warp_input(session, flags, job))).unwrap_or_else(|_| {
        Err(Failure::Input("the program failed on this input (see the message above); please report it".into()))
    });
    bar.inc(1);
    let mut finished = finished.map_err(|f| f.about(&name))?;
    if !files_wait {
        PendingFile::commit_all(std::mem::take(&mut finished.files))?;
        interruption::count_finished();
    }
    Ok(finished)
}

/// Most failures that are printed; the report contains all.
const LISTED: usize = 50;

/// The results of the inputs so far.
struct Collected<'a> {
    options: &'a CommonOptions,
    flags: &'a Flags,
    report: Option<ReportFile>,
    /// Number of inputs of the whole run.
    inputs: usize,
    /// Outputs to commit at the end.
    pending: Vec<PendingFile>,
    /// The inputs with parts left out.
    partial: Vec<String>,
    /// Numbers of inputs.
    finished: usize,
    failed: usize,
    /// The messages to print about failed inputs.
    failures: Vec<String>,
    pages: PageCounts,
}

impl<'a> Collected<'a> {
    fn new(options: &'a CommonOptions, flags: &'a Flags, report: Option<ReportFile>, inputs: usize) -> Self {
        Self {
            options,
            flags,
            report,
            inputs,
            pending: Vec::new(),
            partial: Vec::new(),
            finished: 0,
            failed: 0,
            failures: Vec::new(),
            pages: PageCounts::default(),
        }
    }

    /// Returns `true` if no input has been warped yet.
    fn is_untried(&self) -> bool {
        self.finished == 0
    }

    /// Adds a warped input: prints its notes and warnings.
    fn add_finished(&mut self, finished: Finished) -> Result<(), Failure> {
        let Finished { report, files, page, notes, partial } = finished;
        let several = self.inputs > 1;
        for note in &notes {
            terminal::note(&if several { format!("{}: {note}", report.file) } else { note.clone() });
        }
        if !self.options.quiet {
            page.note().iter().for_each(|note| terminal::note(note));
            // The warnings about pages are the last ones; of several inputs, they are counted and printed at the end.
            let counted = if several { page.warnings().len() } else { 0 };
            warn(&report, report.warnings.len() - counted);
        }
        self.pages.add(&page, &report.file);
        self.finished += 1;
        self.partial.extend(partial.then(|| report.file.clone()));
        self.pending.extend(files);
        self.report.as_mut().map_or(Ok(()), |r| r.add(&report))
    }

    /// Adds a failed input. Its message is printed at the end.
    fn add_failed(&mut self, input: &Path, failure: &Failure) -> Result<(), Failure> {
        let message = failure.message(self.flags);
        self.failed += 1;
        if self.failures.len() < LISTED {
            self.failures.push(message.clone());
        }
        self.report.as_mut().map_or(Ok(()), |r| r.add(&FileReport::failed(display(input), message)))
    }

    /// Commits the remaining outputs, and prints the summary.
    fn finish(mut self) -> Result<Status, Failure> {
        if let Some(report) = self.report.take() {
            self.pending.push(report.finish()?);
        }
        PendingFile::commit_all(std::mem::take(&mut self.pending))?;
        if !self.options.quiet {
            self.pages.warnings(self.inputs).iter().filter(|_| self.inputs > 1).for_each(|w| terminal::warning(w));
        }
        self.warn_of_partial();
        self.print_failures();
        Ok(Status::partial_if(!self.partial.is_empty() || self.failed > 0 || self.pages.are_blank()))
    }

    /// Names the inputs with parts left out, which explain the exit code.
    fn warn_of_partial(&self) {
        const NAMED: usize = 5;
        if self.partial.is_empty() || self.inputs < 2 || self.options.quiet {
            return;
        }
        let (count, all, names) = (self.partial.len(), self.inputs, readable::listed(&self.partial, NAMED));
        terminal::warning(&format!(
            "{count} of {all} inputs were not warped in full, so the exit code is 1: {names}; the warnings and --report FILE say what was \
             left"
        ));
    }

    /// Prints the failures and their number.
    fn print_failures(&self) {
        if self.failed == 0 {
            return;
        }
        self.failures.iter().for_each(|f| terminal::error(f));
        let more = self.failed - self.failures.len();
        if more > 0 {
            let advice = if self.options.report.is_some() { "the report lists" } else { "--report FILE lists" };
            terminal::error(&format!("and {more} more; {advice} them all"));
        }
        let written = match self.finished {
            0 => "nothing was written".to_owned(),
            1 => "the result of the other one is written".to_owned(),
            n => format!("the results of the other {n} are written"),
        };
        terminal::error(&format!("{} of {} inputs failed; {written}", self.failed, self.inputs));
    }
}

/// Most messages of each kind that are printed; the report contains all.
const SHOWN: usize = 8;

/// Prints the first `count` warnings, skipped shapes and missed tolerances.
fn warn(r: &FileReport, count: usize) {
    let of_file = |message: &str| format!("{}: {message}", r.file);
    for w in r.warnings.iter().take(count.min(SHOWN)) {
        terminal::warning(&of_file(w));
    }
    for s in r.skipped.iter().take(SHOWN) {
        terminal::warning(&of_file(&s.to_string()));
    }
    for s in r.shapes.iter().map(|s| &s.shape).filter(|s| !s.path.unresolved.is_empty()).take(SHOWN) {
        let Point { x, y } = s.path.unresolved[0];
        let why = match s.path.resolution {
            Some(resolution) => format!("it is below the resolution of these coordinates, {resolution:.0e}"),
            None => format!("the error there is up to {:.3e}", s.path.max_error),
        };
        terminal::warning(&of_file(&format!("{} misses the tolerance near {x:.4},{y:.4}: {why}", s.id)));
    }
    let more = count.saturating_sub(SHOWN) + r.skipped.len().saturating_sub(SHOWN);
    if more > 0 {
        terminal::warning(&of_file(&format!("and {more} more; --report FILE lists them all")));
    }
}

/// A progress bar over `files` files, with rate and remaining time; hidden for one file, on request, and unless on a terminal.
fn progress_bar(files: usize, quiet: bool) -> ProgressBar {
    if quiet || files < 2 || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(files as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:32} {human_pos}/{human_len} files  {per_sec}  {eta} left") {
        bar.set_style(style);
    }
    bar
}
