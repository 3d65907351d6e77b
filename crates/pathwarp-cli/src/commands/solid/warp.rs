//! `pathwarp solid DEFORMATION MODEL …`: deforms models by a deformation or a chain.

use super::args::{SolidOptions, model_args};
use super::bend::{Bent, MeshSource, SurfaceSource, Work, bend_mesh, bend_surfaces};
use super::model::{Content, Model, ModelFormat};
use super::report;
use crate::commands::warp::described;
use crate::ending::Status;
use crate::pipeline::{Folders, InputFile, Inputs, Job};
use crate::{terminal, watch};
use clap::Command;
use pathwarp::deform::Info;
use pathwarp::recipe::Recipe;
use pathwarp_engine::advice::Flags;
use pathwarp_engine::catalogue::Catalogue;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::format::Format;
use pathwarp_engine::input::display;
use pathwarp_engine::options::{CommonOptions, Given};
use pathwarp_engine::output::PendingFile;
use pathwarp_engine::{recipe_file, references};
use pathwarp_solid::deform::Registry3;
use std::path::{Path, PathBuf};

pub(super) fn command(info: &Info) -> Command {
    described(info).args(model_args())
}

/// Deforms models by a recipe, which was read from the file `from` if there is one.
pub(super) fn run(
    registry: &Registry3,
    recipe: &Recipe,
    given: &Given,
    solid: &SolidOptions,
    from: Option<&Path>,
) -> Result<Status, Failure> {
    let options = given.read()?;
    watch::begin(options.reading.limits);
    let jobs = plan(registry, recipe, &options, from)?;
    for job in &jobs {
        // Fail before a long run if the extension is wrong.
        ModelFormat::of_output(job.target.as_deref(), ModelFormat::Obj)?;
    }
    let mut resolved = recipe.clone();
    references::resolve_files(registry, &mut resolved, &options.reading)?;
    let flags = Flags::of(registry as &dyn Catalogue);
    let work = Work { registry, recipe: &resolved, options: &options, solid, flags: &flags };
    match options.jobs {
        Some(n) => {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
            pool.map_err(|e| Failure::usage(format!("--jobs: {e}")))?.install(|| work.run_jobs(&jobs, given))
        }
        None => work.run_jobs(&jobs, given),
    }
}

/// Plans the outputs of all models before anything is read. `--in-place` is impossible.
fn plan(
    registry: &Registry3,
    recipe: &Recipe,
    options: &CommonOptions,
    from: Option<&Path>,
) -> Result<Vec<Job>, Failure> {
    /// Corrects the name of an output in a folder: from a drawing, an OBJ model is made.
    fn corrected_name(target: PathBuf) -> PathBuf {
        let is_drawing = matches!(Format::of(&target), Some(Format::Svg | Format::Svgz));
        if is_drawing { target.with_extension("obj") } else { target }
    }
    let mut files: Vec<InputFile> = options.inputs.iter().map(InputFile::named).collect();
    if files.is_empty() {
        files.push(InputFile::named("-"));
    }
    Inputs { files: &files, kind: "model", replaceable: false, corrected_name }.plan(registry, recipe, options, from)
}

impl Work<'_> {
    /// Deforms and finishes model after model, each with all threads and the whole allowance. An error that all would meet ends the run.
    fn run_jobs(&self, jobs: &[Job], given: &Given) -> Result<Status, Failure> {
        let options = self.options;
        let _empty_ones_removed_at_the_end = Folders::create(options, jobs)?;
        let (mut failed, mut is_partial, mut reports) = (Vec::new(), false, Vec::new());
        let several = jobs.len() > 1;
        for job in jobs {
            let _batch = several.then(watch::InBatch::begin);
            let name = display(&job.input);
            let bent = match self.run_job(job) {
                Err(e) if several && !e.is_of_recipe() => {
                    let message = e.message(self.flags);
                    reports.push(report::failed(&name, &message)?);
                    failed.push(message);
                    continue;
                }
                other => other?,
            };
            let mut files = bent.files;
            reports.extend(bent.report);
            if !several {
                files.extend(self.common_files(given, &reports, several)?);
            }
            PendingFile::commit_all(files)?;
            if options.explain {
                let prefix = if several { format!("{name}: ") } else { String::new() };
                bent.notes.iter().for_each(|n| terminal::note(&format!("{prefix}{n}")));
            }
            if !options.quiet {
                bent.warnings.iter().for_each(|w| terminal::warning(&format!("{name}: {w}")));
            }
            is_partial |= bent.partial;
        }
        if several {
            PendingFile::commit_all(self.common_files(given, &reports, several)?)?;
            failed.iter().for_each(|f| terminal::error(f));
            if !failed.is_empty() {
                terminal::error(&format!("{} of {} models failed; the others are written", failed.len(), jobs.len()));
            }
        }
        Ok(Status::partial_if(is_partial || !failed.is_empty()))
    }

    /// Prepares the files of the whole run: the recipe and the report, an object for one model, a list for several.
    fn common_files(&self, given: &Given, reports: &[String], several: bool) -> Result<Vec<PendingFile>, Failure> {
        let mut files = Vec::new();
        if let Some(file) = &self.options.write_recipe {
            let folder = file.parent().unwrap_or(Path::new(""));
            let text = recipe_file::write(self.registry, self.recipe, given, folder)?;
            files.push(PendingFile::new(file, text.as_bytes())?);
        }
        if let Some(file) = &self.options.report {
            let text = if several { format!("[\n{}\n]", reports.join(",\n")) } else { reports.concat() };
            files.push(PendingFile::new(file, (text + "\n").as_bytes())?);
        }
        Ok(files)
    }

    /// Reads and deforms a model.
    fn run_job(&self, job: &Job) -> Result<Bent, Failure> {
        let Model { name, content, budget, format, is_drawing } =
            Model::read(&job.input, &self.options.reading, self.solid.depth)?;
        let format = ModelFormat::of_output(job.target.as_deref(), format)?;
        match content {
            Content::Mesh(mesh) => bend_mesh(self, job, MeshSource { name, mesh, format, is_drawing }, &budget),
            Content::Surfaces(surfaces) => bend_surfaces(self, job, SurfaceSource { name, surfaces, format }, &budget),
        }
    }
}
