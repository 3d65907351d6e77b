//! Starts and ends processes. They end with this process, unless it is killed itself.

use crate::fault::Fault;
use std::path::Path;
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// All running processes.
static LIVE: Mutex<Vec<Shared>> = Mutex::new(Vec::new());

/// A process, shared by [`LIVE`] and its [`Running`]; `None` once it has been ended, since another process may then have its number.
type Shared = Arc<Mutex<Option<Child>>>;

/// Environment variable set for plug-ins. A plug-in that called pathwarp with itself as a plug-in would start programs endlessly.
const WITHIN: &str = "PATHWARP_WITHIN_PLUGIN";

/// Time for a program to end after closing a pipe, so that its exit status can be reported.
pub(crate) const GRACE: Duration = Duration::from_millis(200);

/// Interval between checks whether the program has ended, since a child of it may hold its pipes open.
pub(crate) const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// A running program, in a separate process group where the system has them. Killed and waited for when dropped.
pub(crate) struct Running {
    child: Shared,
}

impl Running {
    /// Starts the program, with pipes for its three streams.
    pub(crate) fn start(path: &Path) -> Result<Self, Fault> {
        if std::env::var_os(WITHIN).is_some() {
            return Err(Fault::Nested);
        }
        check_file(path)?;
        let mut command = Command::new(path);
        command.env(WITHIN, "1");
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        #[cfg(unix)]
        {
            use std::os::unix::process::CommandExt;
            command.process_group(0);
        }
        // Hold the lock until the process is listed, so that `end_all` misses none.
        let mut live = live();
        let child = command.spawn().map_err(|e| Fault::NotStarted(e.to_string()))?;
        let child = Arc::new(Mutex::new(Some(child)));
        live.push(Arc::clone(&child));
        Ok(Self { child })
    }

    /// Takes the ends of the pipes.
    pub(crate) fn pipes(&self) -> Option<(ChildStdin, ChildStdout, ChildStderr)> {
        let mut child = self.child();
        let child = child.as_mut()?;
        Some((child.stdin.take()?, child.stdout.take()?, child.stderr.take()?))
    }

    fn child(&self) -> MutexGuard<'_, Option<Child>> {
        self.child.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns `true` if the process has ended, or if the system cannot tell.
    pub(crate) fn has_ended(&self) -> bool {
        self.child().as_mut().is_none_or(has_ended)
    }

    /// Kills the process, with its group where the system has them. Returns its exit status, from before the kill if it had already ended.
    pub(crate) fn end(&mut self) -> Option<ExitStatus> {
        let status = self.child().take().and_then(kill);
        live().retain(|c| !Arc::ptr_eq(c, &self.child));
        status
    }

    /// Returns the fault of a program that has ended or closed a stream where an answer was `expected`. `said` is its standard error.
    pub(crate) fn fault(&mut self, stream: &str, expected: String, said: String) -> Fault {
        if !self.has_ended() {
            return Fault::Closed { stream: stream.to_owned(), expected, said };
        }
        let status = self.end().map_or_else(|| "unknown status".to_owned(), |s| s.to_string());
        Fault::Ended { expected, status, said }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.end();
    }
}

/// Kills all running programs, for a process about to end without unwinding. No program can be started afterwards.
pub fn end_all() {
    let live = live();
    for child in live.iter() {
        child.lock().unwrap_or_else(PoisonError::into_inner).take().and_then(kill);
    }
    // Block threads that are about to start another until the process ends.
    std::mem::forget(live);
}

fn live() -> MutexGuard<'static, Vec<Shared>> {
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(unix)]
fn has_ended(child: &mut Child) -> bool {
    use rustix::process::{WaitId, WaitIdOptions, waitid};
    let Some(pid) = pid(child) else { return true };
    // Don't reap the process: until then, nothing else can have its number.
    let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
    !matches!(waitid(WaitId::Pid(pid), options), Ok(None))
}

#[cfg(not(unix))]
fn has_ended(child: &mut Child) -> bool {
    !matches!(child.try_wait(), Ok(None))
}

#[cfg(unix)]
fn pid(child: &Child) -> Option<rustix::process::Pid> {
    rustix::process::Pid::from_raw(i32::try_from(child.id()).ok()?)
}

fn kill(mut child: Child) -> Option<ExitStatus> {
    #[cfg(unix)]
    if let Some(pid) = pid(&child) {
        // Kill the whole group, which may have members left even if the program itself has ended.
        let _ = rustix::process::kill_process_group(pid, rustix::process::Signal::KILL);
    }
    let _ = child.kill();
    child.wait().ok()
}

/// Checks that a file can be started.
fn check_file(path: &Path) -> Result<(), Fault> {
    let meta = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file).ok_or(Fault::NoFile)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        if meta.permissions().mode() & 0o111 == 0 {
            return Err(Fault::NotExecutable);
        }
    }
    #[cfg(not(unix))]
    let _ = meta;
    Ok(())
}
