//! The plan of a run: the output of each input, checked before anything is read or written.

use crate::sources::Files;
use pathwarp::recipe::{Recipe, Step};
use pathwarp_engine::catalogue::Catalogue;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::format::Format;
use pathwarp_engine::input::{svg_name, unreadable};
use pathwarp_engine::options::CommonOptions;
use pathwarp_engine::output::is_device;
use pathwarp_engine::readable;
use pathwarp_engine::references::{files_read, files_written};
use std::collections::HashSet;
use std::fmt::Write as _;
use std::io::IsTerminal as _;
use std::path::{Component, Path, PathBuf};
use walkdir::{DirEntry, WalkDir};

/// An input with its output files.
pub(crate) struct Job {
    pub(crate) input: PathBuf,
    /// `None` for standard output, or for the copy that `--into` names.
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
    /// `true` if `--in-place` is possible.
    pub(crate) replaceable: bool,
    /// Corrects the extension of a result in `--out-dir`, if the result has not the format of the input.
    pub(crate) corrected_name: fn(PathBuf) -> PathBuf,
}

impl Inputs<'_> {
    /// Plans the jobs of a recipe (from `recipe_file`, if there is one), and checks that no source and no output is overwritten.
    pub(crate) fn plan(
        &self,
        catalogue: &dyn Catalogue,
        recipe: &Recipe,
        options: &CommonOptions,
        recipe_file: Option<&Path>,
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
        files_read(catalogue, recipe).iter().for_each(|f| files.add_source(f));
        recipe_file.iter().for_each(|f| files.add_source(f));
        options.reading.fonts.paths.iter().for_each(|f| files.add_source(f));
        for job in &jobs {
            if self.replaceable { files.add_artwork(&job.input) } else { files.add_source(&job.input) }
        }
        if options.in_place {
            files.allow_in_place();
        }
        for job in &jobs {
            if options.into.is_none() {
                files.add_output(job.target.as_deref().unwrap_or(Path::new("-")), "")?;
            }
            if let Some(preview) = &job.preview {
                files.add_output(preview, "preview")?;
            }
        }
        let others = [("into", &options.into), ("report", &options.report), ("write-recipe", &options.write_recipe)];
        let others = others.into_iter().filter_map(|(option, file)| Some((option, file.as_deref()?)));
        for (option, file) in others.chain(files_written(catalogue, recipe)) {
            files.add_output(file, option)?;
        }
        Ok(jobs)
    }

    /// Checks that the options give each of several inputs a separate output.
    fn check_several(
        &self,
        catalogue: &dyn Catalogue,
        recipe: &Recipe,
        options: &CommonOptions,
    ) -> Result<(), Failure> {
        let kind = self.kind;
        let names_by_pattern = options.out.as_deref().is_some_and(is_pattern);
        if options.into.is_some() {
            return Err(Failure::usage("--into writes one file; give one XCF"));
        }
        if !(options.out_dir.is_some() || names_by_pattern || (options.in_place && options.out.is_none())) {
            // FILE#NAME is a part of a file.
            let exists = |p: &Path| p.as_os_str() == "-" || p.exists() || p.to_string_lossy().contains('#');
            if let Some(missing) = self.files.iter().map(|f| &*f.path).find(|path| !exists(path)) {
                let e = missing.metadata().err().unwrap_or_else(|| std::io::ErrorKind::NotFound.into());
                return Err(Failure::file(missing, unreadable(missing, &e)));
            }
            let advice = match self.files {
                [_, to] if options.out.is_none() => format!("; to write to {0}: -o {0}", to.path.display()),
                _ => String::new(),
            };
            return Err(Failure::usage(format!(
                "several {kind}s need --out-dir DIR, or -o with {{stem}} in the name; their results cannot share one file{advice}"
            )));
        }
        if options.preview.as_deref().is_some_and(|p| !is_pattern(p)) {
            return Err(Failure::usage(format!(
                "--preview draws one {kind}; give one {kind}, or a name with {{stem}}"
            )));
        }
        if let Some((option, _)) = files_written(catalogue, recipe).next() {
            return Err(Failure::usage(format!("--{option} writes one file; give one {kind}")));
        }
        Ok(())
    }

    fn job(&self, options: &CommonOptions, input: &InputFile) -> Result<Job, Failure> {
        let InputFile { path, subfolder, refused } = input;
        let unnamed = |option: &str| Failure::usage(format!("{option} needs named {}s", self.kind));
        let expanded = |pattern: &PathBuf, option: &str| {
            let name = if is_pattern(pattern) { by_pattern(pattern, path, subfolder) } else { Some(pattern.clone()) };
            name.ok_or_else(|| unnamed(option))
        };
        let target = match (&options.out_dir, &options.out) {
            (Some(dir), _) => {
                let extension = options.format.map(Format::extension);
                let target = in_folder(dir, path, subfolder, extension).ok_or_else(|| unnamed("--out-dir"))?;
                Some((self.corrected_name)(target))
            }
            (None, Some(out)) => Some(expanded(out, "{stem}")?),
            (None, None) if options.in_place && options.into.is_none() => {
                if path.as_os_str() == "-" {
                    return Err(unnamed("--in-place"));
                }
                Some(path.clone())
            }
            (None, None) => None,
        };
        let preview = options.preview.as_ref().map(|p| expanded(p, "--preview")).transpose()?;
        Ok(Job { input: path.clone(), target, preview, refused: *refused })
    }
}

