//! Output: files, each written completely or not at all, and standard output.

use crate::failure::Failure;
use crate::temporaries::{self, Temporary};
use std::fs::{File, Metadata};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// An output with its content. Nothing appears under its name before [`PendingFile::commit_all`].
pub struct PendingFile {
    content: Content,
    to: PathBuf,
}

enum Content {
    /// A temporary file, to be renamed.
    File(Temporary),
    /// The bytes for a device or pipe (`/dev/null`, `/dev/stdout`): renaming would replace it by a file.
    Device(Vec<u8>),
    Stdout(Vec<u8>),
}

impl PendingFile {
    /// Writes `bytes` to a temporary file beside `to`; `-` is standard output.
    pub fn new(to: &Path, bytes: &[u8]) -> Result<Self, Failure> {
        match Target::named(to) {
            Target::Stdout => Ok(Self::stdout(bytes.to_vec())),
            Target::Device => Ok(Self { content: Content::Device(bytes.to_vec()), to: to.to_owned() }),
            target => target.pending(to, |file| file.write_all(bytes).map_err(|e| cannot_be_written(&e))),
        }
    }

    /// An output for standard output.
    pub fn stdout(bytes: Vec<u8>) -> Self {
        Self { content: Content::Stdout(bytes), to: PathBuf::from("-") }
    }

    /// Calls `write` with a temporary file beside `to`. Fails for standard output and devices.
    pub(crate) fn with_writer(to: &Path, write: impl FnOnce(&mut File) -> Result<(), String>) -> Result<Self, Failure> {
        Target::named(to).pending(to, write)
    }

    /// Puts all outputs in place. If one fails, those before it are restored to what they were.
    pub fn commit_all(all: Vec<Self>) -> Result<(), Failure> {
        // Print first: printing cannot be undone, and if it fails, no file has been replaced yet.
        let is_file = |p: &Self| matches!(p.content, Content::File(_));
        let (files, streams): (Vec<Self>, Vec<Self>) = all.into_iter().partition(is_file);
        streams.into_iter().try_for_each(Self::print)?;
        let _gate = temporaries::hold(); // An interruption waits until all files are in place.
        let alone = files.len() == 1;
        let mut placed = Vec::with_capacity(files.len());
        for file in files {
            let to = file.to.clone();
            match file.put_in_place(alone) {
                Ok(done) => placed.push(done),
                Err(e) => {
                    placed.into_iter().rev().for_each(Placed::undo);
                    return Err(Failure::output(&to, cannot_be_written(&e)));
                }
            }
        }
        Ok(())
    }

    fn print(self) -> Result<(), Failure> {
        match self.content {
            Content::Stdout(bytes) => to_stdout(&bytes),
            Content::Device(bytes) => {
                let opened = std::fs::OpenOptions::new().append(true).open(&self.to);
                let written = opened.and_then(|mut to| to.write_all(&bytes));
                written.map_err(|e| Failure::output(&self.to, cannot_be_written(&e)))
            }
            Content::File(_) => Ok(()),
        }
    }

    /// Renames a file to its final name. Unless it is `alone`, the file that it replaces is kept, so that it can be restored.
    fn put_in_place(self, alone: bool) -> io::Result<Placed> {
        let replaces = !alone && self.to.exists();
        let backup = replaces.then(|| Temporary::backup(&self.to, folder(&self.to))).transpose()?;
        if let Content::File(temporary) = self.content {
            temporary.rename(&self.to)?;
        }
        Ok(Placed { to: self.to, backup })
    }
}

/// An output that is written piece by piece.
pub struct Draft {
    sink: Sink,
    to: PathBuf,
}

enum Sink {
    File(Temporary, BufWriter<File>),
    /// The bytes for a stream, which gets nothing before everything has succeeded.
    Bytes(Vec<u8>),
}

impl Draft {
    /// Creates a temporary file beside `to`; `-` is standard output.
    pub fn new(to: &Path) -> Result<Self, Failure> {
        match Target::named(to) {
            Target::Stdout | Target::Device => Ok(Self { sink: Sink::Bytes(Vec::new()), to: to.to_owned() }),
            target => {
                let (to, temporary, file) = target.temporary(to)?;
                Ok(Self { sink: Sink::File(temporary, BufWriter::new(file)), to })
            }
        }
    }

    /// Appends to the output.
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        let written = match &mut self.sink {
            Sink::File(_, file) => file.write_all(bytes),
            Sink::Bytes(all) => all.write_all(bytes),
        };
        written.map_err(|e| Failure::output(&self.to, cannot_be_written(&e)))
    }

    /// Returns the complete output.
    pub fn finish(self) -> Result<PendingFile, Failure> {
        match self.sink {
            Sink::File(temporary, mut file) => {
                file.flush().map_err(|e| Failure::output(&self.to, cannot_be_written(&e)))?;
                Ok(PendingFile { content: Content::File(temporary), to: self.to })
            }
            Sink::Bytes(bytes) => PendingFile::new(&self.to, &bytes),
        }
    }
}

/// The destination that an output's name stands for.
enum Target {
    Stdout,
    Device,
    Folder,
    /// A file, which may not exist yet. A symbolic link stands for its target, so that the link is kept.
    File(PathBuf),
}

