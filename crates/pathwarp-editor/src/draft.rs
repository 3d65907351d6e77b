//! The draft: the steps of a drawing as they are, in the user's folder for state until they are saved, so that a crash loses nothing.

use crate::folders;
use crate::host::Host;
use crate::protocol::PageStep;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The version of the file's format.
const VERSION: u32 = 1;
/// What is wrong where nothing can be kept.
pub(crate) const NO_FOLDER: &str = "there is no folder for state (HOME is not set)";

/// What a draft holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Kept {
    pathwarp: u32,
    pub(crate) steps: Vec<PageStep>,
    pub(crate) undo: Vec<Vec<PageStep>>,
    pub(crate) redo: Vec<Vec<PageStep>>,
}

impl Kept {
    pub(crate) fn new(steps: Vec<PageStep>) -> Self {
        Self { pathwarp: VERSION, steps, undo: Vec::new(), redo: Vec::new() }
    }
}

/// The draft of a drawing.
#[derive(Debug, Clone)]
pub(crate) struct Draft {
    /// `None`: nothing can be kept.
    path: Option<PathBuf>,
}

impl Draft {
    /// The draft of the drawing `file` with this content; another content is another drawing.
    pub(crate) fn of(state: Option<&Path>, file: &Path, content: &[u8]) -> Self {
        Self { path: state.map(|s| s.join("drafts").join(folders::key(file, content) + ".json")) }
    }

    /// What was kept; `None` if there is no draft, or one of another version.
    pub(crate) fn read(&self) -> Option<Kept> {
        let text = std::fs::read_to_string(self.path.as_ref()?).ok()?;
        serde_json::from_str::<Kept>(&text).ok().filter(|k| k.pathwarp == VERSION)
    }

    /// Keeps the steps.
    pub(crate) fn keep(&self, host: &dyn Host, kept: &Kept) -> Result<(), String> {
        let path = self.path.as_ref().ok_or(NO_FOLDER)?;
        let text = serde_json::to_string(kept).map_err(|e| e.to_string())?;
        folders::write(host, path, text.as_bytes())
    }

    /// Removes the file, after the steps have been saved.
    pub(crate) fn remove(&self) {
        if let Some(path) = &self.path {
            let _ = std::fs::remove_file(path);
        }
    }
}