/// Returns the list of `--dry-run`: each step's selection, if they differ, and each input with its output.
pub(super) fn listing(recipe: &Recipe, options: &CommonOptions, jobs: &[Job]) -> String {
    let mut out = String::new();
    let are_selective = recipe.steps.iter().any(Step::is_selective);
    for (step, number) in recipe.steps.iter().zip(1..).filter(|_| are_selective) {
        let mut parts = if step.select.is_empty() { "everything".to_owned() } else { step.select.join(", ") };
        if !step.exclude.is_empty() {
            parts += &format!(" without {}", step.exclude.join(", "));
        }
        let _ = writeln!(out, "step {number}, {}: {}", step.deformation, readable::safe_name(&parts));
    }
    let name = |path: &Path| readable::safe_name(&path.display().to_string()).into_owned();
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

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct InputFile {
    pub(crate) path: PathBuf,
    /// The folder of a file that was found in a folder, relative to that; else empty.
    pub(crate) subfolder: PathBuf,
    /// The reason why a file found in a folder is not read.
    pub(crate) refused: Option<&'static str>,
}

impl InputFile {
    /// A file named by the user.
    pub(crate) fn named(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), subfolder: PathBuf::new(), refused: None }
    }
}

/// Returns the inputs that the options name, in order; folders are replaced by the files in them, sorted by name.
pub(super) fn inputs(options: &CommonOptions) -> Result<Vec<InputFile>, Failure> {
    if options.inputs.is_empty() {
        if std::io::stdin().is_terminal() {
            let advice = "write the file's name after the command; - reads what is typed";
            return Err(Failure::usage(format!("no drawing is named: {advice}")));
        }
        return Ok(vec![InputFile::named("-")]);
    }
    let mut out = Vec::with_capacity(options.inputs.len());
    for input in &options.inputs {
        if !input.is_dir() {
            out.push(InputFile::named(input));
        } else if options.recursive {
            let before = out.len();
            drawings_in(input, options, &mut out)?;
            if out.len() == before {
                return Err(Failure::file(input, "the folder holds no SVG files (.svg, .svgz)"));
            }
        } else {
            return Err(Failure::file(input, "is a folder; -r warps the SVG files in it"));
        }
    }
    Ok(out)
}

