//! Runs the program, and finds the project's files.
#![allow(dead_code, reason = "every test file uses another part of this")]

pub mod editor;
pub mod events;
pub mod geometry;
pub mod gimp;
#[cfg(unix)]
pub mod plugins;
pub mod psd;
pub mod xcf;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The project's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap().to_owned()
}

/// Reports that a check is skipped, past the test's captured output: the gate lists such lines at the end.
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

/// Returns the path of the program.
pub fn pathwarp_program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_pathwarp"))
}

/// Another program of the workspace, beside pathwarp's: `cargo build --workspace --bins` builds it.
pub fn program(name: &str) -> PathBuf {
    let program = pathwarp_program().with_file_name(name).with_extension(std::env::consts::EXE_EXTENSION);
    assert!(program.exists(), "{} is not there: run `cargo build --workspace --bins` first", program.display());
    program
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

/// Returns the words of an example, in which outputs called `out.…` lie in a folder.
pub fn words_into(folder: &Path, example: &str) -> Vec<String> {
    let inside = |w: String| {
        if w.starts_with("out") && w.contains('.') { folder.join(w).display().to_string() } else { w }
    };
    words(example).into_iter().map(inside).collect()
}

/// Returns a drawing in Inkscape's form with the given content.
pub fn inkscape_drawing(body: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' \
         xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' \
         xmlns:sodipodi='http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd' width='200' height='200' \
         viewBox='0 0 200 200' version='1.1'>\n{body}\n</svg>\n"
    )
}
