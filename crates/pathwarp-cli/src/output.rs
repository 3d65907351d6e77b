//! Output files, written whole or not at all.

use crate::failure::Failure;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A file that is ready to be written: nothing is visible under its name before [`Pending::commit_all`].
pub(crate) struct Pending {
    content: Content,
    to: PathBuf,
}

enum Content {
    /// To be renamed.
    File(tempfile::NamedTempFile),
    /// For what is no file (`/dev/null`, `/dev/stdout`, a pipe): renaming would put a file in its place.
    Bytes(Vec<u8>),
}

impl Pending {
    /// Writes `bytes` to a temporary file beside `to`.
    pub(crate) fn new(to: &Path, bytes: &[u8]) -> Result<Self, Failure> {
        if is_device(to) {
            return Ok(Self { content: Content::Bytes(bytes.to_vec()), to: to.to_owned() });
        }
        Self::written(to, |file| file.write_all(bytes).map_err(|e| format!("cannot be written: {e}")))
    }

    /// Has `write` write a temporary file beside `to`.
    pub(crate) fn written(to: &Path, write: impl FnOnce(&mut File) -> Result<(), String>) -> Result<Self, Failure> {
        if is_device(to) {
            return Err(Failure::file(to, "is no file; name one"));
        }
        // A link stays one: what it leads to is replaced.
        let to = &to.canonicalize().unwrap_or_else(|_| to.to_owned());
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
        Ok(Self { content: Content::File(file), to: to.to_owned() })
    }

    /// Renames all of them to their names.
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

/// Whether this is something to write to that is no file: a pipe, a terminal.
fn is_device(to: &Path) -> bool {
    to.metadata().is_ok_and(|m| !m.is_file() && !m.is_dir())
}

/// Writes to standard output; a reader that has had enough is no fault.
pub(crate) fn to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(|e| Failure::stdout(&e)),
    }
}
