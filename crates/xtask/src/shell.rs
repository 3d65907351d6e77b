//! Runs command lines from the documentation, with pipes but without a shell; lists and copies files; and spreads work over threads.

use crate::chore::{ChoreError, at};
use clap::ArgMatches;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{fs, thread};

/// The program that `--program` names, or else a release build.
pub(crate) fn program(root: &Path, arguments: &ArgMatches) -> Result<PathBuf, ChoreError> {
    built(root, arguments, "release")
}

/// The program that `--program` names, or else a build in this profile.
pub(crate) fn built(root: &Path, arguments: &ArgMatches, profile: &str) -> Result<PathBuf, ChoreError> {
    if let Some(program) = arguments.get_one::<PathBuf>("program") {
        return program.canonicalize().map_err(at(program));
    }
    let mut cargo = Command::new(env!("CARGO"));
    cargo
        .args(["build", "--quiet", "--profile", profile, "--package", "pathwarp-cli", "--target-dir"])
        .arg(root.join("target"));
    let status = cargo.current_dir(root).status().map_err(|e| e.to_string())?;
    if !status.success() {
        return Err("the program does not build".into());
    }
    Ok(root.join("target").join(profile).join("pathwarp").with_extension(std::env::consts::EXE_EXTENSION))
}

/// Splits a command line into words, which may be in single quotes.
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

/// The commands of a pipeline, each without its first word. Output files are replaced by standard output.
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

/// Runs a command with `input` as its standard input, which it must read before it writes much, and captures its output.
pub(crate) fn feed(command: &mut Command, input: &[u8]) -> io::Result<Output> {
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    if let Some(mut stdin) = child.stdin.take() {
        // The child may exit without reading its input, which breaks the pipe.
        let _ = stdin.write_all(input);
    }
    child.wait_with_output()
}

/// Runs the program on `input` and returns its standard output. Any message other than a note counts as a failure.
pub(crate) fn pipe(root: &Path, program: &Path, args: &[String], input: &[u8]) -> Result<Vec<u8>, ChoreError> {
    let out = feed(Command::new(program).args(args).current_dir(root), input).map_err(at(program))?;
    let messages = String::from_utf8_lossy(&out.stderr);
    if out.status.success() && messages.lines().all(|line| line.starts_with("note: ")) {
        return Ok(out.stdout);
    }
    Err(format!("pathwarp {}: {messages}", args.join(" ")))
}

/// Renders a drawing on white to a PNG file.
pub(crate) fn render(root: &Path, program: &Path, drawing: &[u8], width: &str, png: &Path) -> Result<(), ChoreError> {
    let file = png.display().to_string();
    let args = ["render", "-", "--width", width, "--background", "white", "-o", &file].map(str::to_owned);
    pipe(root, program, &args, drawing).map(drop)
}

/// Renders the preview of a command, given without its leading `pathwarp`, to a PNG file.
pub(crate) fn preview(root: &Path, program: &Path, command: &str, png: &Path) -> Result<(), ChoreError> {
    let line = format!("pathwarp {command}");
    let mut stages = stages(&line);
    let Some(mut last) = stages.pop() else { return Ok(()) };
    let mut drawing = Vec::new();
    for stage in stages {
        drawing = pipe(root, program, &stage, &drawing)?;
    }
    if ["text", "badge"].contains(&last[0].as_str()) {
        // A preview shows the drawing before and after; lettering has no before.
        return render(root, program, &pipe(root, program, &last, &drawing)?, "800", png);
    }
    // Replace any preview that the example itself asks for.
    if let Some(i) = last.iter().position(|w| w == "--preview") {
        last.drain(i..(i + 2).min(last.len()));
    }
    // Some options hold for one format only, so the output keeps its extension.
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let file = words(&line).into_iter().skip_while(|w| w != "-o").nth(1);
    if let (Some(file), Some(output)) = (file, last.iter_mut().skip_while(|w| *w != "-o").nth(1)) {
        *output = folder.path().join(file).display().to_string();
    }
    // A preview needs no explanations.
    last.retain(|w| w != "--explain");
    last.extend(["--quiet", "--preview"].map(str::to_owned));
    last.push(png.display().to_string());
    pipe(root, program, &last, &drawing).map(drop)
}

/// The files below a folder for which `wanted` holds, sorted by path.
pub(crate) fn files_below(folder: &Path, wanted: impl Fn(&Path) -> bool) -> Result<Vec<PathBuf>, ChoreError> {
    let mut out = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).map_err(at(&folder))? {
            let path = entry.map_err(at(&folder))?.path();
            if path.is_dir() {
                folders.push(path);
            } else if wanted(&path) {
                out.push(path);
            }
        }
    }
    out.sort();
    Ok(out)
}

/// Copies a folder with its subfolders.
pub(crate) fn copy_folder(from: &Path, to: &Path) -> Result<(), ChoreError> {
    for file in files_below(from, |_| true)? {
        let copy = to.join(file.strip_prefix(from).unwrap_or(&file));
        fs::create_dir_all(copy.parent().unwrap_or(to)).map_err(at(to))?;
        fs::copy(&file, &copy).map_err(at(&file))?;
    }
    Ok(())
}

/// Returns `true` if a file has one of these extensions.
pub(crate) fn ends_in(path: &Path, extensions: &[&str]) -> bool {
    path.extension().is_some_and(|e| extensions.iter().any(|known| e == *known))
}

/// Applies `f` to every item, on all of the machine's threads, and returns the results in order.
pub(crate) fn in_parallel<T: Sync, R: Send>(items: &[T], f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let worker = || {
        let taken = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
        taken.map_while(|i| Some((i, f(items.get(i)?)))).collect::<Vec<_>>()
    };
    let mut found = thread::scope(|scope| {
        let threads = thread::available_parallelism().map_or(1, usize::from);
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(worker)).collect();
        let join = |w: thread::ScopedJoinHandle<'_, _>| w.join().unwrap_or_else(|p| std::panic::resume_unwind(p));
        workers.into_iter().flat_map(join).collect::<Vec<_>>()
    });
    found.sort_unstable_by_key(|(i, _)| *i);
    found.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn splits_pipelines_into_stages() {
        let all = stages("pathwarp text 'a | b' | pathwarp bend - -o out.svg");
        assert_eq!(all, [vec!["text", "a | b"], vec!["bend", "-", "-o", "-"]]);
    }

    #[test]
    fn results_keep_the_order_of_the_items() {
        let items: Vec<u64> = (0..50).collect();
        let slow_first = |n: &u64| {
            thread::sleep(Duration::from_micros(2000 - 40 * n));
            n * n
        };
        assert_eq!(in_parallel(&items, slow_first), items.iter().map(|n| n * n).collect::<Vec<_>>());
        assert!(in_parallel(&[], slow_first).is_empty());
    }
}
