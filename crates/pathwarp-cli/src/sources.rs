//! Sources are never overwritten unasked: the files that a command reads, checked against those it writes.

use crate::failure::Failure;
use crate::input::{display, split_reference};
use crate::output::{is_device, is_stdout};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::{Path, PathBuf};

/// The files that a command reads and those that it is going to write, by identity.
#[derive(Default)]
pub(crate) struct Files {
    read: HashMap<PathBuf, Source>,
    written: HashMap<PathBuf, String>,
}

/// A file that is read.
struct Source {
    /// As given.
    name: String,
    /// `--in-place` allows it to be overwritten.
    replaceable: bool,
}

impl Files {
    /// Adds a file that is read. `FILE#NAME` is FILE; `-` is none.
    pub(crate) fn read(&mut self, input: &Path) {
        self.add(input, false);
    }

    /// Adds artwork: a file that is read, and may be overwritten if the user says so.
    pub(crate) fn read_artwork(&mut self, input: &Path) {
        self.add(input, true);
    }

    fn add(&mut self, input: &Path, replaceable: bool) {
        if !is_stdout(input) {
            let file = if input.exists() { input.to_owned() } else { split_reference(&input.to_string_lossy()).0 };
            self.read.insert(identity(&file), Source { name: display(input), replaceable });
        }
    }

    /// Allows artwork to be overwritten.
    pub(crate) fn allow_in_place(&mut self) {
        self.read.retain(|_, source| !source.replaceable);
    }

    /// Adds an output. `option` is the option that names it, or empty for the result.
    ///
    /// # Errors
    /// The output is a file that is read, or another output.
    pub(crate) fn write(&mut self, to: &Path, option: &str) -> Result<(), Failure> {
        if is_device(to) {
            return Ok(());
        }
        let shown = match (option, is_stdout(to)) {
            ("", true) => "the result".to_owned(),
            ("", false) => to.display().to_string(),
            (option, _) => format!("--{option} {}", to.display()),
        };
        let id = if is_stdout(to) { to.to_owned() } else { identity(to) };
        if let Some(source) = self.read.get(&id) {
            let same =
                if Path::new(&source.name) == to { String::new() } else { format!(" is {}, which", source.name) };
            let advice = if source.replaceable { ", or allow it with --in-place" } else { "" };
            let problem = "is read by this command and would be overwritten; name another file";
            return Err(Failure::usage(format!("{shown}{same} {problem}{advice}")));
        }
        match self.written.entry(id) {
            Entry::Occupied(other) => {
                let other = other.get();
                let places = if is_stdout(to) { "would both be standard output" } else { "would be the same file" };
                Err(Failure::usage(format!("{other} and {shown} {places}; give each output its own")))
            }
            Entry::Vacant(free) => {
                free.insert(shown);
                Ok(())
            }
        }
    }
}

/// A path that is the same for every way of naming a file: links followed, and case ignored where the system ignores it.
fn identity(file: &Path) -> PathBuf {
    let absolute = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    // Of a file that does not exist yet, the folders that do exist are looked up.
    let existing = absolute.ancestors().find_map(|folder| {
        let rest = absolute.strip_prefix(folder).ok()?;
        let folder = folder.canonicalize().ok()?;
        Some(if rest.as_os_str().is_empty() { folder } else { folder.join(rest) })
    });
    let whole = existing.unwrap_or(absolute);
    if cfg!(any(windows, target_os = "macos")) { whole.to_string_lossy().to_lowercase().into() } else { whole }
}
