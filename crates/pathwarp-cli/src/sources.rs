//! Checks the files that a command writes against those it reads, so that sources are overwritten only on request.

use pathwarp_engine::failure::Failure;
use pathwarp_engine::input::{display, split_reference};
use pathwarp_engine::output::{is_device, is_stdout, link_target};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The files that a command reads and those that it will write, by identity.
#[derive(Default)]
pub(crate) struct Files {
    read: HashMap<PathBuf, Source>,
    /// The outputs with their names in messages.
    written: HashMap<PathBuf, String>,
    folders: RealFolders,
}

/// A file that is read.
struct Source {
    /// The name as given.
    name: String,
    /// `true` if `--in-place` allows it to be overwritten.
    replaceable: bool,
}

impl Files {
    /// Adds a file that is read: FILE of `FILE#NAME`, and nothing for `-`.
    pub(crate) fn add_source(&mut self, input: &Path) {
        self.add(input, false);
    }

    /// Adds artwork: a file that is read, and that `--in-place` may overwrite.
    pub(crate) fn add_artwork(&mut self, input: &Path) {
        self.add(input, true);
    }

    fn add(&mut self, input: &Path, replaceable: bool) {
        if !is_stdout(input) {
            let text = input.to_string_lossy();
            let is_reference = text.contains('#') && !input.exists();
            let file = if is_reference { split_reference(&text).0 } else { input.to_owned() };
            self.read.insert(self.folders.identity(&file), Source { name: display(input), replaceable });
        }
    }

    /// Allows artwork to be overwritten.
    pub(crate) fn allow_in_place(&mut self) {
        self.read.retain(|_, source| !source.replaceable);
    }

    /// Adds an output. `option` is the option that names it, or empty for the result.
    ///
    /// # Errors
    /// [`Failure::Usage`] if the output is a file that is read, or another output.
    pub(crate) fn add_output(&mut self, to: &Path, option: &str) -> Result<(), Failure> {
        if is_device(to) {
            return Ok(());
        }
        let shown = match (option, is_stdout(to)) {
            ("", true) => "the result".to_owned(),
            ("", false) => to.display().to_string(),
            (option, _) => format!("--{option} {}", to.display()),
        };
        let id = if is_stdout(to) { to.to_owned() } else { self.folders.identity(to) };
        if let Some(source) = self.read.get(&id) {
            let is_same_name = Path::new(&source.name) == to;
            let source_name = if is_same_name { String::new() } else { format!(" is {}, which", source.name) };
            let advice = if source.replaceable { ", or allow it with --in-place" } else { "" };
            let problem = "is read by this command and would be overwritten; name another file";
            return Err(Failure::usage(format!("{shown}{source_name} {problem}{advice}")));
        }
        if let Some(other) = self.written.get(&id) {
            let problem = if is_stdout(to) { "would both be standard output" } else { "would be the same file" };
            return Err(Failure::usage(format!("{other} and {shown} {problem}; give each output its own")));
        }
        self.written.insert(id, shown);
        Ok(())
    }
}

/// A cache of the real paths of folders, since most files of a batch share one.
#[derive(Default)]
struct RealFolders(HashMap<PathBuf, PathBuf>);

impl RealFolders {
    /// Returns a path that does not depend on how a file is named: links are resolved, and case is ignored where the system ignores it.
    fn identity(&mut self, file: &Path) -> PathBuf {
        let whole = self.real(file).unwrap_or_else(|| real(file));
        if cfg!(any(windows, target_os = "macos")) { whole.to_string_lossy().to_lowercase().into() } else { whole }
    }

    /// Returns the real path of a file that is not a link, by its folder's. On systems other than Unix, a file may have two names.
    fn real(&mut self, file: &Path) -> Option<PathBuf> {
        if !cfg!(unix) || file.symlink_metadata().is_ok_and(|m| m.is_symlink()) {
            // The target may not exist yet.
            return (!file.exists()).then(|| real(&link_target(file)));
        }
        let (folder, name) = (file.parent()?, file.file_name()?);
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        if let Some(known) = self.0.get(folder) {
            return Some(known.join(name));
        }
        let known = self.0.entry(folder.to_owned()).or_insert_with(|| real(folder));
        Some(known.join(name))
    }
}

/// Returns the absolute path with all links resolved.
fn real(file: &Path) -> PathBuf {
    let absolute = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    // If the file does not exist yet, resolve its existing folders.
    let existing = absolute.ancestors().find_map(|folder| {
        let rest = absolute.strip_prefix(folder).ok()?;
        let folder = folder.canonicalize().ok()?;
        Some(if rest.as_os_str().is_empty() { folder } else { folder.join(rest) })
    });
    existing.unwrap_or(absolute)
}
