//! Temporary files of runs that were killed: the next run that writes to their folder removes them.
//!
//! A name, `.pathwarp-MACHINE-PROCESS-RANDOM`, tells whose file it is. Files of other machines, on shared folders, are left alone, as
//! nothing here can tell whether their process still runs.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, PoisonError};

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

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn only_files_of_ended_processes_are_removed() -> std::io::Result<()> {
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
