//! The plan of a run: which output each input gets, checked before anything is read or written.

use super::inputs::InputFile;
use super::naming::{by_pattern, in_folder, is_pattern, unknown_placeholder};
use crate::catalogue::Catalogue;
use crate::failure::Failure;
use crate::format::Format;
use crate::input::unreadable;
use crate::options::CommonOptions;
use crate::output::is_device;
use crate::readable;
use crate::references::{files_read, files_written};
use crate::sources::Files;
use pathwarp::recipe::{Recipe, Step};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// One input with the files it gives.
pub(crate) struct Job {
    pub(crate) input: PathBuf,
    /// `None`: standard output, or the copy that `--into` names.
    pub(crate) target: Option<PathBuf>,
    pub(crate) preview: Option<PathBuf>,
    /// The reason why the input is not read.
    pub(crate) refused: Option<&'static str>,
}

/// Inputs of one kind.
pub(crate) struct Inputs<'a> {
    pub(crate) files: &'a [InputFile],
    /// The kind's name in messages.
    pub(crate) kind: &'static str,
    /// `--in-place` can be given.
    pub(crate) replaceable: bool,
    /// Corrects the name of a result in a folder.
    pub(crate) result: fn(PathBuf) -> PathBuf,
}

impl Inputs<'_> {
    /// Plans the jobs of a recipe, which was read from the file `from` if there is one, and checks that no source and no output is
    /// overwritten.
    pub(crate) fn plan(
        &self,
        catalogue: &dyn Catalogue,
        recipe: &Recipe,
        options: &CommonOptions,
        from: Option<&Path>,
    ) -> Result<Vec<Job>, Failure> {
        for (option, name) in [("-o", &options.out), ("--out-dir", &options.out_dir), ("--preview", &options.preview)] {
            if let Some(word) = name.as_deref().and_then(unknown_placeholder) {
                let problem = "stands for nothing; {stem} stands for the input's name without its extension";
                return Err(Failure::usage(format!("{option}: {word} {problem}")));
            }
        }
        if self.files.len() > 1 {
            self.check_several(catalogue, recipe, options)?;
        }
        let jobs: Vec<Job> = self.files.iter().map(|i| self.job(options, i)).collect::<Result<_, _>>()?;
        let mut files = Files::default();
        files_read(catalogue, recipe).iter().for_each(|f| files.read(f));
        from.iter().for_each(|f| files.read(f));
        options.reading.fonts.paths.iter().for_each(|f| files.read(f));
        for job in &jobs {
            if self.replaceable { files.read_artwork(&job.input) } else { files.read(&job.input) }
        }
        if options.in_place {
            files.allow_in_place();
        }
        for job in &jobs {
            if options.into.is_none() {
                files.write(job.target.as_deref().unwrap_or(Path::new("-")), "")?;
            }
            if let Some(preview) = &job.preview {
                files.write(preview, "preview")?;
            }
        }
        let others = [("into", &options.into), ("report", &options.report), ("write-recipe", &options.write_recipe)];
        for (option, file) in others {
            if let Some(file) = file {
                files.write(file, option)?;
            }
        }
        for (option, file) in files_written(catalogue, recipe) {
            files.write(file, option)?;
        }
        Ok(jobs)
    }

    /// Checks that the options give every one of several inputs its own output.
    fn check_several(
        &self,
        catalogue: &dyn Catalogue,
        recipe: &Recipe,
        options: &CommonOptions,
    ) -> Result<(), Failure> {
        let kind = self.kind;
        let own_name = options.out.as_deref().is_some_and(is_pattern);
        if options.into.is_some() {
            return Err(Failure::usage("--into writes one file; give one XCF"));
        }
        if !(options.out_dir.is_some() || own_name || options.in_place && options.out.is_none()) {
            let exists =
                |f: &&InputFile| f.path.as_os_str() == "-" || f.path.exists() || f.path.to_string_lossy().contains('#');
            if let Some(missing) = self.files.iter().find(|f| !exists(f)) {
                let e = missing.path.metadata().err().unwrap_or_else(|| std::io::ErrorKind::NotFound.into());
                return Err(Failure::file(&missing.path, unreadable(&missing.path, &e)));
            }
            let hint = match self.files {
                [_, to] if options.out.is_none() => format!("; to write to {0}: -o {0}", to.path.display()),
                _ => String::new(),
            };
            return Err(Failure::usage(format!(
                "several {kind}s need --out-dir DIR, or -o with {{stem}} in the name; their results cannot share one file{hint}"
            )));
        }
        if options.preview.as_deref().is_some_and(|p| !is_pattern(p)) {
            return Err(Failure::usage(format!("--preview draws one {kind}; give one, or a name with {{stem}}")));
        }
        if let Some((option, _)) = files_written(catalogue, recipe).next() {
            return Err(Failure::usage(format!("--{option} writes one file; give one {kind}")));
        }
        Ok(())
    }

    fn job(&self, options: &CommonOptions, input: &InputFile) -> Result<Job, Failure> {
        let InputFile { path, below, refused } = input;
        let unnamed = |option: &str| Failure::usage(format!("{option} needs named {}s", self.kind));
        let expanded = |pattern: &PathBuf, option: &str| -> Result<PathBuf, Failure> {
            if is_pattern(pattern) {
                by_pattern(pattern, path, below).ok_or_else(|| unnamed(option))
            } else {
                Ok(pattern.clone())
            }
        };
        let target = match (&options.out_dir, &options.out) {
            (Some(dir), _) => {
                let extension = options.format.map(Format::extension);
                let target = in_folder(dir, path, below, extension).ok_or_else(|| unnamed("--out-dir"))?;
                Some((self.result)(target))
            }
            (None, Some(out)) => Some(expanded(out, "{stem}")?),
            (None, None) if options.in_place && options.into.is_none() => {
                Some(path.clone()).filter(|p| p.as_os_str() != "-").ok_or_else(|| unnamed("--in-place")).map(Some)?
            }
            (None, None) => None,
        };
        let preview = options.preview.as_ref().map(|p| expanded(p, "--preview")).transpose()?;
        Ok(Job { input: path.clone(), target, preview, refused: *refused })
    }
}

/// The list that `--dry-run` prints: what each step holds for, if that differs, and every input with its output.
pub(super) fn listing(recipe: &Recipe, options: &CommonOptions, jobs: &[Job]) -> String {
    let mut out = String::new();
    let selective = recipe.steps.iter().any(Step::is_selective);
    for (i, step) in recipe.steps.iter().enumerate().filter(|_| selective) {
        let select = if step.select.is_empty() { "everything".to_owned() } else { step.select.join(", ") };
        let except =
            if step.exclude.is_empty() { String::new() } else { format!(" without {}", step.exclude.join(", ")) };
        let _ = writeln!(out, "step {}, {}: {}", i + 1, step.deformation, readable::name(&(select + &except)));
    }
    let name = |path: &Path| readable::name(&path.display().to_string()).into_owned();
    for job in jobs {
        let input = name(&job.input);
        if let Some(why) = job.refused {
            let _ = writeln!(out, "{input} -> nothing: it {why}");
            continue;
        }
        let target = job.target.as_ref().or(options.into.as_ref());
        for to in target.into_iter().chain(&job.preview) {
            let state = if job.input == *to {
                "  (in place)"
            } else if to.is_file() && !is_device(to) {
                "  (replaces a file)"
            } else {
                ""
            };
            let _ = writeln!(out, "{input} -> {}{state}", name(to));
        }
        if target.is_none() {
            let _ = writeln!(out, "{input} -> standard output");
        }
    }
    out
}
