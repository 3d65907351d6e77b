//! The draft: the steps as they are, in a file beside the drawing until they are saved, so that a crash loses nothing.

use crate::host::Host;
use crate::protocol::PageStep;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The version of the file's format.
const VERSION: u32 = 1;
/// Bytes of the longest draft that is read: one with a drawing of 100 MB.
const LONGEST: u64 = 150 << 20;
/// The end of the file's name; the name begins with a dot and the drawing's name.
const EXTENSION: &str = "pathwarp-edit";

/// What a draft holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Kept {
    pathwarp: u32,
    pub(crate) steps: Vec<PageStep>,
    pub(crate) undo: Vec<Vec<PageStep>>,
    pub(crate) redo: Vec<Vec<PageStep>>,
    /// Name and content, as base64, of a drawing that was dropped on the page.
    pub(crate) dropped: Option<(String, String)>,
}

impl Kept {
    pub(crate) fn new(steps: Vec<PageStep>) -> Self {
        Self { pathwarp: VERSION, steps, undo: Vec::new(), redo: Vec::new(), dropped: None }
    }
}

/// The draft of a drawing.
#[derive(Debug, Clone, Default)]
pub(crate) struct Draft {
    /// `None`: nothing is kept.
    path: Option<PathBuf>,
}

impl Draft {
    /// The draft of the drawing `file`.
    pub(crate) fn of(file: &Path) -> Self {
        let name = file.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        Self { path: Some(file.with_file_name(format!(".{name}.{EXTENSION}"))) }
    }

    /// What was kept; `None` if there is no draft, or one of another version. Drawings come with folders from anywhere: a link or a pipe
    /// in the draft's place is none.
    pub(crate) fn read(&self) -> Option<Kept> {
        let path = self.path.as_ref()?;
        std::fs::symlink_metadata(path).ok().filter(|m| m.is_file() && m.len() <= LONGEST)?;
        let text = std::fs::read_to_string(path).ok()?;
        serde_json::from_str::<Kept>(&text).ok().filter(|k| k.pathwarp == VERSION)
    }

    /// Keeps the steps.
    pub(crate) fn keep(&self, host: &dyn Host, kept: &Kept) -> Result<(), String> {
        let Some(path) = &self.path else { return Ok(()) };
        let text = serde_json::to_string(kept).map_err(|e| e.to_string())?;
        host.write(path, text.as_bytes())
    }

    /// Removes the file, after the steps have been saved.
    pub(crate) fn remove(&self) {
        if let Some(path) = &self.path {
            let _ = std::fs::remove_file(path);
        }
    }
}
