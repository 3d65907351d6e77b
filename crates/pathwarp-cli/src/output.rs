//! Output: files, each written completely or not at all, and standard output.

use crate::failure::Failure;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// An output file with its content. Nothing appears under its name before [`PendingFile::commit_all`].
pub(crate) struct PendingFile {
    content: Content,
    to: PathBuf,
}

enum Content {
    /// A temporary file, to be renamed.
    File(tempfile::NamedTempFile),
    /// The bytes for a device or pipe (`/dev/null`, `/dev/stdout`): renaming would replace it by a file.
    Bytes(Vec<u8>),
}

impl PendingFile {
    /// Writes `bytes` to a temporary file beside `to`.
    pub(crate) fn new(to: &Path, bytes: &[u8]) -> Result<Self, Failure> {
        if is_device(to) {
            return Ok(Self { content: Content::Bytes(bytes.to_vec()), to: to.to_owned() });
        }
        Self::with_writer(to, |file| file.write_all(bytes).map_err(|e| format!("cannot be written: {e}")))
    }

    /// Calls `write` with a temporary file beside `to`.
    pub(crate) fn with_writer(to: &Path, write: impl FnOnce(&mut File) -> Result<(), String>) -> Result<Self, Failure> {
        if is_device(to) {
            return Err(Failure::file(to, "is a device, not a file; name a file"));
        }
        // Keep a symbolic link and replace the file it points to.
        let to = &to.canonicalize().unwrap_or_else(|_| to.to_owned());
        let folder = match to.parent() {
            Some(p) if !p.as_os_str().is_empty() => p,
            _ => Path::new("."),
        };
        if to.is_dir() {
            return Err(Failure::file(to, "is a folder; name a file, or use --out-dir"));
        }
        if !folder.is_dir() {
            return Err(Failure::file(folder, "does not exist; create the folder first"));
        }
        let make = || -> std::io::Result<tempfile::NamedTempFile> {
            let mut builder = tempfile::Builder::new();
            builder.prefix(".pathwarp-");
            #[cfg(unix)]
            {
                // The permissions of any newly created file; the umask applies.
                use std::os::unix::fs::PermissionsExt;
                builder.permissions(std::fs::Permissions::from_mode(0o666));
            }
            builder.tempfile_in(folder)
        };
        let mut file = make().map_err(|e| Failure::file(to, format!("cannot be written: {e}")))?;
        write(file.as_file_mut()).map_err(|e| Failure::file(to, e))?;
        Ok(Self { content: Content::File(file), to: to.to_owned() })
    }

    /// Renames all files to their final names.
    pub(crate) fn commit_all(all: Vec<Self>) -> Result<(), Failure> {
        for p in all {
            let written = match p.content {
                Content::File(file) => file.persist(&p.to).map(drop).map_err(|e| e.error),
                Content::Bytes(bytes) => {
                    std::fs::OpenOptions::new().write(true).open(&p.to).and_then(|mut to| to.write_all(&bytes))
                }
            };
            written.map_err(|e| Failure::file(&p.to, format!("cannot be written: {e}")))?;
        }
        Ok(())
    }
}

/// Returns `true` if `to` exists and is neither a file nor a folder: a pipe, a terminal.
fn is_device(to: &Path) -> bool {
    to.metadata().is_ok_and(|m| !m.is_file() && !m.is_dir())
}

/// Writes one result: to the file `target`, or to standard output if there is none.
pub(crate) fn write(target: Option<&Path>, bytes: &[u8]) -> Result<(), Failure> {
    match target {
        Some(to) => PendingFile::commit_all(vec![PendingFile::new(to, bytes)?]),
        None => to_stdout(bytes),
    }
}

/// Writes to standard output. The reader may close the pipe early; ignore that.
pub(crate) fn to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(|e| Failure::stdout(&e)),
    }
}
