//! The folders that `--out-dir` and patterns name.

use super::naming::is_pattern;
use super::plan::Job;
use crate::failure::Failure;
use crate::options::CommonOptions;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Folders that were created for the outputs. Those that stay empty are removed when this is dropped.
pub(crate) struct Folders {
    /// A folder stands before those in it.
    made: Vec<PathBuf>,
}

impl Folders {
    /// Creates the folders that are missing.
    pub(crate) fn create(options: &CommonOptions, jobs: &[Job]) -> Result<Self, Failure> {
        let pattern = |file: &Option<PathBuf>| file.as_deref().is_some_and(is_pattern);
        let own_target = options.out_dir.is_some() || pattern(&options.out);
        let targets = jobs.iter().filter(|_| own_target).flat_map(|j| &j.target);
        let previews = jobs.iter().filter(|_| pattern(&options.preview)).flat_map(|j| &j.preview);
        let folders: HashSet<&Path> = targets.chain(previews).filter_map(|file| file.parent()).collect();
        let mut made = Self { made: Vec::new() };
        for folder in folders {
            made.create_one(folder)?;
        }
        Ok(made)
    }

    fn create_one(&mut self, folder: &Path) -> Result<(), Failure> {
        let missing = |f: &&Path| !f.as_os_str().is_empty() && !f.exists();
        let before = self.made.len();
        self.made.extend(folder.ancestors().take_while(missing).map(Path::to_owned));
        self.made[before..].reverse();
        if folder.as_os_str().is_empty() {
            return Ok(());
        }
        std::fs::create_dir_all(folder).map_err(|e| Failure::output(folder, format!("cannot be created: {e}")))
    }
}

impl Drop for Folders {
    fn drop(&mut self) {
        // Only an empty folder can be removed.
        for folder in self.made.iter().rev() {
            let _ = std::fs::remove_dir(folder);
        }
    }
}
