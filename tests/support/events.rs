//! Waiting for other processes by blocking calls, so that no clock decides how a test ends.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// Time limit that turns a hang into a failure. Whatever ends takes less, even on a busy machine.
pub const LAST_RESORT: Duration = Duration::from_secs(1000);

/// Waits until `event` returns.
#[track_caller]
pub fn awaited<T: Send + 'static>(what: &str, event: impl FnOnce() -> T + Send + 'static) -> T {
    let (sender, receiver) = channel();
    std::thread::spawn(move || sender.send(event()));
    receiver.recv_timeout(LAST_RESORT).unwrap_or_else(|e| match e {
        RecvTimeoutError::Timeout => panic!("{what}: not within {LAST_RESORT:?}"),
        RecvTimeoutError::Disconnected => panic!("{what}: see the message above"),
    })
}

#[cfg(unix)]
pub use pipe::{Heard, Pipe};

#[cfg(unix)]
mod pipe {
    use super::awaited;
    use std::fs::{File, OpenOptions};
    use std::io::{BufRead as _, BufReader, Read as _};
    use std::path::{Path, PathBuf};
    use std::process::Command;

    /// A named pipe.
    pub struct Pipe(PathBuf);

    impl Pipe {
        pub fn new(file: PathBuf) -> Self {
            assert!(Command::new("mkfifo").arg(&file).status().unwrap().success());
            Self(file)
        }

        pub fn path(&self) -> &Path {
            &self.0
        }

        /// Waits until another process reads the pipe. As long as the file is open, that process waits for more.
        #[track_caller]
        pub fn is_read(&self, what: &str) -> File {
            let file = self.0.clone();
            awaited(what, move || OpenOptions::new().write(true).open(file)).unwrap()
        }

        /// Listens to the processes that have the pipe open for writing from now on.
        pub fn hear(&self) -> Heard {
            // A pipe that is opened for reading and writing needs no other side.
            let own = OpenOptions::new().read(true).write(true).open(&self.0).unwrap();
            Heard { lines: BufReader::new(File::open(&self.0).unwrap()), own }
        }
    }

    /// The reading side of a pipe.
    pub struct Heard {
        lines: BufReader<File>,
        own: File,
    }

    impl Heard {
        /// Waits until a process writes a line.
        #[track_caller]
        pub fn line(mut self, what: &str) -> Self {
            awaited(what, move || {
                let mut line = String::new();
                self.lines.read_line(&mut line).unwrap();
                self
            })
        }

        /// Waits until no process has the pipe open.
        #[track_caller]
        pub fn end(self, what: &str) {
            let Self { mut lines, own } = self;
            drop(own);
            awaited(what, move || lines.read_to_end(&mut Vec::new())).unwrap();
        }
    }
}