/// Adds the SVG files below `folder`, except hidden ones and the results of an earlier run.
fn drawings_in(folder: &Path, options: &CommonOptions, out: &mut Vec<InputFile>) -> Result<(), Failure> {
    let results = options.out_dir.as_deref().and_then(|dir| fixed_folder(dir).canonicalize().ok());
    let is_wanted = |entry: &DirEntry| {
        let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
        let is_results = || results.is_some() && entry.path().canonicalize().ok() == results;
        entry.depth() == 0 || !(is_hidden || (entry.file_type().is_dir() && is_results()))
    };
    for entry in WalkDir::new(folder).sort_by_file_name().into_iter().filter_entry(is_wanted) {
        let entry = entry.map_err(|e| Failure::file(e.path().unwrap_or(folder), format!("cannot be read: {e}")))?;
        let path = entry.path();
        if matches!(Format::of(path), Some(Format::Svg | Format::Svgz)) && !path.is_dir() {
            let subfolder = path.strip_prefix(folder).ok().and_then(Path::parent).unwrap_or(Path::new(""));
            let refused = refused(&entry, folder, options.reading.external);
            out.push(InputFile { path: path.to_owned(), subfolder: subfolder.to_owned(), refused });
        }
    }
    Ok(())
}

/// Returns the reason to skip a file that was found in `folder`, since the user has named only the folder.
fn refused(entry: &DirEntry, folder: &Path, external: bool) -> Option<&'static str> {
    let path = entry.path();
    if !path.is_file() {
        return Some("is not a regular file");
    }
    let leaves = || match (path.canonicalize(), folder.canonicalize()) {
        (Ok(file), Ok(folder)) => !file.starts_with(folder),
        _ => true,
    };
    let is_elsewhere = entry.path_is_symlink() && !external && leaves();
    is_elsewhere.then_some("is a symbolic link that leads out of the folder; --allow-external follows it")
}

/// The placeholder in an output's name for the input's file name without extension.
const STEM: &str = "{stem}";

/// Returns `true` if `name` contains the placeholder, and so gives every input a separate output.
pub(super) fn is_pattern(name: &Path) -> bool {
    name.to_string_lossy().contains(STEM)
}

/// Finds the first unknown `{word}` in a name.
pub(super) fn unknown_placeholder(name: &Path) -> Option<String> {
    let name = name.to_string_lossy();
    let inner = name.split('{').skip(1).filter_map(|rest| Some(rest.split_once('}')?.0));
    let is_word = |w: &&str| w.chars().all(|c| c.is_alphanumeric() || "_-.:".contains(c));
    inner.filter(is_word).find(|w| format!("{{{w}}}") != STEM).map(|w| format!("{{{w}}}"))
}

/// Returns the folders of a pattern before the first `{stem}`, which all outputs share.
pub(super) fn fixed_folder(pattern: &Path) -> PathBuf {
    let is_fixed = |c: &Component<'_>| !is_pattern(Path::new(c.as_os_str()));
    pattern.components().take_while(is_fixed).collect()
}

/// Returns the output of `input` by the file name `pattern`. `subfolder` is the input's folder within one given with `--recursive`, which
/// is repeated. `None` if the input has no name.
pub(super) fn by_pattern(pattern: &Path, input: &Path, subfolder: &Path) -> Option<PathBuf> {
    let output = PathBuf::from(pattern.to_string_lossy().replace(STEM, &stem(input)?));
    let file = output.file_name()?;
    Some(output.parent().unwrap_or(Path::new("")).join(subfolder).join(file))
}

/// Returns the output of `input` for `--out-dir`. If the last part of `dir` has {stem} and an extension, `dir` is the pattern of a file. If
/// not, it is a folder, perhaps with {stem}, and the output has the input's name, with `extension` if given. `None` if that has no name.
pub(super) fn in_folder(dir: &Path, input: &Path, subfolder: &Path, extension: Option<&str>) -> Option<PathBuf> {
    let last = dir.file_name().unwrap_or_default();
    if is_pattern(Path::new(last)) && dir.extension().is_some() {
        return by_pattern(dir, input, subfolder);
    }
    let name = result_name(input)?;
    let name = extension.map_or(name.clone(), |e| name.with_extension(e));
    let dir = if is_pattern(dir) { dir.to_string_lossy().replace(STEM, &stem(input)?).into() } else { dir.to_owned() };
    Some(dir.join(subfolder).join(name))
}

