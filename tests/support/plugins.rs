//! A folder of plug-ins, and runs of the program with it.

use crate::support::events::{Heard, Pipe, awaited};
use crate::support::pathwarp_program;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A folder with plug-ins, the cache of their entries, and a drawing.
pub struct Scratch {
    pub dir: TempDir,
    /// Seconds that a program has for an answer: enough on any machine, unless a test waits for them.
    pub seconds: &'static str,
    /// A pipe that the processes of some scripts hold open.
    held: Pipe,
}

impl Scratch {
    pub fn new() -> Self {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir(dir.path().join("plug-ins")).unwrap();
        let drawing = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path d='M10,10 C40,0 60,30 90,10 L80,90 Q40,60 10,80 Z'/></svg>";
        fs::write(dir.path().join("in.svg"), drawing).unwrap();
        let held = Pipe::new(dir.path().join("held"));
        Self { dir, seconds: "1000", held }
    }

    /// Adds to a shell script a pipe that is open until the last of its processes has ended. The script waits until there is a listener.
    pub fn holding(&self, script: &str) -> String {
        let open = format!("#!/bin/sh\nexec 9>'{}'\n", self.held.path().display());
        script.replacen("#!/bin/sh\n", &open, 1)
    }

    /// Listens to the scripts that hold the pipe.
    pub fn listen(&self) -> Heard {
        self.held.hear()
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    /// Writes a script into the plug-in folder.
    pub fn install(&self, name: &str, script: &str) -> PathBuf {
        let file = self.dir.path().join("plug-ins").join(name);
        fs::write(&file, script).unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).unwrap();
        file
    }

    /// Returns a command that runs the program in the folder.
    pub fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(pathwarp_program());
        command.args(args).current_dir(self.dir.path()).stdin(Stdio::null());
        command.env("PATHWARP_PLUGINS", self.dir.path().join("plug-ins"));
        command.env("XDG_CACHE_HOME", self.dir.path().join("cache")).env("HOME", self.dir.path());
        command.env("PATHWARP_PLUGIN_SECONDS", self.seconds);
        command
    }

    pub fn run(&self, args: &[&str]) -> Output {
        let mut command = self.command(args);
        awaited("the program ends", move || command.output()).unwrap()
    }

    /// Runs the program, asserts its exit code, and returns standard output and standard error.
    pub fn expect(&self, code: i32, args: &[&str]) -> (String, String) {
        let out = self.run(args);
        let (stdout, stderr) = (text(&out.stdout), text(&out.stderr));
        assert_eq!(out.status.code(), Some(code), "{args:?}\n{stdout}\n{stderr}");
        (stdout, stderr)
    }
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// An entry named `name` that speaks text.
pub fn entry(name: &str) -> String {
    format!(
        r#"{{"pathwarp-plugin": 1, "protocol": "text", "name": "{name}", "title": "a test", "about": "A test.", "source": "a test"}}"#
    )
}

/// Returns a shell script with that entry, which builds, and answers points by the shell command `answer`; `$line` is the point.
pub fn script(name: &str, answer: &str) -> String {
    format!(
        r#"#!/bin/sh
echo '{entry}'
lines() {{ i=0; while [ $i -lt $1 ]; do read -r line; $2; i=$((i+1)); done; }}
point() {{ {answer}; }}
while read -r command count; do
    case $command in
        build) lines $count :; echo ok;;
        points) lines $count point;;
    esac
done
"#,
        entry = entry(name)
    )
}

/// Returns `true` if Python 3 is installed.
pub fn python() -> bool {
    let found = Command::new("python3").arg("--version").output().is_ok_and(|o| o.status.success());
    if !found {
        crate::support::skipped("plug-ins are not tested without Python 3");
    }
    found
}
