//! The hash of a command's output.

use crate::chore::{ChoreError, at};
use crate::{files, parallel, shell};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The hash of every command's output, in order.
pub(super) fn of_all(root: &Path, program: &Path, lines: &[String]) -> Result<Vec<String>, ChoreError> {
    parallel::map(lines, |line| of_one(root, program, line)).into_iter().collect()
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
        let mut command = Command::new(program);
        command.args(stage).current_dir(folder.path()).env("RAYON_NUM_THREADS", "1");
        let output = shell::feed(&mut command, &piped).map_err(at(program))?;
        hash.update(output.status.code().unwrap_or(-1).to_le_bytes());
        piped = output.stdout;
    }
    hash.update(&piped);
    for file in files::below(folder.path(), |file| !file.starts_with(&samples))? {
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
