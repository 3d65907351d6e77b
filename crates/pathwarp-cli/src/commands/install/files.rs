//! The files of a plug-in: written all or none, and removed with the folders that they leave empty.

use crate::failure::Failure;
use crate::output::PendingFile;
use crate::terminal;
use std::env;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// A file to install.
pub(super) struct Part {
    /// Name relative to the plug-in's folder.
    pub(super) name: PathBuf,
    pub(super) content: Vec<u8>,
    /// The file is a program.
    pub(super) runs: bool,
}

/// This program's own file.
pub(super) fn own_program() -> Result<Vec<u8>, Failure> {
    let own = env::current_exe().and_then(fs::read);
    own.map_err(|e| Failure::Input(format!("the program file cannot be read: {e}")))
}

/// A path in an environment variable.
pub(super) fn variable(name: &str) -> Option<PathBuf> {
    env::var_os(name).filter(|v| !v.is_empty()).map(PathBuf::from)
}

/// Writes the files below `home`. Returns a line for each.
pub(super) fn install(home: &Path, parts: &[Part], dry: bool) -> Result<String, Failure> {
    let mut done = String::new();
    let mut pending = Vec::new();
    for part in parts {
        let file = home.join(&part.name);
        let _ = writeln!(done, "{} {}", if dry { "would write" } else { "wrote" }, file.display());
        if !dry {
            let folder = file.parent().unwrap_or(Path::new(""));
            fs::create_dir_all(folder).map_err(|e| Failure::output(folder, format!("cannot be created: {e}")))?;
            pending.push(PendingFile::new(&file, &part.content)?);
        }
    }
    PendingFile::commit_all(pending)?;
    #[cfg(unix)]
    for file in parts.iter().filter(|p| p.runs && !dry).map(|p| home.join(&p.name)) {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).map_err(|e| Failure::output(&file, e))?;
    }
    Ok(done)
}

/// Removes those of the files that exist, and the folders if nothing else is in them. Returns a line for each file.
pub(super) fn uninstall(home: &Path, names: &[PathBuf], dry: bool) -> Result<String, Failure> {
    let mut done = String::new();
    let existing: Vec<PathBuf> = names.iter().map(|n| home.join(n)).filter(|f| f.exists()).collect();
    if existing.is_empty() {
        terminal::note(&format!("{} is not installed", home.display()));
    }
    for f in &existing {
        let _ = writeln!(done, "{} {}", if dry { "would remove" } else { "removed" }, f.display());
        if !dry {
            fs::remove_file(f).map_err(|e| Failure::output(f, format!("cannot be removed: {e}")))?;
        }
    }
    if !dry {
        // A folder that holds other files stays.
        for folder in existing.iter().filter_map(|f| f.parent()).filter(|f| *f != home) {
            let _ = fs::remove_dir(folder);
        }
        let _ = fs::remove_dir(home);
    }
    Ok(done)
}
