//! Runs the command lines that pages show, with pipes but without a shell.

use crate::chore::{ChoreError, at};
use clap::ArgMatches;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The program named by `--program`, or else one built in release mode.
pub(crate) fn program(root: &Path, arguments: &ArgMatches) -> Result<PathBuf, ChoreError> {
    if let Some(program) = arguments.get_one::<PathBuf>("program") {
        return program.canonicalize().map_err(at(program));
    }
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--release", "--package", "pathwarp-cli", "--target-dir"]).arg(root.join("target"));
    let status = cargo.current_dir(root).status().map_err(|e| e.to_string())?;
    if !status.success() {
        return Err("the program does not build".into());
    }
    Ok(root.join("target/release/pathwarp").with_extension(std::env::consts::EXE_EXTENSION))
}

/// Splits a shell command line with single quotes into words.
pub(crate) fn words(line: &str) -> Vec<String> {
    let mut out = Vec::new();
    for (i, part) in line.split('\'').enumerate() {
        if i % 2 == 1 {
            out.push(part.to_owned());
        } else {
            out.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    out
}

/// The commands of a pipeline, each without its first word. An output file is replaced by standard output.
pub(crate) fn stages(line: &str) -> Vec<Vec<String>> {
    let words = words(line);
    let stages = words.split(|w| w == "|").map(|stage| {
        let mut stage: Vec<String> = stage.iter().skip(1).cloned().collect();
        if let Some(i) = stage.iter().position(|w| w == "-o") {
            stage.drain(i..(i + 2).min(stage.len()));
            stage.extend(["-o".to_owned(), "-".to_owned()]);
        }
        stage
    });
    stages.collect()
}

/// Runs a command with `input` as its standard input and captures its output.
pub(crate) fn feed(command: &mut Command, input: &[u8]) -> io::Result<Output> {
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    if let Some(mut stdin) = child.stdin.take() {
        // The child may exit without reading; ignore the broken pipe.
        let _ = stdin.write_all(input);
    }
    child.wait_with_output()
}

/// Runs the program on `input` and returns its standard output. Any message on standard error is a failure, but for notes, such as
/// of a page that grew.
pub(crate) fn pipe(root: &Path, program: &Path, args: &[String], input: &[u8]) -> Result<Vec<u8>, ChoreError> {
    let out = feed(Command::new(program).args(args).current_dir(root), input).map_err(at(program))?;
    let said = String::from_utf8_lossy(&out.stderr);
    if out.status.success() && said.lines().all(|line| line.starts_with("note: ")) {
        return Ok(out.stdout);
    }
    Err(format!("pathwarp {}: {said}", args.join(" ")))
}

/// Renders the preview of a command, given without its leading `pathwarp`, to a PNG file.
pub(crate) fn preview(root: &Path, program: &Path, command: &str, png: &Path) -> Result<(), ChoreError> {
    let mut stages = stages(&format!("pathwarp {command}"));
    let Some(mut last) = stages.pop() else { return Ok(()) };
    let mut drawing = Vec::new();
    for stage in stages {
        drawing = pipe(root, program, &stage, &drawing)?;
    }
    if last[0] == "text" {
        // Text has no picture from before.
        let lettering = pipe(root, program, &last, &drawing)?;
        let file = png.display().to_string();
        let render = ["render", "-", "--width", "800", "--background", "white", "-o", &file].map(str::to_owned);
        return pipe(root, program, &render, &lettering).map(drop);
    }
    // Replace any preview that the example itself asks for.
    if let Some(i) = last.iter().position(|w| w == "--preview") {
        last.drain(i..(i + 2).min(last.len()));
    }
    last.retain(|w| w != "--explain");
    last.extend(["--quiet", "--preview"].map(str::to_owned));
    last.push(png.display().to_string());
    pipe(root, program, &last, &drawing).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splits_pipelines_into_stages() {
        let all = stages("pathwarp text 'a | b' | pathwarp bend - -o out.svg");
        assert_eq!(all, [vec!["text", "a | b"], vec!["bend", "-", "-o", "-"]]);
    }
}
