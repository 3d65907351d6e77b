//! Output files, written whole or not at all.

use crate::failure::Failure;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A file that is ready to be written: nothing is visible under its name before [`Pending::commit_all`].
pub(crate) struct Pending {
    file: tempfile::NamedTempFile,
    to: PathBuf,
}

impl Pending {
    /// Writes `bytes` to a temporary file beside `to`.
    pub(crate) fn new(to: &Path, bytes: &[u8]) -> Result<Self, Failure> {
        Self::written(to, |file| file.write_all(bytes).map_err(|e| format!("cannot be written: {e}")))
    }

    /// Has `write` write a temporary file beside `to`.
    pub(crate) fn written(to: &Path, write: impl FnOnce(&mut File) -> Result<(), String>) -> Result<Self, Failure> {
        let folder = match to.parent() {
            Some(p) if !p.as_os_str().is_empty() => p,
            _ => Path::new("."),
        };
        if to.is_dir() {
            return Err(Failure::file(to, "is a folder; name a file, or use --out-dir"));
        }
        if !folder.is_dir() {
            return Err(Failure::file(folder, "there is no such folder to write to"));
        }
        let make = || -> std::io::Result<tempfile::NamedTempFile> {
            let mut builder = tempfile::Builder::new();
            builder.prefix(".pathwarp-");
            #[cfg(unix)]
            {
                // As if created by any other program: the umask takes away what it takes away.
                use std::os::unix::fs::PermissionsExt;
                builder.permissions(std::fs::Permissions::from_mode(0o666));
            }
            builder.tempfile_in(folder)
        };
        let mut file = make().map_err(|e| Failure::file(to, format!("cannot be written: {e}")))?;
        write(file.as_file_mut()).map_err(|e| Failure::file(to, e))?;
        Ok(Self { file, to: to.to_owned() })
    }

    /// Renames all of them to their names.
    pub(crate) fn commit_all(all: Vec<Self>) -> Result<(), Failure> {
        for p in all {
            p.file.persist(&p.to).map_err(|e| Failure::file(&p.to, format!("cannot be written: {}", e.error)))?;
        }
        Ok(())
    }
}

/// Writes to standard output; a reader that has had enough is no fault.
pub(crate) fn to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(|e| Failure::stdout(&e)),
    }
}
