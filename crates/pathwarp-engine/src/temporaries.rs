//! Temporary files: removed when they are dropped, and by [`remove_all_and`] before the program ends early.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, MutexGuard, OnceLock, PoisonError, RwLock, RwLockReadGuard};
use tempfile::{Builder, TempPath};

/// The paths of all temporary files that exist.
static LIVE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
/// Locked for reading while files are created or put in place, and for writing by the thread that ends the program.
static GATE: RwLock<()> = RwLock::new(());
/// Called whenever a temporary file is made.
static PROTECT: OnceLock<fn()> = OnceLock::new();

/// A temporary file.
#[derive(Debug)]
pub struct Temporary(Option<TempPath>);

impl Temporary {
    /// Creates an empty file in `folder`.
    pub fn create_in(folder: &Path) -> io::Result<(Self, File)> {
        remove_from(folder);
        let mut builder = builder();
        #[cfg(unix)]
        {
            // The permissions of any newly created file; the umask applies.
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let _gate = hold();
        let (file, path) = builder.tempfile_in(folder)?.into_parts();
        Ok((Self::registered(path), file))
    }

    /// Gives `file` a second name, or copies it where there are no hard links.
    pub(crate) fn backup(file: &Path, folder: &Path) -> io::Result<Self> {
        let linked = builder().make_in(folder, |path| std::fs::hard_link(file, path));
        let made = linked.or_else(|_| builder().make_in(folder, |path| std::fs::copy(file, path).map(drop)))?;
        Ok(Self::registered(made.into_temp_path()))
    }

    fn registered(path: TempPath) -> Self {
        if let Some(protect) = PROTECT.get() {
            protect();
        }
        live().insert(path.to_path_buf());
        Self(Some(path))
    }

    /// Returns the path of the file.
    pub fn path(&self) -> &Path {
        self.0.as_deref().unwrap_or(Path::new(""))
    }

    /// Renames the file; an existing file is replaced.
    pub(crate) fn rename(mut self, to: &Path) -> io::Result<()> {
        let Some(path) = self.0.take() else { return Ok(()) };
        live().remove(&*path);
        path.persist(to).map_err(|e| e.error)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(path) = &self.0 {
            live().remove(&**path);
        }
    }
}

/// Sets a function that is called for each temporary file, so that a program prepares for interruptions only once there is one.
pub fn protect_by(protect: fn()) {
    let _ = PROTECT.set(protect);
}

/// Keeps an interruption waiting until the guard is dropped.
pub(crate) fn hold() -> RwLockReadGuard<'static, ()> {
    GATE.read().unwrap_or_else(PoisonError::into_inner)
}

fn builder() -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(OWN_PREFIX.as_str());
    builder
}

fn live() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Waits for commits under way, so that files that belong together appear together. Then calls `begin`, removes all temporary files, and
/// calls `end`, which ends this program.
pub fn remove_all_and(begin: impl FnOnce(), end: impl FnOnce()) {
    let _gate = GATE.write().unwrap_or_else(PoisonError::into_inner);
    begin();
    for path in live().iter() {
        let _ = std::fs::remove_file(path);
    }
    end();
}

/// The prefix of the names of all temporary files: `.pathwarp-MACHINE-PROCESS-…`.
const PREFIX: &str = ".pathwarp-";

/// The prefix of the names of this run's temporary files.
pub(crate) static OWN_PREFIX: LazyLock<String> =
    LazyLock::new(|| format!("{PREFIX}{}-{}-", machine(), std::process::id()));

/// Folders that have been cleaned already.
static CLEAN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Removes the temporary files that killed runs left in `folder`, when it is called for it the first time.
pub(crate) fn remove_from(folder: &Path) {
    let mut clean = CLEAN.lock().unwrap_or_else(PoisonError::into_inner);
    if clean.contains(folder) {
        return;
    }
    let Ok(entries) = folder.read_dir() else { return };
    clean.insert(folder.to_owned());
    drop(clean);
    for entry in entries.flatten() {
        // A file that cannot be removed does no harm.
        if is_leftover(&entry.file_name()) && entry.file_type().is_ok_and(|t| t.is_file()) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Returns `true` if a process of this machine that has ended made the file called `name`.
fn is_leftover(name: &OsStr) -> bool {
    let process = || {
        let rest = name.to_str()?.strip_prefix(PREFIX)?.strip_prefix(&machine())?;
        rest.strip_prefix('-')?.split_once('-')?.0.parse().ok()
    };
    process().is_some_and(|process: i32| !is_running(process))
}

/// Returns this machine's name, reduced to letters and digits.
#[cfg(unix)]
fn machine() -> String {
    let name = rustix::system::uname();
    name.nodename().to_string_lossy().chars().filter(char::is_ascii_alphanumeric).collect()
}

#[cfg(not(unix))]
fn machine() -> String {
    std::env::var("COMPUTERNAME").unwrap_or_default().chars().filter(char::is_ascii_alphanumeric).collect()
}

#[cfg(unix)]
fn is_running(process: i32) -> bool {
    use rustix::process::{Pid, test_kill_process};
    // A process of another user exists even if it may not be signalled.
    Pid::from_raw(process).is_none_or(|p| test_kill_process(p) != Err(rustix::io::Errno::SRCH))
}

/// Returns `true`, so that nothing is removed: asking the system takes unsafe code.
#[cfg(not(unix))]
fn is_running(_: i32) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_of_ended_processes_are_removed() -> io::Result<()> {
        let mut child = std::process::Command::new("true").spawn()?;
        let ended = child.id();
        child.wait()?;
        let folder = tempfile::tempdir()?;
        let name = |process: u32| format!("{PREFIX}{}-{process}-aB3xY9", machine());
        let kept =
            [name(std::process::id()), name(1), format!("{PREFIX}elsewhere-{ended}-aB3xY9"), ".pathwarp-notes".into()];
        for file in kept.iter().cloned().chain([name(ended)]) {
            std::fs::write(folder.path().join(file), "x")?;
        }
        remove_from(folder.path());
        let left: BTreeSet<_> =
            folder.path().read_dir()?.map(|e| e.map(|e| e.file_name())).collect::<Result<_, _>>()?;
        assert_eq!(left, kept.iter().map(Into::into).collect());
        Ok(())
    }
}