/// Returns the file name of an input's result: the input's, or for a GIMP file the name of its SVG.
fn result_name(input: &Path) -> Option<PathBuf> {
    let name_of_input = || input.file_name().filter(|name| *name != "-").map(PathBuf::from);
    svg_name(input).map(PathBuf::from).or_else(name_of_input)
}

/// Returns the text for [`STEM`] in the name of an input's output.
fn stem(input: &Path) -> Option<String> {
    Some(result_name(input)?.file_stem()?.to_string_lossy().into_owned())
}

/// Folders created for the outputs. When this is dropped, empty ones are removed.
pub(crate) struct Folders {
    /// Each folder comes before those in it.
    made: Vec<PathBuf>,
}

impl Folders {
    /// Creates the folders that are missing.
    pub(crate) fn create(options: &CommonOptions, jobs: &[Job]) -> Result<Self, Failure> {
        let has_pattern = |file: &Option<PathBuf>| file.as_deref().is_some_and(is_pattern);
        let may_create = options.out_dir.is_some() || has_pattern(&options.out);
        let targets = jobs.iter().filter(|_| may_create).flat_map(|j| &j.target);
        let previews = jobs.iter().filter(|_| has_pattern(&options.preview)).flat_map(|j| &j.preview);
        Self::of(targets.chain(previews).map(PathBuf::as_path))
    }

    /// Creates the folders of files.
    pub(crate) fn of<'a>(files: impl IntoIterator<Item = &'a Path>) -> Result<Self, Failure> {
        let parents: HashSet<&Path> = files.into_iter().filter_map(Path::parent).collect();
        let mut folders = Self { made: Vec::new() };
        parents.into_iter().try_for_each(|folder| folders.create_one(folder))?;
        Ok(folders)
    }

    fn create_one(&mut self, folder: &Path) -> Result<(), Failure> {
        if folder.as_os_str().is_empty() {
            return Ok(());
        }
        let is_missing = |f: &&Path| !f.as_os_str().is_empty() && !f.exists();
        let count = self.made.len();
        self.made.extend(folder.ancestors().take_while(is_missing).map(Path::to_owned));
        self.made[count..].reverse();
        std::fs::create_dir_all(folder).map_err(|e| Failure::output(folder, format!("cannot be created: {e}")))
    }
}

impl Drop for Folders {
    fn drop(&mut self) {
        // Removing a folder that is not empty fails.
        for folder in self.made.iter().rev() {
            let _ = std::fs::remove_dir(folder);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_and_folders() {
        let input = Path::new("art/sub/cat.svg");
        let named = |dir: &str, folder: &str, extension| {
            in_folder(Path::new(dir), input, Path::new(folder), extension).unwrap()
        };
        let name = |dir: &str, folder: &str| named(dir, folder, None);
        assert_eq!(name("out", ""), Path::new("out/cat.svg"));
        assert_eq!(name("out", "sub"), Path::new("out/sub/cat.svg"));
        assert_eq!(name("out/{stem}", ""), Path::new("out/cat/cat.svg"));
        assert_eq!(name("out/{stem}-bent.svg", "sub"), Path::new("out/sub/cat-bent.svg"));
        assert_eq!(name("out/v1.2", ""), Path::new("out/v1.2/cat.svg"));
        assert_eq!(by_pattern(Path::new("{stem}.png"), input, Path::new("")).unwrap(), Path::new("cat.png"));
        assert_eq!(named("out", "sub", Some("pdf")), Path::new("out/sub/cat.pdf"));
        assert_eq!(named("out/{stem}", "", Some("pdf")), Path::new("out/cat/cat.pdf"));
        assert_eq!(named("out/{stem}.dxf", "", Some("pdf")), Path::new("out/cat.dxf"));
        assert_eq!(in_folder(Path::new("out"), Path::new("-"), Path::new(""), None), None);
        assert_eq!(fixed_folder(Path::new("out/a/{stem}/x.svg")), Path::new("out/a"));
    }
}