impl Target {
    /// Classifies the name `to`. Asks the system once, unless it is a symbolic link.
    fn named(to: &Path) -> Self {
        if is_stdout(to) {
            return Self::Stdout;
        }
        let found = to.symlink_metadata();
        let is_link = found.as_ref().is_ok_and(Metadata::is_symlink);
        match if is_link { to.metadata() } else { found } {
            Ok(m) if m.is_dir() => Self::Folder,
            Ok(m) if !m.is_file() => Self::Device,
            _ if is_link => Self::behind_link(to),
            _ => Self::File(to.to_owned()),
        }
    }

    /// Classifies a symbolic link, whose target may not exist yet.
    fn behind_link(link: &Path) -> Self {
        let file = link_target(link);
        if is_descriptor(&file) {
            // Write to the open file instead of replacing it: it may have lost its name.
            return if file.ends_with("1") { Self::Stdout } else { Self::Device };
        }
        Self::File(link.canonicalize().unwrap_or(file))
    }

    /// Calls `write` with a temporary file beside the destination.
    fn pending(self, to: &Path, write: impl FnOnce(&mut File) -> Result<(), String>) -> Result<PendingFile, Failure> {
        let (to, temporary, mut file) = self.temporary(to)?;
        write(&mut file).map_err(|e| Failure::output(&to, e))?;
        Ok(PendingFile { content: Content::File(temporary), to })
    }

    /// Creates a temporary file in the destination's folder. Returns the destination and the temporary file.
    fn temporary(self, to: &Path) -> Result<(PathBuf, Temporary, File), Failure> {
        let file = match self {
            Self::File(file) => file,
            Self::Folder => return Err(Failure::output(to, "is a folder; name a file, or use --out-dir")),
            Self::Device | Self::Stdout => return Err(Failure::output(to, "is a device, not a file; name a file")),
        };
        let folder = folder(&file);
        match Temporary::create_in(folder) {
            Ok((temporary, content)) => {
                copy_permissions(&file, &content).map_err(|e| Failure::output(&file, cannot_be_written(&e)))?;
                Ok((file, temporary, content))
            }
            Err(_) if !folder.is_dir() => Err(Failure::output(folder, "does not exist; create the folder first")),
            Err(e) => Err(Failure::output(&file, cannot_be_written(&e))),
        }
    }
}

/// Gives a new file the permissions of the file that it will replace, which may be private.
#[cfg(unix)]
fn copy_permissions(old: &Path, new: &File) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _, fchown};
    /// Excludes the bits that let a program run as its owner.
    const PERMISSIONS: u32 = 0o777;
    let Ok(old) = old.metadata() else { return Ok(()) };
    let created = new.metadata()?;
    if (old.uid(), old.gid()) != (created.uid(), created.gid()) {
        // Only some users may give files away; the others stay owners of what they write.
        let _ = fchown(new, Some(old.uid()), Some(old.gid()));
    }
    new.set_permissions(std::fs::Permissions::from_mode(old.mode() & PERMISSIONS))
}

#[cfg(not(unix))]
fn copy_permissions(_: &Path, _: &File) -> io::Result<()> {
    Ok(())
}

/// Follows a chain of symbolic links to its last file, which may not exist.
pub fn link_target(link: &Path) -> PathBuf {
    /// Length of the longest chain that systems follow.
    const MOST_LINKS: usize = 40;
    let mut file = link.to_owned();
    for _ in 0..MOST_LINKS {
        // A descriptor links to a name that its file may have lost.
        let Some(next) = file.read_link().ok().filter(|_| !is_descriptor(&file)) else { break };
        file = folder(&file).join(next);
    }
    file
}

/// Returns `true` for the name of an open file, such as the target of `/dev/stdout`.
fn is_descriptor(file: &Path) -> bool {
    cfg!(unix) && ["/proc/self/fd", "/dev/fd"].iter().any(|fds| folder(file) == Path::new(fds))
}

/// A file under its final name.
struct Placed {
    to: PathBuf,
    /// A backup of the file that it replaced.
    backup: Option<Temporary>,
}

impl Placed {
    /// Restores the file that was replaced. An error here is ignored; the first error is the one reported.
    fn undo(self) {
        let _ = match self.backup {
            Some(old) => old.rename(&self.to),
            None => std::fs::remove_file(&self.to),
        };
    }
}

/// Returns the folder that a file lies in.
pub(crate) fn folder(file: &Path) -> &Path {
    match file.parent() {
        Some(p) if !p.as_os_str().is_empty() => p,
        _ => Path::new("."),
    }
}

fn cannot_be_written(e: &io::Error) -> String {
    format!("cannot be written: {e}")
}

/// Returns `true` if `to` stands for standard output.
pub fn is_stdout(to: &Path) -> bool {
    to.as_os_str() == "-"
}

/// Returns `true` if `to` stands for no file in a folder, but for standard output, a pipe or a terminal.
pub(crate) fn is_stream(to: &Path) -> bool {
    matches!(Target::named(to), Target::Stdout | Target::Device)
}

/// Returns `true` if `to` exists and is neither a file nor a folder: a pipe, a terminal.
pub fn is_device(to: &Path) -> bool {
    to.metadata().is_ok_and(|m| !m.is_file() && !m.is_dir())
}

/// Writes one result: to the file `target`, or to standard output if there is none.
pub fn write(target: Option<&Path>, bytes: &[u8]) -> Result<(), Failure> {
    match target {
        Some(to) => PendingFile::commit_all(vec![PendingFile::new(to, bytes)?]),
        None => to_stdout(bytes),
    }
}

/// Writes to standard output. Ignores that the reader has closed the pipe.
pub fn to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(|e| Failure::stdout(&e)),
    }
}
