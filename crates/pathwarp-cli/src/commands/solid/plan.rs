//! The outputs of all models, planned before anything is read.

use crate::failure::Failure;
use crate::options::CommonOptions;
use crate::pipeline::{Folders, by_pattern, in_folder, is_pattern};
use crate::references;
use crate::sources::Files;
use pathwarp::recipe::Recipe;
use pathwarp_solid::deform::Registry3;
use std::path::{Path, PathBuf};

/// A model with the files it gives.
pub(super) struct Job {
    pub(super) input: PathBuf,
    /// `None`: standard output.
    pub(super) target: Option<PathBuf>,
    pub(super) preview: Option<PathBuf>,
}

/// Plans the jobs of a recipe, which was read from the file `from` if there is one, and checks that no source and no other output is
/// overwritten.
pub(super) fn plan(
    registry: &Registry3,
    recipe: &Recipe,
    options: &CommonOptions,
    from: Option<&Path>,
) -> Result<Vec<Job>, Failure> {
    let inputs = if options.inputs.is_empty() { vec![PathBuf::from("-")] } else { options.inputs.clone() };
    if inputs.len() > 1 {
        check_several(registry, recipe, options)?;
    }
    let jobs: Vec<Job> = inputs.into_iter().map(|i| job(options, i)).collect::<Result<_, _>>()?;
    let mut files = Files::default();
    references::files_read(registry, recipe).iter().for_each(|f| files.read(f));
    from.iter().for_each(|f| files.read(f));
    jobs.iter().for_each(|j| files.read(&j.input));
    for job in &jobs {
        files.write(job.target.as_deref().unwrap_or(Path::new("-")), "")?;
        if let Some(preview) = &job.preview {
            files.write(preview, "preview")?;
        }
    }
    for (option, file) in [("report", &options.report), ("write-recipe", &options.write_recipe)] {
        if let Some(file) = file {
            files.write(file, option)?;
        }
    }
    for (option, file) in references::files_written(registry, recipe) {
        files.write(file, option)?;
    }
    Ok(jobs)
}

/// The folders of the outputs; those that stay empty are removed again.
pub(super) fn folders(options: &CommonOptions, jobs: &[Job]) -> Result<Folders, Failure> {
    let named = options.out_dir.is_some() || options.out.as_deref().is_some_and(is_pattern);
    let targets = jobs.iter().filter(|_| named).filter_map(|j| j.target.as_deref());
    Folders::of(targets)
}

fn check_several(registry: &Registry3, recipe: &Recipe, options: &CommonOptions) -> Result<(), Failure> {
    if options.out_dir.is_none() && !options.out.as_deref().is_some_and(is_pattern) {
        return Err(Failure::usage(
            "several models need --out-dir DIR, or -o with {stem} in the name; their results cannot share one file",
        ));
    }
    if options.preview.as_deref().is_some_and(|p| !is_pattern(p)) {
        return Err(Failure::usage("--preview draws one model; give one, or a name with {stem}"));
    }
    if let Some((option, _)) = references::files_written(registry, recipe).next() {
        return Err(Failure::usage(format!("--{option} writes one file; give one model")));
    }
    Ok(())
}

fn job(options: &CommonOptions, input: PathBuf) -> Result<Job, Failure> {
    let unnamed = |option: &str| Failure::usage(format!("{option} needs named models"));
    let expanded = |pattern: &PathBuf, option: &str| {
        if is_pattern(pattern) {
            by_pattern(pattern, &input, Path::new("")).ok_or_else(|| unnamed(option))
        } else {
            Ok(pattern.clone())
        }
    };
    let target = match (&options.out_dir, &options.out) {
        (Some(dir), _) => {
            let target = in_folder(dir, &input, Path::new(""), None).ok_or_else(|| unnamed("--out-dir"))?;
            // A drawing gives a model.
            let drawing =
                target.extension().is_some_and(|e| e.eq_ignore_ascii_case("svg") || e.eq_ignore_ascii_case("svgz"));
            Some(if drawing { target.with_extension("obj") } else { target })
        }
        (None, Some(out)) => Some(expanded(out, "{stem}")?),
        (None, None) => None,
    };
    let preview = options.preview.as_ref().map(|p| expanded(p, "--preview")).transpose()?;
    Ok(Job { input, target, preview })
}
