//! The user's folders, and files there that nobody else may read.

use crate::host::Host;
use sha2::{Digest as _, Sha256};
use std::fmt::Write as _;
use std::fs::{self, DirBuilder, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// Most files of a kind that are kept: the newest.
const MOST_FILES: usize = 100;

/// The folder for settings.
pub(crate) fn settings() -> Option<PathBuf> {
    of_user("XDG_CONFIG_HOME", ".config", "APPDATA")
}

/// The folder for what is kept from one run to the next.
pub(crate) fn state() -> Option<PathBuf> {
    of_user("XDG_STATE_HOME", ".local/state", "LOCALAPPDATA")
}

fn of_user(xdg: &str, below_home: &str, windows: &str) -> Option<PathBuf> {
    let folder = |name: &str| std::env::var_os(name).filter(|v| !v.is_empty()).map(PathBuf::from);
    let folder = if cfg!(windows) {
        folder(windows)?
    } else {
        folder(xdg).filter(|p| p.is_absolute()).or_else(|| Some(folder("HOME")?.join(below_home)))?
    };
    Some(folder.join("pathwarp"))
}

/// A name made of a drawing's place, whichever way it is written, and `content`.
pub(crate) fn key(drawing: &Path, content: &[u8]) -> String {
    let folder = drawing.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // A drawing that was dropped on the page may be no file here.
    let here = || folder.canonicalize().unwrap_or_default().join(drawing.file_name().unwrap_or_default());
    let place = drawing.canonicalize().unwrap_or_else(|_| here());
    hex(&[place.as_os_str().as_encoded_bytes(), &[0], content])
}

/// The SHA-256 sum of pieces of text.
pub(crate) fn hex(pieces: &[&[u8]]) -> String {
    let mut sum = Sha256::new();
    pieces.iter().for_each(|piece| sum.update(piece));
    sum.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// Writes a file for the user's eyes only. Where a new one makes too many of them, the oldest go.
pub(crate) fn write(host: &dyn Host, file: &Path, bytes: &[u8]) -> Result<(), String> {
    if !file.exists() {
        create(file).map_err(|e| format!("{}: {e}", file.display()))?;
    }
    // Keeps the permissions of the file.
    host.write(file, bytes)
}

fn create(file: &Path) -> io::Result<()> {
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
