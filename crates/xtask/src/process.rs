//! Runs programs and measures each run: CPU time, elapsed time and peak memory of exactly that process.

use crate::chore::{ChoreError, at};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;
use wait4::Wait4 as _;

/// Time and memory of one run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Usage {
    /// The exit code; `None` if the process was killed.
    pub(crate) code: Option<i32>,
    /// User and system time in seconds.
    pub(crate) cpu: f64,
    /// Elapsed time in seconds.
    pub(crate) wall: f64,
    /// Peak resident size in bytes.
    pub(crate) peak: u64,
}

impl Usage {
    pub(crate) fn megabytes(&self) -> f64 {
        self.peak as f64 / 1e6
    }
}

/// A program with its arguments.
#[derive(Debug, Clone)]
pub(crate) struct Job {
    program: PathBuf,
    args: Vec<OsString>,
}

impl Job {
    pub(crate) fn new(program: &Path, args: impl IntoIterator<Item = impl Into<OsString>>) -> Self {
        Self { program: program.to_owned(), args: args.into_iter().map(Into::into).collect() }
    }

    /// This job with more arguments.
    pub(crate) fn with(&self, more: &[&str]) -> Self {
        let args = self.args.iter().cloned().chain(more.iter().map(Into::into)).collect();
        Self { args, ..self.clone() }
    }

    /// Runs the program once, whatever its exit code.
    pub(crate) fn run_unchecked(&self) -> Result<Usage, ChoreError> {
        let mut command = Command::new(&self.program);
        command.args(&self.args).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let started = Instant::now();
        let done = command.spawn().and_then(|mut child| child.wait4()).map_err(at(&self.program))?;
        Ok(Usage {
            code: done.status.code(),
            cpu: (done.rusage.utime + done.rusage.stime).as_secs_f64(),
            wall: started.elapsed().as_secs_f64(),
            peak: done.rusage.maxrss,
        })
    }

    /// Runs the program once. `None` if it was killed or refused its input (exit code above 1). Code 1 is pathwarp's partial success.
    pub(crate) fn run(&self) -> Result<Option<Usage>, ChoreError> {
        Ok(Some(self.run_unchecked()?).filter(|used| used.code.is_some_and(|c| c <= 1)))
    }

    /// Runs the program several times and returns the run with the median of `figure`.
    pub(crate) fn median(&self, rounds: usize, figure: fn(&Usage) -> f64) -> Result<Usage, ChoreError> {
        let mut runs = Vec::with_capacity(rounds);
        for _ in 0..rounds {
            runs.push(self.run()?.ok_or_else(|| format!("{} failed", self.program.display()))?);
        }
        runs.sort_by(|a, b| figure(a).total_cmp(&figure(b)));
        Ok(runs[runs.len() / 2])
    }
}

/// Runs two jobs alternately, so that drifts of the machine's speed affect both alike, and returns the pair of runs with the median
/// ratio of CPU times. `None` if a run gives `None`.
pub(crate) fn paired(a: &Job, b: &Job, rounds: usize) -> Result<Option<(Usage, Usage)>, ChoreError> {
    let mut pairs = Vec::with_capacity(rounds);
    for _ in 0..rounds {
        let (Some(a), Some(b)) = (a.run()?, b.run()?) else { return Ok(None) };
        pairs.push((a, b));
    }
    pairs.sort_by(|x, y| (x.0.cpu / x.1.cpu).total_cmp(&(y.0.cpu / y.1.cpu)));
    Ok(pairs.get(pairs.len() / 2).copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn usage_belongs_to_one_run() {
        let shell = |script: &str| Job::new(Path::new("/bin/sh"), ["-c", script]);
        let busy = shell("i=0; while [ $i -lt 60000 ]; do i=$((i+1)); done").run().unwrap().unwrap();
        let idle = shell("sleep 0.2").run().unwrap().unwrap();
        assert!(idle.wall >= 0.2 && idle.cpu < 0.1 && busy.cpu > idle.cpu, "{busy:?} {idle:?}");
        assert!(busy.peak > 100_000, "{busy:?}");
        assert!(shell("exit 2").run().unwrap().is_none() && shell("exit 1").run().unwrap().is_some());
        let (a, b) = paired(&shell("sleep 0.1"), &shell("exit 0"), 3).unwrap().unwrap();
        assert!(a.wall > b.wall);
    }
}
