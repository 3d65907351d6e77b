//! Temporary files: removed when they are dropped, and when the program is interrupted.
//!
//! Ctrl-C and SIGTERM run a handler on a thread of its own. It waits for commits under way, so that files that belong together
//! appear together, removes all temporary files and exits.

use crate::terminal;
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{LazyLock, Mutex, MutexGuard, Once, PoisonError, RwLock, RwLockReadGuard};
use tempfile::{Builder, TempPath};

/// The exit code after an interruption: a shell's for SIGINT.
const INTERRUPTED: i32 = 130;

/// Every temporary file there is.
static LIVE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
/// Held for reading while files are created or put in place, and for writing, to the end, by the handler.
static GATE: RwLock<()> = RwLock::new(());
/// Number of inputs of a batch whose results are in place.
static FINISHED: AtomicUsize = AtomicUsize::new(0);
/// An interruption is the usual end of the command, so it needs no message.
static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// A temporary file.
#[derive(Debug)]
pub(crate) struct Temporary(Option<TempPath>);

impl Temporary {
    /// Creates an empty file in `folder`.
    pub(crate) fn create_in(folder: &Path) -> io::Result<(Self, File)> {
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

    /// A second name for `file`, or a copy of it where there are no hard links.
    pub(crate) fn backup(file: &Path, folder: &Path) -> io::Result<Self> {
        let linked = builder().make_in(folder, |path| std::fs::hard_link(file, path));
        let made = linked.or_else(|_| builder().make_in(folder, |path| std::fs::copy(file, path).map(drop)))?;
        Ok(Self::registered(made.into_temp_path()))
    }

    fn registered(path: TempPath) -> Self {
        on_interruption_remove_all();
        live().insert(path.to_path_buf());
        Self(Some(path))
    }

    /// The file.
    pub(crate) fn path(&self) -> &Path {
        self.0.as_deref().unwrap_or(Path::new(""))
    }

    /// Renames the file, over an existing one.
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

/// Keeps the handler waiting until the guard is dropped.
pub(crate) fn hold() -> RwLockReadGuard<'static, ()> {
    GATE.read().unwrap_or_else(PoisonError::into_inner)
}

/// Counts an input of a batch as finished.
pub(crate) fn count_finished() {
    FINISHED.fetch_add(1, Ordering::Relaxed);
}

fn builder() -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(OWN_PREFIX.as_str());
    builder
}

fn live() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Interruptions end the program without a message from now on.
pub(crate) fn on_interruption_end_quietly() {
    IS_QUIET.store(true, Ordering::Relaxed);
    on_interruption_remove_all();
}

/// Installs the handler, once.
pub(crate) fn on_interruption_remove_all() {
    static INSTALL: Once = Once::new();
    INSTALL.call_once(|| {
        // A program around this library may have a handler already; it then answers for interruptions.
        let _ = ctrlc::set_handler(|| {
            remove_all_and(|| {
                if IS_QUIET.load(Ordering::Relaxed) {
                    std::process::exit(INTERRUPTED);
                }
                terminal::error(&match FINISHED.load(Ordering::Relaxed) {
                    0 => "interrupted; no output was written".to_owned(),
                    1 => "interrupted; the result of 1 input is written".to_owned(),
                    n => format!("interrupted; the results of {n} inputs are written"),
                });
                std::process::exit(INTERRUPTED);
            });
        });
    });
}

/// Waits for commits under way, ends the plug-ins' programs, removes all temporary files, and calls `end`, which ends this program.
pub(crate) fn remove_all_and(end: impl FnOnce()) {
    let _gate = GATE.write().unwrap_or_else(PoisonError::into_inner);
    pathwarp_plugin::end_all();
    for path in live().iter() {
        let _ = std::fs::remove_file(path);
    }
    end();
}

const PREFIX: &str = ".pathwarp-";

/// The start of the names of this run's temporary files.
pub(crate) static OWN_PREFIX: LazyLock<String> =
    LazyLock::new(|| format!("{PREFIX}{}-{}-", machine(), std::process::id()));

/// Folders that need no further look.
static CLEAN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Removes what killed runs left in `folder`, at the first call for it.
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

fn is_leftover(name: &OsStr) -> bool {
    let process = || {
        let own = name.to_str()?.strip_prefix(PREFIX)?;
        let (process, _) = own.strip_prefix(&machine())?.strip_prefix('-')?.split_once('-')?;
        process.parse().ok()
    };
    process().is_some_and(|p: i32| !is_running(p))
}

/// This machine's name, of letters and digits alone.
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
    // A process of another user may not be signalled, but it exists.
    Pid::from_raw(process).is_none_or(|p| test_kill_process(p) != Err(rustix::io::Errno::SRCH))
}

/// There is no way to ask without unsafe code, so nothing is removed.
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
