//! The draft: the steps of a drawing until they are saved, stored in the user's folder for state, so that a crash loses nothing.

use crate::host::Host;
use crate::protocol::PageStep;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use std::fmt::Write as _;
use std::fs::{self, DirBuilder, OpenOptions};
use std::io;
use std::mem;
use std::path::{Path, PathBuf};

/// The version of the file's format.
const VERSION: u32 = 2;
/// The problem if the folder for state is unknown.
pub(crate) const NO_FOLDER: &str = "there is no folder for state (HOME is not set)";

/// Most changes that can be undone.
const MOST_UNDO: usize = 500;

/// The state of the work at one time.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Moment {
    pub(crate) steps: Vec<PageStep>,
    /// The index of the drawing on show, among those that the words have been set as.
    #[serde(default)]
    pub(crate) drawing: usize,
}

/// The contents of a draft: the present state, and those to undo and to redo.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct History {
    /// The version of the file's format.
    pathwarp: u32,
    #[serde(flatten)]
    pub(crate) now: Moment,
    pub(crate) undo: Vec<Moment>,
    pub(crate) redo: Vec<Moment>,
    /// The drawings that the words have been set as, the oldest first; empty before the words are edited.
    #[serde(default)]
    drawings: Vec<String>,
}

impl History {
    pub(crate) fn new(steps: Vec<PageStep>) -> Self {
        let now = Moment { steps, drawing: 0 };
        Self { pathwarp: VERSION, now, undo: Vec::new(), redo: Vec::new(), drawings: Vec::new() }
    }

    /// Replaces the steps, with an entry to undo.
    pub(crate) fn push_steps(&mut self, steps: Vec<PageStep>) {
        let next = Moment { steps, ..self.now };
        self.undo.push(mem::replace(&mut self.now, next));
        if self.undo.len() > MOST_UNDO {
            self.undo.remove(0);
        }
        self.redo.clear();
    }

    /// Replaces the words: the drawing `old` by `new`, and the steps.
    pub(crate) fn push_drawing(&mut self, old: &str, new: String, steps: Vec<PageStep>) {
        if self.drawings.is_empty() {
            self.drawings.push(old.to_owned());
        }
        self.push_steps(steps);
        // Drop the drawings of changes that could be redone until now.
        self.drawings.truncate(self.now.drawing + 1);
        self.drawings.push(new);
        self.now.drawing += 1;
    }

    /// Returns the drawing on show, if the words were edited.
    pub(crate) fn drawing(&self) -> Option<&str> {
        self.drawings.get(self.now.drawing).map(String::as_str)
    }

    /// Undoes the last change.
    pub(crate) fn undo(&mut self) {
        if let Some(old) = self.undo.pop() {
            self.redo.push(mem::replace(&mut self.now, old));
        }
    }

    /// Redoes the change undone last.
    pub(crate) fn redo(&mut self) {
        if let Some(new) = self.redo.pop() {
            self.undo.push(mem::replace(&mut self.now, new));
        }
    }
}

/// The draft of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Draft {
    /// A name made from the drawing's location and content.
    pub(crate) key: String,
    /// `None` if drafts cannot be stored.
    path: Option<PathBuf>,
}

impl Draft {
    /// Returns the draft of the drawing `file` with this content. Different contents have different drafts.
    pub(crate) fn for_drawing(state: Option<&Path>, file: &Path, content: &[u8]) -> Self {
        let key = key(file, content);
        Self { path: state.map(|s| s.join("drafts").join(format!("{key}.json"))), key }
    }

    /// Reads the draft; `None` if there is none, or one of another version.
    pub(crate) fn read(&self) -> Option<History> {
        let text = fs::read_to_string(self.path.as_ref()?).ok()?;
        serde_json::from_str::<History>(&text).ok().filter(|k| k.pathwarp == VERSION)
    }

    /// Writes the steps and their history.
    pub(crate) fn store(&self, host: &dyn Host, history: &History) -> Result<(), String> {
        let path = self.path.as_ref().ok_or(NO_FOLDER)?;
        let text = serde_json::to_string(history).map_err(|e| e.to_string())?;
        write(host, path, text.as_bytes())
    }

    /// Removes the file once the steps have been saved.
    pub(crate) fn remove(&self) {
        if let Some(path) = &self.path {
            let _ = fs::remove_file(path);
        }
    }
}

/// Most files of a kind that are kept; the oldest are removed.
const MOST_FILES: usize = 100;

/// Returns the folder for settings.
pub(crate) fn settings() -> Option<PathBuf> {
    user_folder("XDG_CONFIG_HOME", ".config", "APPDATA")
}

/// Returns the folder for state, which is kept from one run to the next.
pub(crate) fn state() -> Option<PathBuf> {
    user_folder("XDG_STATE_HOME", ".local/state", "LOCALAPPDATA")
}

/// Returns the folder `pathwarp` in the folder that an environment variable names: `windows` there, elsewhere `xdg` or below `HOME`.
fn user_folder(xdg: &str, below_home: &str, windows: &str) -> Option<PathBuf> {
    let named = |variable: &str| std::env::var_os(variable).filter(|v| !v.is_empty()).map(PathBuf::from);
    let xdg = || named(xdg).filter(|p| p.is_absolute()).or_else(|| Some(named("HOME")?.join(below_home)));
    let folder = if cfg!(windows) { named(windows) } else { xdg() };
    Some(folder?.join("pathwarp"))
}

/// Makes a name from a drawing's absolute path and `content`.
pub(crate) fn key(drawing: &Path, content: &[u8]) -> String {
    let folder = drawing.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // A drawing dropped on the page may not exist as a file here.
    let joined = || folder.canonicalize().unwrap_or_default().join(drawing.file_name().unwrap_or_default());
    let path = drawing.canonicalize().unwrap_or_else(|_| joined());
    sha256_hex(&[path.as_os_str().as_encoded_bytes(), &[0], content])
}

/// Returns the SHA-256 sum of pieces of text, in hexadecimal.
pub(crate) fn sha256_hex(pieces: &[&[u8]]) -> String {
    let mut sum = Sha256::new();
    pieces.iter().for_each(|piece| sum.update(piece));
    sum.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// Writes a file that only the user may read. If it makes too many of them, the oldest are removed.
pub(crate) fn write(host: &dyn Host, file: &Path, bytes: &[u8]) -> Result<(), String> {
    if !file.exists() {
        create_private(file).map_err(|e| format!("{}: {e}", file.display()))?;
    }
    // The file keeps its permissions.
    host.write(file, bytes)
}

/// Creates an empty file that only the user may read, and removes the oldest files in its folder.
fn create_private(file: &Path) -> io::Result<()> {
    let folder = file.parent().unwrap_or(Path::new("."));
    let (mut folders, mut options) = (DirBuilder::new(), OpenOptions::new());
    #[cfg(unix)]
    {
        use std::os::unix::fs::{DirBuilderExt as _, OpenOptionsExt as _};
        folders.mode(0o700);
        options.mode(0o600);
    }
    folders.recursive(true).create(folder)?;
    options.write(true).create(true).truncate(false).open(file)?;
    let dated = |e: io::Result<fs::DirEntry>| e.and_then(|e| Ok((e.metadata()?.modified()?, e.path()))).ok();
    let mut files: Vec<_> = fs::read_dir(folder)?.filter_map(dated).collect();
    files.sort_unstable_by(|a, b| b.cmp(a));
    files.iter().skip(MOST_FILES).for_each(|(_, old)| drop(fs::remove_file(old)));
    Ok(())
}
