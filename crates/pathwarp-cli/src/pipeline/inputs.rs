//! The inputs: files as given, and with `--recursive` the SVG files in folders.

use super::naming::fixed_folder;
use crate::failure::Failure;
use crate::options::CommonOptions;
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use walkdir::{DirEntry, WalkDir};

/// An input file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct InputFile {
    pub(crate) path: PathBuf,
    /// The folder of a file found in a folder, relative to it; else empty.
    pub(crate) below: PathBuf,
    /// The reason why a file found in a folder is not read.
    pub(crate) refused: Option<&'static str>,
}

impl InputFile {
    /// A file that is named itself.
    pub(crate) fn named(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), below: PathBuf::new(), refused: None }
    }
}

/// The inputs that the options name, in order; folders are replaced by the files in them, sorted by name.
pub(super) fn inputs(options: &CommonOptions) -> Result<Vec<InputFile>, Failure> {
    if options.inputs.is_empty() {
        if std::io::stdin().is_terminal() {
            return Err(Failure::usage(
                "no drawing is named: write the file's name after the command; - reads what is typed",
            ));
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
        let hidden = entry.file_name().to_string_lossy().starts_with('.');
        let is_results = || entry.path().canonicalize().ok() == results;
        entry.depth() == 0 || !(hidden || entry.file_type().is_dir() && results.is_some() && is_results())
    };
    for entry in WalkDir::new(folder).sort_by_file_name().into_iter().filter_entry(is_wanted) {
        let entry = entry.map_err(|e| Failure::file(e.path().unwrap_or(folder), format!("cannot be read: {e}")))?;
        let path = entry.path();
        let is_drawing =
            path.extension().is_some_and(|e| e.eq_ignore_ascii_case("svg") || e.eq_ignore_ascii_case("svgz"));
        if is_drawing && !path.is_dir() {
            let below = path.strip_prefix(folder).ok().and_then(Path::parent).unwrap_or(Path::new(""));
            let refused = refused(&entry, folder, options.reading.external);
            out.push(InputFile { path: path.to_owned(), below: below.to_owned(), refused });
        }
    }
    Ok(())
}

/// The reason why a file in `folder` is not read, nor written with `--in-place`. Only the folder was named.
fn refused(entry: &DirEntry, folder: &Path, external: bool) -> Option<&'static str> {
    let path = entry.path();
    if !path.is_file() {
        return Some("is no regular file");
    }
    let leaves = || match (path.canonicalize(), folder.canonicalize()) {
        (Ok(file), Ok(folder)) => !file.starts_with(folder),
        _ => true,
    };
    let is_elsewhere = entry.path_is_symlink() && !external && leaves();
    is_elsewhere.then_some("is a symbolic link that leads out of the folder; --allow-external follows it")
}
