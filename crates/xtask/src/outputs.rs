//! `cargo xtask outputs`: a fingerprint of everything the program writes, to show that a change of its inside changes nothing
//! outside.
//!
//! `--store FILE` runs every command of the cookbook, of the guides and of the help pages, and a few over each drawing of the
//! given folders, and writes one line per command: a hash of all that it wrote, and the command. `--check FILE` runs the same
//! commands again and names those whose hash differs.
//!
//! Words are not compared: standard error is ignored, and of a report only its numbers count.

use crate::{Fault, cookbook, docs};
use pathwarp::deform::Registry;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What every drawing is put through; each takes the next of these.
const WARPS: [&str; 8] = [
    "warp FILE --style flag --bend 40%",
    "shaper FILE --shaper samples/cages.svg#arch --strokes outline --gradients exact",
    "projective FILE --target '0%,100% 100%,90% 80%,0% 15%,5%' --fit grow",
    "bend FILE --along 'M0,100 Q150,20 300,100' --fit page --structure flatten",
    "envelope FILE --bottom 'M0,100 H400' --top 'M0,40 Q200,-60 400,40' --keep verticals --certify",
    "wave FILE --tolerance 0.05 --merge off + affine --rotate 10",
    "swirl FILE --patterns instantiate --strokes auto --text skip",
    "warp FILE --style arc --bend 60% --gradients keep --images keep --precision 3",
];

/// Commands that no page shows.
const MORE: [&str; 7] = [
    "shaper samples/paper.xcf --base '#Base' --target '#Target' --shaper '#Shaper' -o out.svg --report report.json",
    "shaper samples/paper.xcf --base '#Base' --target '#Target' --shaper '#Shaper' -o out.json",
    "shaper samples/paper.xcf --base '#Base' --target '#Target' --shaper '#Shaper' --into bent.xcf",
    "convert samples/paper.xcf -o out.svg",
    "warp samples/logo.svg --style flag -o out.svg --write-recipe out.toml --embed-recipe --preview out.png",
    "gallery samples/logo.svg -o out.svg",
    "schema",
];

/// What is wanted of a run.
pub(crate) struct Task {
    /// The program; one is built if there is none.
    pub(crate) program: Option<PathBuf>,
    /// Folders of drawings.
    pub(crate) drawings: Vec<PathBuf>,
    /// How many drawings of each folder.
    pub(crate) count: usize,
    /// Where the hashes are, or go.
    pub(crate) file: PathBuf,
    /// Whether to compare instead of to write.
    pub(crate) check: bool,
    /// Run one command of this many.
    pub(crate) every: usize,
}

/// Stores the hashes, or compares with stored ones.
pub(crate) fn run(root: &Path, task: &Task) -> Result<String, Fault> {
    let program = match &task.program {
        Some(p) => p.canonicalize().map_err(|e| format!("{}: {e}", p.display()))?,
        None => docs::build(root)?,
    };
    if !task.check {
        let lines = commands(&program, task)?;
        let hashes = hashes(root, &program, &lines)?;
        let text: String = hashes.iter().zip(&lines).map(|(h, l)| format!("{h} {l}\n")).collect();
        fs::write(&task.file, text).map_err(|e| format!("{}: {e}", task.file.display()))?;
        return Ok(format!("stored what {} commands wrote", lines.len()));
    }
    let text = fs::read_to_string(&task.file).map_err(|e| format!("{}: {e}", task.file.display()))?;
    let stored: Vec<(&str, &str)> = text.lines().filter_map(|l| l.split_once(' ')).step_by(task.every.max(1)).collect();
    let lines: Vec<String> = stored.iter().map(|(_, line)| (*line).to_owned()).collect();
    let now = hashes(root, &program, &lines)?;
    let mut differ = String::new();
    for ((hash, line), new) in stored.iter().zip(&now) {
        if hash != new {
            let _ = write!(differ, "\n  pathwarp {line}");
        }
    }
    if differ.is_empty() {
        Ok(format!("{} commands wrote the same bytes", lines.len()))
    } else {
        Err(format!("of {} commands these wrote other bytes:{differ}", lines.len()))
    }
}

/// All command lines, without the leading `pathwarp`; the stages of a pipeline are separated by ` | `.
fn commands(program: &Path, task: &Task) -> Result<Vec<String>, Fault> {
    let mut seen = BTreeSet::new();
    let mut all = Vec::new();
    let mut add = |line: String| {
        if seen.insert(line.clone()) {
            all.push(line);
        }
    };
    for line in cookbook::commands().chain(MORE) {
        add(line.to_owned());
    }
    for entry in Registry::builtin().entries() {
        for example in entry.info().examples {
            add(example.command.to_owned());
        }
    }
    // The registry's examples are taken whole from its table above: help wraps long lines.
    for line in help_examples(program)? {
        add(line);
    }
    for folder in &task.drawings {
        let files = svg_files(folder)?;
        let step = (files.len() / task.count.max(1)).max(1);
        for (i, file) in files.iter().step_by(step).take(task.count).enumerate() {
            let warp = WARPS[i % WARPS.len()].replace("FILE", &format!("'{}'", file.display()));
            add(format!("{warp} -o out.svg --report report.json --on-error skip"));
        }
    }
    Ok(all)
}

