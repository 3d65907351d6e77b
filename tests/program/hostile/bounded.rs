//! Runs the program under limits of the operating system, and measures it.

use crate::support::pathwarp_program;
use pathwarp::budget::{Limit, Limits};
use std::fs;
use std::io::Read as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::OnceLock;
use tempfile::TempDir;
use wait4::Wait4 as _;

/// The promise: seconds of processor time on the machine for which the limits on work were chosen, and bytes of memory in use.
const SECONDS: f64 = 5.0;
const MEMORY: u64 = 500_000_000;
/// Fraction of the work allowed that runs get; they must have refused after this fraction of the time.
const PART: f64 = 0.03;
/// Seconds for reading an input up to the point where its work is counted.
const READING: f64 = 1.0;
/// Multiple of the promised time that a run gets. Processor time depends on the machine and on its other load, work does not, so only work
/// that nobody counts takes too long. `PATHWARP_PROMISE=1` asks for the promise itself, on a quiet machine.
const MARGIN: f64 = 10.0;
/// Limit on the address space, which the stacks of threads reserve without using it.
const ADDRESSES: u64 = 2 * MEMORY;

fn margin() -> f64 {
    static FOUND: OnceLock<f64> = OnceLock::new();
    *FOUND.get_or_init(|| if std::env::var_os("PATHWARP_PROMISE").is_some() { 1.0 } else { MARGIN })
}

/// A folder with files.
pub struct Folder {
    dir: TempDir,
    /// The fraction of the limits that runs get; `None` for the whole limits.
    part: Option<f64>,
}

impl Folder {
    pub fn with(files: &[(&str, &[u8])]) -> Self {
        let dir = tempfile::tempdir().unwrap();
        for (name, content) in files {
            let path = dir.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, content).unwrap();
        }
        Self { dir, part: Some(PART) }
    }

    /// Gives runs the default limits.
    pub fn whole(self) -> Self {
        Self { part: None, ..self }
    }

    /// Gives runs ten times the fraction that others get, for tests that need their work done.
    pub fn ample(self) -> Self {
        Self { part: Some(10.0 * PART), ..self }
    }

    pub fn path(&self) -> &Path {
        self.dir.path()
    }

    /// Runs the program here. It must end by itself, within the promise.
    #[track_caller]
    pub fn run(&self, args: &[&str]) -> (i32, String) {
        let margin = margin();
        // The shell sets the limits before the program begins, in kilobytes and seconds.
        let (kilobytes, seconds) = (ADDRESSES / 1024, (SECONDS * margin).ceil());
        let limited = format!("ulimit -v {kilobytes} && ulimit -t {seconds} && exec \"$0\" \"$@\"");
        let mut command = Command::new("sh");
        command.arg("-c").arg(limited).arg(pathwarp_program()).args(args).current_dir(self.path());
        if let Some(part) = self.part {
            command.args(["--limit", &format!("work={}", part * Limits::default().of(Limit::Work))]);
        }
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut said = String::new();
        let _ = child.stderr.take().unwrap().read_to_string(&mut said);
        let done = child.wait4().unwrap();
        let (time, memory) = (done.rusage.utime + done.rusage.stime, done.rusage.maxrss);
        let code = done.status.code().unwrap_or_else(|| panic!("{args:?} was killed after {time:?}: {said}"));
        let refused = said.contains("--limit work=");
        let promised = self.part.filter(|_| refused).map_or(SECONDS, |part| part * SECONDS + READING);
        assert!(time.as_secs_f64() < promised * margin, "{args:?} took {time:?}: {said}");
        assert!(memory < MEMORY, "{args:?} took {memory} bytes: {said}");
        assert!([0, 1, 2, 3, 4, 5].contains(&code), "{args:?} ended with {code}: {said}");
        assert!(!said.contains("panicked"), "{args:?}: {said}");
        // Known work is counted before it is done; limits on time and memory are for unknown work.
        assert!(!said.contains("the run takes"), "{args:?}: {said}");
        (code, said)
    }

    /// Runs commands that warp, flatten and render `file`, and returns the code and message of each.
    #[track_caller]
    pub fn run_all(&self, file: &str) -> Vec<(i32, String)> {
        let flat = ["wave", file, "-o", "flat.svg", "--structure", "flatten", "--strokes", "outline", "--fit", "page"];
        let commands: [&[&str]; 6] = [
            &["swirl", file, "-o", "out.svg"],
            &flat,
            &["mls", file, "--pair", "10,10:20,20", "--pin", "50,50", "--gradients", "exact", "-o", "exact.svg"],
            &["render", file, "-o", "out.png"],
            &["paths", file],
            &["convert", file, "-o", "copy.json"],
        ];
        commands.into_iter().map(|c| self.run(c)).collect()
    }

    /// Asserts that warping, rendering and listing `file` are all refused with the limit named: no command can read the file.
    #[track_caller]
    pub fn is_not_read(&self, file: &str, limit: &str) {
        for args in [&["swirl", file, "-o", "out.svg"][..], &["render", file, "-o", "out.png"], &["paths", file]] {
            let (code, said) = self.run(args);
            assert!(code == 3 && said.contains(limit), "{args:?} do not name `{limit}`: {code} {said}");
        }
    }

    /// Asserts that warping and rendering `file` end with these codes and words, after all commands kept the promise.
    #[track_caller]
    pub fn expect(&self, file: &str, [warp, render]: [i32; 2], words: &str) {
        let all = self.run_all(file);
        assert_eq!([all[0].0, all[3].0], [warp, render], "{file}: {all:#?}");
        let ended = all.iter().filter(|(code, _)| *code != 0);
        for (_, said) in ended.take(1) {
            assert!(said.contains(words), "{file} does not say `{words}`: {said}");
        }
    }
}

/// A drawing of 100 × 100 units.
pub fn svg(body: &str) -> Vec<u8> {
    let names = "xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink'";
    format!("<svg {names} viewBox='0 0 100 100' width='100' height='100'>{body}</svg>").into()
}

/// Runs all commands on a drawing.
#[track_caller]
pub fn expect(body: &str, codes: [i32; 2], words: &str) {
    Folder::with(&[("a.svg", &svg(body))]).expect("a.svg", codes, words);
}

/// Asserts that a drawing is refused by the limit when it is read.
#[track_caller]
pub fn is_not_read(body: &str, limit: &str) {
    Folder::with(&[("a.svg", &svg(body))]).is_not_read("a.svg", limit);
}

pub const RECT: &str = "<rect x='10' y='10' width='50' height='30'/>";
