//! The hash of a command's output.

use crate::chore::{ChoreError, at};
use crate::shell;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The hash of every command's output, in order.
pub(super) fn of_all(root: &Path, program: &Path, lines: &[String]) -> Result<Vec<String>, ChoreError> {
    let next = AtomicUsize::new(0);
    let out = Mutex::new(vec![Ok(String::new()); lines.len()]);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some((i, line)) =
                    Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|i| Some((i, lines.get(i)?)))
                {
                    let hash = of_one(root, program, line);
                    if let Ok(mut out) = out.lock() {
                        out[i] = hash;
                    }
                }
            });
        }
    });
    out.into_inner().map_err(|e| e.to_string())?.into_iter().collect()
}

/// Runs a command line in an empty folder with the samples and hashes its exit codes, standard output and files.
fn of_one(root: &Path, program: &Path, line: &str) -> Result<String, ChoreError> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let samples = folder.path().join("samples");
    copy(&root.join("samples"), &samples)?;
    let mut hash = Sha256::new();
    let mut piped = Vec::new();
    let words = shell::words(line);
    for stage in words.split(|w| w == "|") {
        let stage = if stage.first().is_some_and(|w| w == "pathwarp") { &stage[1..] } else { stage };
        let mut child = Command::new(program)
            .args(stage)
            .current_dir(folder.path())
            .env("RAYON_NUM_THREADS", "1")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(at(program))?;
        if let Some(mut stdin) = child.stdin.take() {
            // The program may exit without reading; ignore the broken pipe.
            let _ = stdin.write_all(&piped);
        }
        let output = child.wait_with_output().map_err(|e| e.to_string())?;
        hash.update(output.status.code().unwrap_or(-1).to_le_bytes());
        piped = output.stdout;
    }
    hash.update(&piped);
    let mut files: Vec<PathBuf> = Vec::new();
    collect(folder.path(), &samples, &mut files)?;
    files.sort();
    for file in files {
        let bytes = fs::read(&file).map_err(at(&file))?;
        let name = file.strip_prefix(folder.path()).unwrap_or(&file);
        hash.update(name.as_os_str().as_encoded_bytes());
        if name == Path::new("report.json") {
            hash.update(numbers(&bytes)?);
        } else {
            hash.update(&bytes);
        }
    }
    Ok(hash.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    }))
}

/// Collects the files below a folder, without those in the folder `except`.
fn collect(folder: &Path, except: &Path, out: &mut Vec<PathBuf>) -> Result<(), ChoreError> {
    for entry in fs::read_dir(folder).map_err(|e| e.to_string())? {
        let path = entry.map_err(|e| e.to_string())?.path();
        if path.is_dir() && path != except {
            collect(&path, except, out)?;
        } else if path.is_file() {
            out.push(path);
        }
    }
    Ok(())
}

/// Copies the files of a folder, without its subfolders.
fn copy(from: &Path, to: &Path) -> Result<(), ChoreError> {
    fs::create_dir_all(to).map_err(at(to))?;
    for entry in fs::read_dir(from).map_err(at(from))? {
        let entry = entry.map_err(at(from))?;
        if entry.path().is_file() {
            fs::copy(entry.path(), to.join(entry.file_name())).map_err(at(from))?;
        }
    }
    Ok(())
}

/// A report without messages, times and version.
fn numbers(report: &[u8]) -> Result<Vec<u8>, ChoreError> {
    fn strip(value: &mut Value) {
        match value {
            Value::Object(map) => {
                for name in ["warnings", "why", "seconds", "version"] {
                    map.remove(name);
                }
                map.values_mut().for_each(strip);
            }
            Value::Array(list) => list.iter_mut().for_each(strip),
            _ => {}
        }
    }
    let mut value: Value = serde_json::from_slice(report).map_err(|e| format!("report: {e}"))?;
    strip(&mut value);
    serde_json::to_vec(&value).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_messages_and_times_of_a_report_may_change() {
        let report = |why: &str, error: &str| {
            numbers(
                format!(r#"{{"totals":{{"seconds":{error}}},"shapes":[{{"why":"{why}","max_error":{error}}}]}}"#)
                    .as_bytes(),
            )
        };
        assert_eq!(report("a", "0.5"), report("b", "0.5"));
        assert_ne!(report("a", "0.5"), report("a", "0.25"));
    }
}
