//! Runs the program, and finds the project's files.
#![allow(dead_code, reason = "every test file uses another part of this")]

pub mod browser;
pub mod editor;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

/// The project's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// Says that a check is skipped, past the test's own captured output: the gate lists such lines at the end.
pub fn skipped(why: impl std::fmt::Display) {
    use std::io::Write as _;
    let _ = std::io::stderr().write_all(format!("skipped: {why}\n").as_bytes());
}

/// A file of `samples/`.
pub fn sample(name: &str) -> PathBuf {
    root().join("samples").join(name)
}

/// The artwork among the samples (cages and anchors are not).
pub fn artwork() -> Vec<String> {
    let mut all: Vec<String> = std::fs::read_dir(root().join("samples"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .filter(|n| {
            let guides = ["cages.svg", "anchors.svg", "banner.svg", "envelopes.svg", "shapes.svg", "meshes.svg"];
            n.ends_with(".svg") && !guides.contains(&n.as_str())
        })
        .collect();
    all.sort();
    assert!(all.len() >= 8);
    all
}

/// Builds the program `name` and returns its path. Test binaries are in `target/PROFILE/deps`. With the features of the whole
/// workspace, nothing that `cargo test --workspace` has built is built again.
pub fn program(name: &str) -> PathBuf {
    let profile = std::env::current_exe().unwrap().parent().unwrap().parent().unwrap().to_owned();
    let mut build = Command::new(env!("CARGO"));
    build.args(["build", "--quiet", "--workspace", "--bin", name]).current_dir(root());
    build.arg("--target-dir").arg(profile.parent().unwrap());
    if profile.ends_with("release") {
        build.arg("--release");
    }
    assert!(build.status().unwrap().success(), "{name} does not build");
    profile.join(name).with_extension(std::env::consts::EXE_EXTENSION)
}

/// The program.
pub fn pathwarp_program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| program("pathwarp"))
}

/// Runs `pathwarp` from the project's root.
pub fn pathwarp<S: AsRef<std::ffi::OsStr>>(args: &[S]) -> Output {
    Command::new(pathwarp_program()).args(args).current_dir(root()).stdin(Stdio::null()).output().unwrap()
}

/// Runs `pathwarp` in a folder, with standard input.
pub fn pathwarp_in(folder: &Path, args: &[&str], stdin: &[u8]) -> Output {
    use std::io::Write;
    let mut child = Command::new(pathwarp_program())
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The program may exit early; ignore the broken pipe.
    let _ = child.stdin.take().unwrap().write_all(stdin);
    child.wait_with_output().unwrap()
}

/// Starts `pathwarp` in a folder, without standard input.
pub fn start_in(folder: &Path, args: &[&str]) -> std::process::Child {
    let mut command = Command::new(pathwarp_program());
    command.args(args).current_dir(folder);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Runs `pathwarp` and asserts its exit code. Returns standard output and standard error.
#[track_caller]
pub fn expect_code<S: AsRef<std::ffi::OsStr> + std::fmt::Debug>(code: i32, args: &[S]) -> (String, String) {
    let out = pathwarp(args);
    let text = |b: &[u8]| String::from_utf8_lossy(b).into_owned();
    assert_eq!(out.status.code(), Some(code), "{args:?}\n{}", text(&out.stderr));
    (text(&out.stdout), text(&out.stderr))
}

/// Splits a command line as a shell does, as far as the examples need it: words and single quotes.
pub fn words(line: &str) -> Vec<String> {
    let mut out = Vec::new();
    let mut word: Option<String> = None;
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '\'' => {
                quoted = !quoted;
                word.get_or_insert_default();
            }
            c if c.is_whitespace() && !quoted => out.extend(word.take()),
            c => word.get_or_insert_default().push(c),
        }
    }
    out.extend(word);
    out
}