/// The examples in the help of every subcommand that run on the samples.
fn help_examples(program: &Path) -> Result<Vec<String>, Fault> {
    let help = |args: &[&str]| -> Result<String, Fault> {
        let out = Command::new(program).args(args).output().map_err(|e| format!("{}: {e}", program.display()))?;
        Ok(String::from_utf8_lossy(&out.stdout).into_owned())
    };
    let names = help(&["help"])?;
    let names = names.lines().skip_while(|l| !l.starts_with("Commands:")).skip(1).take_while(|l| !l.is_empty());
    let mut out = Vec::new();
    let names = names.filter_map(|l| l.strip_prefix("  ")?.split_whitespace().next());
    for name in names.filter(|n| Registry::builtin().get(n).is_none()) {
        for line in help(&["help", name])?.lines() {
            if let Some(command) = line.trim().strip_prefix("pathwarp ")
                && command.contains("samples/")
            {
                out.push(command.to_owned());
            }
        }
    }
    Ok(out)
}

/// Every SVG file below a folder, in order, by its whole path.
fn svg_files(folder: &Path) -> Result<Vec<PathBuf>, Fault> {
    let fault = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut out = Vec::new();
    for entry in fs::read_dir(folder.canonicalize().map_err(fault)?).map_err(fault)? {
        let path = entry.map_err(fault)?.path();
        if path.is_dir() {
            out.extend(svg_files(&path)?);
        } else if path.extension().is_some_and(|e| e == "svg") && !path.display().to_string().contains('\'') {
            out.push(path);
        }
    }
    out.sort();
    Ok(out)
}

/// The hash of what each command writes, in order.
fn hashes(root: &Path, program: &Path, lines: &[String]) -> Result<Vec<String>, Fault> {
    let next = AtomicUsize::new(0);
    let out = Mutex::new(vec![Ok(String::new()); lines.len()]);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some((i, line)) =
                    Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|i| Some((i, lines.get(i)?)))
                {
                    let hash = written(root, program, line);
                    if let Ok(mut out) = out.lock() {
                        out[i] = hash;
                    }
                }
            });
        }
    });
    out.into_inner().map_err(|e| e.to_string())?.into_iter().collect()
}

/// The hash of a command's exit codes, standard output and files, run in a folder of its own.
fn written(root: &Path, program: &Path, line: &str) -> Result<String, Fault> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let samples = folder.path().join("samples");
    copy(&root.join("samples"), &samples)?;
    let mut hash = Sha256::new();
    let mut piped = Vec::new();
    let words = docs::words(line);
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
            .map_err(|e| format!("{}: {e}", program.display()))?;
        if let Some(mut stdin) = child.stdin.take() {
            // The program may exit without reading; ignore the broken pipe.
            let _ = stdin.write_all(&piped);
        }
        let done = child.wait_with_output().map_err(|e| e.to_string())?;
        hash.update(done.status.code().unwrap_or(-1).to_le_bytes());
        piped = done.stdout;
    }
    hash.update(&piped);
    let mut files: Vec<PathBuf> = Vec::new();
    collect(folder.path(), &samples, &mut files)?;
    files.sort();
    for file in files {
        let bytes = fs::read(&file).map_err(|e| format!("{}: {e}", file.display()))?;
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

fn collect(folder: &Path, left_out: &Path, out: &mut Vec<PathBuf>) -> Result<(), Fault> {
    for entry in fs::read_dir(folder).map_err(|e| e.to_string())? {
        let path = entry.map_err(|e| e.to_string())?.path();
        if path.is_dir() && path != left_out {
            collect(&path, left_out, out)?;
        } else if path.is_file() {
            out.push(path);
        }
    }
    Ok(())
}

fn copy(from: &Path, to: &Path) -> Result<(), Fault> {
    let fault = |e: std::io::Error| format!("{}: {e}", from.display());
    fs::create_dir_all(to).map_err(fault)?;
    for entry in fs::read_dir(from).map_err(fault)? {
        let entry = entry.map_err(fault)?;
        if entry.path().is_file() {
            fs::copy(entry.path(), to.join(entry.file_name())).map_err(fault)?;
        }
    }
    Ok(())
}

/// A report without its messages and times.
fn numbers(report: &[u8]) -> Result<Vec<u8>, Fault> {
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
    fn only_the_words_of_a_report_may_change() {
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
