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

/// Folders of the workspace that commands read.
const INPUTS: [&str; 2] = ["samples", "crates/pathwarp-text/tests/fonts"];

/// Runs a command line in a folder that holds only its inputs, and hashes its exit codes, standard output and files.
fn of_one(root: &Path, program: &Path, line: &str) -> Result<String, ChoreError> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let inputs: Vec<&str> = INPUTS.into_iter().filter(|input| line.contains(input)).collect();
    for input in &inputs {
        copy(&root.join(input), &folder.path().join(input))?;
    }
    let mut hash = Sha256::new();
    let mut piped = Vec::new();
    let words = shell::words(line);
    for stage in words.split(|w| w == "|") {
        let stage = if stage.first().is_some_and(|w| w == "pathwarp") { &stage[1..] } else { stage };
        let mut command = Command::new(program);
        command.args(stage).current_dir(folder.path()).env("RAYON_NUM_THREADS", "1");
        let output = shell::feed(&mut command, &piped).map_err(at(program))?;
        hash.update(output.status.code().unwrap_or(-1).to_le_bytes());
        piped = if stage.first().is_some_and(|w| w == "schema") { wordless(&output.stdout)? } else { output.stdout };
    }
    hash.update(&piped);
    for file in files::below(folder.path(), |file| !inputs.iter().any(|i| file.starts_with(folder.path().join(i))))? {
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
    without(report, |name, _| ["warnings", "why", "seconds", "version"].contains(&name))
}

/// A schema without descriptions and titles. Properties may have these names, too, but their values are not strings.
fn wordless(schema: &[u8]) -> Result<Vec<u8>, ChoreError> {
    without(schema, |name, value| value.is_string() && ["description", "title"].contains(&name))
}

/// A JSON document without some members of its objects.
fn without(json: &[u8], dropped: impl Fn(&str, &Value) -> bool) -> Result<Vec<u8>, ChoreError> {
    fn strip(value: &mut Value, dropped: &dyn Fn(&str, &Value) -> bool) {
        match value {
            Value::Object(map) => {
                map.retain(|name, value| !dropped(name, value));
                map.values_mut().for_each(|value| strip(value, dropped));
            }
            Value::Array(list) => list.iter_mut().for_each(|value| strip(value, dropped)),
            _ => {}
        }
    }
    let mut value: Value = serde_json::from_slice(json).map_err(|e| e.to_string())?;
    strip(&mut value, &dropped);
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

    #[test]
    fn only_the_words_of_a_schema_may_change() {
        let schema = |words: &str, kind: &str| {
            wordless(
                format!(
                    r#"{{"title":"{words}","properties":{{"title":{{"type":"{kind}","description":"{words}"}}}}}}"#
                )
                .as_bytes(),
            )
        };
        assert_eq!(schema("a", "string"), schema("b", "string"));
        assert_ne!(schema("a", "string"), schema("a", "number"));
    }
}
